//! Regular meshes that are no rectangle get strands from edge to edge, and others none.

use std::collections::BTreeSet;

use bevy_math::{Quat, Vec3, ops};
use drape_solver::{MeshStructure, Method, SourceMesh, SpringKind, SubstepPolicy, Topology, measure};
use fastrand::Rng;

use crate::{
    bench_bed::{Bed, rms},
    fixtures::{
        material::{Springs, springs, springs_in_air},
        mesh::{Grid, assemble, both, fan, shaped, topology, triangle},
    },
    lattices::{hexagons, strewn},
};

/// The cells of a square metre of `side` x `side` particles, upright, that are wanted.
pub fn quads(side: u32, is_wanted: impl Fn(u32, u32) -> bool) -> SourceMesh {
    let place = |i: u32| Vec3::new((i % side) as f32, -((i / side) as f32), 0.0) / (side - 1) as f32;
    let cells = (0..side - 1).flat_map(|row| (0..side - 1).map(move |column| (row, column)));
    let triangles: Vec<[u32; 3]> = cells
        .filter(|&(row, column)| is_wanted(row, column))
        .flat_map(|(row, column)| {
            let a = row * side + column;
            [[a, a + side, a + 1], [a + 1, a + side, a + side + 1]]
        })
        .collect();
    assemble((0..side * side).map(place).collect(), &triangles)
}

/// A square metre without the quarter at the bottom right.
pub fn ell(side: u32) -> SourceMesh {
    quads(side, |row, column| row < side / 2 || column < side / 2)
}

/// Equilateral triangles around a tube.
pub fn sleeve(around: u32, rings: u32) -> SourceMesh {
    let place = |i: u32| {
        let (ring, column) = (i / around, i % around);
        let angle = core::f32::consts::TAU * (column as f32 + 0.5 * (ring % 2) as f32) / around as f32;
        Vec3::new(0.2 * ops::cos(angle), -0.05 * ring as f32, 0.2 * ops::sin(angle))
    };
    let cells = (0..rings - 1).flat_map(|ring| (0..around).map(move |column| (ring, column)));
    let triangles: Vec<[u32; 3]> = cells
        .flat_map(|(ring, column)| {
            let at = |down: u32, along: u32| (ring + down) * around + (column + along) % around;
            let [a, b, c, d] = [at(0, 0), at(0, 1), at(1, 0), at(1, 1)];
            if ring % 2 == 0 { [[a, b, c], [b, d, c]] } else { [[a, d, c], [a, b, d]] }
        })
        .collect();
    assemble((0..around * rings).map(place).collect(), &triangles)
}

/// Rings and spokes around a hub, upright, a metre wide.
fn disc(spokes: u32, rings: u32) -> SourceMesh {
    let place = |i: u32| {
        let (ring, spoke) = (i / spokes + 1, i % spokes);
        let (angle, radius) = (core::f32::consts::TAU * spoke as f32 / spokes as f32, 0.5 * ring as f32 / rings as f32);
        Vec3::new(radius * ops::cos(angle), radius * ops::sin(angle), 0.0)
    };
    let hub = spokes * rings;
    let cells = (0..rings - 1).flat_map(|ring| (0..spokes).map(move |spoke| (ring * spokes, spoke)));
    let quads = cells.flat_map(|(ring, spoke)| {
        let next = (spoke + 1) % spokes;
        let [a, b, c, d] = [ring + spoke, ring + next, ring + spokes + spoke, ring + spokes + next];
        [[a, c, b], [b, c, d]]
    });
    let fan = (0..spokes).map(|spoke| [hub, spoke, (spoke + 1) % spokes]);
    let triangles: Vec<[u32; 3]> = quads.chain(fan).collect();
    assemble((0..hub).map(place).chain([Vec3::ZERO]).collect(), &triangles)
}

type Key = (u32, u32, u32);

/// The springs of all packs: along the strands, and across two springs of one.
fn packed(topology: &Topology) -> [BTreeSet<Key>; 2] {
    let nobody = topology.particle_count() as u32;
    let [mut along, mut across] = [BTreeSet::new(), BTreeSet::new()];
    for pack in &topology.strand_packs {
        let count = pack.nodes.len();
        for lane in 0..8 {
            let particle = |j: usize| pack.nodes[j % count][lane];
            let lengths = [(1, &pack.stretch, &mut along), (2, &pack.bend, &mut across)];
            for (steps, lengths, springs) in lengths {
                for (j, rest) in lengths.iter().enumerate().filter(|(_, rest)| rest[lane] > 0.0) {
                    let (a, b) = (particle(j), particle(j + steps));
                    assert!(j + steps < count || pack.closed && steps == 1, "only a ring goes on after its end");
                    assert!(a < nobody && b < nobody, "a spring to nobody");
                    assert!(springs.insert((a.min(b), a.max(b), rest[lane].to_bits())), "{a} to {b} twice");
                }
            }
        }
    }
    [along, across]
}

