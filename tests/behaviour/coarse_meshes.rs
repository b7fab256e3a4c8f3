//! A mesh that is too coarse to show its fabric's folds is told of once.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::{common::*, quiet::Quiet};

/// A square metre with cells of 50 mm: fine enough for leather, which needs 52 mm, and for nothing softer.
const COARSE: ClothGrid = ClothGrid { size: Vec2::ONE, particles: UVec2::splat(21), lying: true };
/// Cells of 20 mm: fine enough for silk, which needs 22.6 mm.
const FINE: ClothGrid = ClothGrid { size: Vec2::ONE, particles: UVec2::splat(51), lying: true };

impl Quiet {
    /// The warnings while a cloth becomes ready.
    fn spawn(&mut self, grid: ClothGrid, more: impl Bundle) -> (Entity, Vec<String>) {
        let cloth = spawn_cloth(&mut self.app, grid, more);
        let said = self.run(3);
        assert_eq!(get::<ClothStatus>(&self.app, cloth), &ClothStatus::Ready);
        (cloth, said)
    }
}

#[test]
fn the_warning_names_the_cloth_and_both_lengths() {
    let mut quiet = Quiet::new();
    let (cloth, said) = quiet.spawn(COARSE, Fabric::SILK);
    assert_eq!(said.len(), 1, "{said:?}");
    let parts =
        [&format!("cloth {cloth} has edges of 50.0 mm"), "22.6 mm at most", "finer", "Fabric::bending_rigidity"];
    assert!(parts.iter().all(|part| said[0].contains(part)), "{said:?}");
    assert_eq!(quiet.run(60), Vec::<String>::new(), "once");
}

#[test]
fn the_scale_of_the_entity_counts() {
    let mut quiet = Quiet::new();
    let small = Transform::from_scale(Vec3::splat(0.4));
    assert_eq!(quiet.spawn(COARSE, (Fabric::SILK, small)).1, Vec::<String>::new());
    let large = Transform::from_scale(Vec3::splat(2.0));
    assert!(quiet.spawn(FINE, (Fabric::SILK, large)).1[0].contains("edges of 40.0 mm"));
}

#[test]
fn a_mesh_that_is_fine_enough_is_not_told_of() {
    let mut quiet = Quiet::new();
    assert_eq!(quiet.spawn(FINE, Fabric::SILK).1, Vec::<String>::new());
    assert_eq!(quiet.spawn(COARSE, Fabric::LEATHER).1, Vec::<String>::new());
    let limp = Fabric { bending_rigidity: 0.0, ..default() };
    assert_eq!(quiet.spawn(FINE, limp).1, Vec::<String>::new(), "no mesh is fine enough");
}

#[test]
fn plain_springs_are_not_told_of_until_they_go() {
    let mut quiet = Quiet::new();
    let (cloth, said) = quiet.spawn(COARSE, (Fabric::SILK, ClothSprings::default()));
    assert_eq!(said, Vec::<String>::new());
    get_mut::<ClothSprings>(&mut quiet.app, cloth).bend_stiffness = 1.0;
    *get_mut::<Fabric>(&mut quiet.app, cloth) = Fabric::DENIM;
    assert_eq!(quiet.run(3), Vec::<String>::new());
    quiet.app.world_mut().entity_mut(cloth).remove::<ClothSprings>();
    assert!(quiet.run(3)[0].contains("edges of 50.0 mm in the mean, and its fabric needs them to be 34.9 mm"));
}

#[test]
fn a_fabric_that_is_changed_is_told_of_once_however_often() {
    let mut quiet = Quiet::new();
    let (cloth, said) = quiet.spawn(COARSE, Fabric::LEATHER);
    assert_eq!(said, Vec::<String>::new());
    let mut said = Vec::new();
    for frame in 0..200 {
        // To and fro, as a slider is moved: from where 50 mm are enough to where they aren't.
        let share = (frame % 40_i32 - 20).abs() as f32 / 20.0;
        get_mut::<Fabric>(&mut quiet.app, cloth).bending_rigidity = 1e-4 + 1e-3 * share;
        said.extend(quiet.run(1));
    }
    assert_eq!(said.len(), 1, "{said:?}");
    *get_mut::<Fabric>(&mut quiet.app, cloth) = Fabric::SILK;
    quiet.run(1);
    for fabric in [Fabric::LEATHER, Fabric::SILK, Fabric::DENIM, Fabric::SILK] {
        *get_mut::<Fabric>(&mut quiet.app, cloth) = fabric;
        assert_eq!(quiet.run(2), Vec::<String>::new(), "told of before");
    }
}

#[test]
fn a_fabric_that_the_mesh_is_much_too_coarse_for_is_told_of_after_one_that_it_was_a_little_too_coarse_for() {
    let mut quiet = Quiet::new();
    assert_eq!(quiet.spawn(COARSE, Fabric::COTTON_WOVEN).1.len(), 1);
    let cloth = quiet.app.world_mut().query_filtered::<Entity, With<Cloth>>().single(quiet.app.world()).expect("one");
    *get_mut::<Fabric>(&mut quiet.app, cloth) = Fabric { bending_rigidity: 1e-6, ..Fabric::SILK };
    assert_eq!(quiet.run(5).len(), 1);
}

#[test]
fn a_mesh_that_comes_late_is_told_of_when_it_comes() {
    let mut quiet = Quiet::new();
    let mesh = quiet.app.world().resource::<Assets<Mesh>>().reserve_handle();
    quiet.app.world_mut().spawn((Mesh3d(mesh.clone()), Cloth::default(), Fabric::SILK));
    assert_eq!(quiet.run(5), Vec::<String>::new());
    quiet.app.world_mut().resource_mut::<Assets<Mesh>>().insert(mesh.id(), COARSE.into()).expect("a reserved handle");
    assert_eq!(quiet.run(5).len(), 1);
}
