//! Finds the triangles of colliders that are no primitives, and where they are.

use bevy::{
    ecs::query::QueryData,
    math::{Affine3A, Isometry3d, Mat3A},
    mesh::skinning::SkinnedMesh,
    platform::collections::HashSet,
    prelude::*,
};

use super::{ClothCollider, ColliderMemory, ColliderShape, error::ColliderError};
use crate::{
    cloth::Cloth,
    draw::TakenOff,
    error::ClothError,
    frame::{JumpDetection, Pass, PastPose, PerPass},
    mesh_input,
    solver::{MeshShape, Shape},
};
use library::Library;
use posed::Posed;
use prepared::{Contents, Prepared, Recipe, Source};

mod height_field;
mod hull;
mod library;
mod posed;
mod prepared;
mod scale;
pub(crate) mod triangles;

pub use height_field::HeightField;
pub(crate) use prepared::PreparedMeshes;

/// All that the triangles of a collider depend on.
#[derive(QueryData)]
#[query_data(mutable)]
pub(crate) struct MeshCollider {
    entity: Entity,
    collider: Ref<'static, ClothCollider>,
    memory: &'static mut ColliderMemory,
    mesh: Option<&'static Mesh3d>,
    skeleton: Option<&'static SkinnedMesh>,
    taken: Option<&'static TakenOff>,
    is_cloth: Has<Cloth>,
}

/// What is known of the triangles of a collider.
#[derive(Clone, Debug)]
pub(crate) struct Triangles {
    /// What it is made of. While something else is being made, this is what cloth meets.
    in_force: Option<(Recipe, Prepared)>,
    /// The height field that it was when it was last looked at.
    field: Option<Source>,
    /// Where a skeleton has put its points, in each pass.
    posed: PerPass<Posed>,
    /// What came of all that, for the coming step. None while it is waited for.
    placed: Result<Option<(Shape, Isometry3d)>, ColliderError>,
}

impl Default for Triangles {
    fn default() -> Self {
        Self { in_force: None, field: None, posed: PerPass::default(), placed: Ok(None) }
    }
}

impl Triangles {
    /// Shape and world pose at the end of the coming step. None while it is waited for.
    pub fn placed(&self) -> Result<Option<(Shape, Isometry3d)>, ColliderError> {
        self.placed.clone()
    }
}

/// Drops what has been made of meshes that have changed since. In one of the passes only: each change is told once.
pub(crate) fn drop_changed_meshes(
    mut mesh_events: MessageReader<AssetEvent<Mesh>>,
    mut prepared: ResMut<PreparedMeshes>,
) {
    let changed = mesh_events.read().filter_map(|event| match event {
        AssetEvent::Modified { id } => Some(*id),
        _ => None,
    });
    let changed: HashSet<AssetId<Mesh>> = changed.collect();
    prepared.update(|mesh| changed.contains(&mesh));
}

/// Finds the triangles of all colliders that have some: makes those that are new or have changed.
pub(crate) fn prepare_meshes(
    mut colliders: Query<MeshCollider>,
    mut prepared: ResMut<PreparedMeshes>,
    library: Library,
    jumps: JumpDetection,
    mut joints: Local<Vec<Affine3A>>,
) {
    for mut collider in &mut colliders {
        let placed = match collider.collider.shape {
            ColliderShape::Solid(_) => Ok(None),
            _ => collider.place(&library, &mut prepared, &jumps, &mut joints),
        };
        let triangles = &mut collider.memory.triangles;
        if !matches!(placed, Ok(Some(_))) && triangles.in_force.is_some() {
            *triangles = Triangles { field: triangles.field, ..default() };
        }
        triangles.placed = placed;
    }
}

