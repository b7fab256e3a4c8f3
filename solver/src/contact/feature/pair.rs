//! Contact between two features that may touch: a point and a face, or two edges.
//!
//! ```text
//!      0                 0 ----- 1
//!      |  gap               |  gap
//!   1 --- 2            2 ----- 3   across
//!     \ /
//!      3
//! ```
//!
//! A pair remembers on which side of each other its features were. The direction between them turns with them, and where it
//! turns around within a substep they have passed through each other, and go back. That is what keeps the order of layers.

use bevy_math::Vec3A;

use crate::{
    contact::{body::MovedBody, friction},
    geometry::closest_point,
};

/// Points that features are made of: particles of all cloths that may touch, then those of obstacles.
#[derive(Clone, Debug, Default)]
pub struct FeaturePoints {
    /// Where they are, m.
    pub position: Vec<Vec3A>,
    /// Where they were when the substep began, m.
    pub previous: Vec<Vec3A>,
    /// Inverse mass, 1/kg. Zero for those that nothing moves.
    pub inverse_mass: Vec<f32>,
    /// Whether places before the substep have been moved too.
    pub has_parted: bool,
}

/// What was nearer before than this share of the distance to keep was far too near.
const FAR_TOO_NEAR: f32 = 0.7;

/// What kind of features a pair has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Features {
    /// The first point and the face of the other three.
    PointFace,
    /// The edge of the first two points and that of the others.
    EdgeEdge,
}

/// Two features that may touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeatureContact {
    pub features: Features,
    /// Number of each point.
    pub points: [u32; 4],
    /// Distance to keep, m.
    pub distance: f32,
    /// By how much more of it there is at the far end of the second edge, m: of a tapered obstacle.
    pub taper: f32,
    /// Coulomb friction, no unit.
    pub friction: f32,
    /// Distance when it was last looked at, m; negative after having passed through.
    pub gap: f32,
    /// Distance when the substep began, m.
    pub gap_before: f32,
    /// Unit vector from the second feature to the first, on the side where it belongs.
    pub normal: Vec3A,
    /// Normal force in the latest substep, N, where the cloth's implicit step has found one.
    pub load: f32,
    /// Whether the contact is solved along with the cloth, friction and all: what is left is to keep the features apart.
    pub is_solved_by_cloth: bool,
}

/// How far apart a pair's features are, and where.
#[derive(Clone, Copy, Debug)]
pub struct Separation {
    /// Weight of each point in the way from the second feature's closest point to the first's.
    pub weights: [f32; 4],
    /// Unit vector from the second feature to the first, on the side where it belongs.
    pub normal: Vec3A,
    /// Distance along that, m.
    pub gap: f32,
    /// Distance to keep there, m.
    pub distance: f32,
}

/// How two features are to each other.
#[derive(Clone, Copy, Debug)]
pub struct ClosestPoints {
    /// Weight of each point in the way from the second feature's closest point to the first's.
    pub weights: [f32; 4],
    /// That way, m.
    pub between: Vec3A,
}

impl Features {
    /// The closest points of two features.
    #[inline]
    pub fn nearest(self, [a, b, c, d]: [Vec3A; 4]) -> ClosestPoints {
        let weights = match self {
            Self::PointFace => {
                let on = closest_point::on_triangle(a, [b, c, d]);
                [1.0, -on.x, -on.y, -on.z]
            }
            Self::EdgeEdge => {
                let (s, t) = closest_point::on_edges([a, b], [c, d]);
                [1.0 - s, s, t - 1.0, -t]
            }
        };
        ClosestPoints { weights, between: weighted(weights, [a, b, c, d]) }
    }

    /// Whether all of the first feature is farther than `distance` from all of the second along `normal`.
    #[inline]
    fn is_beyond(self, [a, b, c, d]: [Vec3A; 4], normal: Vec3A, distance: f32) -> bool {
        let [a, b, c, d] = [normal.dot(a), normal.dot(b), normal.dot(c), normal.dot(d)];
        match self {
            Self::PointFace => a - b.max(c).max(d) > distance,
            Self::EdgeEdge => a.min(b) - c.max(d) > distance,
        }
    }
}

