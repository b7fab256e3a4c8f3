//! The points and edges of an obstacle that cloth may be caught on.

use core::ops::Range;

use bevy_math::Vec3A;

use crate::{
    contact::feature::narrow_phase::Displacements,
    geometry::bvh::{TriangleBvh, bounds::BvhBounds},
    input::Obstacle,
    shape::{DeformedPoints, MeshShape, Shape, sharp_features::SharpFeatures},
};

/// A mesh whose points move within its frame.
#[derive(Clone, Debug, Default)]
pub struct DeformedMesh {
    points: Vec<Vec3A>,
    way: Vec<Vec3A>,
    places: BvhBounds,
}

impl DeformedMesh {
    /// Follows a mesh in the part `span` of a step.
    fn follow(&mut self, surface: &TriangleBvh, from: &[Vec3A], to: &[Vec3A], span: &Range<f32>) {
        self.points.clear();
        self.points.extend(from.iter().zip(to).map(|(&p, &q)| p.lerp(q, span.start)));
        self.way.clear();
        self.way.extend(from.iter().zip(to).map(|(&p, &q)| (q - p) * (span.end - span.start)));
        let ways = Displacements { position: &self.points, way: &self.way, slack: &[] };
        self.places.follow(surface, |triangle| ways.bounds(triangle), None::<fn(_) -> _>);
    }
}

/// An obstacle as the search sees it, in its own frame.
#[derive(Clone, Copy)]
pub struct ObstacleGeometry<'a> {
    pub points: &'a [Vec3A],
    pub surface: &'a TriangleBvh,
    pub places: &'a BvhBounds,
    pub radii: &'a [f32],
    /// Whether it is the edges and corners of a mesh, and whether that encloses a volume.
    pub is_of_mesh: bool,
    pub is_closed: bool,
    /// How far the points will come, where they move.
    pub way: Option<&'a [Vec3A]>,
}

impl<'a> ObstacleGeometry<'a> {
    /// Those of an obstacle where it is when the part `span` of the step begins. None where nothing of it is sharp.
    pub fn of(
        obstacle: &'a Obstacle,
        span: &Range<f32>,
        deformed: &'a mut DeformedMesh,
        outline: impl FnOnce() -> &'a SharpFeatures,
    ) -> Option<Self> {
        let of_mesh = |points, surface, places, is_closed, way| {
            Some(Self { points, surface, places, radii: &[], is_of_mesh: true, is_closed, way })
        };
        match &obstacle.shape {
            Shape::Solid(_) => {
                let SharpFeatures { points, radii, surface, places } = outline();
                let target = Self { points, surface, places, radii, is_of_mesh: false, is_closed: false, way: None };
                (!points.is_empty()).then_some(target)
            }
            Shape::Mesh(MeshShape { mesh, deformed: None }) => {
                of_mesh(&mesh.points, &mesh.surface, &mesh.places, mesh.is_closed, None)
            }
            Shape::Mesh(MeshShape { mesh, deformed: Some(DeformedPoints { ends: [from, to], .. }) }) => {
                deformed.follow(&mesh.surface, from, to, span);
                let DeformedMesh { points, way, places } = deformed;
                of_mesh(points, &mesh.surface, places, mesh.is_closed, Some(way))
            }
        }
    }
}
