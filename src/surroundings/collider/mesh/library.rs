//! Where the triangles of colliders, their skeletons and their poses come from.

use bevy::{
    asset::LoadState,
    ecs::system::SystemParam,
    math::{Affine3A, Isometry3d, Mat3A},
    mesh::skinning::SkinnedMesh,
    prelude::*,
};

use super::{
    prepared::{Contents, Source},
    scale,
};
use crate::{
    draw::ClothMesh,
    error::ClothError,
    frame::{Skeletons, joint_matrices},
    surroundings::collider::{ColliderShape, error::ColliderError},
};

/// Where triangles, skeletons and poses come from.
#[derive(SystemParam)]
pub(crate) struct Library<'w, 's> {
    meshes: Res<'w, Assets<Mesh>>,
    assets: Option<Res<'w, AssetServer>>,
    cloths: Query<'w, 's, &'static ClothMesh>,
    skeletons: Skeletons<'w, 's>,
}

impl Library<'_, '_> {
    /// Whether a mesh is drawn for a cloth, and rewritten all the time.
    pub(super) fn is_of_cloth(&self, mesh: AssetId<Mesh>) -> bool {
        self.cloths.iter().any(|cloth| cloth.drawn_with(mesh).is_some())
    }

    /// Pose and scale of an entity.
    pub(super) fn pose_and_scale(&self, entity: Entity) -> Result<(Isometry3d, Mat3A), ColliderError> {
        let pose = self.skeletons.poses.compute_global_transform(entity).map_err(|_| ColliderError::NoSize)?;
        Ok(scale::split(pose.affine()))
    }

    /// The contents of a source. None while they aren't loaded.
    pub(super) fn contents<'a>(
        &'a self,
        source: Source,
        shape: &'a ColliderShape,
    ) -> Result<Option<Contents<'a>>, ColliderError> {
        let Some(mesh) = source.mesh() else {
            return Ok(match shape {
                ColliderShape::HeightField(field) => Some(Contents::HeightField(field)),
                _ => None,
            });
        };
        if let Some(mesh) = self.meshes.get(mesh) {
            return Ok(Some(Contents::Mesh(mesh)));
        }
        match self.assets.as_ref().map(|assets| assets.load_state(mesh)) {
            Some(LoadState::Failed(error)) => Err(ClothError::NotLoaded { reason: error.to_string() }.into()),
            _ => Ok(None),
        }
    }

    /// Writes what each joint does to the mesh's space, up to the first that isn't there. Returns the frame that they do
    /// it in, which is upright and where the first joint is, and the mesh's scale as far as it matters to its triangles:
    /// whether it is mirrored. None while the bind pose isn't loaded.
    ///
    /// The entity's own transform has no say, as it hasn't for what is drawn.
    pub(super) fn find_joints(
        &self,
        skeleton: &SkinnedMesh,
        joints: &mut Vec<Affine3A>,
    ) -> Result<Option<(Isometry3d, Mat3A)>, ColliderError> {
        let Some(bindposes) = self.skeletons.bindposes(skeleton) else { return Ok(None) };
        let pose = |joint| self.skeletons.pose(joint);
        let Some(place) = joint_matrices(&skeleton.joints, bindposes, pose, joints) else {
            return Err(ColliderError::Skeleton { needed: skeleton.joints.len().max(1), found: 0 });
        };
        if !(place.is_finite() && joints.iter().all(|joint| joint.is_finite())) {
            return Err(ColliderError::NoSize);
        }
        let is_mirrored = joints[0].matrix3.determinant() < 0.0;
        let mirror = Mat3A::from_diagonal(Vec3::new(if is_mirrored { -1.0 } else { 1.0 }, 1.0, 1.0));
        Ok(Some((Isometry3d::from_translation(place), mirror)))
    }
}
