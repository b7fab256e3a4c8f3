//! What the rate of frames, of steps and of substeps changes: the first nothing, the others little.

use std::time::Duration;

use bevy::{
    math::{Vec3A, ops},
    mesh::MeshPlugin,
    prelude::*,
    time::TimeUpdateStrategy,
};
use bevy_drape::prelude::*;

use super::{
    Extent,
    bed::{Bed, bare},
    record::{Case, Measurement, Outcome, Rest},
};

const COTTON: Fabric = Fabric::COTTON_WOVEN;

/// Cells along each side.
const CELLS: u32 = 20;

/// Share of the side, 1 m, that one surface may be off the other.
const TOLERANCE: f64 = 0.02;

/// A hanging cloth in an app that draws 24, 60, 144 and 1000 frames a second, or one that never takes as long as the last:
/// after as many fixed steps its bits are the same.
pub fn of_frames(_: Extent) -> Outcome {
    let reference = bits_at(|_| 60.0);
    let uneven = |frame: u32| 20.0 + 130.0 * ((frame * 37 % 101) as f32 / 101.0);
    let rates: [(&str, fn(u32) -> f32); 4] =
        [("24", |_| 24.0), ("144", |_| 144.0), ("1000", |_| 1000.0), ("20 to 150", uneven)];
    let measurements = rates.into_iter().map(|(name, rate)| {
        let differing = reference.iter().zip(bits_at(rate)).filter(|(a, b)| *a != b).count();
        let quantity = format!("numbers that differ at {name} frames/s from 60 frames/s");
        let case = Case { fabric: "cotton_woven", mesh: "grid", n: CELLS, ..Case::default() };
        Measurement::new("frame-rates", &quantity, case, differing as f64, 0.0).of(1.0).within(0.0)
    });
    Outcome { measurements: measurements.collect(), ..Outcome::default() }
}

/// Fixed steps that are compared.
const STEPS: u32 = 120;

/// Counts the steps, and keeps the bits of all positions after [`STEPS`] of them.
#[derive(Resource, Default)]
struct Notes {
    steps: u32,
    bits: Vec<u32>,
}

fn note(mut notes: ResMut<Notes>, cloths: Query<&ClothState>) {
    notes.steps += 1;
    if notes.steps == STEPS {
        let values = cloths.iter().flat_map(ClothState::positions).flat_map(|p| p.to_array());
        notes.bits = values.map(f32::to_bits).collect();
    }
}

/// The bits after [`STEPS`] of 1/60 s, in frames that are drawn at a rate, 1/s.
fn bits_at(rate: impl Fn(u32) -> f32) -> Vec<u32> {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), MeshPlugin, ClothPlugin::default()))
        .insert_resource(Time::<Fixed>::from_hz(60.0))
        // It becomes cloth while time stands still.
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO))
        .init_resource::<Notes>()
        .add_systems(FixedLast, note);
    app.finish();
    app.cleanup();
    let grid = ClothGrid::new(1.0, 1.0, CELLS + 1, CELLS + 1).lying();
    let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(grid);
    app.world_mut().spawn((Mesh3d(mesh), Cloth::default(), COTTON, Pins::edge_corners(ClothEdge::Top)));
    let mut status = app.world_mut().query::<&ClothStatus>();
    while !status.iter(app.world()).all(|status| *status == ClothStatus::Ready) {
        app.update();
    }
    for frame in 0.. {
        app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(1.0 / rate(frame))));
        app.update();
        if app.world().resource::<Notes>().steps >= STEPS {
            break;
        }
    }
    app.world_mut().remove_resource::<Notes>().map(|notes| notes.bits).unwrap_or_default()
}

/// m/s. In f32 and at 4600 substeps a second, rounding never lets a cloth that is soft against folding quite rest.
const SLOW: f32 = 0.01;

/// A cloth at rest, hung by two corners as a game would hang it, for steps of 1/30, 1/60 and 1/144 s with 8, 16 and 32
/// substeps, against the one in the middle: the farthest that a place of the one surface is from the other.
pub fn of_steps(extent: Extent) -> Outcome {
    let brief = [(30.0, 16), (60.0, 8), (144.0, 8)];
    let others = [(30.0, 8), (30.0, 32), (60.0, 32), (144.0, 16), (144.0, 32)];
    let cases = if extent == Extent::Brief { brief.to_vec() } else { [&brief[..], &others].concat() };
    let (reference, _) = hung(60.0, 16);
    let measurements = cases.iter().map(|&(rate, substeps)| {
        let (bed, rest) = hung(rate, substeps);
        let apart = hausdorff(&bed, &reference).max(hausdorff(&reference, &bed));
        let quantity = format!("Hausdorff distance at 1/{rate} s from 1/60 s in 16 substeps, m");
        let case = Case { fabric: "cotton_woven", mesh: "grid", n: CELLS, substeps: Some(substeps), ..Case::default() };
        Measurement::new("step-rates", &quantity, case, apart, 0.0).of(1.0).within(TOLERANCE).after(rest)
    });
    Outcome { measurements: measurements.collect(), ..Outcome::default() }
}

fn hung(rate: f32, substeps: u32) -> (Bed, Rest) {
    let grid = ClothGrid::new(1.0, 1.0, CELLS + 1, CELLS + 1).lying();
    let bed = Bed::new(grid, bare(COTTON));
    let mut bed = Bed { dt: 1.0 / rate, substeps, slow: SLOW, ..bed };
    bed = bed.pinned(|p| p.z < -0.499 && p.x.abs() > 0.499).tethered();
    // Which way it folds is decided by this, rather than by rounding.
    let wave = |x: f32| ops::sin(core::f32::consts::TAU * x);
    for position in &mut bed.particles.position {
        position.y += 0.001 * wave(position.x) * wave(position.z + 0.25);
    }
    // Let go in honey, or it would be chance which folds it falls into. Then as much as is still left.
    bed.run_damped(50.0, 20.0);
    bed.run_damped(5.0, 10.0);
    let rest = bed.settle(5.0, 20.0);
    (bed, rest)
}

/// The farthest that a particle of the one is from the surface of the other, m.
fn hausdorff(from: &Bed, to: &Bed) -> f64 {
    let nearest = |&place: &Vec3A| {
        let corners = to.topology.triangles.iter().map(|t| t.map(|i| to.particles.position[i as usize]));
        corners.map(|[a, b, c]| distance_to_triangle(place, a, b, c)).fold(f32::INFINITY, f32::min)
    };
    from.particles.position.iter().map(nearest).fold(0.0, f32::max).into()
}

fn distance_to_triangle(p: Vec3A, a: Vec3A, b: Vec3A, c: Vec3A) -> f32 {
    let normal = (b - a).cross(c - a);
    let is_beside = |a: Vec3A, b: Vec3A| (b - a).cross(p - a).dot(normal) < 0.0;
    let sides = [(a, b), (b, c), (c, a)];
    if sides.into_iter().any(|(a, b)| is_beside(a, b)) {
        sides.map(|(a, b)| distance_to_line(p, a, b)).into_iter().fold(f32::INFINITY, f32::min)
    } else {
        (p - a).dot(normal.normalize_or_zero()).abs()
    }
}

fn distance_to_line(p: Vec3A, a: Vec3A, b: Vec3A) -> f32 {
    let share = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    p.distance(a.lerp(b, share))
}
