//! Clothes on animated characters in a headless app: what they cost, and how near to their skin they are.

use std::{collections::BTreeMap, io, path::PathBuf, time::Duration};

use bevy::{app::AnimationSystems, prelude::*, time::TimeUpdateStrategy};
use bevy_drape::{Obstacles, prelude::*};
use cpu_time::ProcessTime;
use serde_json::{Value, json};

use crate::{app, clips::Clip, measure};
use free::Free;
use model::Model;

mod free;
mod model;

/// Frames before the measurement.
const WARM_UP: u32 = 30;

/// The mannequin with cape and skirt, many times over, in a clip and in the wind.
#[derive(clap::Args, Clone, Debug)]
pub struct Character {
    /// Characters
    #[arg(long, default_value_t = 20)]
    characters: u32,
    /// idle, walk, run, jump, turn or sit
    #[arg(long, default_value = "run")]
    clip: String,
    /// Frames a second
    #[arg(long, default_value_t = 64.0)]
    hz: f64,
    /// Frames
    #[arg(long, default_value_t = 300, value_parser = clap::value_parser!(u32).range(1..))]
    frames: u32,
    /// Without capsules on the body
    #[arg(long)]
    no_body: bool,
    /// Substeps of all clothes, instead of those that they choose
    #[arg(long)]
    substeps: Option<u32>,
    /// Steps all cloths on one thread
    #[arg(long)]
    single_threaded: bool,
}

/// The character that wears a garment.
#[derive(Component)]
struct WornBy(Entity);

/// What a character does, and since when.
#[derive(Component)]
struct Actor {
    clip: Clip,
    phase: f32,
}

/// The character that a joint is of.
#[derive(Component)]
struct JointOf(Entity);

impl Character {
    /// What a frame costs with them, and how the clothes fare.
    ///
    /// # Errors
    ///
    /// Where the model can't be read, or has no such clip.
    pub fn measure(&self) -> io::Result<Value> {
        let path = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/mannequin.glb"));
        let clips = Clip::read_all(&path)?;
        let clip = clips.get(&self.clip).ok_or_else(|| io::Error::other(format!("clips are {:?}", clips.keys())))?;
        let model = Model::read(&path)?;
        let plugin = ClothPlugin::default();
        let mut app = app::headless(Some(if self.single_threaded { plugin.single_threaded() } else { plugin }));
        let frame = Duration::from_secs_f64(1.0 / self.hz);
        app.insert_resource(TimeUpdateStrategy::ManualDuration(frame));
        app.add_systems(PostUpdate, animate.in_set(AnimationSystems).before(TransformSystems::Propagate));
        app.world_mut().spawn(Wind { velocity: Vec3::new(0.5, 0.0, -3.0), gusts: 0.5, ..default() });
        for i in 0..self.characters {
            let place = Vec3::new(2.0 * (i % 5) as f32, 0.0, 2.0 * (i / 5) as f32);
            self.spawn(app.world_mut(), &model, clip, place, 0.037 * i as f32);
        }
        let (mut times, mut efforts) = (Vec::new(), Vec::new());
        let mut seen = Seen::default();
        for frame in 0..WARM_UP + self.frames {
            let start = ProcessTime::now();
            let time = app::microseconds(|| app.update());
            let effort = start.elapsed();
            if frame >= WARM_UP {
                times.push(time);
                efforts.push(effort.as_secs_f64() * 1e3);
                seen.look(app.world_mut());
            }
        }
        let Seen { mut strains, substeps, particles, inside, deepest, step_times } = seen;
        strains.sort_unstable_by(f32::total_cmp);
        let quantile = |share: f64| strains.get((share * strains.len().saturating_sub(1) as f64) as usize).copied();
        let worst = times.iter().copied().fold(0.0, f64::max);
        let median = measure::median(times);
        Ok(json!({
            "scene": "character",
            "characters": self.characters,
            "clip": self.clip,
            "hz": self.hz,
            "particles": particles,
            "ms_per_update": median / 1000.0,
            "ms_per_update_worst": worst / 1000.0,
            "cpu_ms_per_update": measure::median(efforts),
            "us_per_step": step_times.into_iter().map(|(name, times)| (name, measure::median(times))).collect::<BTreeMap<_, _>>(),
            "ns_per_particle": (1000.0 * median / particles.max(1) as f64).round(),
            "substeps_most": substeps,
            "strain_p99_where_free": quantile(0.99),
            "strain_largest_where_free": quantile(1.0),
            "inside_body_per_frame": inside as f64 / f64::from(self.frames),
            "deepest_in_body_m": deepest,
        }))
    }

