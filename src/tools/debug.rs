//! Seeing inside: gizmos of springs, pins, tethers and all else that acts on a cloth, and Bevy diagnostics.
//!
//! ```no_run
//! use bevy::prelude::*;
//! use bevy_drape::{debug::*, prelude::*};
//!
//! App::new()
//!     .add_plugins((DefaultPlugins, ClothPlugin::default(), ClothDebugPlugin, ClothDiagnosticsPlugin))
//!     .add_systems(Update, |keys: Res<ButtonInput<KeyCode>>, mut config: ResMut<ClothDebugConfig>| {
//!         if keys.just_pressed(KeyCode::F1) {
//!             config.structural_springs ^= true;
//!             config.pins ^= true;
//!         }
//!     });
//! ```

use bevy::{
    gizmos::{GizmoPlugin, gizmos::GizmoBuffer},
    math::Affine3A,
    prelude::*,
};

use crate::{
    cloth::InForce,
    draw::{ClothMesh, Drawn},
    frame::ClothRun,
    schedule::{ClothPlugin, ClothSystems},
    state::{ClothAttachments, ClothGrabs, ClothState},
    surroundings::{collider::Obstacles, wind::Winds},
};

mod diagnostics;
mod palette;
mod shape;
mod springs;
mod surroundings;
mod view;
mod wires;

pub use diagnostics::ClothDiagnosticsPlugin;
pub use view::{ClothDebugConfig, ClothDebugView};

/// Draws the inside of cloths with gizmos: what [`ClothDebugConfig`] says of all of them, and what a
/// [`ClothDebugView`] says of its own entity. At first it draws nothing, which costs nothing.
///
/// Needs [`ClothPlugin`] and Bevy's `GizmoPlugin`, which `DefaultPlugins` has; without them it does nothing and says what
/// is missing. On the screen, gizmos come with Bevy's feature `bevy_gizmos_render`.
#[derive(Clone, Copy, Debug, Default)]
pub struct ClothDebugPlugin;

/// The gizmos of cloths, for Bevy's `GizmoConfigStore`: line width, depth bias, render layers, on and off.
///
/// By default their lines are one pixel wide and a little closer to the camera than they are, so that the cloth that they
/// lie on doesn't hide half of them. They are drawn also where the cloth's own entity is hidden.
#[derive(Clone, Copy, Debug, Default, Reflect, GizmoConfigGroup)]
#[reflect(Default, Debug, Clone)]
pub struct ClothGizmos;

/// Where gizmos go.
type Lines = GizmoBuffer<ClothGizmos, ()>;

/// Brings lines before the cloth that they lie on: 1 cm of 2 m from the camera, 3 cm of 5 m.
const DEPTH_BIAS: f32 = -0.0015;

impl Plugin for ClothDebugPlugin {
    fn build(&self, app: &mut App) {
        init_gizmos(app);
        app.init_resource::<ClothDebugConfig>()
            .add_systems(PostUpdate, draw_cloths.after(ClothSystems::Draw).run_if(has_something_to_draw));
    }

    /// Says what is missing, once all plugins are there.
    fn finish(&self, app: &mut App) {
        init_gizmos(app);
        let needs = [
            ("ClothPlugin", app.is_plugin_added::<ClothPlugin>()),
            ("GizmoPlugin (in DefaultPlugins)", app.is_plugin_added::<GizmoPlugin>()),
        ];
        let missing: Vec<&str> = needs.iter().filter(|(_, there)| !there).map(|&(plugin, _)| plugin).collect();
        if !missing.is_empty() {
            warn!("ClothDebugPlugin can't do its work: it needs {}; add them to the app", missing.join(", "));
        }
    }
}

/// Makes room for the gizmos, as soon as there are any, and keeps settings that are there already.
fn init_gizmos(app: &mut App) {
    if app.is_plugin_added::<GizmoPlugin>() && !has_gizmos(app.world().get_resource::<GizmoConfigStore>()) {
        let mut config = GizmoConfig { depth_bias: DEPTH_BIAS, ..default() };
        config.line.width = 1.0;
        app.insert_gizmo_config(ClothGizmos, config);
    }
}

fn has_gizmos(store: Option<&GizmoConfigStore>) -> bool {
    store.is_some_and(|store| store.get_config::<ClothGizmos>().is_some())
}

fn has_something_to_draw(
    config: Res<ClothDebugConfig>,
    views: Query<(), With<ClothDebugView>>,
    store: Option<Res<GizmoConfigStore>>,
    cloth: Option<Res<ClothRun>>,
) -> bool {
    (config.is_any() || !views.is_empty()) && has_gizmos(store.as_deref()) && cloth.is_some()
}

/// A cloth as it is drawn in this frame.
struct Shown<'a> {
    /// Of the latest step: what the solver knows.
    state: &'a ClothState,
    attachments: &'a ClothAttachments,
    grabs: &'a ClothGrabs,
    in_force: &'a InForce,
    /// As drawn, in the entity's own space.
    drawn: &'a Drawn,
    to_world: Affine3A,
    /// World position of each particle as drawn, m.
    places: &'a [Vec3],
}

fn draw_cloths(
    mut gizmos: Gizmos<ClothGizmos>,
    config: Res<ClothDebugConfig>,
    cloths: Query<(
        (&ClothState, &ClothAttachments, &ClothGrabs, &InForce),
        (&ClothMesh, &GlobalTransform, Option<&ClothDebugView>),
    )>,
    obstacles: Res<Obstacles>,
    winds: Res<Winds>,
    mut places: Local<Vec<Vec3>>,
    mut wires: Local<wires::Wires>,
) {
    if !gizmos.config.enabled {
        return;
    }
    let lines: &mut Lines = &mut gizmos;
    if config.colliders {
        surroundings::draw_colliders(lines, &obstacles, &mut wires);
    }
    for ((state, attachments, grabs, in_force), (ClothMesh { shape: drawn, .. }, transform, own)) in &cloths {
        let view = own.map_or(config.view, |own| own.or(&config.view));
        // Not drawn yet, or flat ever since.
        let is_drawn = state.particle_count() > 0 && drawn.particles.len() == state.particle_count();
        if !is_drawn || !(view.is_any() || config.wind) {
            continue;
        }
        let to_world = transform.affine();
        places.clear();
        places.extend(drawn.particles.iter().map(|&p| Vec3::from(to_world.transform_point3a(p))));
        let shown = Shown { state, attachments, grabs, in_force, drawn, to_world, places: &places };
        draw_cloth(lines, &shown, &view);
        if config.wind {
            surroundings::draw_wind(lines, &shown, &winds, &config);
        }
    }
}

fn draw_cloth(lines: &mut Lines, shown: &Shown, view: &ClothDebugView) {
    springs::draw_springs(lines, shown, view);
    if view.tethers {
        springs::draw_tethers(lines, shown);
    }
    if view.pins {
        shape::draw_pins(lines, shown, view.mark_size);
    }
    if view.grabs {
        shape::draw_grabs(lines, shown, view.mark_size);
    }
    if view.normals {
        shape::draw_normals(lines, shown, view.normal_length);
    }
    if view.bounds {
        shape::draw_bounds(lines, shown);
    }
}
