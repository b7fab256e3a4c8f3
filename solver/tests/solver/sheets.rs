//! Sheets of triangles in no order, with the moduli that a laboratory measures.

use std::f32::consts::PI;

use bevy_math::{EulerRot, Quat, Vec2, Vec2Swizzles, Vec3, Vec3A, ops};
use drape_solver::{Elasticity, Material, Method, Moduli, SimdLevel, SourceMesh, SpringConstants, Topology, measure};
use proptest::prelude::*;

use crate::{
    bench_bed::{ALL, Bed, GRAVITY, STABLE, bits, rms},
    fixtures::mesh::assemble,
};

/// Points of a strip along x, moved at random inside, in cells of about `cell`, m, joined by Delaunay's triangulation.
fn strewn(length: f32, width: f32, cell: f32) -> (Vec<Vec2>, Vec<[u32; 3]>) {
    let mut random = fastrand::Rng::with_seed(7);
    let [columns, rows] = [length, width].map(|side| (side / cell).round() as u32);
    let mut points = Vec::new();
    for (i, j) in (0..=columns).flat_map(|i| (0..=rows).map(move |j| (i, j))) {
        let mut shift = |k: u32, count: u32| if k > 0 && k < count { 0.5 * (random.f32() - 0.5) } else { 0.0 };
        let at = Vec2::new(i as f32 + shift(i, columns), j as f32 + shift(j, rows));
        points.push(at * Vec2::new(length / columns as f32, width / rows as f32));
    }
    let corners: Vec<_> = points.iter().map(|p| delaunator::Point { x: p.x.into(), y: p.y.into() }).collect();
    let triangles = delaunator::triangulate(&corners).triangles;
    let area = |t: &[usize; 3]| (points[t[1]] - points[t[0]]).perp_dot(points[t[2]] - points[t[0]]).abs();
    let triangles = triangles.as_chunks().0.iter().filter(|t| area(t) > 1e-3 * cell * cell);
    let triangles = triangles.map(|t| t.map(|i| i as u32)).collect();
    (points, triangles)
}

/// The mesh of a strip, put into space. The warp is along its length.
fn mesh((points, triangles): &(Vec<Vec2>, Vec<[u32; 3]>), place: impl Fn(Vec2) -> Vec3) -> SourceMesh {
    let uvs = points.iter().map(|p| p.yx()).collect();
    SourceMesh { uvs: Some(uvs), ..assemble(points.iter().map(|&p| place(p)).collect(), triangles) }
}

fn lying(p: Vec2) -> Vec3 {
    Vec3::new(p.x, 0.0, p.y)
}

fn sheet(density: f32, moduli: Moduli) -> Material {
    Material::bare(density, Elasticity::Moduli(moduli))
}

/// The places of particles, by their x.
fn where_x(bed: &Bed, is: impl Fn(f32) -> bool) -> Vec<u32> {
    (0..).zip(&bed.topology.rest).filter(|(_, p)| is(p.x)).map(|(i, _)| i).collect()
}

const JERSEY: Moduli = Moduli {
    stretch: [60.0, 110.0],
    shear: 30.0,
    stiffening: [2.0, 5.0],
    compression: 0.5,
    bending: 2e-3,
    stretch_damping: 0.0,
    bend_damping: 0.0,
};

#[test]
fn a_strip_that_is_pulled_gets_longer_by_the_force_over_its_stiffness() {
    let (length, width, strain) = (0.5, 0.2, 0.05);
    for (pulled, shear) in [([40.0, 40.0], 6.0), ([20.0, 60.0], 8.0)] {
        for (method, substeps) in [(Method::Explicit, 1), (Method::Xpbd, 32), (Method::Strands, 32)] {
            let moduli = Moduli::from_strips(pulled, shear, [0.0; 2], 1.0).unwrap();
            let material = Material { damping: 20.0, ..sheet(0.2, moduli) };
            let bed = Bed::new(mesh(&strewn(length, width, 0.025), lying), material);
            let (held, free) = (where_x(&bed, |x| x < 1e-4), where_x(&bed, |x| x > length - 1e-4));
            let mut bed = Bed { method, gravity: Vec3A::ZERO, ..bed.with_substeps(substeps) }.pinned(held);
            // Each point of the end takes its part of the width.
            let places: Vec<f32> = free.iter().map(|&i| bed.topology.rest[i as usize].z).collect();
            let most = width / (free.len() - 1) as f32;
            for (&i, place) in free.iter().zip(&places) {
                let part = if *place < 1e-4 || *place > width - 1e-4 { 0.5 * most } else { most };
                bed.particles.force[i as usize] = Vec3A::X * (strain * pulled[0] * part);
            }
            bed.run(2.0);
            // Away from the ends, of which one is held in its width.
            let way = |x: f32| {
                let near = |i: &usize| (bed.topology.rest[*i].x - x).abs() < 0.02;
                let near: Vec<usize> = (0..bed.particles.len()).filter(near).collect();
                let ways = near.iter().map(|&i| bed.particles.position[i].x - bed.topology.rest[i].x);
                ways.sum::<f32>() / near.len() as f32
            };
            let found = (way(0.35) - way(0.15)) / 0.2;
            assert!((found / strain - 1.0).abs() < 0.1, "{method:?}, {pulled:?} N/m: {found}");
        }
    }
}

