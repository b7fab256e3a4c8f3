//! Reads the meshes and joints of a body.

use bevy::{
    asset::{AssetServer, LoadState},
    ecs::system::SystemParam,
    math::Affine3A,
    mesh::skinning::SkinnedMesh,
    platform::collections::HashMap,
    prelude::*,
};

use super::{
    ClothBody,
    error::BodyError,
    memory::Source,
    shares::{Joint, Vertex},
};
use crate::{
    cloth::Cloth,
    frame::Skeletons,
    garment::ClothPartOf,
    mesh_input::{self, Skin},
    proxy::ClothProxy,
};

/// All that bodies are made of.
#[derive(SystemParam)]
pub(crate) struct Anatomy<'w, 's> {
    meshes: Res<'w, Assets<Mesh>>,
    assets: Option<Res<'w, AssetServer>>,
    skinned: Query<
        'w,
        's,
        (&'static Mesh3d, &'static SkinnedMesh),
        (Without<Cloth>, Without<ClothPartOf>, Without<ClothProxy>),
    >,
    names: Query<'w, 's, &'static Name>,
    children: Query<'w, 's, &'static Children>,
    parents: Query<'w, 's, &'static ChildOf>,
    places: Query<'w, 's, (), With<Transform>>,
    skeletons: Skeletons<'w, 's>,
}

/// Joints of a body with their entities, and what is wrong with them.
pub(super) struct Found {
    pub joints: Vec<(Entity, Joint)>,
    pub error: Option<BodyError>,
}

impl Anatomy<'_, '_> {
    /// The skinned meshes of a body.
    pub(super) fn sources(&self, entity: Entity, body: &ClothBody) -> Vec<Source> {
        let own = core::iter::once(entity).chain(self.children.iter_descendants(entity));
        let is_left_out = |mesh: Entity| {
            let parent = self.parents.get(mesh).ok().filter(|_| mesh != entity).map(ChildOf::parent);
            [Some(mesh), parent].into_iter().flatten().any(|named| body.leaves_out(self.name(named)))
        };
        let source = |entity| {
            let (mesh, skeleton) = self.skinned.get(entity).ok().filter(|_| !is_left_out(entity))?;
            let bindposes = skeleton.inverse_bindposes.id();
            Some(Source { entity, mesh: mesh.0.id(), bindposes, joints: skeleton.joints.clone() })
        };
        own.filter_map(source).collect()
    }

    pub(super) fn name(&self, entity: Entity) -> Option<&Name> {
        self.names.get(entity).ok()
    }

    /// The joints of all meshes with what follows them most. None while something may still load.
    pub(super) fn joints(&self, sources: &[Source], body: &ClothBody) -> Result<Option<Found>, BodyError> {
        let mut found = Found { joints: Vec::new(), error: None };
        let mut numbers = HashMap::new();
        let mut is_any_skinned = false;
        for (number, source) in sources.iter().enumerate() {
            let Some(mesh) = self.mesh(source)? else { return Ok(None) };
            let Some(bindposes) = self.bindposes(source)? else { return Ok(None) };
            let unusable = |error| BodyError::Mesh { mesh: source.entity, error };
            let geometry = mesh_input::read(mesh).map_err(unusable)?;
            let areas = areas(&geometry.positions, &geometry.triangles);
            let all: Vec<u32> = (0..geometry.positions.len() as u32).collect();
            let Some(skin) = Skin::read(mesh, &geometry.positions, &all) else { continue };
            is_any_skinned = true;
            let known: Vec<Option<usize>> = source
                .joints
                .iter()
                .zip(bindposes)
                .map(|(&joint, bindpose)| {
                    let is_there = self.places.contains(joint);
                    let at = is_there.then(|| *numbers.entry(joint).or_insert(found.joints.len()))?;
                    if at == found.joints.len() {
                        found.joints.push((joint, self.joint(joint, sources.len(), body)));
                    }
                    found.joints[at].1.bindposes[number] = Some(Affine3A::from_mat4(*bindpose));
                    Some(at)
                })
                .collect();
            let number_of = |joint: usize| known.get(joint).copied().flatten();
            let missing = (0..skin.joint_count).filter(|&joint| number_of(joint).is_none()).count();
            if missing > 0 {
                found.error = Some(BodyError::Skeleton { mesh: source.entity, needed: skin.joint_count, missing });
            }
            for (point, area) in skin.points().iter().zip(areas).filter(|(_, area)| *area > 0.0) {
                if let Some(at) = number_of(point.strongest().into()) {
                    found.joints[at].1.vertices.push(Vertex { mesh: number, place: point.place, area });
                }
            }
        }
        if !is_any_skinned {
            return Err(BodyError::NoWeights);
        }
        for (entity, joint) in &mut found.joints {
            let mut above = self.parents.iter_ancestors(*entity);
            joint.parent = above.find_map(|entity| numbers.get(&entity).copied());
        }
        Ok(Some(found))
    }

    /// A joint that nothing follows yet.
    fn joint(&self, entity: Entity, mesh_count: usize, body: &ClothBody) -> Joint {
        let scale = self.skeletons.pose(entity).map(|pose| pose.matrix3.determinant().abs().cbrt());
        Joint {
            parent: None,
            bindposes: vec![None; mesh_count],
            vertices: Vec::new(),
            // A character that is only just growing has the size that its model has.
            scale: scale.filter(|scale| scale.is_normal()).unwrap_or(1.0),
            is_left_out: body.leaves_out(self.name(entity)),
        }
    }

    /// The mesh of a source. None while it may still load.
    fn mesh(&self, source: &Source) -> Result<Option<&Mesh>, BodyError> {
        let failed = |reason| {
            let error = crate::error::ClothError::NotLoaded { reason };
            BodyError::Mesh { mesh: source.entity, error }
        };
        let mesh = self.meshes.get(source.mesh);
        mesh.map_or_else(|| self.fails_to_load(source.mesh).map_or(Ok(None), |it| Err(failed(it))), |it| Ok(Some(it)))
    }

    /// Its inverse bind poses. None while they may still load.
    fn bindposes(&self, source: &Source) -> Result<Option<&[Mat4]>, BodyError> {
        let failed = |reason| BodyError::BindPoses { mesh: source.entity, reason };
        let Ok((_, skeleton)) = self.skinned.get(source.entity) else { return Ok(None) };
        let found = self.skeletons.bindposes(skeleton);
        found.map_or_else(
            || self.fails_to_load(source.bindposes).map_or(Ok(None), |it| Err(failed(it))),
            |it| Ok(Some(it)),
        )
    }

    /// Why an asset won't come, if that is known.
    fn fails_to_load<A: Asset>(&self, asset: AssetId<A>) -> Option<String> {
        match self.assets.as_ref()?.load_state(asset) {
            LoadState::Failed(error) => Some(error.to_string()),
            _ => None,
        }
    }
}

/// The area of each vertex: a third of that of the triangles around it.
fn areas(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<f32> {
    let mut areas = vec![0.0; positions.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| positions[i as usize]);
        let area = (b - a).cross(c - a).length() / 6.0;
        triangle.iter().for_each(|&i| areas[i as usize] += area);
    }
    areas
}
