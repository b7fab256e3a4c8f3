//! A free cloth falls as any body does.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

const FRAMES: usize = 30;

/// Height that a cloth has lost after half a second.
fn fall(app: &mut App, more: impl Bundle) -> Vec3 {
    let cloth = spawn_cloth(app, ClothGrid::new(0.4, 0.4, 5, 5), (undamped(), more));
    run(app, FRAMES);
    place(app, cloth, 12)
}

#[test]
fn a_free_cloth_falls_like_a_stone() {
    for solver in [ClothSolver::Strands, ClothSolver::Xpbd] {
        let mut app = headless();
        let more = (undamped(), Cloth { solver, ..default() });
        let cloth = spawn_cloth(&mut app, ClothGrid::new(0.4, 0.4, 5, 5), more);
        run(&mut app, FRAMES);
        // Symplectic Euler in n substeps h: g h² n (n + 1) / 2, a little more than g t² / 2.
        let substeps = report(&app, cloth).substeps as f32;
        let n = FRAMES as f32 * substeps;
        let h = STEP / substeps;
        let expected = Vec3::NEG_Y * 9.81 * h * h * n * (n + 1.0) / 2.0;
        let rest = points(&ClothGrid::new(0.4, 0.4, 5, 5).into());
        for (vertex, rest) in rest.into_iter().enumerate() {
            assert_close(place(&app, cloth, vertex as u32), rest + expected, 1e-3);
        }
        for velocity in state(&app, cloth).velocities() {
            assert_close(velocity, Vec3::NEG_Y * 9.81 * 0.5, 1e-2);
        }
        let error = expected.y / (-0.5 * 9.81 * 0.25) - 1.0;
        assert!(error.abs() < 0.005, "{solver:?} in {substeps} substeps: {error}");
    }
}

#[test]
fn the_gravity_scale_is_a_factor() {
    let mut app = headless();
    let scaled = |gravity_scale| Cloth { gravity_scale, ..default() };
    let full = fall(&mut app, scaled(1.0)).y;
    assert_eq!(fall(&mut app, scaled(0.0)), Vec3::ZERO);
    assert!((fall(&mut app, scaled(0.5)).y / full - 0.5).abs() < 1e-3);
    assert!((fall(&mut app, scaled(-1.0)).y / full + 1.0).abs() < 1e-3);
}

#[test]
fn gravity_points_where_the_resource_says() {
    let mut app = headless();
    let earth = fall(&mut app, ()).length();
    app.insert_resource(ClothGravity(Vec3::new(1.62, 0.0, 0.0)));
    let moon = fall(&mut app, ());
    assert!((moon.x / earth - 1.62 / 9.81).abs() < 1e-3, "{moon}");
    assert_close(moon, Vec3::X * moon.x, 1e-5);
}

#[test]
fn damping_slows_the_fall() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, ClothGrid::new(0.4, 0.4, 5, 5), Fabric { damping: 2.0, ..undamped() });
    run(&mut app, 60);
    // v' = -g - c v: v = -g / c (1 - exp(-c t)).
    let expected = -9.81 / 2.0 * (1.0 - (-2.0_f64).exp());
    let velocity = state(&app, cloth).velocity(12).unwrap().y;
    assert!((f64::from(velocity) / expected - 1.0).abs() < 0.01, "{velocity}, expected {expected}");
}
