//! Fine meshes are drawn with the coarse cloth that they follow.

use bevy::{ecs::system::NonSendMarker, math::Affine3A, prelude::*};

use super::mesh::{ClothMesh, Drawn};
use crate::{
    frame::{self, ClothRun},
    proxy::Embedded,
    state::{BoundSkin, ClothState, Skinning},
};

/// Computes what meshes look like that follow a cloth, once that is known of it.
pub(crate) fn shape_proxies(
    mut proxies: Query<(&mut Embedded, &Skinning, &GlobalTransform, &mut ClothMesh), Without<ClothState>>,
    drivers: Query<&ClothMesh, With<ClothState>>,
    poses: Query<&GlobalTransform>,
    run: Res<ClothRun>,
    _main_thread: NonSendMarker,
) {
    frame::for_each(proxies.iter_mut(), run.parallel, |(mut embedded, skinning, transform, mut mesh)| {
        let Ok(driver) = drivers.get(embedded.driver) else { return };
        mesh.follow(&driver.shape, &mut embedded, skinning.0.as_deref(), transform.affine(), &poses);
    });
}

impl ClothMesh {
    /// Follows `driver`, as that is drawn. `pose` takes the mesh to the world, and `poses` are those of all entities by now.
    fn follow(
        &mut self,
        driver: &Drawn,
        embedded: &mut Embedded,
        bound: Option<&BoundSkin>,
        pose: Affine3A,
        poses: &Query<&GlobalTransform>,
    ) {
        let ClothMesh { binding, shape, .. } = self;
        let Embedded { embedding, scratch, topology, .. } = embedded;
        // The driver may have been made anew, and isn't drawn at first.
        if driver.particles.len() != topology.particle_count() {
            return;
        }
        let Some(place) = shape.place(bound, pose, poses) else { return };
        if !(driver.is_new() || shape.has_moved(pose, bound)) {
            return;
        }
        embedding.place(&driver.particles, scratch, &mut shape.particles);
        let to_world = Affine3A { matrix3: driver.pose.matrix3, translation: driver.pose.translation - place };
        shape.particles.iter_mut().for_each(|point| *point = to_world.transform_point3a(*point));
        if bound.is_some() {
            let is_pinned = |point: &usize| embedding.corners(*point).all(|(corner, _)| driver.is_pinned(corner));
            let pinned: Vec<usize> = (0..embedding.len()).filter(is_pinned).collect();
            shape.note_pins(pinned.iter().copied(), embedding.len());
        }
        shape.show(binding, bound, pose, place);
    }
}
