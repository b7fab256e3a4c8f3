//! Plain springs take the place of the fabric's moduli, and leave it to them again.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

/// A square metre of 5 x 5 cells.
const GRID: ClothGrid = ClothGrid { size: Vec2::ONE, particles: UVec2::splat(6), lying: false };

/// A weightless sheet that is pulled to 1.1 times its width, of a fabric that doesn't get narrower by that.
fn pulled(more: impl Bundle) -> (App, Entity) {
    let mut app = headless();
    let bar = app.world_mut().spawn(Transform::default()).id();
    let pins = Pins::edge(ClothEdge::Left).and(Pins::edge(ClothEdge::Right).to_entity(bar));
    let settings = Cloth { gravity_scale: 0.0, tether_slack: None, ..default() };
    let fabric = Fabric {
        warp_stiffness: 3000.0,
        weft_stiffness: 1000.0,
        shear_stiffness: 0.0,
        bending_rigidity: 0.0,
        damping: 20.0,
        ..undamped()
    };
    let cloth = spawn_cloth(&mut app, GRID, (settings, fabric, pins));
    app.world_mut().entity_mut(cloth).insert(more);
    run(&mut app, 2);
    get_mut::<Transform>(&mut app, bar).translation.x = 0.1;
    run(&mut app, 180);
    (app, cloth)
}

/// Only those along the threads, N/m.
fn springs(structural_stiffness: f32) -> ClothSprings {
    ClothSprings { structural_stiffness, shear_stiffness: 0.0, bend_stiffness: 0.0, ..default() }
}

/// Of a strain of 0.1 across a square metre of weft of 1000 N/m: C ε²/2, J.
const OF_FABRIC: f32 = 5.0;
/// Of 6 rows of 5 springs of 1000 N/m, each stretched by 2 cm, J.
const OF_SPRINGS: f32 = 6.0;

#[track_caller]
fn assert_energy(app: &App, cloth: Entity, expected: f32) {
    let energy = state(app, cloth).energy(Vec3::ZERO).elastic;
    assert!((energy / expected - 1.0).abs() < 0.01, "{energy} for {expected} J");
}

#[test]
fn springs_act_in_the_next_step_as_they_come_change_and_go() {
    let (mut app, cloth) = pulled(());
    assert_energy(&app, cloth, OF_FABRIC);
    app.world_mut().entity_mut(cloth).insert(springs(1000.0));
    run(&mut app, 1);
    assert_energy(&app, cloth, OF_SPRINGS);
    get_mut::<ClothSprings>(&mut app, cloth).structural_stiffness = 2500.0;
    run(&mut app, 1);
    assert_energy(&app, cloth, 2.5 * OF_SPRINGS);
    app.world_mut().entity_mut(cloth).insert(springs(500.0));
    run(&mut app, 1);
    assert_energy(&app, cloth, 0.5 * OF_SPRINGS);
    app.world_mut().entity_mut(cloth).remove::<ClothSprings>();
    run(&mut app, 1);
    assert_energy(&app, cloth, OF_FABRIC);
    assert_eq!(app.world().resource::<Heard>().reset, [], "it runs on");
}

#[test]
fn springs_may_be_there_from_the_beginning() {
    let (mut app, cloth) = pulled(springs(1000.0));
    assert_energy(&app, cloth, OF_SPRINGS);
    get_mut::<Fabric>(&mut app, cloth).weft_stiffness = 9000.0;
    run(&mut app, 1);
    assert_energy(&app, cloth, OF_SPRINGS);
    app.world_mut().entity_mut(cloth).remove::<ClothSprings>();
    run(&mut app, 1);
    assert_energy(&app, cloth, 9.0 * OF_FABRIC);
}

#[test]
fn a_cloth_that_bad_springs_keep_from_being_built_is_tried_again_when_they_change_or_go() {
    let mends: [fn(&mut App, Entity); 3] = [
        |app, cloth| get_mut::<ClothSprings>(app, cloth).shear_stiffness = 1.0,
        |app, cloth| {
            app.world_mut().entity_mut(cloth).insert(ClothSprings::default());
        },
        |app, cloth| {
            app.world_mut().entity_mut(cloth).remove::<ClothSprings>();
        },
    ];
    for mend in mends {
        let mut app = headless();
        let cloth = spawn_cloth(&mut app, GRID, ClothSprings { shear_stiffness: -1.0, ..default() });
        run(&mut app, 3);
        assert!(matches!(get::<ClothStatus>(&app, cloth), ClothStatus::Failed(_)));
        mend(&mut app, cloth);
        run(&mut app, 2);
        assert_eq!(get::<ClothStatus>(&app, cloth), &ClothStatus::Ready);
    }
}
