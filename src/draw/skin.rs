//! Has an entity carry the skin and the morph weights that its mesh is made for, and no others.
//!
//! Bevy chooses the pipeline by the mesh, and what is bound to it by the entity. Joints on the one without a skin on the
//! other, or the other way round, are an error that ends the app; weights without morph targets hide the mesh on the web.
//! A cloth's own mesh has no morph targets, and joints only where it is worn on a skeleton.

use bevy::{
    ecs::{entity::EntityMapper, query::QueryData},
    mesh::{VertexFormat, morph::MeshMorphWeights, skinning::SkinnedMesh},
    prelude::*,
};

use super::mesh::ClothMesh;
use crate::garment::ClothPartOf;

/// What would deform an entity's mesh, if that had joints and morph targets. Comes back with a mesh that has.
#[derive(Component, Clone, Debug, Default)]
#[component(map_entities = map_entities)]
pub(crate) struct TakenOff {
    /// Colliders on the same entity go on following it.
    pub skin: Option<SkinnedMesh>,
    weights: Option<MeshMorphWeights>,
}

/// A copied character's skin follows the copy's joints.
fn map_entities<M: EntityMapper>(taken: &mut TakenOff, mapper: &mut M) {
    if let Some(skin) = &mut taken.skin {
        Component::map_entities(skin, mapper);
    }
    if let Some(weights) = &mut taken.weights {
        Component::map_entities(weights, mapper);
    }
}

/// What a copy of a mesh no longer has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Lost {
    pub skin: bool,
    pub morph_targets: bool,
}

/// A copy that is drawn where its vertices are.
pub(crate) fn copy_without_skin(mesh: &Mesh) -> (Mesh, Lost) {
    let morph_targets = mesh.try_has_morph_targets().unwrap_or_default();
    let mut copy = if morph_targets { copy_without_morph_targets(mesh) } else { mesh.clone() };
    let skin = take_skin_off(&mut copy);
    copy.set_skinned_mesh_bounds(None);
    (copy, Lost { skin, morph_targets })
}

/// Takes joints and weights off a mesh. Whether it had any.
pub(crate) fn take_skin_off(mesh: &mut Mesh) -> bool {
    let skin = [Mesh::ATTRIBUTE_JOINT_INDEX, Mesh::ATTRIBUTE_JOINT_WEIGHT];
    skin.map(|attribute| mesh.try_remove_attribute(attribute).is_ok()).contains(&true)
}

/// A copy whose vertices are drawn in bind space, by the skin that they have.
pub(crate) fn copy_with_skin(mesh: &Mesh) -> (Mesh, Lost) {
    let morph_targets = mesh.try_has_morph_targets().unwrap_or_default();
    let mut copy = if morph_targets { copy_without_morph_targets(mesh) } else { mesh.clone() };
    // Those of the skin alone: cloth is elsewhere.
    copy.set_skinned_mesh_bounds(None);
    (copy, Lost { skin: false, morph_targets })
}

/// Morph targets can be set, and not be unset.
fn copy_without_morph_targets(mesh: &Mesh) -> Mesh {
    let mut copy = Mesh::new(mesh.primitive_topology(), mesh.asset_usage);
    for (attribute, values) in mesh.try_attributes().into_iter().flatten() {
        // Values of another format can't be drawn, and inserting them panics.
        if VertexFormat::from(values) == attribute.format {
            copy.insert_attribute(*attribute, values.clone());
        }
    }
    if let Ok(indices) = mesh.try_indices() {
        copy.insert_indices(indices.clone());
    }
    copy.enable_raytracing = mesh.enable_raytracing;
    copy.final_aabb = mesh.final_aabb;
    copy
}

/// An entity that is cloth, or was.
#[derive(QueryData)]
#[query_data(mutable)]
pub(crate) struct Wearer {
    entity: Entity,
    mesh: &'static Mesh3d,
    skin: Option<&'static SkinnedMesh>,
    weights: Option<&'static MeshMorphWeights>,
    taken: Option<&'static mut TakenOff>,
}

/// There is something that may have to come off, or back.
type HasSkin =
    Or<(With<TakenOff>, (Or<(With<ClothMesh>, With<ClothPartOf>)>, Or<(With<SkinnedMesh>, With<MeshMorphWeights>)>))>;

/// Lets entities have the skin and the morph weights that their meshes are made for, and no others.
pub(crate) fn fit_skins(mut commands: Commands, mut wearers: Query<Wearer, HasSkin>, meshes: Res<Assets<Mesh>>) {
    for mut wearer in &mut wearers {
        // One that isn't there isn't drawn.
        let Some(mesh) = meshes.get(&wearer.mesh.0) else { continue };
        let mut entity = commands.entity(wearer.entity);
        let (mut new, is_new) = (TakenOff::default(), wearer.taken.is_none());
        let taken = wearer.taken.as_deref_mut().unwrap_or(&mut new);
        fit(&mut entity, wearer.skin, &mut taken.skin, has_joints(mesh));
        fit(&mut entity, wearer.weights, &mut taken.weights, has_morph_targets(mesh));
        match (is_new, taken.skin.is_none() && taken.weights.is_none()) {
            (true, false) => drop(entity.try_insert(new)),
            (false, true) => drop(entity.try_remove::<TakenOff>()),
            _ => {}
        }
    }
}

/// Whether Bevy draws a mesh by a skin. One that only the renderer still has isn't a cloth's own: whatever was beside it
/// fitted.
fn has_joints(mesh: &Mesh) -> bool {
    let attributes = [Mesh::ATTRIBUTE_JOINT_INDEX, Mesh::ATTRIBUTE_JOINT_WEIGHT];
    attributes.into_iter().all(|attribute| mesh.try_contains_attribute(attribute).unwrap_or(true))
}

/// Whether Bevy draws a mesh by morph weights; likewise.
fn has_morph_targets(mesh: &Mesh) -> bool {
    mesh.try_has_morph_targets().unwrap_or(true)
}

/// Takes off what doesn't fit, and puts back what does. What was inserted last counts.
fn fit<C: Component + Clone>(entity: &mut EntityCommands, on: Option<&C>, off: &mut Option<C>, fits: bool) {
    match on {
        Some(on) if !fits => {
            *off = Some(on.clone());
            entity.try_remove::<C>();
        }
        Some(_) => *off = None,
        None if fits => {
            if let Some(off) = off.take() {
                entity.try_insert(off);
            }
        }
        None => {}
    }
}
