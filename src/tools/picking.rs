//! Cloth that mouse and fingers can grab, on `bevy_picking`.
//!
//! A press on a cloth takes hold of the exact point under the pointer; from then on it follows the pointer in the plane
//! through it that faces the camera. The wheel, or a second finger, moves that plane nearer and farther. The same can be
//! done by code: see [`ClothGrabs::grab`](crate::prelude::ClothGrabs::grab).

use bevy::{
    ecs::schedule::common_conditions::resource_exists,
    picking::{
        PickingPlugin, PickingSystems,
        mesh_picking::{MeshPickingPlugin, MeshPickingSettings, ray_cast::RayCastBackfaces, update_hits},
        pointer::{PointerButton, PointerId, PointerInput},
    },
    prelude::*,
};

use crate::{cloth::Cloth, garment::ClothPartOf, pins::PinTarget, proxy::ClothProxy, state::ClothGrip};

mod hold;
mod press;

use hold::Hold;

/// Lets pointers grab cloth. Add it next to [`ClothPlugin`](crate::prelude::ClothPlugin).
///
/// Needs Bevy's picking plugins, which `DefaultPlugins` has with Bevy's feature `bevy_picking`. Cloth is found by its
/// mesh, with Bevy's mesh picking, which this brings along if nobody else does: whatever else can be picked, be it a
/// mesh in front or a panel, is in the way. A cloth with `Pickable::IGNORE` can't be grabbed, and neither can one whose
/// mesh is a triangle strip, which Bevy's mesh picking doesn't see.
///
/// ```no_run
/// # use bevy::prelude::*;
/// # use bevy_drape::prelude::*;
/// App::new().add_plugins((DefaultPlugins, ClothPlugin::default(), ClothPickingPlugin)).run();
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct ClothPickingPlugin;

impl Plugin for ClothPickingPlugin {
    fn build(&self, app: &mut App) {
        // A cloth has two sides. One that was spawned before the plugin was added has to say so itself.
        let registered = [
            app.try_register_required_components::<Cloth, RayCastBackfaces>(),
            app.try_register_required_components::<ClothPartOf, RayCastBackfaces>(),
            app.try_register_required_components::<ClothProxy, RayCastBackfaces>(),
        ];
        for error in registered.into_iter().filter_map(Result::err) {
            warn!("ClothPickingPlugin: cloth may be grabbed from its front only ({error}); add the plugin earlier");
        }
        app.init_resource::<ClothPickingSettings>()
            .init_resource::<PointerGrabs>()
            .add_systems(
                PreUpdate,
                hold::follow_pointers.in_set(PickingSystems::Last).run_if(resource_exists::<Messages<PointerInput>>),
            )
            .add_observer(press::on_press);
    }

    /// Looks at what the app has once all plugins are there: adding mesh picking earlier would forbid the app to do so.
    fn finish(&self, app: &mut App) {
        if !app.is_plugin_added::<PickingPlugin>() {
            warn!(
                "ClothPickingPlugin can't do its work: add DefaultPickingPlugins, or DefaultPlugins with `bevy_picking`"
            );
        } else if !app.is_plugin_added::<MeshPickingPlugin>() {
            app.init_resource::<MeshPickingSettings>()
                .add_systems(PreUpdate, update_hits.in_set(PickingSystems::Backend));
        }
    }
}

/// How pointers grab cloth. Change it at any time.
#[derive(Resource, Clone, Debug, PartialEq, Reflect)]
#[reflect(Resource, Default, Debug, Clone, PartialEq)]
pub struct ClothPickingSettings {
    /// Whether cloth can be grabbed. Switched off, nothing more is; what is held stays so until it is let go.
    pub enabled: bool,
    /// The button that grabs. A finger counts as the primary one.
    pub button: PointerButton,
    /// How firmly pointers hold the cloth.
    pub grip: ClothGrip,
    /// Whether what is let go stays pinned where it is, by the particles of its triangle.
    pub pin_on_release: bool,
    /// Keys that do the same while one of them is held. Shift by default; none for no such key.
    pub pin_keys: Vec<KeyCode>,
    /// What such pins are fixed to. The world by default.
    pub pin_to: PinTarget,
    /// Share of the distance to the camera that one line of the wheel moves the point by, no unit. 0.05 to 0.2; negative
    /// to turn the wheel's direction around.
    pub wheel_step: f32,
}

impl Default for ClothPickingSettings {
    fn default() -> Self {
        Self {
            enabled: true,
            button: PointerButton::Primary,
            grip: ClothGrip::default(),
            pin_on_release: false,
            pin_keys: vec![KeyCode::ShiftLeft, KeyCode::ShiftRight],
            pin_to: PinTarget::World,
            wheel_step: 0.1,
        }
    }
}

/// What pointers hold. A camera that turns with the same button should rest while this isn't empty.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_drape::prelude::*;
/// # fn orbit() {}
/// # let mut app = App::new();
/// app.add_systems(Update, orbit.run_if(|grabs: Res<PointerGrabs>| grabs.is_empty()));
/// ```
#[derive(Resource, Debug, Default)]
pub struct PointerGrabs {
    holds: Vec<Hold>,
}

impl PointerGrabs {
    /// Whether no pointer holds any cloth.
    pub fn is_empty(&self) -> bool {
        self.holds.is_empty()
    }

    /// The cloth that a pointer holds.
    pub fn held_by(&self, pointer: PointerId) -> Option<Entity> {
        self.holds.iter().find(|hold| hold.pointer == pointer).map(|hold| hold.cloth)
    }
}
