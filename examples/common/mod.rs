//! What every windowed example shares: the app with its plugins, a scene to stand in, woven materials, and a way to run
//! without a window that writes pictures instead.

#![allow(dead_code, unused_imports, reason = "each example is its own crate and uses only a part of this module")]

mod arguments;
mod capture;
mod lathe;
mod loading;
mod machine;
mod mipmaps;
mod overlay;
mod scenery;
mod studio;
mod weave;

use std::path::PathBuf;

use bevy::{
    app::ScheduleRunnerPlugin,
    gltf::GltfPlugin,
    prelude::*,
    render::RenderPlugin,
    window::{ExitCondition, WindowResolution},
    winit::WinitPlugin,
};
use bevy_drape::prelude::{ATTRIBUTE_CLOTH, ATTRIBUTE_PIN};
use bevy_panorbit_camera::PanOrbitCameraPlugin;
use clap::Parser;

pub use arguments::Arguments;
use capture::CapturePlugin;
pub use lathe::turned;
pub use overlay::Overlay;
#[cfg(feature = "picking")]
pub use scenery::rest_camera_while_dragging;
pub use scenery::{spawn_camera, spawn_ground, spawn_scenery, spawn_sky, spawn_sun};
pub use studio::Studio;
pub use weave::{fabric_material, woven, woven_normals};

/// An app that shows its scene in a window, or writes it to picture files where `--capture` asks for them or where
/// no window can be opened.
pub fn app(title: &str, help: &str) -> App {
    app_with(Arguments::parse(), title, help)
}

/// The same for an example that has arguments of its own as well.
pub fn app_with(arguments: Arguments, title: &str, help: &str) -> App {
    if let Err(cause) = machine::graphics_adapter() {
        fail(cause);
    }
    let directory = arguments.capture.clone().or_else(directory_instead_of_window);

    let mut app = App::new();
    match directory {
        Some(directory) => {
            if let Err(cause) = capture::create_directory(&directory) {
                fail(cause);
            }
            app.add_plugins(plugins_without_a_window());
            app.add_plugins(CapturePlugin {
                directory,
                frames: arguments.frames,
                every: arguments.every,
                size: arguments.size.0,
            });
        }
        None => {
            app.add_plugins((plugins_with_a_window(title, arguments.size.0), PanOrbitCameraPlugin));
        }
    }
    app.add_plugins(overlay::plugin).insert_resource(Overlay { help: help.to_owned(), ..default() });
    app
}

/// Ends an example that cannot run here with one clear sentence instead of a panic.
fn fail(cause: String) -> ! {
    eprintln!("{cause}");
    std::process::exit(1)
}

/// Pictures are better than nothing.
fn directory_instead_of_window() -> Option<PathBuf> {
    let obstacle = machine::window_obstacle()?;
    let directory = PathBuf::from("captures").join(machine::example_name());
    println!("Writing pictures to {}, because {obstacle}.", directory.display());
    Some(directory)
}

fn plugins_with_a_window(title: &str, size: UVec2) -> impl PluginGroup {
    shared_plugins().set(WindowPlugin {
        primary_window: Some(Window { title: title.to_owned(), resolution: WindowResolution::from(size), ..default() }),
        ..default()
    })
}

fn plugins_without_a_window() -> impl PluginGroup {
    shared_plugins()
        .set(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
        .set(RenderPlugin {
            // A pipeline that is still being compiled leaves its objects out of the frame.
            synchronous_pipeline_compilation: true,
            ..default()
        })
        .disable::<WinitPlugin>()
        .add(ScheduleRunnerPlugin::default())
}

fn shared_plugins() -> bevy::app::PluginGroupBuilder {
    DefaultPlugins
        .set(AssetPlugin {
            // An absolute path, so that the program finds its assets when it isn't started by cargo.
            file_path: concat!(env!("CARGO_MANIFEST_DIR"), "/assets").to_owned(),
            ..default()
        })
        // The plugin reads `_PIN` and `_CLOTH` by itself. Known to Bevy's loader, which strips the underscore, they aren't
        // warned of.
        .set(
            GltfPlugin::default()
                .add_custom_vertex_attribute("PIN", ATTRIBUTE_PIN)
                .add_custom_vertex_attribute("CLOTH", ATTRIBUTE_CLOTH),
        )
}
