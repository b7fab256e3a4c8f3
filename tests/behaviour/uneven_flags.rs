//! Flags of triangles in no rows and columns come to rest, pulled in their own plane, with the substeps that they choose.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

/// Speed of the particles (m/s, root of the mean square), and the strain that 99 of 100 sides stay below, of a flag of so many
/// vertices a side, moved by up to this share of a cell, `seconds` after it was let go.
fn at_rest(side: u32, share: f32, seconds: f32) -> [f32; 2] {
    let mut app = headless();
    let flag = spawn_cloth(&mut app, uneven(ClothGrid::new(1.0, 1.0, side, side), share), Pins::edge(ClothEdge::Left));
    run(&mut app, (seconds / STEP) as usize);
    let state = state(&app, flag);
    let squares: f32 = state.velocities().map(Vec3::length_squared).sum();
    let mut strains = strains(&app, flag);
    strains.sort_unstable_by(f32::total_cmp);
    [(squares / state.particle_count() as f32).sqrt(), strains[strains.len() * 99 / 100]]
}

#[test]
fn an_uneven_flag_that_is_pulled_in_its_plane_comes_to_rest() {
    let flags = [(24, 0.1, 15.0), (24, 0.25, 15.0), (64, 0.25, 6.0)];
    let found = flags.map(|(side, share, seconds)| at_rest(side, share, seconds));
    // The largest still swings a little after that time.
    for ([speed, strain], slow) in found.into_iter().zip([0.01, 0.01, 0.2]) {
        assert!(strain < 0.05 && speed < slow, "speeds and strains of {flags:?}: {found:?}");
    }
}

#[test]
fn rows_and_columns_need_no_more_substeps_than_their_strain_asks_for() {
    let mut app = headless();
    let grid = ClothGrid::new(1.0, 1.0, 24, 24);
    let [even, uneven] = [Mesh::from(grid), uneven(grid, 0.1)].map(|mesh| {
        let flag = spawn_cloth(&mut app, mesh, Pins::edge(ClothEdge::Left));
        run(&mut app, 2);
        report(&app, flag).substeps
    });
    assert!(even < 8, "{even}");
    assert!(uneven >= 8, "{uneven}");
}

#[test]
fn narrow_triangles_take_more_substeps() {
    let mut mesh = uneven(ClothGrid::new(1.0, 1.0, 12, 12), 0.1);
    if let Some(bevy::mesh::VertexAttributeValues::Float32x3(places)) = mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION) {
        let (near, of) = (Vec3::from(places[65]), Vec3::from(places[66]));
        places[65] = of.lerp(near, 0.05).to_array();
    }
    let mut app = headless();
    let flag = spawn_cloth(&mut app, mesh, Pins::edge(ClothEdge::Left));
    run(&mut app, 2);
    assert_eq!(report(&app, flag).substeps, 32);
    run(&mut app, 300);
    assert!(largest_strain(&app, flag) < 0.05, "{}", largest_strain(&app, flag));
}
