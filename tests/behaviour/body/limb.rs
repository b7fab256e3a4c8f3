//! A character that is one limb.

use core::f32::consts::{FRAC_PI_2, TAU};

use bevy::{
    asset::RenderAssetUsages,
    mesh::{
        Indices, PrimitiveTopology, VertexAttributeValues,
        skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    },
    prelude::*,
};
use bevy_drape::{
    prelude::*,
    solver::{Obstacle, Shape},
};

use crate::common::*;

/// A limb along the Y axis of its root: "upper" from 0 to 0.5 m, "lower" to 1 m and "finger" to 1.1 m.
pub struct Limb {
    pub root: Entity,
    pub mesh: Entity,
    pub joints: [Entity; 3],
}

pub const NAMES: [&str; 3] = ["upper", "lower", "finger"];

/// Where each joint is along the limb, where it ends, and its radius there and there, m.
const JOINTS: [[f32; 4]; 3] = [[0.0, 0.5, 0.1, 0.08], [0.5, 1.0, 0.08, 0.05], [1.0, 1.1, 0.012, 0.01]];

/// Rings of a joint, and vertices of a ring.
const RINGS: usize = 6;
const AROUND: usize = 12;

/// Rings of vertices around each joint.
pub fn mesh() -> Mesh {
    let (mut places, mut joints, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for (joint, [start, end, first, last]) in JOINTS.into_iter().enumerate() {
        for ring in 0..RINGS {
            // Not quite to the end: the next joint has a ring there.
            let share = ring as f32 / RINGS as f32;
            for i in 0..AROUND {
                let (angle, radius) = (i as f32 / AROUND as f32 * TAU, first + share * (last - first));
                places.push([radius * ops::cos(angle), start + share * (end - start), radius * ops::sin(angle)]);
                joints.push([joint as u16, 0, 0, 0]);
            }
        }
    }
    for ring in 0..(JOINTS.len() * RINGS - 1) as u32 {
        for i in 0..AROUND as u32 {
            let [a, b] = [i, (i + 1) % AROUND as u32].map(|i| ring * AROUND as u32 + i);
            let [c, d] = [a, b].map(|below| below + AROUND as u32);
            indices.extend([a, c, b, b, c, d]);
        }
    }
    let weights = vec![[1.0, 0.0, 0.0, 0.0]; places.len()];
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, places)
        .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, VertexAttributeValues::Uint16x4(joints))
        .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, weights)
        .with_inserted_indices(Indices::U32(indices))
}

pub fn bindposes() -> SkinnedMeshInverseBindposes {
    JOINTS.map(|[start, ..]| Mat4::from_translation(Vec3::NEG_Y * start)).to_vec().into()
}

/// Spawns a limb without a body yet.
pub fn spawn(app: &mut App, root: Transform) -> Limb {
    let mesh = add_mesh(app, mesh());
    let inverse_bindposes = app.world_mut().resource_mut::<Assets<SkinnedMeshInverseBindposes>>().add(bindposes());
    let world = app.world_mut();
    let root = world.spawn((root, Name::new("root"))).id();
    let mut above = root;
    let mut from = 0.0;
    let joints = [0, 1, 2].map(|i: usize| {
        let start = JOINTS[i][0];
        above = world.spawn((Transform::from_xyz(0.0, start - from, 0.0), Name::new(NAMES[i]), ChildOf(above))).id();
        from = start;
        above
    });
    let skeleton = SkinnedMesh { inverse_bindposes, joints: joints.to_vec() };
    let mesh = world.spawn((Mesh3d(mesh), skeleton, Transform::default(), ChildOf(root))).id();
    Limb { root, mesh, joints }
}

/// Spawns a limb with a body.
pub fn spawn_body(app: &mut App, root: Transform) -> Limb {
    let limb = spawn(app, root);
    app.world_mut().entity_mut(limb.root).insert(ClothBody::default());
    limb
}

/// Along X rather than Y, its root at a place.
pub fn lying(place: Vec3) -> Transform {
    Transform::from_translation(place).with_rotation(Quat::from_rotation_z(-FRAC_PI_2))
}

/// The parts of a body, each with the name of its joint.
pub fn parts(app: &mut App, body: Entity) -> Vec<(String, Entity)> {
    let mut parts = app.world_mut().query::<(Entity, &ClothBodyPart, &Name)>();
    let own = parts.iter(app.world()).filter(|(_, part, _)| part.body == body);
    let mut own: Vec<_> = own.map(|(entity, _, name)| (name.as_str().replace("cloth body ", ""), entity)).collect();
    own.sort();
    own
}

pub fn names(app: &mut App, body: Entity) -> Vec<String> {
    parts(app, body).into_iter().map(|(name, _)| name).collect()
}

/// Distance of a place in the world from an obstacle at the end of the latest step, m.
pub fn distance(obstacle: &Obstacle, place: Vec3) -> f32 {
    let Shape::Solid(solid) = &obstacle.shape else { panic!("a solid") };
    solid.surface(obstacle.end.inverse().transform_point(place)).distance
}
