//! Cloth takes no more substeps than it may: by its own limit, and by the time that all cloth has.

use bevy::prelude::*;
use bevy_drape::{prelude::*, solver::SubstepReason};

use crate::common::*;

/// A cloth that asks for 16 substeps, at a place.
fn spawn_costly(app: &mut App, x: f32, cloth: Cloth) -> Entity {
    let cloth = Cloth { self_collision: true, ..cloth };
    let more = (cloth, ClothSleepingDisabled, Pins::edge(ClothEdge::Top), Transform::from_xyz(x, 2.0, 0.0));
    spawn_cloth(app, ClothGrid::new(0.5, 0.5, 10, 10), more)
}

#[test]
fn no_step_is_more_work_than_a_cloth_may_do() {
    let mut app = headless();
    let cloth = spawn_costly(&mut app, 0.0, Cloth::default());
    run(&mut app, 3);
    assert_eq!(report(&app, cloth).substeps, 16);
    for (max_work, substeps) in [(599, 5), (600, 6), (1, 1), (1600, 16), (1_000_000, 16)] {
        get_mut::<Cloth>(&mut app, cloth).max_work = Some(max_work);
        run(&mut app, 2);
        let report = report(&app, cloth);
        assert_eq!((report.substeps, report.needed_substeps), (substeps, 16), "{max_work}");
        assert_eq!(report.reason == SubstepReason::Budget, substeps < 16, "{}", report.reason);
    }
}

#[test]
fn a_limit_leaves_the_explicit_solver_alone() {
    let mut app = headless();
    let cloth = spawn_costly(&mut app, 0.0, Cloth { solver: ClothSolver::Explicit, max_work: Some(1), ..default() });
    run(&mut app, 3);
    assert!(report(&app, cloth).substeps > 1);
}

#[test]
fn too_little_time_for_all_leaves_each_a_quarter_until_there_is_enough_again() {
    let mut app = headless();
    let cloths = [0.0, 5.0].map(|x| spawn_costly(&mut app, x, Cloth::default()));
    app.insert_resource(ClothBudget { milliseconds: 1e-6 });
    run(&mut app, 5);
    for cloth in cloths {
        let report = report(&app, cloth);
        assert_eq!((report.substeps, report.reason), (4, SubstepReason::Budget));
    }
    for milliseconds in [1e6, f32::INFINITY, f32::NAN, -1.0, 0.0] {
        app.insert_resource(ClothBudget { milliseconds: 1e-6 });
        run(&mut app, 2);
        app.insert_resource(ClothBudget { milliseconds });
        run(&mut app, 2);
        assert_eq!(cloths.map(|cloth| report(&app, cloth).substeps), [16; 2], "{milliseconds} ms");
    }
}

#[test]
fn what_is_far_from_all_active_cameras_is_cut_first() {
    let mut app = headless();
    let cloths: [Entity; 5] = core::array::from_fn(|i| spawn_costly(&mut app, 5.0 * i as f32, Cloth::default()));
    let at = |x: f32| (Camera::default(), Transform::from_xyz(x, 2.0, 3.0));
    app.world_mut().spawn(at(20.0));
    let off = app.world_mut().spawn(at(0.0)).id();
    get_mut::<Camera>(&mut app, off).is_active = false;
    run(&mut app, 60);
    let substeps = |app: &App| cloths.map(|cloth| report(app, cloth).substeps);
    // From a budget that is enough for all down to one that is not: whatever the machine takes, the order is the same.
    for halvings in 0..30 {
        app.insert_resource(ClothBudget { milliseconds: 1e3 * 0.5_f32.powi(halvings) });
        run(&mut app, 2);
        let now = substeps(&app);
        assert!(now.is_sorted(), "{now:?}, though the last is the nearest");
    }
    assert_eq!(substeps(&app), [4; 5]);
}
