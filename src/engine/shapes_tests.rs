//! Parts are where their shape is, as parry itself measures it.

use bevy::{
    math::{Vec3A, primitives::InfinitePlane3d},
    prelude::*,
};

use super::{super::parry, convert};
use crate::{
    engine::Part,
    solver::{Shape, Solid},
};
use parry::{
    math::Pose,
    shape::{RoundShape, SharedShape, TriMesh, Voxels},
    utils::Array2,
};

fn corners() -> Vec<Vec3> {
    vec![Vec3::new(0.4, 0.0, 0.1), Vec3::new(-0.3, 0.1, 0.4), Vec3::new(0.0, -0.2, -0.5), Vec3::new(0.1, 0.6, 0.0)]
}

fn bowl() -> SharedShape {
    let heights = [0.5, 0.2, 0.4, 0.3, 0.0, 0.2, 0.6, 0.1, 0.5, 0.4, 0.3, 0.7];
    SharedShape::heightfield(Array2::new(3, 4, heights.to_vec()), Vec3::new(1.5, 1.0, 1.2))
}

fn compound() -> SharedShape {
    let at = |x: f32, turn: f32| Pose::from_parts(Vec3::new(x, 0.1, 0.0), Quat::from_rotation_z(turn));
    let ball = SharedShape::ball(0.2);
    SharedShape::compound(vec![(at(-0.4, 0.0), ball), (at(0.4, 0.7), SharedShape::cylinder(0.3, 0.1))])
}

fn shapes() -> Vec<SharedShape> {
    let [a, b, c, _] = corners()[..] else { return Vec::new() };
    let hull = SharedShape::convex_hull(&corners()).unwrap();
    let round_hull = SharedShape::round_convex_hull(&corners(), 0.1).unwrap();
    let inner = SharedShape::cone(0.3, 0.2);
    let inner = *inner.as_cone().unwrap();
    vec![
        SharedShape::ball(0.4),
        SharedShape::cuboid(0.3, 0.5, 0.2),
        SharedShape::capsule(a, b, 0.15),
        SharedShape::capsule_x(0.4, 0.15),
        SharedShape::capsule(a, a, 0.15),
        SharedShape::segment(a, b),
        SharedShape::triangle(a, b, c),
        SharedShape::trimesh(corners(), vec![[0, 1, 2], [0, 2, 3]]).unwrap(),
        SharedShape::polyline(corners(), None),
        SharedShape::halfspace(Vec3::new(0.6, 0.8, 0.0)),
        bowl(),
        compound(),
        hull,
        SharedShape::cylinder(0.4, 0.25),
        SharedShape::cone(0.4, 0.25),
        SharedShape::round_cuboid(0.3, 0.5, 0.2, 0.1),
        SharedShape::round_triangle(a, b, c, 0.1),
        SharedShape::round_cylinder(0.4, 0.25, 0.1),
        SharedShape::new(RoundShape { inner_shape: inner, border_radius: 0.1 }),
        round_hull,
        SharedShape::new(Voxels::new(Vec3::new(0.2, 0.3, 0.2), &[IVec3::ZERO, IVec3::X, IVec3::new(1, 1, 0)])),
    ]
}

/// Distance from outside, m.
fn distance(part: &Part, point: Vec3) -> f32 {
    let local = part.pose.inverse().transform_point(Vec3A::from(point));
    let own = match &part.shape {
        Shape::Solid(solid) => solid.surface(local).distance,
        Shape::Mesh(mesh) => {
            let points = mesh.mesh.points.iter().map(|&p| p.into()).collect();
            let mesh = SharedShape::new(TriMesh::new(points, mesh.mesh.triangles().to_vec()).unwrap());
            mesh.project_local_point(local.into(), false).point.distance(local.into())
        }
    };
    own - part.rounding
}

fn places() -> impl Iterator<Item = Vec3> {
    (0..343).map(|i| Vec3::new((i % 7) as f32 - 3.1, (i / 7 % 7) as f32 - 2.9, (i / 49) as f32 - 3.3) * 0.29)
}

#[test]
fn parts_are_as_far_away_as_their_shape() {
    for shape in shapes() {
        let parts = convert(Entity::PLACEHOLDER, &*shape);
        let name = shape.shape_type();
        assert!(!parts.is_empty(), "{name:?}");
        let mut outside = 0;
        for place in places() {
            let projected = shape.project_local_point(place, true);
            let expected = projected.point.distance(place);
            // Inside of several at once, the depth is another matter.
            if projected.is_inside || expected < 1e-3 {
                continue;
            }
            outside += 1;
            let distance = parts.iter().map(|part| distance(part, place)).fold(f32::INFINITY, f32::min);
            // Parry goes around rounded shapes by iterations that end early.
            let tolerance = if parts[0].rounding > 0.0 { 1e-2 } else { 1e-3 };
            assert!((distance - expected).abs() < tolerance, "{name:?} at {place}: {distance} for {expected}");
        }
        assert!(outside > 50, "{name:?}: {outside}");
    }
}

#[test]
fn what_encloses_a_volume_faces_out_of_it() {
    let closed = shapes().into_iter().flat_map(|shape| convert(Entity::PLACEHOLDER, &*shape));
    let mut count = 0;
    for mesh in closed.filter_map(|part| if let Shape::Mesh(mesh) = part.shape { Some(mesh.mesh) } else { None }) {
        if !mesh.is_closed {
            continue;
        }
        count += 1;
        let volume = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|i| mesh.points[i as usize]);
            a.dot(b.cross(c)) / 6.0
        };
        let whole: f32 = mesh.triangles().iter().map(volume).sum();
        assert!(whole > 0.01, "{whole}");
    }
    assert_eq!(count, 3);
}

#[test]
fn a_shape_that_cannot_be_met_has_no_parts() {
    for shape in [SharedShape::ball(0.0), SharedShape::cuboid(0.1, f32::NAN, 0.1), SharedShape::cone(0.0, 0.5)] {
        assert!(convert(Entity::PLACEHOLDER, &*shape).is_empty());
    }
}

#[test]
fn a_half_space_keeps_its_normal() {
    let normal = Vec3::new(0.6, 0.8, 0.0);
    let [part] = &convert(Entity::PLACEHOLDER, &*SharedShape::halfspace(normal))[..] else { panic!("one part") };
    assert_eq!(part.shape, Shape::Solid(Solid::HalfSpace(InfinitePlane3d::new(normal))));
}