    fn spawn(&self, world: &mut World, model: &Model, clip: &Clip, place: Vec3, phase: f32) {
        let character = world.spawn((Transform::from_translation(place), Actor { clip: clip.clone(), phase })).id();
        let (joints, parts) = model.spawn(world, character);
        if !self.no_body {
            let except = ["Tunic", "CapeFine"].map(String::from).to_vec();
            world.entity_mut(character).insert(ClothBody { except, ..default() });
        }
        for joint in joints {
            world.entity_mut(joint).insert(JointOf(character));
        }
        for (name, part) in parts {
            let fabric = match name.as_str() {
                "Cape" => Fabric::WOOL_FLANNEL,
                "Skirt" => Fabric::COTTON_WOVEN,
                _ => continue,
            };
            let skin = ClothSkin { backstop: Some(0.01), backstop_radius: 0.3, ..default() };
            let free =
                world.get::<Mesh3d>(part).and_then(|mesh| world.resource::<Assets<Mesh>>().get(mesh).map(Free::of));
            let free = free.unwrap_or_default();
            let cloth = Cloth { substeps: self.substeps, ..default() };
            world.entity_mut(part).insert((cloth, fabric, skin, free, WornBy(character)));
        }
    }
}

/// What is seen of the clothes after each frame.
#[derive(Default)]
struct Seen {
    strains: Vec<f32>,
    substeps: u32,
    particles: usize,
    /// Free vertices inside of their own body, over all frames, and how deep the deepest was, m; negative outside, none without a body.
    inside: usize,
    deepest: Option<f32>,
    /// Mean time of a step, by what is worn, µs.
    step_times: BTreeMap<String, Vec<f64>>,
}

impl Seen {
    fn look(&mut self, world: &mut World) {
        let mut cloths = world.query::<(&Name, &ClothState, &ClothReport, &Free, &WornBy)>();
        let obstacles = world.resource::<Obstacles>();
        self.particles = 0;
        let mut times: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
        for (name, state, report, free, &WornBy(character)) in cloths.iter(world) {
            let body = free::parts_of(character, obstacles, |entity| world.get::<ClothBodyPart>(entity));
            self.particles += state.particle_count();
            self.strains.extend(free.strains(state));
            self.substeps = self.substeps.max(report.latest().map_or(0, |latest| latest.substeps));
            for depth in free.depths(state, &body) {
                self.inside += usize::from(depth > free::DEEP);
                self.deepest =
                    Some(self.deepest.map_or(depth, |deepest| deepest.max(depth))).filter(|_| !body.is_empty());
            }
            times.entry(name.as_str()).or_default().push(report.step_time().as_secs_f64() * 1e6);
        }
        for (name, times) in times {
            let mean = times.iter().sum::<f64>() / times.len() as f64;
            self.step_times.entry(name.into()).or_default().push(mean);
        }
    }
}

/// Poses the joints of all characters.
fn animate(mut joints: Query<(&Name, &JointOf, &mut Transform)>, actors: Query<&Actor>, time: Res<Time>) {
    for (name, of, mut transform) in &mut joints {
        if let Ok(actor) = actors.get(of.0) {
            actor.clip.pose(name, time.elapsed_secs() + actor.phase, &mut transform);
        }
    }
}
