//! Reads skinned meshes and their skeleton from a binary glTF file, without a renderer.

use std::{io, path::Path};

use bevy::{
    asset::RenderAssetUsages,
    mesh::{
        Indices, PrimitiveTopology, VertexAttributeValues,
        skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    },
    prelude::*,
};
use bevy_drape::prelude::ATTRIBUTE_CLOTH;
use gltf::{Semantic, accessor::Iter};

/// A skeleton and the meshes on it.
pub struct Model {
    /// Name, transform and parent of each joint.
    joints: Vec<(String, Transform, Option<usize>)>,
    bindposes: Vec<Mat4>,
    /// The meshes by the names of their nodes.
    parts: Vec<(String, Mesh)>,
}

impl Model {
    /// Reads the first skin of a file, and all meshes.
    pub fn read(path: &Path) -> io::Result<Self> {
        let file = gltf::Gltf::open(path).map_err(io::Error::other)?;
        let blob = file.blob.as_deref().ok_or_else(|| io::Error::other("the file has no binary chunk"))?;
        let skin = file.skins().next().ok_or_else(|| io::Error::other("the file has no skin"))?;
        let nodes: Vec<gltf::Node> = skin.joints().collect();
        let parent =
            |child: &gltf::Node| nodes.iter().position(|it| it.children().any(|it| it.index() == child.index()));
        let joints = nodes.iter().map(|node| {
            let (translation, rotation, scale) = node.transform().decomposed();
            let transform = Transform {
                translation: translation.into(),
                rotation: Quat::from_array(rotation),
                scale: scale.into(),
            };
            (node.name().unwrap_or_default().to_owned(), transform, parent(node))
        });
        let bindposes = skin.reader(|_| Some(blob)).read_inverse_bind_matrices();
        let bindposes = bindposes.into_iter().flatten().map(|matrix| Mat4::from_cols_array_2d(&matrix)).collect();
        let of_node = |node: gltf::Node| {
            let name = node.name().unwrap_or_default().to_owned();
            let meshes = node.mesh().into_iter().flat_map(|mesh| mesh.primitives().collect::<Vec<_>>());
            meshes.map(|primitive| (name.clone(), read_mesh(&primitive, blob))).collect::<Vec<_>>()
        };
        Ok(Self { joints: joints.collect(), bindposes, parts: file.nodes().flat_map(of_node).collect() })
    }

    /// Spawns the joints below `root`, and an entity for each mesh, by name.
    pub fn spawn(&self, world: &mut World, root: Entity) -> (Vec<Entity>, Vec<(String, Entity)>) {
        let joints: Vec<Entity> = self
            .joints
            .iter()
            .map(|(name, transform, _)| world.spawn((Name::new(name.clone()), *transform)).id())
            .collect();
        for (&joint, (.., parent)) in joints.iter().zip(&self.joints) {
            let parent = parent.map_or(root, |parent| joints[parent]);
            world.entity_mut(joint).insert(ChildOf(parent));
        }
        let bindposes = SkinnedMeshInverseBindposes::from(self.bindposes.clone());
        let inverse_bindposes = world.resource_mut::<Assets<SkinnedMeshInverseBindposes>>().add(bindposes);
        let part = |(name, mesh): &(String, Mesh)| {
            let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh.clone());
            let skeleton = SkinnedMesh { inverse_bindposes: inverse_bindposes.clone(), joints: joints.clone() };
            let part = (Name::new(name.clone()), Mesh3d(mesh), skeleton, Transform::default(), ChildOf(root));
            (name.clone(), world.spawn(part).id())
        };
        let parts = self.parts.iter().map(part).collect();
        (joints, parts)
    }
}

fn read_mesh(primitive: &gltf::Primitive, blob: &[u8]) -> Mesh {
    let reader = primitive.reader(|_| Some(blob));
    let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default());
    let positions: Vec<[f32; 3]> = reader.read_positions().into_iter().flatten().collect();
    mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, positions);
    if let Some(normals) = reader.read_normals() {
        mesh.insert_attribute(Mesh::ATTRIBUTE_NORMAL, normals.collect::<Vec<_>>());
    }
    if let Some(uvs) = reader.read_tex_coords(0) {
        mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, uvs.into_f32().collect::<Vec<_>>());
    }
    if let (Some(joints), Some(weights)) = (reader.read_joints(0), reader.read_weights(0)) {
        let joints = VertexAttributeValues::Uint16x4(joints.into_u16().collect());
        mesh.insert_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, joints);
        mesh.insert_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, weights.into_f32().collect::<Vec<_>>());
    }
    // Without the underscore that it has in the file.
    let paint = primitive.get(&Semantic::Extras("CLOTH".into()));
    if let Some(paint) = paint.and_then(|accessor| Iter::<f32>::new(accessor, |_| Some(blob))) {
        mesh.insert_attribute(ATTRIBUTE_CLOTH, paint.collect::<Vec<f32>>());
    }
    if let Some(indices) = reader.read_indices() {
        mesh.insert_indices(Indices::U32(indices.into_u32().collect()));
    }
    mesh
}