/// How deep the end of a strip hangs over an edge, m. Its bending length is 3 cm.
fn overhanging(method: Method, substeps: u32, cell: f32, overhang: f32) -> f32 {
    let (density, bending) = (0.3, 0.3 * GRAVITY * 0.03_f32.powi(3));
    let moduli = Moduli { stretch: [3000.0; 2], shear: 500.0, compression: 1.0, bending, ..Moduli::default() };
    let material = Material { damping: 8.0, ..sheet(density, moduli) };
    let held = 2.0 * cell;
    let bed = Bed::new(mesh(&strewn(held + overhang, 0.06, cell), lying), material);
    let (fixed, end) = (where_x(&bed, |x| x < held + 0.1 * cell), where_x(&bed, |x| x > held + overhang - 1e-4));
    let mut bed = Bed { method, ..bed.with_substeps(substeps) }.pinned(fixed);
    bed.run(1.5);
    -end.iter().map(|&i| bed.particles.position[i as usize].y).sum::<f32>() / end.len() as f32
}

#[test]
fn a_strip_over_an_edge_hangs_as_deep_whatever_the_substep() {
    // Cells of a fifth of the bending length: with one sweep over the bends, it would hang more than twice as deep.
    for (overhang, least) in [(0.018, 8), (0.03, 4)] {
        let truth = overhanging(Method::Explicit, 1, 0.006, overhang);
        for (method, substeps) in [(Method::Xpbd, 8), (Method::Strands, 8), (Method::Strands, least)] {
            let depth = overhanging(method, substeps, 0.006, overhang);
            let ratio = depth / truth;
            assert!((ratio - 1.0).abs() < 0.06, "{method:?}, {substeps} substeps, {overhang} m: {ratio}");
        }
    }
}

/// Half of a tube, 10 cm in radius.
fn half_tube(p: Vec2) -> Vec3 {
    let (radius, angle) = (0.1, p.x / 0.1);
    Vec3::new(radius * ops::sin(angle), radius * ops::cos(angle), p.y)
}

#[test]
fn what_is_made_curved_stays_so_whichever_way_it_is_turned() {
    for method in ALL {
        for bend_damping in [0.0, 0.01] {
            let material = sheet(0.2, Moduli { bend_damping, stretch_damping: bend_damping, ..JERSEY });
            let made = strewn(0.1 * PI, 0.1, 0.02);
            let mut bed = Bed { method, gravity: Vec3A::ZERO, ..Bed::new(mesh(&made, half_tube), material) };
            assert!(bed.topology.is_curved);
            let turn = Quat::from_euler(EulerRot::default(), 0.4, 1.3, -0.7);
            for position in &mut bed.particles.position {
                *position = turn * *position;
            }
            let start = bed.particles.clone();
            bed.run(1.0);
            // Rounding lets it drift by less than a millimetre.
            assert!(rms(&bed.particles, &start) < 1e-3, "{method:?}: {} m/s", bed.fastest());
        }
    }
}

#[test]
fn what_is_made_flat_is_not_curved_however_it_lies() {
    let turn = Quat::from_euler(EulerRot::default(), 0.4, 1.3, -0.7);
    let made = strewn(0.5, 0.3, 0.02);
    let bed = Bed::new(mesh(&made, |p| turn * lying(p) + Vec3::splat(3.0)), sheet(0.2, JERSEY));
    assert!(!bed.topology.is_curved && !bed.topology.bends.is_empty());
}

#[test]
fn spinning_does_not_count_as_bending() {
    /// Kinetic energy over that at the start, after a second.
    fn kept(method: Method, bend_damping: f32) -> f32 {
        let material = sheet(0.2, Moduli { bend_damping, ..JERSEY });
        let made = strewn(0.1 * PI, 0.1, 0.02);
        let mut bed = Bed { method, gravity: Vec3A::ZERO, ..Bed::new(mesh(&made, half_tube), material) };
        let centre = bed.centre();
        for (velocity, position) in bed.particles.velocity.iter_mut().zip(&bed.particles.position) {
            *velocity = Vec3A::Z.cross(*position - centre) * 3.0;
        }
        let energy = |bed: &Bed| measure::energy(&bed.particles, &bed.topology, &bed.material, Vec3A::ZERO).kinetic;
        let before = energy(&bed);
        bed.run(1.0);
        energy(&bed) / before
    }
    for method in ALL {
        let [damped, undamped] = [0.2, 0.0].map(|damping| kept(method, damping));
        // What it loses without is the method's.
        assert!(undamped > 0.8 && damped > 0.95 * undamped, "{method:?}: {damped} {undamped}");
    }
}

