//! What a game can ask of a cloth at any time.

use bevy::{ecs::system::EntityCommands, prelude::*};

use crate::{
    draw::ClothMesh,
    pins::{PinGroup, PinTarget, Pins, targets_by_particle},
    state::{ClothState, ClothStatus, Requests},
};
use teleport::{Along, teleport};

mod shift;
mod teleport;

pub use shift::WorldShiftCommands;

/// Commands for an entity with a [`Cloth`](crate::prelude::Cloth), on any other of which they do nothing, and teleports of
/// any entity.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_drape::prelude::*;
/// fn let_go(mut commands: Commands, flag: Single<Entity, With<Cloth>>) {
///     commands.entity(*flag).unpin_cloth(Pins::edge(ClothEdge::Left));
/// }
/// ```
pub trait ClothCommands {
    /// Puts the cloth back into its rest shape at its entity's present transform and scale, at rest. Then
    /// [`ClothReset`](crate::prelude::ClothReset) is sent. A large cloth goes on for some frames until that is worked out.
    fn reset_cloth(&mut self) -> &mut Self;

    /// Pins more vertices, where they are now.
    fn pin_cloth(&mut self, pins: Pins) -> &mut Self;

    /// Unpins vertices: all that `pins` choose, whatever it says that they be fixed to.
    fn unpin_cloth(&mut self, pins: Pins) -> &mut Self;

    /// Moves the entity to `transform`, and all cloth that is on it or below it rigidly along, as if the world had moved:
    /// nothing is dragged through the space between. A whole character is teleported by this, called on its root: its
    /// cloths, its obstacles, and what is pinned to its bones.
    ///
    /// Hands let go, and world pins come along. A pin to an entity that isn't below holds on to that.
    fn teleport_cloth(&mut self, transform: Transform) -> &mut Self;

    /// Moves an obstacle to `transform`, and all obstacles below it, without a way: cloth that is between isn't hit, and
    /// cloth that lies on it stays behind. What is pinned to it comes along.
    ///
    /// For obstacles of every kind, and bodies of physics engines.
    fn teleport_collider(&mut self, transform: Transform) -> &mut Self;
}

impl ClothCommands for EntityCommands<'_> {
    fn reset_cloth(&mut self) -> &mut Self {
        self.queue_silenced(|mut entity: EntityWorldMut| {
            if let Some(mut requests) = entity.get_mut::<Requests>() {
                requests.reset = true;
            }
        })
    }

    fn pin_cloth(&mut self, pins: Pins) -> &mut Self {
        self.queue_silenced(|mut entity: EntityWorldMut| {
            let pins = without_refused(pins, &entity);
            if let Some(mut own) = entity.get_mut::<Pins>() {
                // What is chosen again is overridden whole: groups don't pile up where pins come and go.
                own.groups.retain(|old| pins.groups.iter().all(|new| new.select != old.select));
                own.groups.extend(pins.groups);
            }
        })
    }

    fn unpin_cloth(&mut self, pins: Pins) -> &mut Self {
        let free = |group: PinGroup| PinGroup { to: PinTarget::Free, ..group };
        let groups = pins.groups.into_iter().map(free).collect();
        self.pin_cloth(Pins { groups })
    }

    fn teleport_cloth(&mut self, transform: Transform) -> &mut Self {
        self.queue_silenced(move |entity: EntityWorldMut| put(entity, transform, Along::Cloths))
    }

    fn teleport_collider(&mut self, transform: Transform) -> &mut Self {
        self.queue_silenced(move |entity: EntityWorldMut| put(entity, transform, Along::Colliders))
    }
}

/// Puts an entity elsewhere, and what is on it and below it.
fn put(mut entity: EntityWorldMut, transform: Transform, along: Along) {
    if let Some(mut place) = entity.get_mut::<Transform>() {
        *place = transform;
        let root = entity.id();
        entity.world_scope(|world| teleport(world, root, along));
    }
}

/// Leaves out the groups that don't fit a running cloth's mesh: kept, they would keep later ones from being read.
fn without_refused(mut pins: Pins, entity: &EntityWorldMut) -> Pins {
    let is_running = entity.get::<ClothStatus>().is_some_and(ClothStatus::is_running);
    let meshes = entity.world().get_resource::<Assets<Mesh>>().filter(|_| is_running);
    let source = entity.get::<ClothMesh>().zip(meshes).and_then(|(own, meshes)| meshes.get(&own.source));
    let (Some(state), Some(mesh)) = (entity.get::<ClothState>(), source) else { return pins };
    let (_, refused) = targets_by_particle(&pins, mesh, &state.particle_of_vertex, &state.topology);
    for (group, error) in refused.into_iter().rev() {
        warn!("cloth {} leaves these pins out: {error}", entity.id());
        pins.groups.remove(group);
    }
    pins
}
