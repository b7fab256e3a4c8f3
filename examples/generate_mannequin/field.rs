//! Shapes as fields: about the distance to a surface, negative inside, which blend where they meet.

use bevy::math::{Vec2, Vec3};

/// How far apart the places are that a gradient compares, m.
const GRADIENT_STEP: f32 = 1e-3;

/// An ellipse across a [`Loft`].
#[derive(Clone, Copy)]
pub struct Station {
    /// Its place along the axis, m from the start.
    pub along: f32,
    /// Half axes in the directions of [`Loft::wide`] and [`Loft::deep`], m.
    pub half: Vec2,
    /// Centre in the same directions, m from the axis.
    pub centre: Vec2,
}

/// A tube around an axis, through ellipses across it.
pub struct Loft {
    pub start: Vec3,
    pub axis: Vec3,
    pub wide: Vec3,
    pub deep: Vec3,
    pub stations: Vec<Station>,
}

impl Loft {
    /// A loft whose stations are rows of place, half axes and centre. `wide` needn't be at a right angle to the axis.
    pub fn new(start: Vec3, axis: Vec3, wide: Vec3, rows: &[[f32; 5]]) -> Self {
        let axis = axis.normalize();
        let deep = wide.cross(axis).normalize();
        let station = |&[along, wide, deep, x, y]: &[f32; 5]| Station {
            along,
            half: Vec2::new(wide, deep),
            centre: Vec2::new(x, y),
        };
        Self { start, axis, wide: axis.cross(deep), deep, stations: rows.iter().map(station).collect() }
    }

    pub fn field(&self, point: Vec3) -> f32 {
        let from_start = point - self.start;
        let along = from_start.dot(self.axis);
        let (station, beyond) = self.station(along);
        let across = Vec2::new(from_start.dot(self.wide), from_start.dot(self.deep)) - station.centre;
        let aside = ellipse(across, station.half);
        // Ends are round.
        let round = 0.9 * station.half.min_element();
        if beyond > 0.0 { Vec2::new((aside + round).max(0.0), beyond).length() - round } else { aside }
    }

    /// A point of the loft: `angle` is 0 where it is deepest and grows towards where it is widest, rad.
    pub fn point(&self, along: f32, angle: f32) -> Vec3 {
        let Station { half, centre, .. } = self.station(along).0;
        let across = centre + half * Vec2::new(libm::sinf(angle), libm::cosf(angle));
        self.start + self.axis * along + self.wide * across.x + self.deep * across.y
    }

    /// The ellipse at a place along the axis, and how far the place is beyond the loft's ends.
    fn station(&self, along: f32) -> (Station, f32) {
        let [first, .., last] = self.stations.as_slice() else {
            return (Station { along, half: Vec2::ZERO, centre: Vec2::ZERO }, f32::INFINITY);
        };
        let within = along.clamp(first.along, last.along);
        let next = self.stations.partition_point(|station| station.along < within).max(1);
        let knot = |index: usize| self.stations[index.min(self.stations.len() - 1)];
        let [a, b, c, d] = [knot(next.saturating_sub(2)), knot(next - 1), knot(next), knot(next + 1)];
        let t = (within - b.along) / (c.along - b.along);
        let half = spline(t, [a, b, c, d].map(|s| (s.along, s.half)));
        let centre = spline(t, [a, b, c, d].map(|s| (s.along, s.centre)));
        (Station { along: within, half, centre }, (along - within).abs())
    }
}

/// The cubic between the second and the third knot, in whose slopes the outer ones take part.
fn spline(t: f32, [a, b, c, d]: [(f32, Vec2); 4]) -> Vec2 {
    let slope = |from: (f32, Vec2), to: (f32, Vec2)| (to.1 - from.1) / (to.0 - from.0).max(1e-6);
    let span = c.0 - b.0;
    let start = if a.0 < b.0 { slope(a, c) } else { slope(b, c) };
    let end = if d.0 > c.0 { slope(b, d) } else { slope(b, c) };
    let (t2, t3) = (t * t, t * t * t);
    b.1 * (2.0 * t3 - 3.0 * t2 + 1.0)
        + start * span * (t3 - 2.0 * t2 + t)
        + c.1 * (3.0 * t2 - 2.0 * t3)
        + end * span * (t3 - t2)
}

/// About the distance to an ellipse (Quilez, "Ellipsoid SDF", one dimension less) with blunter ends than a true one.
fn ellipse(point: Vec2, half: Vec2) -> f32 {
    let blunt = 0.55 * half.min_element();
    let half = half - blunt;
    let scaled = (point / half).length();
    let steep = (point / (half * half)).length();
    let field = if steep < 1e-6 { -half.min_element() } else { scaled * (scaled - 1.0) / steep };
    field - blunt
}

/// About the distance to an ellipsoid along the axes.
pub fn ellipsoid(point: Vec3, centre: Vec3, half: Vec3) -> f32 {
    let from_centre = point - centre;
    let scaled = (from_centre / half).length();
    let steep = (from_centre / (half * half)).length();
    if steep < 1e-6 { -half.min_element() } else { scaled * (scaled - 1.0) / steep }
}

/// The distance to a capsule whose radius changes evenly from `start` to `end`.
pub fn capsule(point: Vec3, start: (Vec3, f32), end: (Vec3, f32)) -> f32 {
    let way = end.0 - start.0;
    let t = ((point - start.0).dot(way) / way.length_squared()).clamp(0.0, 1.0);
    point.distance(start.0 + way * t) - (start.1 + (end.1 - start.1) * t)
}

/// Both shapes, with a fillet of about the radius `fillet` where they meet.
pub fn union(a: f32, b: f32, fillet: f32) -> f32 {
    let overlap = (fillet - (a - b).abs()).max(0.0) / fillet;
    a.min(b) - overlap * overlap * fillet * 0.25
}

/// The direction in which a field grows, and how much a metre.
pub fn gradient(field: impl Fn(Vec3) -> f32, point: Vec3) -> Vec3 {
    let along = |axis: Vec3| field(point + axis * GRADIENT_STEP) - field(point - axis * GRADIENT_STEP);
    Vec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z)) / (2.0 * GRADIENT_STEP)
}

/// The point moved along the gradient to where the field has a value.
pub fn project(field: impl Fn(Vec3) -> f32, mut point: Vec3, value: f32) -> Vec3 {
    for _ in 0..6 {
        let slope = gradient(&field, point);
        point -= slope * ((field(point) - value) / slope.length_squared().max(0.05));
    }
    point
}

/// 0 below `from`, 1 above `to`, without a kink between.
pub fn smooth(from: f32, to: f32, value: f32) -> f32 {
    let t = ((value - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
