//! Tethers are as long as the cloth, and hold.

use core::f32::consts::TAU;

use bevy_math::{Vec3, ops};
use drape_solver::{Method, SourceMesh, Tethers, build};

use crate::{
    bench_bed::{Bed, STABLE},
    fixtures::{
        material::{Springs, springs},
        mesh::{Grid, assemble, both, shaped},
    },
};

#[test]
fn on_a_flat_grid_a_tether_is_as_long_as_the_straight_line() {
    let bed = Bed::lying(33, springs(Springs::default()));
    let tethers = build::tethers(&bed.topology, &[0, 32]);
    for particle in (0..33 * 33).filter(|particle| ![0, 32].contains(particle)) {
        assert!(tethers.iter().any(|tether| tether.particle == particle), "{particle} has none");
    }
    let middle = tethers.iter().filter(|tether| tether.particle == 16).count();
    assert_eq!(middle, 2, "between two pins, both hold");
    for tether in tethers.iter() {
        let rest = |i: u32| bed.topology.rest[i as usize];
        let straight = rest(tether.particle).distance(rest(tether.pin));
        let error = tether.length / straight - 1.0;
        assert!((-1e-4..1e-3).contains(&error), "{tether:?}: {straight} m, {error}");
    }
}

/// An open tube around the Y axis, of `around` x `rings` cells. Its diagonals alternate.
fn tube(radius: f32, height: f32, around: u32, rings: u32) -> SourceMesh {
    let place = |ring: u32, column: u32| {
        let angle = TAU * column as f32 / around as f32;
        Vec3::new(radius * ops::cos(angle), height * ring as f32 / rings as f32, radius * ops::sin(angle))
    };
    let positions = (0..=rings).flat_map(|ring| (0..around).map(move |column| place(ring, column))).collect();
    let mut triangles = Vec::new();
    for (ring, column) in (0..rings).flat_map(|ring| (0..around).map(move |column| (ring, column))) {
        let at = |ring: u32, column: u32| ring * around + column % around;
        let [a, b] = [at(ring, column), at(ring, column + 1)];
        let [c, d] = [at(ring + 1, column), at(ring + 1, column + 1)];
        triangles.extend(if (ring + column) % 2 == 0 { [[a, c, b], [b, c, d]] } else { [[a, c, d], [a, d, b]] });
    }
    assemble(positions, &triangles)
}

#[test]
fn around_a_tube_a_tether_is_as_long_as_the_straight_line_on_its_unrolled_side() {
    for (around, rings) in [(48, 40), (24, 60), (96, 20)] {
        let (radius, height) = (0.25, 1.0);
        let bed = Bed::new(tube(radius, height, around, rings), springs(Springs::default()));
        let pin = (rings / 3) * around + 5;
        let tethers = build::tethers(&bed.topology, &[pin]);
        assert_eq!(tethers.len(), bed.particles.len() - 1);
        // The tube is as wide as its sides are, not as the circle around them.
        let side = 2.0 * radius * ops::sin(core::f32::consts::PI / around as f32);
        for tether in tethers.iter() {
            let columns = (tether.particle % around).abs_diff(pin % around);
            let across = columns.min(around - columns) as f32 * side;
            let along = (tether.particle / around).abs_diff(pin / around) as f32 * height / rings as f32;
            let unrolled = ops::hypot(across, along);
            let error = tether.length / unrolled - 1.0;
            assert!(error.abs() < 0.005, "{around} x {rings}: {tether:?}: {unrolled} m, {error}");
        }
    }
}

#[test]
fn around_a_slit_a_tether_takes_the_long_way() {
    // A sheet slit from the left edge to its middle column: the way goes around the end of the slit.
    let n = 21;
    let grid = Grid::new(1.0, 1.0, n, n);
    let mut mesh = SourceMesh::from(grid);
    let slit_row = 10;
    mesh.triangles.retain(|t| {
        let rows = t.iter().map(|v| v / n);
        let left = t.iter().all(|v| v % n <= 10);
        !(left && rows.clone().min() == Some(slit_row) && rows.max() == Some(slit_row + 1))
    });
    let bed = Bed::new(mesh, springs(Springs::default()));
    let (above, below) = (grid.particle(0, slit_row), grid.particle(0, slit_row + 1));
    let tethers = build::tethers(&bed.topology, &[above]);
    let tether = tethers.iter().find(|tether| tether.particle == below).expect("the sheet is in one piece");
    // To the end of the slit, down a cell, and back: 0.5 m each way.
    assert!((tether.length - 1.05).abs() < 0.01, "{} m", tether.length);
}

#[test]
fn a_particle_without_a_way_to_a_pin_has_no_tether() {
    let sheet = Grid::new(1.0, 1.0, 3, 3);
    let mesh = both(sheet, shaped(sheet, |p| p + Vec3::X * 5.0));
    let bed = Bed::new(mesh, springs(Springs::default()));
    let tethers = build::tethers(&bed.topology, &[0]);
    assert_eq!(tethers.len(), 8);
    assert!(tethers.iter().all(|tether| tether.particle < 9));
}

#[test]
fn tethers_keep_a_soft_cloth_within_its_length() {
    let reaches = STABLE.map(|method| {
        let soft = springs(Springs { structural_stiffness: 5.0, ..Springs::default() });
        let mut bed = Bed::lying(16, soft).pinned([0, 15]).tethered(&[0, 15]).like_a_game(method);
        let mut farthest = 0.0_f32;
        for _ in 0..120 {
            bed.step(1.0 / 60.0);
            for tether in bed.tethers.iter().flat_map(Tethers::iter) {
                let p = |i: u32| bed.particles.position[i as usize];
                farthest = farthest.max(p(tether.particle).distance(p(tether.pin)) / tether.length);
            }
        }
        farthest
    });
    // The second of two tethers can push a particle a little past the first, and strands come after both.
    let most = STABLE.map(|method| if method == Method::Strands { 1.06 } else { 1.05 });
    assert!(reaches.iter().zip(most).all(|(&reach, most)| reach <= most), "{STABLE:?} are stretched to {reaches:?}");
}
