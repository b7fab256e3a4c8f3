//! The solver and the build stage, without an `App`.
//!
//! `cargo bench -p drape_lab`; the lab measures whole scenes.

use bevy::{math::Mat3A, math::Vec3A, prelude::Mesh};
use bevy_drape::{
    build,
    prelude::{ClothGrid, ClothSprings, Fabric},
    solver::{
        Elasticity, Material, Method, Particles, PinMotion, Scratch, StepContext, StepSettings, SubstepPolicy,
        Topology,
        embedding::{Embedding, EmbeddingScratch},
        step,
    },
};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};

fn grid(n: u32) -> Mesh {
    ClothGrid::new(1.0, 1.0, n, n).lying().into()
}

fn topology(n: u32) -> Topology {
    build::topology_of(&grid(n), Mat3A::IDENTITY).expect("a grid is a mesh with an area")
}

/// One frame of a cloth that hangs by two corners.
fn hang(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("hang");
    let fabric = Fabric::default().material().expect("valid constants");
    let constants = ClothSprings::default().constants().expect("valid constants");
    let springs = Material { elasticity: Elasticity::Springs(constants), density: 0.2, ..fabric };
    for (name, material, method, n, air) in [
        ("strands", springs, Method::Strands, 64, 0.0),
        ("strands in air", springs, Method::Strands, 64, 1.225),
        ("strands of a fabric in air", fabric, Method::Strands, 64, 1.225),
        ("xpbd", springs, Method::Xpbd, 64, 0.0),
        ("xpbd in air", springs, Method::Xpbd, 64, 1.225),
        ("explicit", springs, Method::Explicit, 32, 0.0),
    ] {
        let topology = topology(n);
        let rest: Vec<Vec3A> = topology.rest.iter().copied().map(Vec3A::from).collect();
        let pins = [0, n - 1];
        let pin_motions = pins.map(|particle| {
            let place = rest[particle as usize];
            PinMotion { particle, start: place, end: place }
        });
        let mut particles = Particles::at_rest(rest, &topology, &material);
        particles.set_masses(&topology, &material, |i| pins.contains(&(i as u32)));
        let tethers = build::tethers(&topology, &pins);
        let substep_policy = match method {
            Method::Strands => SubstepPolicy::to_hold(0.005, &topology, material.moduli()),
            Method::Xpbd | Method::Explicit => SubstepPolicy::fixed(8, Vec::new()),
        };
        let settings = StepSettings { method, substep_policy, tether_slack: 0.002, ..StepSettings::default() };
        let ctx = StepContext {
            gravity: Vec3A::NEG_Y * 9.81,
            fluid_density: air,
            pin_motions: &pin_motions,
            tethers: Some(&tethers),
            ..StepContext::new(1.0 / 60.0, &settings, material)
        };
        let mut scratch = Scratch::default();
        group.bench_function(BenchmarkId::new(name, n), |bencher| {
            bencher.iter(|| step(&mut particles, &topology, &ctx, &mut scratch));
        });
    }
    group.finish();
}

/// What it takes until a mesh is cloth.
fn build_stage(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("build");
    for n in [32, 64] {
        let mesh = grid(n);
        group.bench_function(BenchmarkId::new("topology", n), |bencher| {
            bencher.iter(|| build::topology_of(&mesh, Mat3A::IDENTITY));
        });
        let topology = topology(n);
        group.bench_function(BenchmarkId::new("tethers", n), |bencher| {
            bencher.iter(|| build::tethers(&topology, &[0, n - 1]));
        });
        let middle = topology.triangles[topology.triangles.len() / 2];
        group.bench_function(BenchmarkId::new("grab_tethers", n), |bencher| {
            bencher.iter(|| build::grab_tethers(&topology, middle, [0.2, 0.3, 0.5]));
        });
    }
    group.finish();
}

/// A fine mesh of 12,321 points that follows a cloth of 28 x 28 particles.
fn embedding(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("embedding");
    let corners: Vec<Vec3A> = topology(28).rest.iter().copied().map(Vec3A::from).collect();
    let points: Vec<Vec3A> = topology(111).rest.iter().map(|&point| Vec3A::from(point) + Vec3A::Y * 0.01).collect();
    let triangles = topology(28).triangles;
    group.bench_function("new", |bencher| bencher.iter(|| Embedding::new(&points, &corners, &triangles)));
    let embedding = Embedding::new(&points, &corners, &triangles);
    let (mut scratch, mut places) = (EmbeddingScratch::default(), Vec::new());
    group.bench_function("place", |bencher| bencher.iter(|| embedding.place(&corners, &mut scratch, &mut places)));
    group.finish();
}

criterion_group!(benches, hang, build_stage, embedding);
criterion_main!(benches);
