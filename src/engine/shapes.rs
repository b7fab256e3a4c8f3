//! From parry's shapes to parts that cloth can meet. Compiled once for each engine, since each has a parry of its own;
//! `parry` is the one that the module around this one uses.

use std::sync::Arc;

use bevy::{
    math::{Isometry3d, primitives::InfinitePlane3d},
    platform::collections::{HashMap, HashSet},
    prelude::{Cone, Cuboid, Cylinder, Dir3, Entity, IVec3, Sphere, warn},
};

use super::parry::{
    math::Pose,
    shape::{self, Shape, SharedShape, TypedShape, Voxels},
};
use crate::{
    engine::{self, Part},
    solver::Solid,
};

/// What tells a shape from all others, as long as anybody has it.
pub(super) fn address(shape: &SharedShape) -> usize {
    Arc::as_ptr(&shape.0).cast::<()>() as usize
}

/// The parts of a collider's shape. None, with a warning, where cloth can't meet it.
pub(super) fn convert(collider: Entity, shape: &dyn Shape) -> Vec<Part> {
    let mut parts = Vec::new();
    add_parts(shape, Isometry3d::IDENTITY, &mut parts);
    parts.retain(Part::is_sound);
    if parts.is_empty() {
        warn!(
            "collider {collider} is left out by cloth: its shape ({:?}) has no finite size or is a custom one; give it a \
             ClothCollider or, so that nobody asks again, NotClothCollider",
            shape.shape_type()
        );
    }
    parts
}

pub(super) fn isometry(pose: &Pose) -> Isometry3d {
    Isometry3d::new(pose.translation, pose.rotation)
}

fn add_parts(shape: &dyn Shape, pose: Isometry3d, parts: &mut Vec<Part>) {
    let part = match shape.as_typed_shape() {
        TypedShape::Ball(ball) => Part::new(Solid::Sphere(Sphere::new(ball.radius))),
        TypedShape::Cuboid(it) => cuboid(it),
        TypedShape::Capsule(capsule) => engine::capsule([capsule.segment.a, capsule.segment.b], capsule.radius),
        TypedShape::Segment(segment) => engine::capsule([segment.a, segment.b], 0.0),
        TypedShape::Triangle(it) => triangle(it),
        TypedShape::Voxels(it) => voxels(it),
        TypedShape::TriMesh(mesh) => engine::mesh(mesh.vertices().iter().copied(), mesh.indices(), false),
        TypedShape::Polyline(polyline) => {
            let lines = polyline.segments().map(|segment| engine::capsule([segment.a, segment.b], 0.0));
            parts.extend(lines.map(|line| Part { pose: pose * line.pose, ..line }));
            return;
        }
        TypedShape::HalfSpace(space) => match Dir3::new(space.normal) {
            Ok(normal) => Part::new(Solid::HalfSpace(InfinitePlane3d { normal })),
            Err(_) => return,
        },
        TypedShape::HeightField(field) => {
            let (points, triangles) = field.to_trimesh();
            engine::mesh(points, &triangles, false)
        }
        TypedShape::Compound(compound) => {
            for (own, shape) in compound.shapes() {
                add_parts(&**shape, pose * isometry(own), parts);
            }
            return;
        }
        TypedShape::ConvexPolyhedron(it) => polyhedron(it),
        TypedShape::Cylinder(it) => cylinder(it),
        TypedShape::Cone(it) => cone(it),
        TypedShape::RoundCuboid(round) => cuboid(&round.inner_shape).rounded(round.border_radius),
        TypedShape::RoundTriangle(round) => triangle(&round.inner_shape).rounded(round.border_radius),
        TypedShape::RoundCylinder(round) => cylinder(&round.inner_shape).rounded(round.border_radius),
        TypedShape::RoundCone(round) => cone(&round.inner_shape).rounded(round.border_radius),
        TypedShape::RoundConvexPolyhedron(round) => polyhedron(&round.inner_shape).rounded(round.border_radius),
        TypedShape::Custom(_) => return,
    };
    parts.push(Part { pose: pose * part.pose, ..part });
}

fn cuboid(cuboid: &shape::Cuboid) -> Part {
    Part::new(Solid::Cuboid(Cuboid { half_size: cuboid.half_extents }))
}

fn cylinder(cylinder: &shape::Cylinder) -> Part {
    Part::new(Solid::Cylinder(Cylinder { radius: cylinder.radius, half_height: cylinder.half_height }))
}

fn cone(cone: &shape::Cone) -> Part {
    Part::new(Solid::Cone(Cone { radius: cone.radius, height: 2.0 * cone.half_height }))
}

fn triangle(triangle: &shape::Triangle) -> Part {
    engine::mesh([triangle.a, triangle.b, triangle.c], &[[0, 1, 2]], false)
}

fn polyhedron(polyhedron: &shape::ConvexPolyhedron) -> Part {
    let (points, triangles) = polyhedron.to_trimesh();
    engine::mesh(points, &triangles, true)
}

/// The sides of voxels that have no neighbour there.
fn voxels(voxels: &Voxels) -> Part {
    let filled = || voxels.voxels().filter(|voxel| !voxel.state.is_empty());
    let filled_cells: HashSet<IVec3> = filled().map(|voxel| voxel.grid_coords).collect();
    let mut numbers = HashMap::new();
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for voxel in filled() {
        for (axis, sign) in (0..3).flat_map(|axis| [(axis, -1), (axis, 1)]) {
            let out = IVec3::AXES[axis] * sign;
            if filled_cells.contains(&(voxel.grid_coords + out)) {
                continue;
            }
            let (across, along) = (IVec3::AXES[(axis + 1) % 3], IVec3::AXES[(axis + 2) % 3] * sign);
            let corner = |p: i32, q: i32| out + across * p + along * q;
            let quad = [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)].map(|corner| {
                // Corners lie between cells: on a grid of half cells, they are where all cells around them meet.
                *numbers.entry(voxel.grid_coords * 2 + corner).or_insert_with(|| {
                    points.push(voxel.center + corner.as_vec3() * voxels.voxel_size() / 2.0);
                    points.len() as u32 - 1
                })
            });
            triangles.extend([[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]);
        }
    }
    engine::mesh(points, &triangles, true)
}

#[cfg(test)]
#[path = "shapes_tests.rs"]
mod tests;
