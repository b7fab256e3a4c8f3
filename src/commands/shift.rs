//! A floating origin: the whole world is shifted, and cloth goes on as if it hadn't been.

use bevy::{ecs::entity_disabling::Disabled, prelude::*};

use crate::{
    state::{self, ClothAttachments, ClothGrabs, ClothState, Skinning},
    surroundings::{
        collider::{ColliderMemory, Obstacles, changes::ObstacleChanges},
        wind::Winds,
    },
};

/// Commands that shift the whole world, to keep what is near the camera near the world's origin.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_drape::prelude::*;
/// fn recentre(mut commands: Commands, player: Single<&Transform, With<Camera3d>>) {
///     if player.translation.length() > 1000.0 {
///         commands.shift_world(-player.translation);
///     }
/// }
/// ```
pub trait WorldShiftCommands {
    /// Moves all entities by `by` (m): those with a `Transform` and no parent, whatever they are, and with them all that
    /// cloth keeps of places. Nothing is swept or pulled by that; cloth moves on as if nothing had happened, to the bit as
    /// far as sums of places are exact, gusts and eddies too. A shift that isn't finite does nothing.
    ///
    /// Call it before `PostUpdate`, where transforms are propagated.
    fn shift_world(&mut self, by: Vec3) -> &mut Self;

    /// Tells cloth of a shift that the game has made itself, or that a floating origin plugin has: call it in the frame, and
    /// between the same steps, in which transforms are moved.
    fn world_shifted(&mut self, by: Vec3) -> &mut Self;
}

impl WorldShiftCommands for Commands<'_, '_> {
    fn shift_world(&mut self, by: Vec3) -> &mut Self {
        self.queue(move |world: &mut World| {
            if by.is_finite() {
                let mut roots = world.query_filtered::<&mut Transform, (Without<ChildOf>, Allow<Disabled>)>();
                roots.iter_mut(world).for_each(|mut place| place.translation += by);
                shift(world, by);
            }
        });
        self
    }

    fn world_shifted(&mut self, by: Vec3) -> &mut Self {
        self.queue(move |world: &mut World| {
            if by.is_finite() {
                shift(world, by);
            }
        });
        self
    }
}

/// Shifts all that cloth keeps of places.
fn shift(world: &mut World, by: Vec3) {
    let mut cloths = world
        .query_filtered::<(&mut ClothState, &mut ClothAttachments, &mut ClothGrabs, &mut Skinning), Allow<Disabled>>();
    for (mut state, mut attachments, mut grabs, mut skinning) in cloths.iter_mut(world) {
        if let Some(bound) = &mut skinning.0 {
            bound.shift(by);
        }
        state::shift(&mut state, &mut attachments, &mut grabs, by);
    }
    let mut colliders = world.query_filtered::<&mut ColliderMemory, Allow<Disabled>>();
    colliders.iter_mut(world).for_each(|mut memory| memory.shift(by));
    if let Some(mut obstacles) = world.get_resource_mut::<Obstacles>() {
        obstacles.shift(by);
    }
    if let Some(mut changes) = world.get_resource_mut::<ObstacleChanges>() {
        changes.shift(by);
    }
    if let Some(mut winds) = world.get_resource_mut::<Winds>() {
        winds.shift(by);
    }
    #[cfg(feature = "avian")]
    crate::engine::avian::shift(world, by);
    #[cfg(feature = "rapier")]
    crate::engine::rapier::shift(world, by);
}
