//! Which joints get which vertices, and what capsules come of that. Knows no entities.

use bevy::math::{Affine3A, Vec3A};

use super::{
    ClothBody,
    fit::{Fit, fit},
};

/// A joint of fewer vertices gives them to the one above it.
const FEWEST: usize = 8;

/// A joint, and the vertices that follow it most.
#[derive(Clone, Debug)]
pub(super) struct Joint {
    /// Number of the next joint above it.
    pub parent: Option<usize>,
    /// What takes the space of each mesh to its own; none of a mesh that doesn't know it.
    pub bindposes: Vec<Option<Affine3A>>,
    pub vertices: Vec<Vertex>,
    /// How many metres are one of its own.
    pub scale: f32,
    /// It gets no capsule.
    pub is_left_out: bool,
}

/// A vertex of a mesh.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    /// Number of the mesh.
    pub mesh: usize,
    pub place: Vec3A,
    /// Area of the skin that is its own, m²: finely modelled fingers or ears count no more than they cover.
    pub area: f32,
}

/// The capsules of joints, in their own space, with the numbers of these: the first joints first.
pub(super) fn capsules(mut joints: Vec<Joint>, body: &ClothBody) -> Vec<(usize, Fit)> {
    let depth = |joint: usize| {
        // No more than there are: parents could go in a circle only if the hierarchy did.
        let above = core::iter::successors(Some(joint), |&joint| joints[joint].parent);
        above.take(joints.len()).count()
    };
    // The lowest joint first: what it gives away counts above.
    let mut order: Vec<(usize, usize)> = (0..joints.len()).map(|joint| (depth(joint), joint)).collect();
    order.sort_by_key(|&(depth, _)| core::cmp::Reverse(depth));
    let mut found = Vec::new();
    for (_, joint) in order {
        let Joint { parent, ref bindposes, ref vertices, scale, is_left_out } = joints[joint];
        if is_left_out {
            continue;
        }
        let point = |&Vertex { mesh, place, area }: &Vertex| {
            let bindpose = bindposes.get(mesh)?.as_ref()?;
            Some((bindpose.transform_point3a(place), area))
        };
        let points: Vec<(Vec3A, f32)> =
            vertices.iter().filter_map(point).filter(|(place, _)| place.is_finite()).collect();
        let fitted = (points.len() >= FEWEST).then(|| fit(&points, body.cover)).flatten();
        match fitted.filter(|fit| fit.radius() * scale >= body.smallest) {
            Some(fit) => found.push((joint, fit)),
            None => {
                let vertices = core::mem::take(&mut joints[joint].vertices);
                if let Some(parent) = parent {
                    joints[parent].vertices.extend(vertices);
                }
            }
        }
    }
    found.sort_by_key(|&(joint, _)| joint);
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Corners, edges and faces of a cube of this half size.
    fn cube(half: f32, count: usize) -> Vec<Vertex> {
        let place = |i: usize| Vec3A::new((i % 3) as f32 - 1.0, (i / 3 % 3) as f32 - 1.0, (i / 9) as f32 - 1.0) * half;
        (0..27).filter(|i| *i != 13).take(count).map(|i| Vertex { mesh: 0, place: place(i), area: 1.0 }).collect()
    }

    fn joint(parent: Option<usize>, vertices: Vec<Vertex>) -> Joint {
        let bindposes = vec![Some(Affine3A::IDENTITY)];
        Joint { parent, bindposes, vertices, scale: 1.0, is_left_out: false }
    }

    fn found(joints: &[Joint]) -> Vec<usize> {
        capsules(joints.to_vec(), &ClothBody::default()).into_iter().map(|(joint, _)| joint).collect()
    }

    #[test]
    fn what_is_small_goes_to_the_joint_above() {
        let joints = [joint(None, Vec::new()), joint(Some(0), cube(0.1, 7)), joint(Some(1), cube(0.01, 26))];
        assert_eq!(found(&joints), [1], "a thin end makes enough vertices with the few above it");
        let joints = [joint(None, cube(0.1, 26)), joint(Some(0), cube(0.1, 26)), joint(Some(1), cube(0.1, 3))];
        assert_eq!(found(&joints), [0, 1]);
        assert_eq!(found(&[joint(None, cube(0.01, 26))]), [0; 0], "and is nobody's where there is none");
    }

    #[test]
    fn sizes_are_those_in_the_world() {
        let small = Joint { scale: 0.01, ..joint(None, cube(1.0, 26)) };
        assert_eq!(found(core::slice::from_ref(&small)), [0; 0]);
        assert_eq!(found(&[Joint { scale: 0.1, ..small }]), [0]);
    }

    #[test]
    fn a_joint_that_is_left_out_keeps_what_it_has_and_is_given() {
        let left_out = Joint { is_left_out: true, ..joint(Some(0), cube(0.1, 26)) };
        let joints = [joint(None, Vec::new()), left_out, joint(Some(1), cube(0.01, 26))];
        assert_eq!(found(&joints), [0; 0]);
    }

    #[test]
    fn vertices_come_into_the_space_of_the_joint_that_gets_them() {
        let there = Some(Affine3A::from_translation([5.0, 0.0, 0.0].into()));
        let joints = [Joint { bindposes: vec![there, None], ..joint(None, Vec::new()) }, joint(Some(0), cube(0.1, 7))];
        let mut joints = joints.to_vec();
        joints[1].vertices.push(Vertex { mesh: 0, place: Vec3A::splat(0.1), area: 1.0 });
        joints[1].vertices.push(Vertex { mesh: 1, place: Vec3A::splat(9.0), area: 1.0 });
        joints[1].bindposes = vec![None];
        let found = capsules(joints, &ClothBody::default());
        assert!(found[0].0 == 0 && (found[0].1.centre.x - 5.0).abs() < 0.1, "{found:?}");
    }
}
