//! Shapes of a physics engine as cloth sees them: each made of parts that the solver knows, worked out once.

use std::sync::Arc;

use bevy::{
    math::{Isometry3d, Vec3A, primitives::Capsule3d},
    platform::{
        collections::{HashMap, HashSet},
        hash::FixedHasher,
    },
    prelude::*,
};

use crate::solver::{MeshShape, Shape, Solid, TriangleMesh};

/// A part of a collider.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Part {
    pub shape: Shape,
    /// Where it is in the collider's frame.
    pub pose: Isometry3d,
    /// By how much it is larger all around than its shape, m.
    pub rounding: f32,
}

impl Part {
    /// One that is where its collider is.
    pub fn new(shape: impl Into<Shape>) -> Self {
        Self { shape: shape.into(), pose: Isometry3d::IDENTITY, rounding: 0.0 }
    }

    /// Makes the part larger all around by `rounding` (m).
    pub fn rounded(self, rounding: f32) -> Self {
        Self { rounding, ..self }
    }

    /// Whether there is something to touch, all of it finite.
    pub fn is_sound(&self) -> bool {
        let is_size = |size: f32| size.is_finite() && size > 0.0;
        // What is rounded may have no size of its own.
        let is_part = |size: f32| size.is_finite() && size >= 0.0 && size + self.rounding > 0.0;
        let has_size = match &self.shape {
            Shape::Solid(Solid::Sphere(sphere)) => is_part(sphere.radius),
            Shape::Solid(Solid::Ellipsoid(ellipsoid)) => ellipsoid.half_size.to_array().into_iter().all(is_size),
            Shape::Solid(Solid::Cuboid(cuboid)) => cuboid.half_size.to_array().into_iter().all(is_part),
            // One of no thickness is a line, and cloth keeps its distance from lines too.
            Shape::Solid(Solid::Capsule(capsule)) => (capsule.radius + capsule.half_length).is_finite(),
            Shape::Solid(Solid::Cylinder(cylinder)) => is_part(cylinder.radius) && is_part(cylinder.half_height),
            Shape::Solid(Solid::Cone(cone)) => is_size(cone.radius) && is_size(cone.height),
            Shape::Solid(Solid::TaperedCapsule(_) | Solid::HalfSpace(_)) => true,
            Shape::Mesh(mesh) => !mesh.mesh.triangles().is_empty() && mesh.mesh.points.iter().all(|p| p.is_finite()),
        };
        let is_placed = self.pose.translation.is_finite() && self.pose.rotation.is_finite();
        has_size && is_placed && self.rounding.is_finite() && self.rounding >= 0.0
    }
}

/// A capsule between two places, m.
pub(crate) fn capsule([a, b]: [Vec3; 2], radius: f32) -> Part {
    let (way, length) = (b - a).normalize_and_length();
    let turn = if length > 0.0 { Quat::from_rotation_arc(Vec3::Y, way) } else { Quat::IDENTITY };
    let capsule = Solid::Capsule(Capsule3d { radius, half_length: length / 2.0 });
    Part { pose: Isometry3d::new((a + b) / 2.0, turn), ..Part::new(capsule) }
}

/// Triangles between points, m. Points at one place become one.
pub(crate) fn mesh(points: impl IntoIterator<Item = Vec3>, triangles: &[[u32; 3]], is_closed: bool) -> Part {
    let mut known = HashMap::new();
    let mut welded = Vec::new();
    let numbers: Vec<u32> = points
        .into_iter()
        .map(|point| {
            // Adding zero makes -0 the same as 0.
            let key = (point + 0.0).to_array().map(f32::to_bits);
            *known.entry(key).or_insert_with(|| {
                welded.push(Vec3A::from(point));
                welded.len() as u32 - 1
            })
        })
        .collect();
    let number = |i: u32| numbers.get(i as usize).copied();
    let triangles = triangles.iter().filter_map(|&[a, b, c]| Some([number(a)?, number(b)?, number(c)?]));
    let has_area = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| welded[i as usize]);
        (b - a).cross(c - a).length_squared() > 0.0
    };
    let mut seen = HashSet::new();
    let is_new = |&[a, b, c]: &[u32; 3]| {
        let mut corners = [a, b, c];
        corners.sort_unstable();
        seen.insert(corners)
    };
    let triangles: Vec<[u32; 3]> = triangles.filter(has_area).filter(is_new).collect();
    Part::new(Shape::Mesh(MeshShape {
        mesh: Arc::new(TriangleMesh::new(welded, &triangles, is_closed)),
        deformed: None,
    }))
}

/// The parts of all shapes in use. `S` keeps a shape, and with it the address that it is known by.
#[derive(Debug)]
pub(crate) struct Shapes<S> {
    known: HashMap<usize, Known<S>, FixedHasher>,
    /// Number of the present step.
    step: u64,
    in_use: usize,
}

#[derive(Debug)]
struct Known<S> {
    _shape: S,
    parts: Arc<[Part]>,
    /// The step that used it last.
    used: u64,
}

impl<S> Default for Shapes<S> {
    fn default() -> Self {
        Self { known: HashMap::with_hasher(FixedHasher), step: 0, in_use: 0 }
    }
}

impl<S: Clone> Shapes<S> {
    /// Begins another step.
    pub fn begin(&mut self) {
        (self.step, self.in_use) = (self.step + 1, 0);
    }

    /// The parts of the shape at this address, worked out by `convert` where that hasn't been done.
    pub fn parts(&mut self, address: usize, shape: &S, convert: impl FnOnce() -> Vec<Part>) -> Arc<[Part]> {
        let step = self.step;
        let known = self.known.entry(address).or_insert_with(|| Known {
            _shape: shape.clone(),
            parts: convert().into(),
            used: 0,
        });
        if known.used != step {
            known.used = step;
            self.in_use += 1;
        }
        known.parts.clone()
    }

    /// Forgets the shapes that the step hasn't used.
    pub fn end(&mut self) {
        if self.known.len() > self.in_use {
            let step = self.step;
            self.known.retain(|_, known| known.used == step);
        }
    }
}
