//! Clothes on animated characters in a headless app: what they cost, and how near to their skin they are.

use std::{io, path::PathBuf, time::Duration};

use bevy::{
    app::AnimationSystems,
    mesh::{Indices, VertexAttributeValues},
    prelude::*,
    time::TimeUpdateStrategy,
};
use bevy_drape::prelude::*;
use serde_json::{Value, json};

use crate::{app, clips::Clip, measure};
use model::Model;

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
    /// Steps all cloths on one thread
    #[arg(long)]
    single_threaded: bool,
}

/// Sides of the triangles of clothes that are free: both ends may be farther from their skin than two of them are long. Strain of
/// others says how the skin stretches.
#[derive(Component)]
struct FreeSides(Vec<([usize; 2], f32)>);

impl FreeSides {
    fn of(mesh: &Mesh) -> Self {
        let positions: Vec<Vec3> = mesh
            .attribute(Mesh::ATTRIBUTE_POSITION)
            .and_then(VertexAttributeValues::as_float3)
            .map(|places| places.iter().copied().map(Vec3::from).collect())
            .unwrap_or_default();
        let paint = match mesh.attribute(ATTRIBUTE_CLOTH) {
            Some(VertexAttributeValues::Float32(paint)) => paint.clone(),
            _ => vec![f32::INFINITY; positions.len()],
        };
        let corners: Vec<usize> = mesh.indices().into_iter().flat_map(Indices::iter).collect();
        let sides = corners.as_chunks().0.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let sides = sides.map(|[a, b]| ([a, b], positions[a].distance(positions[b])));
        Self(sides.filter(|&([a, b], length)| length > 0.0 && paint[a].min(paint[b]) > 2.0 * length).collect())
    }

    /// Strain of each, no unit.
    fn strains<'a>(&'a self, state: &'a ClothState) -> impl Iterator<Item = f32> + 'a {
        let place = |vertex: usize| state.particle_of_vertex(vertex).and_then(|particle| state.position(particle));
        self.0.iter().filter_map(move |&([a, b], length)| Some(place(a)?.distance(place(b)?) / length - 1.0))
    }
}

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
        let mut times = Vec::new();
        let (mut strains, mut substeps, mut particles) = (Vec::new(), 0, 0);
        for frame in 0..WARM_UP + self.frames {
            let time = app::microseconds(|| app.update());
            if frame < WARM_UP {
                continue;
            }
            times.push(time);
            let mut cloths = app.world_mut().query::<(&ClothState, &ClothReport, &FreeSides)>();
            particles = cloths.iter(app.world()).map(|(state, ..)| state.particle_count()).sum();
            for (state, report, sides) in cloths.iter(app.world()) {
                strains.extend(sides.strains(state));
                substeps = substeps.max(report.latest().map_or(0, |latest| latest.substeps));
            }
        }
        strains.sort_unstable_by(f32::total_cmp);
        let quantile = |share: f32| strains.get((share * strains.len().saturating_sub(1) as f32) as usize).copied();
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
            "ns_per_particle": (1000.0 * median / particles.max(1) as f64).round(),
            "substeps_most": substeps,
            "strain_p99_where_free": quantile(0.99),
            "strain_largest_where_free": quantile(1.0),
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
            let sides = world
                .get::<Mesh3d>(part)
                .and_then(|mesh| world.resource::<Assets<Mesh>>().get(mesh).map(FreeSides::of));
            world.entity_mut(part).insert((Cloth::default(), fabric, skin, sides.unwrap_or(FreeSides(Vec::new()))));
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