/// The sum of points by their weights.
#[inline]
pub fn weighted(weights: [f32; 4], [a, b, c, d]: [Vec3A; 4]) -> Vec3A {
    a * weights[0] + b * weights[1] + c * weights[2] + d * weights[3]
}

/// The body that one of two features is of.
#[derive(Clone, Copy, Debug)]
pub struct BodyContact<'a> {
    pub body: &'a MovedBody,
    /// From the origin of the points, m.
    pub centre: Vec3A,
    /// Whether it has the first feature.
    pub is_first: bool,
}

impl BodyContact<'_> {
    /// Where the cloth is touched, from the body's centre of mass, m.
    fn beside(&self, weights: [f32; 4], places: [Vec3A; 4]) -> Vec3A {
        let of_cloth = if self.is_first { -1.0 } else { 1.0 };
        weighted(weights.map(|weight| (weight * of_cloth).max(0.0)), places) - self.centre
    }
}

/// What a body gets within a substep of h seconds, times h.
#[derive(Clone, Copy, Debug)]
pub struct Impulse {
    /// kg m
    pub linear: Vec3A,
    /// About its centre of mass, kg m².
    pub angular: Vec3A,
}

/// How two features touched.
#[derive(Clone, Copy, Debug)]
pub struct Touch {
    /// How much nearer they were than they are now, m.
    pub depth: f32,
    /// What the obstacle among them got, if it is a body.
    pub impulse: Impulse,
}

/// How two features part.
#[derive(Clone, Copy, Debug)]
pub struct FeatureCorrection {
    pub points: [usize; 4],
    /// Weight of each point in the way from the second feature's closest point to the first's.
    pub weights: [f32; 4],
    /// Unit vector from the second feature to the first.
    pub normal: Vec3A,
    /// By how much they came too near within the substep, m.
    pub penetration: f32,
    /// By how much they part of what they were too near before, m: without gaining speed.
    pub depenetration: f32,
    /// Coulomb friction, no unit.
    pub friction: f32,
}

impl FeatureCorrection {
    /// Moves the points by their weights and inverse masses, with friction against their slide. Returns what the obstacle among
    /// them got if it is a body; nothing where nothing can be moved.
    #[inline]
    pub fn apply(&self, points: &mut FeaturePoints, body: Option<&BodyContact>) -> Option<Impulse> {
        let Self { points: all, weights, normal, penetration, depenetration, friction } = *self;
        let places = all.map(|i| points.position[i]);
        let before = all.map(|i| points.previous[i]);
        let masses = all.map(|i| points.inverse_mass[i]);
        let of_points = friction::effective_inverse_mass(weights, masses);
        let beside = body.map(|on| on.beside(weights, places));
        let effective_inverse_mass = |direction: Vec3A| match (body, beside) {
            (Some(on), Some(beside)) => of_points + on.body.inverse_mass_at(beside, direction),
            _ => of_points,
        };
        let along_normal = effective_inverse_mass(normal);
        if along_normal <= 0.0 {
            return None;
        }
        let part = normal * (depenetration / along_normal);
        let displacement = weighted(weights, places) - weighted(weights, before);
        let lambda = penetration / along_normal;
        let change = friction::impulse([normal, displacement], lambda, friction, effective_inverse_mass);
        for ((&i, weight), w) in all.iter().zip(weights).zip(masses) {
            points.position[i] += (change + part) * (weight * w);
            points.previous[i] += part * (weight * w);
        }
        points.has_parted |= part != Vec3A::ZERO;
        let linear = if body.is_some_and(|on| on.is_first) { change } else { -change };
        Some(Impulse { linear, angular: beside.map_or(Vec3A::ZERO, |beside| beside.cross(linear)) })
    }
}

