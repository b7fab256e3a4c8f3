//! Avian's colliders are obstacles, and cloth pushes its bodies.

use avian3d::{
    parry::{self, shape::SharedShape},
    prelude::{CollisionLayers, LayerMask, PhysicsSystems},
};
use bevy::prelude::*;

use super::{Bridge, Engine, schedule};

mod attach;
mod gather;
mod push;
#[expect(clippy::duplicate_mod, reason = "each engine has a parry of its own, with the same shapes")]
#[path = "shapes.rs"]
mod shapes;

/// Makes all of Avian's colliders obstacles for cloth, and gives the momentum that cloth loses to them to their bodies.
///
/// No collider needs anything else: of every shape, with its scale and its place in its body, alone or in a compound. No
/// obstacles are sensors, what is disabled, and what [`ClothAvianSettings`] or a
/// [`NotClothCollider`](crate::prelude::NotClothCollider) leave out. A collider that has a
/// [`ClothCollider`](crate::prelude::ClothCollider) as well is that one instead.
///
/// A collider's layers are those that Avian says that it is a member of: a cloth meets those of its
/// [`collision_mask`](crate::prelude::Cloth::collision_mask). Avian's default friction, 0.5, leaves a cloth's as it is;
/// half of it halves that.
///
/// Within a fixed step Avian moves its bodies first. Cloth then sees their way over that step, gives way to them and
/// moves them as they give way, and what momentum they have got, they have in Avian's next step. Have both in the same schedule:
/// `FixedPostUpdate` is the default of both. Bodies that cloth touches stay awake. Between steps cloth is drawn interpolated:
/// give bodies that touch it Avian's `TransformInterpolation`, so that they are too.
///
/// Needs [`ClothPlugin`](crate::prelude::ClothPlugin) and Avian's `PhysicsPlugins`, in any order; without one of them it
/// does nothing and says so.
///
/// ```no_run
/// # use avian3d::prelude::*;
/// # use bevy::prelude::*;
/// # use bevy_drape::prelude::*;
/// App::new().add_plugins((DefaultPlugins, PhysicsPlugins::default(), ClothPlugin::default(), ClothAvianPlugin));
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct ClothAvianPlugin;

/// What cloth is for Avian's colliders.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Resource, Default, Debug, Clone, PartialEq)]
pub struct ClothAvianSettings {
    /// Layers that all cloth is in, and those that it meets, by Avian's rules: both have to want it, cloth and collider. All
    /// by default.
    pub layers: CollisionLayers,
}

impl Default for ClothAvianSettings {
    fn default() -> Self {
        Self { layers: CollisionLayers::new(LayerMask::ALL, LayerMask::ALL) }
    }
}

impl Plugin for ClothAvianPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ClothAvianSettings>().init_resource::<Bridge<SharedShape>>();
    }

    fn finish(&self, app: &mut App) {
        if !app.world().contains_resource::<Time<avian3d::prelude::Physics>>() {
            warn!("ClothAvianPlugin can't do its work: it needs Avian's PhysicsPlugins; add them to the app");
            return;
        }
        let systems = ((gather::gather_colliders, attach::attach_pins).chain(), push::push_bodies.into_configs());
        schedule::bridge(app, "ClothAvianPlugin", Engine::Avian, PhysicsSystems::Last, systems);
    }
}

/// The world has been shifted, and all bodies with it.
pub(crate) fn shift(world: &mut World, by: Vec3) {
    if let Some(mut bridge) = world.get_resource_mut::<Bridge<SharedShape>>() {
        bridge.bodies.shift(by);
    }
}
