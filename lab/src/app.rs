//! What cloth costs in a headless Bevy app, wall time: all that the plugin does, without a renderer.

use std::{
    io, thread,
    time::{Duration, Instant},
};

use bevy::{mesh::MeshPlugin, prelude::*, time::TimeUpdateStrategy};
use bevy_drape::prelude::*;
use serde_json::{Value, json};

use super::{
    hang::hang,
    measure,
    mesh::MeshSource,
    options::{Options, PinnedPart, Solver},
    scene::{DENSITY, FRAME},
};

/// Frames before the measurement: pools and buffers fill.
const WARM_UP: u32 = 30;

/// The hanging cloth in an app, against the same app without it, one without the plugin, and the solver alone. They take
/// turns, so that whatever else the machine does meets them alike.
pub fn one_cloth(options: &Options) -> io::Result<Value> {
    let plugin = ClothPlugin::default().single_threaded();
    let mut bare = headless(None);
    let mut empty = headless(Some(plugin));
    let mut app = headless(Some(plugin));
    spawn_hanging(&mut app, options);
    let mut scene = hang(options, &MeshSource::Grid, PinnedPart::Corners)?;
    let mut step = || {
        scene.step(None);
    };
    let [mut updates, mut empties, mut bares, mut solvers, mut around] = [const { Vec::new() }; 5];
    for frame in 0..WARM_UP + options.frames {
        let bare = microseconds(|| bare.update());
        let [nothing, update, solver] =
            [microseconds(|| empty.update()), microseconds(|| app.update()), microseconds(&mut step)];
        if frame >= WARM_UP {
            bares.push(bare);
            empties.push(nothing);
            updates.push(update);
            solvers.push(solver);
            around.push(update - bare - solver);
        }
    }
    Ok(json!({
        "scene": "app",
        "n": options.n,
        "us_per_update_without_plugin": measure::median(bares).round(),
        "us_per_update_empty": measure::median(empties).round(),
        "us_per_update": measure::median(updates).round(),
        "us_solver": measure::median(solvers).round(),
        "us_around_solver": measure::median(around).round(),
    }))
}

fn spawn_hanging(app: &mut App, options: &Options) {
    let solver = match options.solver {
        Solver::Strands => ClothSolver::Strands,
        Solver::Xpbd => ClothSolver::Xpbd,
        Solver::Explicit => ClothSolver::Explicit,
    };
    let grid = ClothGrid::new(1.0, 1.0, options.n, options.n).lying();
    let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(grid);
    app.world_mut().spawn((
        Mesh3d(mesh),
        Cloth {
            solver,
            max_strain: options.max_strain,
            substeps: options.substeps,
            tether_slack: Some(options.tether_slack),
            ..default()
        },
        Fabric { density: DENSITY, damping: options.damping, drag: 0.0, lift: 0.0, ..default() },
        ClothSprings::default(),
        Pins::edge_corners(ClothEdge::Top),
    ));
}

/// A hanging cloth until its mesh has become cloth. Time stands still, so that no step is in the frames.
pub fn building(options: &Options) -> Value {
    let mut app = headless(Some(ClothPlugin::default()));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    for _ in 0..WARM_UP {
        app.update();
    }
    spawn_hanging(&mut app, options);
    let mut status = app.world_mut().query::<&ClothStatus>();
    let start = Instant::now();
    let mut frames = Vec::new();
    while !status.iter(app.world()).all(|status| *status == ClothStatus::Ready) {
        frames.push(microseconds(|| app.update()) / 1000.0);
        // As much as a renderer would leave to others.
        thread::sleep(Duration::from_millis(1));
    }
    let until_ready = start.elapsed().as_secs_f64() * 1000.0;
    let ready = frames.pop();
    json!({
        "scene": "build",
        "n": options.n,
        "frames": frames.len() + 1,
        "ms_until_ready": until_ready,
        "ms_longest_frame_before": frames.into_iter().fold(0.0, f64::max),
        "ms_frame_in_which_it_is_ready": ready,
    })
}