impl MeshColliderItem<'_, '_> {
    /// The collider's shape and world pose at the end of the coming step. None while something isn't there yet.
    fn place(
        &mut self,
        library: &Library,
        prepared: &mut PreparedMeshes,
        jumps: &JumpDetection,
        joints: &mut Vec<Affine3A>,
    ) -> Result<Option<(Shape, Isometry3d)>, ColliderError> {
        let source = self.source(library)?;
        let Some(contents) = library.contents(source, &self.collider.shape)? else { return Ok(None) };
        let is_skinned = matches!(contents, Contents::Mesh(mesh) if mesh_input::is_skinned(mesh));
        // Cloth is drawn without its skin, and what collides beside it still follows it.
        let skeleton = self.skeleton.or(self.taken.and_then(|taken| taken.skin.as_ref())).filter(|_| is_skinned);
        let (end, scale) = match skeleton {
            Some(skeleton) => match library.find_joints(skeleton, joints)? {
                Some(found) => found,
                None => return Ok(None),
            },
            None => library.pose_and_scale(self.entity)?,
        };
        let ColliderMemory { pose, triangles, .. } = &mut *self.memory;
        let recipe = triangles.recipe(source, scale)?;
        if let Some(outcome) = prepared.get_or_make(&recipe, contents) {
            triangles.in_force = Some((recipe, outcome?));
        }
        let Some((_, Prepared { mesh, skin })) = &triangles.in_force else { return Ok(None) };
        let skin = skin.as_ref().filter(|_| skeleton.is_some());
        for of in Pass::BOTH {
            if skin.is_some() != triangles.posed[of].is_any() {
                // A skeleton has come or gone, and with it the frame that the pose is of.
                pose[of].forget();
                triangles.posed[of] = Posed::default();
            }
        }
        let is_put =
            skeleton.and_then(|skeleton| skeleton.joints.first()).is_some_and(|&joint| jumps.is_teleported(joint));
        if is_put {
            // As if it had been there before.
            pose[jumps.pass()].set(jumps.step(), end);
        }
        let is_new = is_put || !matches!(jumps.past_pose(self.entity, pose, &end), PastPose::Known(_));
        let deformed = match skin {
            Some(skin) if skin.joint_count > joints.len() => {
                return Err(ColliderError::Skeleton { needed: skin.joint_count, found: joints.len() });
            }
            Some(skin) => Some(triangles.posed[jumps.pass()].follow(skin, joints, is_new)?),
            None => None,
        };
        Ok(Some((Shape::Mesh(MeshShape { mesh: mesh.clone(), deformed }), end)))
    }

    /// What the triangles are made of.
    fn source(&mut self, library: &Library) -> Result<Source, ColliderError> {
        let named = match &self.collider.shape {
            ColliderShape::Mesh(named) | ColliderShape::ConvexHull(named) => named,
            ColliderShape::HeightField(field) => {
                let known = self.memory.triangles.field.filter(|_| !self.collider.is_changed());
                let source = known.unwrap_or_else(|| Source::of(field));
                self.memory.triangles.field = Some(source);
                return Ok(source);
            }
            ColliderShape::Solid(_) => return Err(ColliderError::NoMesh),
        };
        let mesh = match (named, self.mesh) {
            (Some(named), _) => named.id(),
            (None, _) if self.is_cloth => return Err(ColliderError::IsCloth),
            (None, Some(own)) => own.0.id(),
            (None, None) => return Err(ColliderError::NoMesh),
        };
        let source = match &self.collider.shape {
            ColliderShape::ConvexHull(_) => Source::ConvexHull(mesh),
            _ => Source::Mesh(mesh),
        };
        let is_new = self.memory.triangles.in_force.as_ref().is_none_or(|(recipe, _)| recipe.source != source);
        if is_new && library.is_of_cloth(mesh) {
            return Err(ColliderError::IsCloth);
        }
        Ok(source)
    }
}

impl Triangles {
    /// The late pass begins with the points of the fixed one.
    pub fn begin_late(&mut self) {
        self.posed[Pass::Late] = self.posed[Pass::Fixed].clone();
    }

    /// What to make of `source` under `scale`: what there is, where only rounding tells them apart.
    fn recipe(&self, source: Source, scale: Mat3A) -> Result<Recipe, ColliderError> {
        let known = self.in_force.as_ref().map(|&(recipe, _)| recipe);
        if let Some(recipe) = known.filter(|recipe| recipe.source == source && scale::is_same(recipe.scale, scale)) {
            return Ok(recipe);
        }
        if !(scale.is_finite() && scale.determinant().is_normal()) {
            return Err(ClothError::FlatTransform.into());
        }
        Ok(Recipe { source, scale: scale::rounded(scale) })
    }
}
