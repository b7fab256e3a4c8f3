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
    for [speed, strain] in found {
        assert!(strain < 0.012 && speed < 0.01, "speeds and strains of {flags:?}: {found:?}");
    }
}

#[test]
fn triangles_need_no_more_substeps_than_rows_and_columns() {
    let mut app = headless();
    let grid = ClothGrid::new(1.0, 1.0, 24, 24);
    let mut narrow = uneven(grid, 0.1);
    if let Some(bevy::mesh::VertexAttributeValues::Float32x3(places)) = narrow.attribute_mut(Mesh::ATTRIBUTE_POSITION) {
        let (near, of) = (Vec3::from(places[100]), Vec3::from(places[101]));
        places[100] = of.lerp(near, 0.05).to_array();
    }
    for mesh in [uneven(grid, 0.1), narrow] {
        let flag = spawn_cloth(&mut app, mesh, Pins::edge(ClothEdge::Left));
        run(&mut app, 300);
        assert_eq!(report(&app, flag).substeps, 4);
        assert!(largest_strain(&app, flag) < 0.05, "{}", largest_strain(&app, flag));
    }
}
