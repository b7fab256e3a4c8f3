//! Runs a scene and measures time, strain, penetration and intersections.

use std::{fs, io, path::Path, time::Instant};

use bevy::tasks::{TaskPool, TaskPoolBuilder};
use cpu_time::ThreadTime;
use serde_json::{Value, json};

use super::{
    mesh::MeshSource,
    options::{Options, Solver},
    oracle::{self, Oracle},
    scene::{Cloth, FRAME, Look, Scene},
};

/// Measures what some arguments on the lab's command line ask for.
pub type Measure = fn(&str) -> io::Result<Value>;

/// Frames at the end that the strain is averaged over.
const LAST: usize = 60;

/// What is measured after each frame.
struct Frame {
    microseconds: f64,
    look: Look,
}

/// A pool that makes `threads` with the one that asks it for work.
pub fn pool(threads: u32) -> Option<TaskPool> {
    (threads > 1).then(|| TaskPoolBuilder::new().num_threads(threads as usize - 1).build())
}

/// Runs `scene` and returns its line. With an `oracle` it also says how far the cloth is from it after 0.5 s, and how
/// far the oracle is stretched.
pub fn run(
    name: &str,
    options: &Options,
    mesh: &MeshSource,
    mut scene: Scene,
    oracle: Option<&Oracle>,
) -> io::Result<Value> {
    let pool = pool(options.threads);
    let mut substeps = 0;
    let mut frames = Vec::new();
    let mut distance = None;
    let positions_after = options.at_seconds.map_or(options.frames, |seconds| (seconds / FRAME).round() as u32);
    for frame in 1..=options.frames {
        scene.lead();
        // What several threads do is seen by the clock on the wall only.
        let (start, wall) = (ThreadTime::now(), Instant::now());
        substeps = scene.step(pool.as_ref());
        let time = if pool.is_some() { wall.elapsed() } else { start.elapsed() };
        let microseconds = time.as_secs_f64() * 1e6;
        frames.push(Frame { microseconds, look: Look::at(&scene) });
        if frame == oracle::FRAME {
            distance = oracle.map(|oracle| oracle.rms_distance(&scene.cloths[0].particles.position));
        }
        if let Some(file) = &options.positions
            && frame == positions_after
        {
            write_positions(file, &scene.cloths)?;
        }
    }
    let mut line = line(name, options, mesh, &scene, substeps, &frames);
    if let Some(oracle) = oracle {
        line["rms_05s_m"] = distance.into();
        line["oracle_max_strain"] = oracle.max_strain.into();
        line["oracle_mean_strain"] = oracle.mean_strain.into();
    }
    Ok(line)
}

fn line(name: &str, options: &Options, mesh: &MeshSource, scene: &Scene, substeps: u32, frames: &[Frame]) -> Value {
    let cloths = &scene.cloths;
    let last = &frames[frames.len().saturating_sub(LAST)..];
    let mean = |value: fn(&Look) -> f32| last.iter().map(|frame| value(&frame.look)).sum::<f32>() / last.len() as f32;
    let worst = frames.iter().fold(Look::default(), |worst, frame| worst.worse_of(&frame.look));
    let end = frames.last().map(|frame| frame.look).unwrap_or_default();
    let mut line = json!({
        "scene": name,
        "mesh": mesh.to_string(),
        // A file has as many particles as it has.
        "n": if let MeshSource::File(_) = mesh { None } else { Some(options.n) },
        "particles": cloths.iter().map(|cloth| cloth.particles.len()).sum::<usize>(),
        "springs": cloths.iter().map(|cloth| cloth.topology.springs.len()).sum::<usize>(),
        "substeps": substeps,
        "weave": cloths[0].topology.structure().to_string(),
        "levels": levels(&cloths[0]),
        "build_ms": cloths.iter().map(|cloth| cloth.build_ms).sum::<f64>(),
        "tethers_ms": cloths.iter().map(|cloth| cloth.tethers_ms).sum::<f64>(),
        "solver": match options.solver { Solver::Strands => "strands", Solver::Xpbd => "xpbd", Solver::Explicit => "explicit" },
        "threads": options.threads,
        "us_per_frame_median": median(frames.iter().map(|frame| frame.microseconds).collect()).round(),
        "us_per_frame_worst": frames.iter().map(|frame| frame.microseconds).fold(0.0, f64::max).round(),
        "max_strain": mean(|look| look.max_strain),
        "p99_strain": mean(|look| look.p99_strain),
        "mean_strain": mean(|look| look.mean_strain),
        "max_strain_over_time": worst.max_strain,
        "self_collision": format!("{:?}", scene.surroundings.settings.self_collision).to_lowercase(),
        // Of any place of any triangle.
        "max_penetration_m": worst.penetration,
        "max_penetration_of_particles_m": worst.particle_penetration,
        "intersecting_pairs_end": end.intersecting_pairs,
        "intersecting_pairs_worst": worst.intersecting_pairs,
        "intersecting_share_worst": worst.intersecting_pairs as f64 / scene.triangle_count() as f64,
        "max_speed_end": end.max_speed,
        "finite": cloths.iter().all(|cloth| cloth.particles.is_finite()),
        "peak_rss_mb": peak_rss_mb(),
    });
    if let Some(fault) = &scene.fault {
        line[format!("{}_end", fault.name)] = end.fault.into();
        line[format!("{}_worst", fault.name)] = worst.fault.into();
    }
    line
}

/// The coarse levels as the option writes them.
pub fn levels(cloth: &Cloth) -> String {
    let levels =
        cloth.rig.settings.substep_policy.levels.iter().map(|level| format!("{}x{}", level.stride, level.iterations));
    let levels: Vec<String> = levels.collect();
    if levels.is_empty() { "none".into() } else { levels.join(",") }
}

/// The middle one of `values`.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values[values.len() / 2]
}

fn write_positions(file: &Path, cloths: &[Cloth]) -> io::Result<()> {
    let positions = cloths.iter().flat_map(|cloth| &cloth.particles.position);
    let lines: Vec<String> = positions.map(|p| format!("{} {} {}\n", p.x, p.y, p.z)).collect();
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
