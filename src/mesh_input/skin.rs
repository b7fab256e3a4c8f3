//! Reads how the points of a mesh follow the joints of a skeleton: linear blend skinning, as Bevy does it. Knows no entities.

use bevy::{
    math::{Affine3A, Mat3A, Vec3A},
    mesh::VertexAttributeValues,
    prelude::*,
};

/// Joints that a point follows, at most.
const JOINTS: usize = 4;

/// How points of a mesh follow joints.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Skin {
    points: Vec<SkinPoint>,
    /// Number of joints that the points follow, and of those before them.
    pub joint_count: usize,
}

/// A point, and how it follows joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SkinPoint {
    /// Its place in the mesh's own space.
    pub place: Vec3A,
    pub joints: [u16; JOINTS],
    /// Shares of the joints; their sum is 1.
    pub weights: [f32; JOINTS],
}

/// Whether a mesh says how it follows joints.
pub(crate) fn is_skinned(mesh: &Mesh) -> bool {
    influences(mesh).is_some()
}

/// Joints and weights of each vertex, where the mesh has them for all.
fn influences(mesh: &Mesh) -> Option<(&[[u16; JOINTS]], &[[f32; JOINTS]])> {
    let count = mesh.try_attribute(Mesh::ATTRIBUTE_POSITION).ok()?.len();
    let joints = match mesh.try_attribute(Mesh::ATTRIBUTE_JOINT_INDEX).ok()? {
        VertexAttributeValues::Uint16x4(joints) => joints,
        _ => return None,
    };
    let weights = match mesh.try_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT).ok()? {
        VertexAttributeValues::Float32x4(weights) => weights,
        _ => return None,
    };
    (joints.len() == count && weights.len() == count).then_some((joints, weights))
}

/// Whether any vertex of a mesh follows a joint.
pub(crate) fn follows(mesh: &Mesh, joint: usize) -> bool {
    let of_vertices = influences(mesh).map(|(joints, weights)| joints.iter().flatten().zip(weights.iter().flatten()));
    of_vertices.into_iter().flatten().any(|(&other, &weight)| usize::from(other) == joint && weight > 0.0)
}

impl Skin {
    /// Reads the skin of the vertices of `mesh` with these numbers, which are at `positions`. None where it has no skin.
    pub fn read(mesh: &Mesh, positions: &[Vec3], vertices: &[u32]) -> Option<Self> {
        let (joints, weights) = influences(mesh)?;
        let point = |&vertex: &u32| {
            let vertex = vertex as usize;
            let weights = shares(weights[vertex]);
            SkinPoint { place: positions[vertex].into(), joints: joints[vertex], weights }
        };
        let points: Vec<SkinPoint> = vertices.iter().map(point).collect();
        let followed = points.iter().flat_map(|point| point.joints.into_iter().zip(point.weights));
        let last = followed.filter(|&(_, weight)| weight > 0.0).map(|(joint, _)| joint).max();
        Some(Self { points, joint_count: last.map_or(0, |joint| usize::from(joint) + 1) })
    }

    /// The points, in the order of the vertices that were given.
    pub fn points(&self) -> &[SkinPoint] {
        &self.points
    }

    /// The joint that has the most of some points, with the sum of their weights.
    pub fn main_joint(&self, points: impl Iterator<Item = usize>) -> u16 {
        let mut sums = vec![0.0; self.joint_count];
        for point in points.map(|point| &self.points[point]) {
            for (&joint, weight) in point.joints.iter().zip(point.weights).filter(|(_, weight)| *weight > 0.0) {
                sums[usize::from(joint)] += weight;
            }
        }
        strongest((0..).zip(sums))
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Writes where the points are, with what each joint does to the mesh's space in `joints`, of which there have to be
    /// as many as the skin follows.
    pub fn pose(&self, joints: &[Affine3A], places: &mut [Vec3A]) {
        for (point, place) in self.points.iter().zip(places) {
            let joints = point.influences().map(|(joint, weight)| (&joints[joint], weight));
            *place = joints.map(|(joint, weight)| weight * joint.transform_point3a(point.place)).sum();
        }
    }
}

impl SkinPoint {
    /// The joints that it follows, with their weights.
    fn influences(&self) -> impl Iterator<Item = (usize, f32)> {
        let joints = self.joints.iter().map(|&joint| usize::from(joint)).zip(self.weights);
        joints.filter(|&(_, weight)| weight > 0.0)
    }

