//! What the joints of a skeleton do to the space of a mesh.

use bevy::{
    ecs::system::SystemParam,
    math::{Affine3A, Vec3A},
    mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    prelude::*,
};

use super::Poses;

/// Skeletons, as they are by now.
#[derive(SystemParam)]
pub(crate) struct Skeletons<'w, 's> {
    bindposes: Option<Res<'w, Assets<SkinnedMeshInverseBindposes>>>,
    pub poses: Poses<'w, 's>,
}

impl Skeletons<'_, '_> {
    /// The inverse bind poses of a skeleton's joints. None while they aren't loaded.
    pub fn bindposes(&self, skeleton: &SkinnedMesh) -> Option<&[Mat4]> {
        self.bindposes.as_ref()?.get(&skeleton.inverse_bindposes).map(|bindposes| &**bindposes)
    }

    /// World pose of a joint, if it is there.
    pub fn pose(&self, joint: Entity) -> Option<Affine3A> {
        self.poses.compute_global_transform(joint).ok().map(|pose| pose.affine())
    }
}

/// Writes what each joint does to the mesh's space, as far as they and their inverse bind poses are there: into a frame that is upright
/// and where the first joint is. Returns that place; none without a first joint.
///
/// The mesh's own transform has no say, as it hasn't for what is drawn.
pub(crate) fn joint_matrices(
    joints: &[Entity],
    bindposes: &[Mat4],
    pose: impl Fn(Entity) -> Option<Affine3A>,
    matrices: &mut Vec<Affine3A>,
) -> Option<Vec3A> {
    matrices.clear();
    matrices.extend(joints.iter().take(bindposes.len()).map_while(|&joint| pose(joint)));
    let place = matrices.first()?.translation;
    for (matrix, &bindpose) in matrices.iter_mut().zip(bindposes) {
        // Differences first: far from the world's origin, only they have precision left.
        matrix.translation -= place;
        *matrix *= Affine3A::from_mat4(bindpose);
    }
    Some(place)
}