/// Flags on their poles, ten in a row.
#[derive(clap::Args, Clone, Copy, Debug)]
pub struct Many {
    /// Flags
    #[arg(long, default_value_t = 100)]
    cloths: u32,
    /// With 17 capsules beside each second flag, which doesn't touch them
    #[arg(long)]
    figures: bool,
    /// Without wind, once they have come to rest and sleep
    #[arg(long)]
    calm: bool,
    /// Frames of 1/60 s
    #[arg(long, default_value_t = 300, value_parser = clap::value_parser!(u32).range(1..))]
    frames: u32,
    /// Steps all cloths on one thread
    #[arg(long)]
    single_threaded: bool,
}

impl Many {
    /// What a frame costs with them, and without.
    pub fn measure(self) -> Value {
        let Self { cloths, figures, calm, frames, single_threaded } = self;
        let plugin = ClothPlugin::default();
        let plugin = if single_threaded { plugin.single_threaded() } else { plugin };
        let empty = frame_microseconds(&mut headless(Some(plugin)), frames);
        let mut app = headless(Some(plugin));
        let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(ClothGrid::new(1.0, 0.62, 32, 20));
        for i in 0..cloths {
            app.world_mut().spawn((
                Mesh3d(mesh.clone()),
                Cloth::default(),
                Fabric { density: 0.12, ..default() },
                ClothSprings { bend_stiffness: 4.0, ..default() },
                Pins::edge(ClothEdge::Left),
                Transform::from_xyz(1.5 * (i % 10) as f32, 1.5, 1.5 * (i / 10) as f32),
            ));
        }
        if figures {
            let beside = |i: u32| Vec3::new(1.5 * (i % 10) as f32 - 0.7, 1.5, 1.5 * (i / 10) as f32);
            (0..cloths).step_by(2).for_each(|i| spawn_figure(app.world_mut(), beside(i)));
        }
        if calm {
            let_sleep(&mut app);
        } else {
            let wind = Wind { velocity: Vec3::new(5.0, 0.0, 1.0), gusts: 0.6, turbulence: 0.25, ..default() };
            app.world_mut().spawn(wind);
        }
        let update = frame_microseconds(&mut app, frames);
        json!({
            "scene": "many",
            "cloths": cloths,
            "asleep": asleep(&mut app),
            "obstacles": if figures { cloths.div_ceil(2) * LIMBS } else { 0 },
            "particles": cloths * 32 * 20,
            "threads": if single_threaded { 1 } else { bevy::tasks::available_parallelism() },
            "ms_per_update_empty": empty / 1000.0,
            "ms_per_update": update / 1000.0,
        })
    }
}

/// Number of cloths that are asleep.
fn asleep(app: &mut App) -> usize {
    let mut status = app.world_mut().query::<&ClothStatus>();
    status.iter(app.world()).filter(|status| **status == ClothStatus::Asleep).count()
}

/// Runs an app until all of its cloths sleep, or for two minutes of its time.
fn let_sleep(app: &mut App) {
    const LONGEST: f32 = 120.0;
    let cloths = app.world_mut().query::<&Cloth>().iter(app.world()).count();
    for _ in 0..(LONGEST / FRAME) as u32 {
        if asleep(app) == cloths {
            break;
        }
        app.update();
    }
}

/// Capsules of a figure.
const LIMBS: u32 = 17;

/// As many capsules as a character has limbs, around a place.
fn spawn_figure(world: &mut World, place: Vec3) {
    for limb in 0..LIMBS {
        let height = (limb as f32 / (LIMBS - 1) as f32 - 0.5) * 0.8;
        let side = (limb % 3) as f32 * 0.08;
        let collider = ClothCollider::from(Capsule3d::new(0.05, 0.15));
        world.spawn((collider, Transform::from_translation(place + Vec3::new(-side, height, 0.0))));
    }
}

/// An app that steps once an update.
pub(crate) fn headless(plugin: Option<ClothPlugin>) -> App {
    let frame = Duration::from_secs_f32(FRAME);
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), MeshPlugin))
        .insert_resource(Time::<Fixed>::from_duration(frame))
        .insert_resource(TimeUpdateStrategy::ManualDuration(frame));
    if let Some(plugin) = plugin {
        app.add_plugins(plugin);
    }
    app.finish();
    app.cleanup();
    app
}

/// Median wall time of an update, µs.
fn frame_microseconds(app: &mut App, frames: u32) -> f64 {
    for _ in 0..WARM_UP {
        app.update();
    }
    measure::median((0..frames).map(|_| microseconds(|| app.update())).collect())
}

/// Wall time of some work, µs.
pub(crate) fn microseconds(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64() * 1e6
}
