//! What stands out of a solid so much that it would poke through between the particles of a cloth: its edges and tips,
//! and the inside of what is thin.

use bevy_math::{
    Vec3, Vec3A,
    primitives::{Capsule3d, Cone, Cuboid, Cylinder, Sphere},
};

use crate::{
    geometry::bvh::{
        TriangleBvh,
        bounds::{Bounds, BvhBounds},
    },
    shape::{Solid, TaperedCapsule},
};

mod ellipsoid;

/// Points and edges with a distance around them.
#[derive(Clone, Debug, Default)]
pub struct SharpFeatures {
    pub points: Vec<Vec3A>,
    /// Distance around each point, m.
    pub radii: Vec<f32>,
    /// The edges, as triangles without an area.
    pub surface: TriangleBvh,
    /// Boxes around them, as thick as they are.
    pub places: BvhBounds,
}

/// Corners of the polygon that stands for a rim. It lies within the rim by 0.5 % of its radius.
const RIM: u32 = 32;

impl SharpFeatures {
    /// Follows `solid`, as `tightness` asks for.
    pub fn of(solid: &Solid, tightness: FeatureTolerance) -> Self {
        let mut outline = OutlineBuilder::default();
        if tightness.pierced_by(solid).is_none() {
            return outline.finish();
        }
        match *solid {
            Solid::Sphere(Sphere { radius }) => outline.bone([Vec3A::ZERO; 2], [radius; 2]),
            Solid::Capsule(Capsule3d { radius, half_length }) => {
                outline.bone([-half_length, half_length].map(|y| Vec3A::Y * y), [radius; 2]);
            }
            Solid::TaperedCapsule(TaperedCapsule { radius_top, radius_bottom, half_length }) => {
                outline.bone([-half_length, half_length].map(|y| Vec3A::Y * y), [radius_bottom, radius_top]);
            }
            Solid::Ellipsoid(ellipsoid) => outline.ellipsoid(&ellipsoid),
            Solid::Cuboid(Cuboid { half_size }) => outline.cuboid(half_size.into()),
            Solid::Cylinder(Cylinder { radius, half_height }) => {
                outline.rim(radius, half_height);
                outline.rim(radius, -half_height);
                if tightness.is_thin(radius) && half_height > radius {
                    let end = half_height - radius;
                    outline.bone([-end, end].map(|y| Vec3A::Y * y), [radius; 2]);
                }
            }
            Solid::Cone(Cone { radius, height }) => {
                outline.rim(radius, -height / 2.0);
                // The ball that touches side and base; the cone narrows from it to the tip.
                let inner = radius * height / (radius + (radius * radius + height * height).sqrt());
                outline.bone([Vec3A::Y * (inner - height / 2.0), Vec3A::Y * (height / 2.0)], [inner, 0.0]);
            }
            Solid::HalfSpace(_) => {}
        }
        outline.finish()
    }
}

/// How tightly a cloth lies on what it lies on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeatureTolerance {
    /// Its longest edge, as stretched as it counts, m.
    pub edge: f32,
    /// Distance that it keeps, m.
    pub distance: f32,
    /// How deep its edges may sink in, m.
    pub sink: f32,
}

/// What comes between the particles of a cloth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Sharpness {
    /// An edge, or what is so round that a triangle's inside sinks into it.
    Edge,
    /// What fits through a stretched cell, or ends in that.
    Tip,
}

impl FeatureTolerance {
    /// How sharp a solid is.
    pub fn pierced_by(self, solid: &Solid) -> Option<Sharpness> {
        // The sine of half a right angle is that by which edges fall off to both sides.
        let is_caught = core::f32::consts::FRAC_1_SQRT_2 * self.edge / 2.0 > self.sink;
        match *solid {
            Solid::Sphere(Sphere { radius }) | Solid::Capsule(Capsule3d { radius, .. }) => self.pierced_by_ball(radius),
            Solid::TaperedCapsule(TaperedCapsule { radius_top, radius_bottom, .. }) => {
                self.pierced_by_ball(radius_top.min(radius_bottom))
            }
            Solid::Ellipsoid(ellipsoid) => {
                let [sharp, blunt] = ellipsoid.tip_radii();
                self.is_thin(sharp).then_some(if self.fits(blunt) { Sharpness::Tip } else { Sharpness::Edge })
            }
            Solid::Cylinder(Cylinder { radius, .. }) => {
                self.pierced_by_ball(radius).or(is_caught.then_some(Sharpness::Edge))
            }
            Solid::Cuboid(_) => is_caught.then_some(Sharpness::Edge),
            Solid::Cone(_) => is_caught.then_some(Sharpness::Tip),
            Solid::HalfSpace(_) => None,
        }
    }

    fn pierced_by_ball(self, radius: f32) -> Option<Sharpness> {
        self.is_thin(radius).then_some(if self.fits(radius) { Sharpness::Tip } else { Sharpness::Edge })
    }

