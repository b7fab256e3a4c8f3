//! Runs a scene and measures time, strain and penetration.

use std::{fs, io, path::Path, time::Instant};

use bevy::math::Vec3A;
use bevy_drape::solver::{self, Scratch, Shape, SpringKind, constraint::spring::strain};
use cpu_time::ThreadTime;
use serde_json::{Value, json};

use super::{
    Options, Solver,
    mesh::MeshSource,
    oracle::{self, Oracle},
    scene::{FRAME, Scene},
    threads,
};

/// Frames at the end that the strain is averaged over.
const LAST: usize = 60;

/// What is measured after each frame.
struct Frame {
    microseconds: f64,
    max_strain: f32,
    p99_strain: f32,
    mean_strain: f32,
    penetration: f32,
    intersecting_pairs: usize,
}

/// Runs `scene` and returns its line. With an `oracle` it also says how far the cloth is from it after 0.5 s, and how
/// far the oracle is stretched.
pub fn run(name: &str, options: &Options, mut scene: Scene, oracle: Option<&Oracle>) -> io::Result<Value> {
    let pool = threads::pool(options.threads);
    let mut scratch = Scratch::default();
    let mut substeps = 0;
    let mut frames = Vec::new();
    let mut distance = None;
    let positions_after = options.at_seconds.map_or(options.frames, |seconds| (seconds / FRAME).round() as u32);
    for frame in 1..=options.frames {
        let mut particles = core::mem::take(&mut scene.particles);
        let ctx = scene.context(options, pool.as_ref());
        // What several threads do is seen by the clock on the wall only.
        let (start, wall) = (ThreadTime::now(), Instant::now());
        let report = solver::step(&mut particles, &scene.topology, &ctx, &mut scratch);
        let time = if pool.is_some() { wall.elapsed() } else { start.elapsed() };
        let microseconds = time.as_secs_f64() * 1e6;
        substeps = report.substeps;
        scene.particles = particles;
        frames.push(measure(&scene, microseconds));
        if frame == oracle::FRAME {
            distance = oracle.map(|oracle| oracle.rms_distance(&scene.particles.position));
        }
        if let Some(file) = &options.positions
            && frame == positions_after
        {
            write_positions(file, &scene.particles.position)?;
        }
    }
    let mut line = line(name, options, &scene, substeps, &frames);
    if let Some(oracle) = oracle {
        line["rms_05s_m"] = distance.into();
        line["oracle_max_strain"] = oracle.max_strain.into();
        line["oracle_mean_strain"] = oracle.mean_strain.into();
    }
    Ok(line)
}

fn line(name: &str, options: &Options, scene: &Scene, substeps: u32, frames: &[Frame]) -> Value {
    let last = &frames[frames.len().saturating_sub(LAST)..];
    let mean = |value: fn(&Frame) -> f32| last.iter().map(value).sum::<f32>() / last.len() as f32;
    let most = |value: fn(&Frame) -> f32| frames.iter().map(value).fold(0.0, f32::max);
    json!({
        "scene": name,
        "mesh": scene.mesh.to_string(),
        // A file has as many particles as it has.
        "n": if let MeshSource::File(_) = scene.mesh { None } else { Some(options.n) },
        "particles": scene.particles.len(),
        "springs": scene.topology.springs.len(),
        "substeps": substeps,
        "weave": scene.topology.weave().to_string(),
        "levels": scene.levels(),
        "build_ms": scene.build_ms,
        "tethers_ms": scene.tethers_ms,
        "solver": match options.solver { Solver::Strands => "strands", Solver::Xpbd => "xpbd", Solver::Explicit => "explicit" },
        "threads": options.threads,
        "us_per_frame_median": median(frames.iter().map(|frame| frame.microseconds).collect()).round(),
        "max_strain": mean(|frame| frame.max_strain),
        "p99_strain": mean(|frame| frame.p99_strain),
        "mean_strain": mean(|frame| frame.mean_strain),
        "max_strain_over_time": most(|frame| frame.max_strain),
        "max_penetration_m": most(|frame| frame.penetration),
        "intersecting_pairs_end": frames.last().map(|frame| frame.intersecting_pairs),
        "intersecting_pairs_worst": frames.iter().map(|frame| frame.intersecting_pairs).max(),
        "max_speed_end": scene.particles.velocity.iter().map(|v| v.length()).fold(0.0, f32::max),
        "finite": scene.particles.is_finite(),
        "peak_rss_mb": peak_rss_mb(),
    })
}

fn measure(scene: &Scene, microseconds: f64) -> Frame {
    let position = &scene.particles.position;
    let mut strains: Vec<f32> =
        scene.topology.springs_of(SpringKind::Structural).map(|spring| strain(position, spring)).collect();
    // A full sort of a large cloth's springs would take longer than its frame.
    let at = (strains.len() - 1) * 99 / 100;
    let (_, p99, above) = strains.select_nth_unstable_by(at, f32::total_cmp);
    let (p99_strain, max_strain) = (*p99, above.iter().copied().fold(*p99, f32::max));
    let depth = |p: &Vec3A| {
        let distances = scene.obstacles.iter().filter_map(|obstacle| match obstacle.shape {
            Shape::Solid(solid) => Some(solid.surface(obstacle.end.inverse().transform_point(*p)).distance),
            Shape::Mesh(_) => None,
        });
        distances.fold(0.0, |deepest, distance| f32::max(deepest, -distance))
    };
    Frame {
        microseconds,
        max_strain,
        p99_strain,
        mean_strain: strains.iter().map(|strain| strain.max(0.0)).sum::<f32>() / strains.len() as f32,
        intersecting_pairs: solver::measure::intersecting_pairs(&scene.particles, &scene.topology),
        penetration: position.iter().map(depth).fold(0.0, f32::max),
    }
}

/// The middle one of `values`.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values[values.len() / 2]
}

fn write_positions(file: &Path, positions: &[Vec3A]) -> io::Result<()> {
    let lines: Vec<String> = positions.iter().map(|p| format!("{} {} {}\n", p.x, p.y, p.z)).collect();
    let named = |error| io::Error::other(format!("positions can't be written to {}: {error}", file.display()));
    fs::write(file, lines.concat()).map_err(named)
}

/// The most memory that the process has held, MB. Linux says; elsewhere null.
fn peak_rss_mb() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some((kilobytes / 1024.0).round())
}
