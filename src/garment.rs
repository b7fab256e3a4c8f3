//! Garments: one cloth made of several meshes.

use bevy::{mesh::skinning::SkinnedMesh, prelude::*};

use crate::{error::ClothError, mesh_input::Span};

/// Makes the entity's mesh a part of the garment on another entity: a [`Cloth`](crate::prelude::Cloth) that has no `Mesh3d` of its
/// own. Vertices of two parts that are at the same place are sewn together.
///
/// Meshes below a garment in the hierarchy get it by themselves, but for those that are cloth on their own: so a model whose cape
/// has a lining of another material, which makes it two meshes in Bevy, is one cloth with [`Cloth`](crate::prelude::Cloth) on the
/// entity of its node. Insert it for meshes that are elsewhere. Parts keep their materials, and are drawn as they are otherwise:
/// skinned, if all of them are, and on one skeleton.
///
/// The vertices of a garment are numbered through, part after part: first those below it, as the hierarchy has them, then others. Pins
/// and the like count them so.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_drape::prelude::*;
/// fn sew(mut commands: Commands, names: Query<(Entity, &Name), Added<Name>>) {
///     for (entity, name) in &names {
///         if name.as_str() == "Coat" { // the node, with a mesh below it for each of its materials
///             commands.entity(entity).insert(Cloth::default());
///         }
///     }
/// }
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[relationship(relationship_target = ClothParts)]
#[reflect(Component, Debug, Clone, PartialEq)]
pub struct ClothPartOf(pub Entity);

/// The meshes of a garment, each of which is [`ClothPartOf`] it.
#[derive(Component, Debug, Default, Reflect)]
#[relationship_target(relationship = ClothPartOf)]
#[reflect(Component, Debug)]
pub struct ClothParts(Vec<Entity>);

/// What a garment is made of: on a cloth without a mesh of its own, once there are meshes for it.
#[derive(Component, Debug, Default)]
#[component(clone_behavior = Ignore)]
pub(crate) struct Garment {
    pub parts: Vec<GarmentPart>,
    /// One mesh of all parts, or why there is none.
    pub joined: Option<Result<Handle<Mesh>, ClothError>>,
    /// How long it has waited for meshes, s.
    pub waited: f32,
    /// How many parts there were when it was said that attributes of theirs are left out.
    pub told_of: usize,
}

/// A mesh of a garment.
#[derive(Clone, Debug)]
pub(crate) struct GarmentPart {
    pub entity: Entity,
    /// The user's mesh: never written.
    pub source: Handle<Mesh>,
    pub skeleton: Option<SkinnedMesh>,
    /// Where it is in the mesh of all.
    pub span: Span,
}