    /// Whether what is as round as that fits through a cell of the cloth.
    fn fits(self, radius: f32) -> bool {
        radius + self.distance < self.edge
    }

    /// Whether a chord of the cloth sinks too deep into what is round.
    fn is_thin(self, radius: f32) -> bool {
        let (round, edge) = (radius + self.distance, self.edge);
        let depth = if round > edge / 2.0 { edge * edge / (8.0 * round) } else { edge / 2.0 };
        depth > self.sink
    }
}

/// An outline as it is drawn.
#[derive(Default)]
struct OutlineBuilder {
    points: Vec<Vec3A>,
    radii: Vec<f32>,
    edges: Vec<[u32; 3]>,
}

impl OutlineBuilder {
    fn point(&mut self, place: Vec3A, radius: f32) -> u32 {
        self.points.push(place);
        self.radii.push(radius);
        self.points.len() as u32 - 1
    }

    /// Two balls and what lies between them; one where the ends are the same.
    fn bone(&mut self, [from, to]: [Vec3A; 2], [near, far]: [f32; 2]) {
        let first = self.point(from, near);
        let last = if from == to { first } else { self.point(to, far) };
        self.edges.push([first, last, last]);
    }

    fn rim(&mut self, radius: f32, height: f32) {
        let first = self.points.len() as u32;
        for i in 0..RIM {
            let (sine, cosine) = bevy_math::ops::sin_cos(i as f32 * core::f32::consts::TAU / RIM as f32);
            self.point(Vec3A::new(radius * cosine, height, radius * sine), 0.0);
        }
        self.edges.extend((0..RIM).map(|i| [first + i, first + (i + 1) % RIM, first + i]));
    }

    fn cuboid(&mut self, half_size: Vec3A) {
        let first = self.points.len() as u32;
        for corner in 0..8 {
            let side = |axis: u32| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
            self.point(half_size * Vec3A::new(side(0), side(1), side(2)), 0.0);
        }
        for corner in 0..8_u32 {
            let upward = (0..3).filter(|axis| corner >> axis & 1 == 0);
            self.edges.extend(upward.map(|axis| [first + corner, first + corner + (1 << axis), first + corner]));
        }
    }

    fn finish(self) -> SharpFeatures {
        let Self { points, radii, edges } = self;
        if points.is_empty() {
            return SharpFeatures::default();
        }
        let rest: Vec<Vec3> = points.iter().copied().map(Vec3::from).collect();
        let surface = TriangleBvh::new(&rest, &edges);
        let mut places = BvhBounds::default();
        let ball = |i: u32| Bounds::around([points[i as usize]]).grown(radii[i as usize]);
        let around = |[a, b, _]: [u32; 3]| ball(a).union(ball(b));
        places.follow(&surface, around, None::<fn(_) -> _>);
        SharpFeatures { points, radii, surface, places }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Ellipsoid;

    #[test]
    fn an_outline_lies_within_its_solid() {
        let solids = [
            Solid::Sphere(Sphere::new(0.01)),
            Solid::Capsule(Capsule3d::new(0.01, 0.5)),
            Solid::TaperedCapsule(TaperedCapsule::new(0.01, 0.03, 0.3)),
            Solid::Ellipsoid(Ellipsoid { half_size: Vec3::new(0.4, 0.02, 0.2) }),
            Solid::Ellipsoid(Ellipsoid { half_size: Vec3::new(0.01, 0.01, 0.5) }),
            Solid::Ellipsoid(Ellipsoid { half_size: Vec3::new(0.01, 0.010_01, 0.01) }),
            Solid::Cuboid(Cuboid::new(0.2, 0.3, 0.4)),
            Solid::Cylinder(Cylinder::new(0.01, 0.4)),
            Solid::Cone(Cone::new(0.1, 0.4)),
        ];
        for solid in solids {
            let outline = SharpFeatures::of(&solid, FeatureTolerance { edge: 0.1, distance: 0.001, sink: 0.0005 });
            assert!(!outline.points.is_empty(), "{solid:?}");
            for (&point, radius) in outline.points.iter().zip(&outline.radii) {
                assert!(solid.surface(point).distance < 1e-5 - radius, "{solid:?}: {point}");
            }
        }
    }

    #[test]
    fn what_is_round_enough_has_none() {
        let tightness = FeatureTolerance { edge: 0.022, distance: 0.0, sink: 0.0005 };
        assert!(SharpFeatures::of(&Solid::Sphere(Sphere::new(0.3)), tightness).points.is_empty());
        let half_size = Vec3::new(0.4, 0.35, 0.3);
        assert!(SharpFeatures::of(&Solid::Ellipsoid(Ellipsoid { half_size }), tightness).points.is_empty());
    }
}
