//! Tethers are as long as the cloth, and hold.

use bevy::prelude::*;
use bevy_drape::{
    build,
    prelude::{ClothGrid, Fabric},
};

use crate::bench_bed::{Bed, bare};

#[test]
fn on_a_flat_grid_a_tether_is_as_long_as_the_straight_line() {
    let bed = Bed::lying(33, bare(Fabric::default()));
    let tethers = build::tethers(&bed.topology, &[0, 32]);
    for particle in (0..33 * 33).filter(|particle| ![0, 32].contains(particle)) {
        assert!(tethers.iter().any(|tether| tether.particle == particle), "{particle} has none");
    }
    let middle = tethers.iter().filter(|tether| tether.particle == 16).count();
    assert_eq!(middle, 2, "between two pins, both hold");
    for tether in &tethers {
        let rest = |i: u32| bed.topology.rest[i as usize];
        let straight = rest(tether.particle).distance(rest(tether.pin));
        let error = tether.length / straight - 1.0;
        assert!((-1e-4..1e-3).contains(&error), "{tether:?}: {straight} m, {error}");
    }
}

#[test]
fn around_a_slit_a_tether_takes_the_long_way() {
    // A sheet slit from the left edge to its middle column: the way goes around the end of the slit.
    let n = 21;
    let grid = ClothGrid::new(1.0, 1.0, n, n);
    let mesh = Mesh::from(grid);
    let Some(indices) = mesh.indices() else { panic!("a grid is indexed") };
    let indices: Vec<u32> = indices.iter().map(|i| i as u32).collect();
    let slit_row = 10;
    let kept: Vec<u32> = indices
        .chunks(3)
        .filter(|t| {
            let rows = t.iter().map(|v| v / n);
            let left = t.iter().all(|v| v % n <= 10);
            !(left && rows.clone().min() == Some(slit_row) && rows.max() == Some(slit_row + 1))
        })
        .flatten()
        .copied()
        .collect();
    let mesh = mesh.with_inserted_indices(bevy::mesh::Indices::U32(kept));
    let bed = Bed::new(mesh, bare(Fabric::default()));
    let (above, below) = (grid.vertex(0, slit_row), grid.vertex(0, slit_row + 1));
    let tethers = build::tethers(&bed.topology, &[above]);
    let tether = tethers.iter().find(|tether| tether.particle == below).expect("the sheet is in one piece");
    // To the end of the slit, down a cell, and back: 0.5 m each way.
    assert!((tether.length - 1.05).abs() < 0.01, "{} m", tether.length);
}

#[test]
fn a_particle_without_a_way_to_a_pin_has_no_tether() {
    let two = Mesh::from(ClothGrid::new(1.0, 1.0, 3, 3));
    let mut mesh = two.clone();
    mesh.merge(&two.translated_by(Vec3::X * 5.0)).expect("the same attributes");
    let bed = Bed::new(mesh, bare(Fabric::default()));
    let tethers = build::tethers(&bed.topology, &[0]);
    assert_eq!(tethers.len(), 8);
    assert!(tethers.iter().all(|tether| tether.particle < 9));
}

#[test]
fn tethers_keep_a_soft_cloth_within_its_length() {
    let soft = bare(Fabric { structural_stiffness: 5.0, ..Fabric::default() });
    let mut bed = Bed::lying(16, soft).pinned([0, 15]);
    bed.tethers = build::tethers(&bed.topology, &[0, 15]);
    for _ in 0..120 {
        bed.step(1.0 / 60.0);
        for tether in &bed.tethers {
            let p = |i: u32| bed.particles.position[i as usize];
            // The second of two tethers can push a particle a little past the first.
            assert!(p(tether.particle).distance(p(tether.pin)) <= tether.length * 1.05);
        }
    }
}