fn keys(topology: &Topology, kind: SpringKind, on_strand: bool) -> BTreeSet<Key> {
    let batches = topology.batches.iter().filter(|batch| batch.kind == kind && batch.on_strand == on_strand);
    let springs = batches.flat_map(|batch| &topology.springs[batch.range.clone()]);
    springs.map(|spring| (spring.a.min(spring.b), spring.a.max(spring.b), spring.rest.to_bits())).collect()
}

/// Packs, and batches that aren't on strands, have every spring once, and no two strands of a pack meet.
#[track_caller]
pub fn assert_shared_out(topology: &Topology) {
    let [along, across] = packed(topology);
    assert_eq!(along, keys(topology, SpringKind::Structural, true));
    assert_eq!(across, keys(topology, SpringKind::Bend, true));
    assert!(keys(topology, SpringKind::Shear, true).is_empty());
    let nobody = topology.particle_count() as u32;
    for pack in &topology.strand_packs {
        let mut seen = BTreeSet::new();
        let particles = pack.nodes.as_flattened().iter().filter(|&&particle| particle != nobody);
        assert!(particles.copied().all(|particle| seen.insert(particle)), "strands of a pack meet");
        assert_eq!(pack.nodes.len(), pack.stretch.len());
    }
}

fn strand_count(topology: &Topology) -> usize {
    match topology.structure() {
        MeshStructure::Strands { count } => count,
        other => panic!("{other}"),
    }
}

#[test]
fn regular_meshes_have_all_their_structural_springs_on_strands() {
    let cross = |row: u32, column: u32| (8..16).contains(&row) || (8..16).contains(&column);
    let holed = |row: u32, column: u32| !((8..12).contains(&row) && (6..14).contains(&column));
    let cases = [
        ("triangles", hexagons(20), 20 + 29 + 28),
        ("an L", ell(24), 24 + 12 + 24 + 12 - 24),
        ("a cross", quads(25, cross), 25 + 25),
        ("with a hole", quads(25, holed), 25 + 25 + 3 + 7),
        ("a sleeve", sleeve(24, 20), 20 + 2 * 24),
    ];
    for (name, mesh, strands) in cases {
        let topology = topology(mesh);
        println!("{name}: {}", topology.structure());
        assert_shared_out(&topology);
        assert_eq!(keys(&topology, SpringKind::Structural, false).len(), 0, "{name}");
        assert_eq!(strand_count(&topology), strands, "{name}");
    }
}

#[test]
fn strands_of_quads_bend_and_those_of_triangles_bend_across_their_edges() {
    let quads = topology(ell(24));
    assert_eq!(keys(&quads, SpringKind::Bend, false).len(), 0);
    let triangles = topology(hexagons(20));
    assert_eq!(keys(&triangles, SpringKind::Bend, true).len(), 0);
}

#[test]
fn rings_are_closed() {
    let topology = topology(sleeve(24, 20));
    let rings: Vec<_> = topology.strand_packs.iter().filter(|pack| pack.closed).collect();
    assert_eq!(rings.iter().map(|pack| pack.strand_count()).sum::<usize>(), 20);
    for ring in rings {
        assert_eq!((ring.nodes.len(), ring.spring_count()), (24, 24 * ring.strand_count()));
    }
}

#[test]
fn spokes_end_before_their_hub() {
    let topology = topology(disc(32, 16));
    assert_shared_out(&topology);
    assert_eq!(strand_count(&topology), 16 + 32);
    assert_eq!(keys(&topology, SpringKind::Structural, false).len(), 32);
}

#[test]
fn a_mesh_in_any_order_has_the_same_strands() {
    for (name, mesh) in [("triangles", hexagons(20)), ("an L", ell(24))] {
        let expected = strand_count(&topology(mesh.clone()));
        for seed in 0..5 {
            let mut rng = Rng::with_seed(seed);
            let place = |vertex: u32| mesh.positions[vertex as usize];
            let mut triangles: Vec<[Vec3; 3]> = mesh.triangles.iter().map(|triangle| triangle.map(place)).collect();
            rng.shuffle(&mut triangles);
            let corners = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect::<Vec<_>>();
            let topology = topology(assemble(triangles.as_flattened().to_vec(), &corners));
            assert_shared_out(&topology);
            assert_eq!(strand_count(&topology), expected, "{name}, seed {seed}");
        }
    }
}

#[test]
fn irregular_meshes_have_no_strands_and_neither_have_tiny_ones_and_fans() {
    let far = |p: Vec3| p + Vec3::X * 5.0;
    let meshes = [
        ("Delaunay's", strewn(30)),
        ("one triangle", triangle()),
        ("two", both(triangle(), shaped(triangle(), far))),
        ("a fan", fan(200)),
    ];
    for (name, mesh) in meshes {
        let topology = topology(mesh);
        assert!(topology.strand_packs.is_empty() && topology.batches.iter().all(|batch| !batch.on_strand), "{name}");
        assert!(matches!(topology.structure(), MeshStructure::Unstructured { .. }), "{name}");
    }
}

