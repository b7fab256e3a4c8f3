//! Bodies: characters that clothes are kept out of, by capsules made from their skin.

use bevy::{ecs::entity_disabling::Disabled, prelude::*};

use crate::{
    error::ClothError,
    parameter::{Parameter, check_parameters},
};
use memory::BodyMemory;

mod axes;
mod error;
mod fit;
mod groups;
pub(crate) mod make;
mod memory;
mod shares;
mod sources;

pub(crate) use groups::BodyGroups;

/// Keeps cloth out of a character, by a [`TaperedCapsule`](crate::prelude::TaperedCapsule) on each of its joints, made from its
/// skin.
///
/// It goes on the root of a character, above the joints and the meshes of the body, or on the entity of the body's mesh. All
/// meshes there with a `SkinnedMesh` count, but for those of [`Cloth`](crate::prelude::Cloth). Once they are loaded, the vertices
/// that a joint holds most get a capsule around them; it is a child of that joint with a
/// [`ClothCollider`](crate::prelude::ClothCollider), a `Name` and a [`ClothBodyPart`], to be looked at, edited or despawned.
/// Another mesh, other values here, and all are made anew.
///
/// Clothes meet their own body only: those that are below the entity of a `ClothBody`, or on a skeleton that is. With
/// [`ClothSkin::meets_others`](crate::prelude::ClothSkin::meets_others) they meet all bodies, as cloth that belongs to none does.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_drape::prelude::*;
/// # #[derive(Component)] struct Character;
/// fn embody(character: On<Add, Character>, mut commands: Commands) {
///     let except = vec!["hand.L".into(), "hand.R".into()]; // which would hook on sleeves
///     commands.entity(character.entity).insert(ClothBody { except, ..default() });
/// }
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
#[require(BodyMemory)]
pub struct ClothBody {
    /// Share of a joint's vertices that its capsule has inside, no unit, 0 to 1, 0.85 by default. More makes capsules thicker: less skin
    /// sticks out, and clothes stand farther off elsewhere.
    #[reflect(@Parameter::within("", (0.0, 1.0), (0.5, 1.0)))]
    pub cover: f32,
    /// Radius that a capsule has at least, in the world, m, 0 or more, 0.02 by default: what is thinner, as a finger, goes to the
    /// joint above.
    #[reflect(@Parameter::not_negative("m", (0.0, 0.1)).entered((0.0, 10.0)).shown_as("mm", 1e3))]
    pub smallest: f32,
    /// Names of joints that get no capsule, and of meshes, or the nodes right above them, that aren't of the body.
    pub except: Vec<String>,
}

impl Default for ClothBody {
    /// A capsule for all joints but the finest.
    fn default() -> Self {
        Self { cover: 0.85, smallest: 0.02, except: Vec::new() }
    }
}

impl ClothBody {
    /// Checks the ranges of all settings.
    ///
    /// # Errors
    ///
    /// [`ClothError::InvalidParameter`] with the first field that is out of its range.
    pub fn validate(&self) -> Result<(), ClothError> {
        check_parameters(self, |_| true)
    }

    /// Whether something of this name is left out.
    fn leaves_out(&self, name: Option<&Name>) -> bool {
        name.is_some_and(|name| self.except.iter().any(|other| other == name.as_str()))
    }
}

/// Marks a capsule that a [`ClothBody`] has made, on a child of one of its joints.
///
/// It may be edited or despawned, and stays so until the body is made anew. A collider of a game's own that gets one is part of the
/// body too, and goes with the others then.
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
pub struct ClothBodyPart {
    /// The entity with the [`ClothBody`].
    #[entities]
    pub body: Entity,
}

impl Default for ClothBodyPart {
    /// Of no body.
    fn default() -> Self {
        Self { body: Entity::PLACEHOLDER }
    }
}

/// The capsules go with their body, also those on joints that aren't below it.
pub(crate) fn on_body_removed(
    removed: On<Remove, ClothBody>,
    parts: Query<(Entity, &ClothBodyPart), Allow<Disabled>>,
    mut commands: Commands,
) {
    commands.entity(removed.entity).try_remove::<BodyMemory>();
    despawn_parts(removed.entity, parts.iter(), &mut commands);
}

/// Despawns the parts of a body.
fn despawn_parts<'a>(body: Entity, parts: impl Iterator<Item = (Entity, &'a ClothBodyPart)>, commands: &mut Commands) {
    for (entity, _) in parts.filter(|(_, part)| part.body == body) {
        // With its character, it may be gone already.
        commands.entity(entity).try_despawn();
    }
}