    /// The joint that it follows most.
    pub fn strongest(&self) -> u16 {
        strongest(self.joints.into_iter().zip(self.weights))
    }

    /// Rotation and scale that the joints give its surroundings.
    pub fn matrix(&self, joints: &[Affine3A]) -> Mat3A {
        let sum = |sum: Mat3A, (joint, weight): (usize, f32)| sum + joints[joint].matrix3 * weight;
        self.influences().fold(Mat3A::ZERO, sum)
    }
}

/// The joint of the largest weight: the first of them; joint 0 where there is none.
fn strongest(weights: impl Iterator<Item = (u16, f32)>) -> u16 {
    let first = (0, f32::NEG_INFINITY);
    weights.fold(first, |most, next| if next.1 > most.1 { next } else { most }).0
}

/// Weights as shares, by Bevy's rule: negative ones are none, and where there are none the first joint has it all. What is shares
/// already, but for rounding, keeps its bits: the renderer doesn't divide them again.
fn shares(weights: [f32; JOINTS]) -> [f32; JOINTS] {
    const ROUNDING: f32 = 1e-3;
    let weights = weights.map(|weight| if weight.is_finite() { weight.max(0.0) } else { 0.0 });
    let sum: f32 = weights.iter().sum();
    match sum {
        _ if (sum - 1.0).abs() < ROUNDING => weights,
        _ if sum > 0.0 => weights.map(|weight| weight / sum),
        _ => [1.0, 0.0, 0.0, 0.0],
    }
}

#[cfg(test)]
mod tests {
    use bevy::{asset::RenderAssetUsages, mesh::PrimitiveTopology};

    use super::*;

    const PLACES: [Vec3; 3] = [Vec3::X, Vec3::Y, Vec3::Z];

    fn mesh(joints: Vec<[u16; 4]>, weights: Vec<[f32; 4]>) -> Mesh {
        Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, PLACES.iter().map(Vec3::to_array).collect::<Vec<_>>())
            .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, VertexAttributeValues::Uint16x4(joints))
            .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, weights)
    }

    #[test]
    fn points_follow_their_joints_by_their_weights() {
        let weights = vec![[1.0, 0.0, 0.0, 0.0], [3.0, 1.0, 0.0, 0.0], [0.0; 4]];
        let mesh = mesh(vec![[1, 9, 0, 0], [0, 1, 0, 0], [1, 0, 0, 0]], weights);
        assert!(is_skinned(&mesh));
        let skin = Skin::read(&mesh, &PLACES, &[1, 0, 2]).unwrap();
        assert_eq!((skin.len(), skin.joint_count), (3, 2), "a joint of no weight isn't followed");
        let joints = [Affine3A::IDENTITY, Affine3A::from_translation(Vec3::Y * 4.0)];
        let mut places = [Vec3A::NAN; 3];
        skin.pose(&joints, &mut places);
        assert_eq!(places, [Vec3A::Y * 2.0, Vec3A::new(1.0, 4.0, 0.0), Vec3A::new(0.0, 4.0, 1.0)]);
    }

    #[test]
    fn a_mesh_without_weights_for_all_vertices_has_no_skin() {
        let plain = mesh(vec![[0; 4]; 3], vec![[1.0; 4]; 3]).with_removed_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT);
        for mesh in [plain, mesh(vec![[0; 4]; 2], vec![[1.0; 4]; 3]), mesh(vec![[0; 4]; 3], vec![[1.0; 4]; 1])] {
            assert!(!is_skinned(&mesh));
            assert_eq!(Skin::read(&mesh, &PLACES, &[0]), None);
        }
    }
}
