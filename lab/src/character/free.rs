//! The free parts of clothes: how far they are stretched, and what of them is inside of the body.

use bevy::{
    math::Vec3A,
    mesh::{Indices, VertexAttributeValues},
    prelude::*,
};
use bevy_drape::{
    Obstacles,
    prelude::*,
    solver::{Obstacle, Shape},
};

/// What is deeper than this inside of a capsule counts, m.
pub const DEEP: f32 = 0.0005;

/// What of a garment is free: vertices that may be farther from their skin than two edges are long, and sides between two of these.
/// Strain of others says how the skin stretches, and what is painted holds them where the body is.
#[derive(Component, Default)]
pub struct Free {
    /// Ends and rest length, m.
    sides: Vec<([usize; 2], f32)>,
    vertices: Vec<usize>,
}

impl Free {
    pub fn of(mesh: &Mesh) -> Self {
        let positions: Vec<Vec3> = mesh
            .attribute(Mesh::ATTRIBUTE_POSITION)
            .and_then(VertexAttributeValues::as_float3)
            .map(|places| places.iter().copied().map(Vec3::from).collect())
            .unwrap_or_default();
        let paint = match mesh.attribute(ATTRIBUTE_CLOTH) {
            Some(VertexAttributeValues::Float32(paint)) => paint.clone(),
            _ => vec![f32::INFINITY; positions.len()],
        };
        let corners: Vec<usize> = mesh.indices().into_iter().flat_map(Indices::iter).collect();
        let sides = corners.as_chunks().0.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let sides = sides.map(|[a, b]| ([a, b], positions[a].distance(positions[b])));
        let is_free = |&([a, b], length): &([usize; 2], f32)| length > 0.0 && paint[a].min(paint[b]) > 2.0 * length;
        let sides: Vec<_> = sides.filter(is_free).collect();
        let mut vertices: Vec<usize> = sides.iter().flat_map(|(ends, _)| *ends).collect();
        vertices.sort_unstable();
        vertices.dedup();
        Self { sides, vertices }
    }

    /// Strain of each side, no unit.
    pub fn strains<'a>(&'a self, state: &'a ClothState) -> impl Iterator<Item = f32> + 'a {
        let sides = self.sides.iter();
        sides.filter_map(move |&([a, b], length)| Some(place(state, a)?.distance(place(state, b)?) / length - 1.0))
    }

    /// How deep each vertex is inside of what it is deepest in, m; negative outside.
    pub fn depths<'a>(&'a self, state: &'a ClothState, body: &'a [&Obstacle]) -> impl Iterator<Item = f32> + 'a {
        let depth = |place: Vec3| body.iter().map(|part| depth(part, place)).fold(f32::NEG_INFINITY, f32::max);
        self.vertices.iter().filter_map(move |&vertex| place(state, vertex).map(depth))
    }
}

fn place(state: &ClothState, vertex: usize) -> Option<Vec3> {
    state.particle_of_vertex(vertex).and_then(|particle| state.position(particle))
}

/// How deep a place is in a part of a body at the end of a step, m.
fn depth(part: &Obstacle, place: Vec3) -> f32 {
    match &part.shape {
        Shape::Solid(solid) => -solid.surface(part.end.inverse().transform_point(Vec3A::from(place))).distance,
        Shape::Mesh(_) => f32::NEG_INFINITY,
    }
}

/// The parts of a body among all obstacles.
pub fn parts_of<'a>(
    body: Entity,
    obstacles: &'a Obstacles,
    parts: impl Fn(Entity) -> Option<&'a ClothBodyPart>,
) -> Vec<&'a Obstacle> {
    let own = obstacles.iter().filter(|(entity, ..)| parts(*entity).is_some_and(|part| part.body == body));
    own.map(|(.., obstacle)| obstacle).collect()
}