#[test]
fn whatever_is_left_of_a_sheet_has_every_spring_once() {
    let mut packed = 0;
    for seed in 0..60 {
        let mut rng = Rng::with_seed(seed);
        let share = rng.f32();
        let mut missing: Vec<bool> = (0..20 * 20).map(|_| rng.f32() < 0.5 * share * share).collect();
        missing[9 * 20 + 9] = true;
        let topology = topology(quads(20, |row, column| !missing[(row * 20 + column) as usize]));
        assert_shared_out(&topology);
        packed += usize::from(!topology.strand_packs.is_empty());
    }
    assert!(packed > 10, "{packed} of 60");
}

/// A sheet that hangs by the two particles that are farthest up, left and right.
fn hung(mesh: SourceMesh) -> Bed {
    let bed = Bed::new(mesh, springs(Springs::default()));
    let highest = bed.topology.rest.iter().map(|p| p.y).fold(f32::MIN, f32::max);
    let top = || (0_u32..).zip(&bed.topology.rest).filter(|(_, p)| p.y > highest - 1e-4);
    let left = top().min_by(|(_, p), (_, q)| p.x.total_cmp(&q.x)).expect("a particle").0;
    let right = top().max_by(|(_, p), (_, q)| p.x.total_cmp(&q.x)).expect("a particle").0;
    Bed { fluid_density: 0.0, ..bed }.pinned([left, right]).tethered(&[left, right])
}

/// The same cloth with its strands taken apart.
fn unravelled(mut bed: Bed) -> Bed {
    bed.topology.strand_packs.clear();
    bed.topology.batches.iter_mut().for_each(|batch| batch.on_strand = false);
    bed
}

/// Triangles that stand upright, a metre high.
fn upright_triangles(n: u32) -> SourceMesh {
    let turn = Quat::from_rotation_x(core::f32::consts::FRAC_PI_2);
    shaped(hexagons(n), |p| turn * p / n as f32)
}

#[test]
fn strands_leave_less_strain_than_springs_in_as_many_substeps() {
    for (name, mesh, factor) in
        [("triangles", upright_triangles(32), 0.4), ("an L", ell(32), 0.2), ("a disc", disc(48, 16), 0.5)]
    {
        let bed = hung(mesh).with_substeps(4);
        let [with, without] = [bed.clone(), unravelled(bed)].map(|mut bed| {
            bed.run(2.0);
            measure::strain(&bed.particles, &bed.topology).mean
        });
        println!("{name}: {with} for {without}");
        assert!(with < factor * without, "{name}: {with} for {without}");
    }
}

#[test]
fn strands_move_as_the_textbook_says_when_steps_are_small() {
    let turn = Quat::from_rotation_x(-core::f32::consts::FRAC_PI_2);
    let meshes = [("triangles", upright_triangles(10)), ("an L", ell(10)), ("a sleeve", sleeve(10, 10))];
    for ((name, mesh), damping) in meshes.iter().flat_map(|mesh| [(mesh, 0.0), (mesh, 0.05)]) {
        let soft = Springs {
            structural_stiffness: 200.0,
            structural_damping: damping,
            bend_damping: damping,
            ..Springs::default()
        };
        let bed = Bed { tethers: None, material: springs(soft), ..hung(shaped(mesh.clone(), |p| turn * p)) }
            .with_substeps(64);
        assert!(!bed.topology.strand_packs.is_empty(), "{name}");
        let explicit = Bed { method: Method::Explicit, ..bed.clone() };
        let [strands, springs, explicit] = [bed.clone(), unravelled(bed.clone()), explicit].map(|mut bed| {
            bed.run(0.25);
            bed.particles
        });
        let [off, springs_off, way] = [&strands, &springs, &bed.particles].map(|particles| rms(particles, &explicit));
        println!("{name}, damping {damping}: {off} m off, springs {springs_off}, on a way of {way}");
        assert!(
            off < 1.1 * springs_off && off < 0.01 * way,
            "{name}, damping {damping}: {off} m off on a way of {way}"
        );
    }
}

#[test]
fn the_substeps_to_hold_a_strain_hold_it_on_strands() {
    let mut failures = Vec::new();
    for (side, max_strain) in [(16, 0.01), (32, 0.01), (32, 0.005)] {
        let mut bed = hung(ell(side));
        bed.material = springs_in_air(Springs::default());
        bed.tether_slack = 0.002;
        bed.substep_policy = SubstepPolicy::to_hold(max_strain, &bed.topology, bed.material.moduli());
        assert!(bed.substep_policy.levels.is_empty());
        bed.run(3.0);
        let strains = (0..60).map(|_| {
            bed.step(1.0 / 60.0);
            measure::strain(&bed.particles, &bed.topology).largest
        });
        let strain = strains.sum::<f32>() / 60.0;
        let case = format!("{side} a side, {} substeps: {strain} for {max_strain}", bed.substep_policy.substeps);
        println!("{case}");
        failures.extend((strain > max_strain).then_some(case));
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn a_mesh_says_what_it_was_found_to_be() {
    let texts: [(SourceMesh, _); 3] = [
        (Grid::new(1.0, 1.0, 30, 20).into(), "20 rows, 30 columns"),
        (ell(24), "48 strands"),
        (triangle(), "springs in 3 colours"),
    ];
    for (mesh, text) in texts {
        assert_eq!(topology(mesh).structure().to_string(), text);
    }
}
