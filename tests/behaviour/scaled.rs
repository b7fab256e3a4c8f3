//! A cloth follows the scale of its entity while it runs.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

/// Squash and stretch by 20 %, every 1.7 s, about the same volume.
fn breath(frame: usize) -> Vec3 {
    let tall = 1.0 + 0.2 * ops::sin(frame as f32 * 0.06);
    Vec3::new(1.0 / tall.sqrt(), tall, 1.0 / tall.sqrt())
}

/// Meshes as they are: rows and columns, threads of triangles, triangles alone, a closed one, one with seams.
fn meshes() -> Vec<(&'static str, Mesh)> {
    let grid = ClothGrid::new(0.5, 0.5, 13, 17);
    vec![
        ("grid", grid.into()),
        ("uneven", uneven(grid, 0.25)),
        ("closed", Cylinder::new(0.25, 0.5).mesh().resolution(16).segments(8).without_caps().into()),
        ("seamed", seamed_strip().scaled_by(Vec3::splat(0.25))),
    ]
}

/// The strain that 99 of 100 sides stay below.
fn strain_of_most(app: &App, cloth: Entity) -> f32 {
    let mut strains = strains(app, cloth);
    strains.sort_unstable_by(f32::total_cmp);
    strains[(strains.len() * 99 / 100).min(strains.len() - 1)]
}

#[test]
fn a_scale_that_breathes_strains_nothing_beyond_itself() {
    for (name, mesh) in meshes() {
        let mut app = headless();
        let root = app.world_mut().spawn(Transform::default()).id();
        let top = Pins::region(Vec3::new(-1.0, 0.2, -1.0), Vec3::ONE);
        let cloth = spawn_cloth(&mut app, mesh, (top, ChildOf(root)));
        run(&mut app, 60);
        let settled = strain_of_most(&app, cloth);
        let mut worst = 0.0_f32;
        for frame in 0..130 {
            get_mut::<Transform>(&mut app, root).scale = breath(frame);
            run(&mut app, 1);
            worst = worst.max(strain_of_most(&app, cloth));
        }
        assert!(worst < settled + 0.02, "{name}: {settled} at rest, {worst} while it breathes");
        assert!(app.world().resource::<Heard>().reset.is_empty(), "{name}: it isn't built anew");
        run(&mut app, 1);
        let rest = state(&app, cloth).topology().rest.clone();
        get_mut::<Transform>(&mut app, root).scale = Vec3::ONE;
        run(&mut app, 1);
        assert_ne!(rest, state(&app, cloth).topology().rest, "{name}: the rest shape is scaled");
    }
}

#[test]
fn a_scale_that_comes_back_leaves_the_rest_shape_as_it_was_built() {
    for (name, mesh) in meshes() {
        let mut app = headless();
        let cloth = spawn_cloth(&mut app, mesh, Pins::region(Vec3::new(-1.0, 0.2, -1.0), Vec3::ONE));
        run(&mut app, 3);
        let (built, built_tethers) = (state(&app, cloth).topology().clone(), tethers(&app, cloth));
        for frame in 1..40 {
            get_mut::<Transform>(&mut app, cloth).scale = breath(frame);
            run(&mut app, 1);
            assert!(*state(&app, cloth).topology() != built, "{name}");
        }
        get_mut::<Transform>(&mut app, cloth).scale = Vec3::ONE;
        run(&mut app, 1);
        assert!(*state(&app, cloth).topology() == built, "{name}");
        assert_eq!(tethers(&app, cloth), built_tethers, "{name}");
    }
}

#[test]
fn a_stretched_rest_shape_has_the_lengths_of_a_mesh_of_that_scale() {
    let scale = Vec3::new(1.1, 0.8, 1.3);
    for (name, mesh) in meshes() {
        let mut app = headless();
        let pins = || Pins::region(Vec3::new(-1.0, 0.2, -1.0), Vec3::ONE);
        let scaled = spawn_cloth(&mut app, mesh.clone(), pins());
        let built = spawn_cloth(&mut app, mesh, (pins(), Transform::from_scale(scale)));
        run(&mut app, 3);
        let before = state(&app, scaled).topology().clone();
        get_mut::<Transform>(&mut app, scaled).scale = scale;
        run(&mut app, 1);
        let [scaled_tethers, built_tethers] = [scaled, built].map(|cloth| tethers(&app, cloth));
        let [scaled, built] = [scaled, built].map(|cloth| state(&app, cloth));
        for (spring, old) in scaled.topology().springs.iter().zip(&before.springs) {
            let way = before.rest[old.b as usize] - before.rest[old.a as usize];
            let ratio = (scale * way).length() / way.length();
            assert!((spring.rest / (old.rest * ratio) - 1.0).abs() < 1e-4, "{name}: {spring:?} {old:?}");
        }
        if let (Some(one), Some(other)) = (&scaled.topology().lattice, &built.topology().lattice) {
            let lengths = |of: &bevy_drape::solver::Lattice| {
                [&of.along_rows.stretch, &of.along_rows.bend, &of.along_columns.stretch, &of.along_columns.bend]
                    .map(|lanes| lanes.as_flattened().to_vec())
                    .concat()
            };
            let diagonals = |of: &bevy_drape::solver::Lattice| [&of.falling, &of.rising].map(|lanes| lanes.concat());
            let pairs = lengths(one).into_iter().zip(lengths(other));
            let pairs = pairs.chain(diagonals(one).concat().into_iter().zip(diagonals(other).concat()));
            for (one, other) in pairs {
                assert!((one - other).abs() <= 1e-4 * other, "{name}: {one} {other}");
            }
        }
        // Which pins are near depends on the scale.
        let same = |&(one, other): &(&_, &_)| {
            let ends = |tether: &bevy_drape::solver::Tether| (tether.particle, tether.pin);
            ends(one) == ends(other)
        };
        let pairs: Vec<_> = scaled_tethers.iter().zip(&built_tethers).filter(same).collect();
        assert!(!pairs.is_empty(), "{name}");
        for (one, other) in pairs {
            assert!((one.length / other.length - 1.0).abs() < 0.06, "{name}: {one:?} {other:?}");
        }
    }
}

#[test]
fn a_scale_that_is_flat_or_not_finite_leaves_the_rest_shape_alone() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, ClothGrid::new(0.5, 0.5, 9, 9), Pins::edge(ClothEdge::Top));
    run(&mut app, 3);
    let built = state(&app, cloth).topology().clone();
    for scale in [Vec3::new(1.0, 0.0, 1.0), Vec3::NAN, Vec3::splat(f32::INFINITY)] {
        get_mut::<Transform>(&mut app, cloth).scale = scale;
        run(&mut app, 1);
        assert!(*state(&app, cloth).topology() == built, "{scale}");
    }
}