#[test]
fn forces_of_a_sheet_keep_its_energy() {
    for place in [lying, half_tube] {
        let bed = Bed::new(mesh(&strewn(0.1 * PI, 0.1, 0.02), place), sheet(0.2, JERSEY));
        let mut bed = Bed { method: Method::Explicit, gravity: Vec3A::ZERO, ..bed };
        let mut random = fastrand::Rng::with_seed(1);
        for velocity in &mut bed.particles.velocity {
            *velocity = Vec3A::from([0; 3].map(|_| random.f32() - 0.5));
        }
        let energy = |bed: &Bed| measure::energy(&bed.particles, &bed.topology, &bed.material, Vec3A::ZERO);
        let before = energy(&bed).total();
        let mut elastic = 0.0_f32;
        // Far below what is stable, the energy hardly swings.
        for _ in 0..600 {
            bed.step(1.0 / 48_000.0);
            elastic = elastic.max(energy(&bed).elastic);
            assert!((energy(&bed).total() / before - 1.0).abs() < 0.05, "{:?} of {before} J", energy(&bed));
        }
        assert!(elastic > 0.2 * before, "{elastic} J");
    }
}

#[test]
fn springs_that_are_alike_take_no_notice_of_faces_and_bends() {
    for method in ALL {
        let alike = SpringConstants { stiffness: 200.0, damping: 0.1 };
        let material = Material::bare(0.2, Elasticity::Springs([alike; 3]));
        let bed = Bed::new(mesh(&strewn(0.3, 0.2, 0.03), lying), material);
        let mut bed = Bed { method, ..bed }.pinned([0]);
        let mut without = bed.clone();
        let Topology { faces, face_batches, bends, bend_batches, .. } = &mut without.topology;
        faces.clear();
        face_batches.clear();
        bends.clear();
        bend_batches.clear();
        bed.run(0.2);
        without.run(0.2);
        assert_eq!(bits(&bed.particles), bits(&without.particles), "{method:?}");
    }
}

#[test]
fn all_instructions_give_the_same_bits_and_nothing_is_allocated() {
    for place in [lying, half_tube] {
        for damping in [0.0, 0.01] {
            let material = sheet(0.2, Moduli { stretch_damping: damping, bend_damping: damping, ..JERSEY });
            let mut bed = Bed::new(mesh(&strewn(0.1 * PI, 0.1, 0.02), place), material).pinned([0, 5]);
            let mut plain = bed.clone();
            plain.scratch.simd_level = SimdLevel::Baseline;
            bed.run(0.5);
            plain.run(0.5);
            assert_eq!(bits(&bed.particles), bits(&plain.particles));
            let memory = allocation_counter::measure(|| {
                bed.step(1.0 / 60.0);
            });
            assert_eq!(memory.count_total, 0);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn whatever_it_is_made_of_and_however_it_is_crumpled_it_stays_finite(
        powers in prop::array::uniform5(-6.0_f32..9.0),
        size in prop_oneof![Just(0.0_f32), Just(0.1), Just(100.0)],
        seed in any::<u64>(),
        dt in prop_oneof![Just(0.001_f32), Just(0.1)],
        curved in any::<bool>(),
    ) {
        let [warp, weft, shear, bending, damping] = powers.map(|power| ops::powf(10.0, power));
        let moduli = Moduli {
            stretch: [warp.max(shear), weft.max(shear)],
            shear,
            bending,
            stretch_damping: damping.min(10.0),
            bend_damping: damping.min(10.0),
            ..JERSEY
        };
        let made = strewn(0.1 * PI, 0.1, 0.03);
        let bed = Bed::new(mesh(&made, if curved { half_tube } else { lying }), sheet(0.2, moduli));
        let mut random = fastrand::Rng::with_seed(seed);
        for method in STABLE {
            let mut bed = Bed { method, ..bed.clone() }.pinned([0]);
            for position in &mut bed.particles.position {
                *position = Vec3A::from([0; 3].map(|_| random.f32() - 0.5)) * size;
            }
            for _ in 0..20 {
                bed.step(dt);
            }
            prop_assert!(bed.particles.is_finite(), "{method:?}");
        }
    }
}
