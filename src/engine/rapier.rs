//! Rapier's colliders are obstacles, and cloth pushes its bodies.

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::{self, shape::SharedShape},
    plugin::{PhysicsSet, RapierContextInitialization},
    prelude::CollisionGroups,
};

use super::{Bridge, Engine, schedule};

mod attach;
mod gather;
mod push;
#[expect(clippy::duplicate_mod, reason = "each engine has a parry of its own, with the same shapes")]
#[path = "shapes.rs"]
mod shapes;

/// Makes all of Rapier's colliders obstacles for cloth, and gives the momentum that cloth loses to them to their bodies.
///
/// No collider needs anything else: of every shape, with its scale and its place in its body, alone or in a compound. No
/// obstacles are sensors, what is disabled, and what [`ClothRapierSettings`] or a
/// [`NotClothCollider`](crate::prelude::NotClothCollider) leave out. A collider that has a
/// [`ClothCollider`](crate::prelude::ClothCollider) as well is that one instead.
///
/// A collider's layers are the groups that Rapier says that it is a member of, by default all: a cloth meets those of its
/// [`collision_mask`](crate::prelude::Cloth::collision_mask). Rapier's default friction, 0.5, leaves a cloth's as it is;
/// half of it halves that.
///
/// Rapier moves its bodies first. Cloth then sees their way since its latest step, gives way to them and moves them as they
/// give way, and what momentum they have got, they have in Rapier's next step. Have both in a fixed schedule, with one time
/// step: Rapier's own choice is `PostUpdate`, which runs once a frame. Bodies that cloth touches stay awake. Between steps cloth
/// is drawn interpolated: bodies that touch it should be too.
///
/// Needs [`ClothPlugin`](crate::prelude::ClothPlugin) and `RapierPhysicsPlugin`, in any order; without one of them it does
/// nothing and says so.
///
/// ```no_run
/// # use bevy::prelude::*;
/// # use bevy_drape::prelude::*;
/// # use bevy_rapier3d::prelude::*;
/// App::new()
///     .add_plugins((DefaultPlugins, ClothPlugin::default(), ClothRapierPlugin))
///     .insert_resource(Time::<Fixed>::from_hz(60.0))
///     .insert_resource(TimestepMode::Fixed { dt: 1.0 / 60.0, substeps: 1 })
///     .add_plugins(RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule());
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct ClothRapierPlugin;

/// What cloth is for Rapier's colliders.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Resource, Default, Debug, Clone, PartialEq)]
pub struct ClothRapierSettings {
    /// Groups that all cloth is in, and those that it meets, by Rapier's rules: both have to want it, cloth and collider.
    /// All by default.
    pub groups: CollisionGroups,
}

impl Plugin for ClothRapierPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ClothRapierSettings>().init_resource::<Bridge<SharedShape>>();
    }

    fn finish(&self, app: &mut App) {
        if !app.world().contains_resource::<RapierContextInitialization>() {
            warn!("ClothRapierPlugin can't do its work: it needs RapierPhysicsPlugin; add it to the app");
            return;
        }
        let systems = ((gather::gather_colliders, attach::attach_pins).chain(), push::push_bodies.into_configs());
        schedule::bridge(app, "ClothRapierPlugin", Engine::Rapier, PhysicsSet::Writeback, systems);
    }
}

/// The world has been shifted, and all bodies with it.
pub(crate) fn shift(world: &mut World, by: Vec3) {
    if let Some(mut bridge) = world.get_resource_mut::<Bridge<SharedShape>>() {
        bridge.bodies.shift(by);
    }
}
