//! The lab's experiments on contact, to look at: the same cloths, obstacles and hands, step by step.
//!
//! ```text
//! cargo run --all-features --example contact -- twist
//! cargo run --all-features --example contact -- layers --capture captures --frames 300 --every 300
//! ```

#[path = "../common/mod.rs"]
mod common;
mod drawing;
mod experiment;

use bevy::prelude::*;
use clap::Parser;
use drape_lab::scene::{FRAME, Scene};

use experiment::Experiment;

#[derive(Parser)]
struct Command {
    /// What is shown
    #[arg(value_enum, default_value = "drape")]
    experiment: Experiment,
    /// Particles along a metre
    #[arg(long, default_value_t = 64, value_parser = clap::value_parser!(u32).range(2..=256))]
    n: u32,
    /// Substeps a frame; by default as many as the strain needs
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=256))]
    substeps: Option<u32>,
    #[command(flatten)]
    shared: common::Arguments,
}

/// What is stepped.
#[derive(Resource)]
struct Stage(Scene);

fn main() -> std::io::Result<AppExit> {
    let Command { experiment, n, substeps, shared } = Command::parse();
    let (eye, look_at) = experiment.view();
    let scene = experiment.scene(n, substeps)?;
    let setup = move |mut commands: Commands| {
        common::spawn_camera(&mut commands, eye, look_at);
    };
    Ok(common::app_with(shared, "Contact", experiment.about())
        .insert_resource(Time::<Fixed>::from_seconds(FRAME.into()))
        .insert_resource(Stage(scene))
        .add_systems(Startup, (common::spawn_scenery, setup, drawing::spawn))
        .add_systems(FixedUpdate, step)
        .add_systems(Update, (drawing::draw_cloths, drawing::place_obstacles))
        .run())
}

fn step(mut stage: ResMut<Stage>) {
    stage.0.lead();
    stage.0.step(None);
}