impl FeatureContact {
    /// Brings the features as far apart as they should be, with friction. Those that were nearer before part by no more than
    /// `most_parted` (m). Returns how they touched, if they did.
    #[inline]
    pub fn solve(&mut self, points: &mut FeaturePoints, most_parted: f32, body: Option<&BodyContact>) -> Option<Touch> {
        let farthest = self.distance + self.taper.max(0.0);
        self.gap_before = self.gap;
        if self.is_beyond(points, farthest) {
            self.gap = farthest;
            return None;
        }
        let Separation { weights, normal, gap, distance } = self.separation(points);
        let target = distance.min(self.gap + most_parted);
        let old_gap = core::mem::replace(&mut self.gap, gap);
        self.normal = normal;
        if gap >= target {
            return None;
        }
        // What was too near before parts without gaining speed.
        let penetration = if self.is_solved_by_cloth {
            // The gap before is that before the cloth was solved: of that, only speed is left to be undone.
            let moved = self.points.map(|i| points.position[i as usize] - points.previous[i as usize]);
            (-normal.dot(weighted(weights, moved))).clamp(0.0, target - gap)
        } else {
            (old_gap.min(target) - gap).max(0.0)
        };
        let parting = FeatureCorrection {
            points: self.points.map(|i| i as usize),
            weights,
            normal,
            penetration,
            depenetration: target - gap - penetration,
            friction: if self.is_solved_by_cloth { 0.0 } else { self.friction },
        };
        let impulse = parting.apply(points, body)?;
        self.gap = target;
        Some(Touch { depth: target - gap, impulse })
    }

    /// Does the same once more within a substep, where other pairs have undone it. What was far too near before doesn't part this time:
    /// cloth that lies in itself, as a copy does, would be thrown.
    pub fn solve_again(
        &mut self,
        points: &mut FeaturePoints,
        most_parted: f32,
        body: Option<&BodyContact>,
    ) -> Option<Touch> {
        self.gap = self.gap_before;
        let was_apart = self.gap > FAR_TOO_NEAR * self.distance;
        self.solve(points, if was_apart { most_parted } else { 0.0 }, body)
    }

    /// Whether all of the first feature is farther than `distance` (m) from all of the second, along the latest normal.
    #[inline]
    pub fn is_beyond(&self, points: &FeaturePoints, distance: f32) -> bool {
        let places = self.points.map(|i| points.position[i as usize]);
        self.features.is_beyond(places, self.normal, distance)
    }

    /// How far apart the features are, and where: on the side where they belong, unless they have passed through each other.
    #[inline]
    pub fn separation(&self, points: &FeaturePoints) -> Separation {
        let places = self.points.map(|i| points.position[i as usize]);
        let before = self.points.map(|i| points.previous[i as usize]);
        let ClosestPoints { weights, between } = self.features.nearest(places);
        let (direction, length) = between.normalize_and_length();
        let (mut normal, mut gap) = if length > 0.0 { (direction, length) } else { (self.normal, 0.0) };
        if normal.dot(self.normal) < 0.0 && (self.gap < 0.0 || self.has_passed(before, places)) {
            (normal, gap) = (-normal, -gap);
        }
        // Of an edge's places, the far end is at weight 1.
        let distance = match self.features {
            Features::PointFace => self.distance,
            Features::EdgeEdge => self.distance - self.taper * weights[3],
        };
        Separation { weights, normal, gap, distance }
    }

    /// Whether the features met on their way from `before` to `after`.
    fn has_passed(&self, before: [Vec3A; 4], after: [Vec3A; 4]) -> bool {
        let [b0, b1, b2, b3] = before;
        let [a0, a1, a2, a3] = after;
        // Six times the volume between the four points is zero where they are in one plane.
        let volume = |[p, q, r, s]: [Vec3A; 4]| (q - p).cross(r - p).dot(s - p);
        let (start, end) = (volume([b0, b1, b2, b3]), volume([a0, a1, a2, a3]));
        let share = start / (start - end);
        if !(0.0..=1.0).contains(&share) {
            // Side by side in a plane, or around each other: nothing is known for sure.
            return false;
        }
        let met = core::array::from_fn(|i| before[i].lerp(after[i], share));
        let ClosestPoints { between, .. } = self.features.nearest(met);
        between.length() <= self.distance.max(1e-4)
    }
}

#[cfg(test)]
mod tests;
