//! Particles at the faces of meshes.
//!
//! A particle is kept in front of the first face that it goes through within a substep, and at its distance from the nearest
//! one. That takes no memory: which side it was on is seen from where it was.

use bevy::math::Vec3A;

use crate::solver::contact::{
    closest,
    pair::{Given, OnBody, Parting, Points},
};

/// Faces that particles may meet before the next search.
#[derive(Clone, Debug, Default)]
pub struct Faces {
    /// Numbers of the corners of each.
    pub corners: Vec<[u32; 3]>,
    pub meetings: Vec<Meeting>,
}

/// A particle and the faces of one mesh that it may meet.
#[derive(Clone, Copy, Debug)]
pub struct Meeting {
    /// Number of the particle.
    pub particle: u32,
    /// Numbers of its faces: the first, and the one after the last.
    pub faces: [u32; 2],
    /// Distance to keep, m.
    pub distance: f32,
    /// Coulomb friction, no unit.
    pub friction: f32,
    /// Whether the mesh encloses a volume: behind its faces is inside.
    pub is_closed: bool,
    /// Whether no face rises above another: pushed out of one, a particle isn't in another.
    pub is_convex: bool,
}

/// Whether none of some faces rises above the plane of another, but by what rounding makes.
pub fn are_convex(faces: impl Iterator<Item = [Vec3A; 3]> + Clone) -> bool {
    faces.clone().all(|plane| {
        let outward = normal(plane);
        let far = 1e-3 * outward.length();
        let mut corners = faces.clone().flatten();
        corners.all(|corner| outward.dot(corner - plane[0]) <= far * (corner - plane[0]).length())
    })
}

/// A face when a substep begins and now.
#[derive(Clone, Copy)]
struct Face {
    corners: [u32; 3],
    then: [Vec3A; 3],
    now: [Vec3A; 3],
}

/// A particle at a face.
#[derive(Clone, Copy)]
struct At {
    weights: Vec3A,
    /// Unit vector from the face to the particle, or to where the particle belongs.
    normal: Vec3A,
    /// Distance, m; negative behind a face of what is closed.
    gap: f32,
}

/// Normal of a triangle, as long as twice its area, m².
fn normal([a, b, c]: [Vec3A; 3]) -> Vec3A {
    (b - a).cross(c - a)
}

impl Face {
    fn new(corners: [u32; 3], points: &Points) -> Self {
        let at = |places: &[Vec3A]| corners.map(|i| places[i as usize]);
        Self { corners, then: at(&points.previous), now: at(&points.position) }
    }

    /// The share of a particle's way from `before` to `place` at which it goes through the face, or by it within `tolerance`
    /// (m), and on which side it was: 1 in front, -1 behind.
    fn passed(&self, [before, place]: [Vec3A; 2], tolerance: f32) -> Option<(f32, f32)> {
        let start = normal(self.then).dot(before - self.then[0]);
        let end = normal(self.now).dot(place - self.now[0]);
        if (start >= 0.0) == (end >= 0.0) {
            return None;
        }
        let share = start / (start - end);
        let met = before.lerp(place, share);
        let corners = [0, 1, 2].map(|k| self.then[k].lerp(self.now[k], share));
        let off = met - weighted(closest::on_triangle(met, corners), corners);
        (off.length_squared() <= tolerance * tolerance).then_some((share, if start >= 0.0 { 1.0 } else { -1.0 }))
    }
}

fn weighted(weights: Vec3A, [a, b, c]: [Vec3A; 3]) -> Vec3A {
    a * weights.x + b * weights.y + c * weights.z
}

/// How a place is to a triangle.
fn at(place: Vec3A, corners: [Vec3A; 3], is_closed: bool) -> At {
    let weights = closest::on_triangle(place, corners);
    let between = place - weighted(weights, corners);
    let outward = normal(corners);
    let (direction, length) = between.normalize_and_length();
    if length == 0.0 {
        return At { weights, normal: outward.normalize_or(Vec3A::Y), gap: 0.0 };
    }
    let is_behind = is_closed && outward.dot(between) < 0.0;
    if is_behind {
        At { weights, normal: -direction, gap: -length }
    } else {
        At { weights, normal: direction, gap: length }
    }
}

impl Meeting {
    /// Where a particle lies between faces, pushed out of one it comes into another: so many are left in a substep.
    const PASSES: u32 = 3;

    /// How far beyond its edges a face is gone through all the same, as a share of the distance: nothing slips between two.
    const SEAM: f32 = 0.1;

    /// Keeps the particle off its faces, with friction. What was too near before parts by no more than `most_parted` (m).
    /// Where it touched, returns what the mesh got, if it is a body.
    pub fn solve(
        &self,
        corners: &[[u32; 3]],
        points: &mut Points,
        most_parted: f32,
        body: Option<&OnBody>,
    ) -> Option<Given> {
        let [first, end] = self.faces.map(|i| i as usize);
        let faces = &corners[first..end];
        let mut given = None;
        // A body has moved after the first.
        for _ in 0..if body.is_some() || self.is_convex { 1 } else { Self::PASSES } {
            let Some(parting) = self.parting(faces, points, most_parted) else { break };
            let Some(once) = parting.happen(points, body) else { break };
            given = Some(once);
        }
        given
    }

    /// How the particle is to part from its faces, if it has to.
    fn parting(&self, faces: &[[u32; 3]], points: &Points, most_parted: f32) -> Option<Parting> {
        let particle = self.particle as usize;
        let way @ [before, place] = [points.previous[particle], points.position[particle]];
        let mut first: Option<(f32, f32, Face)> = None;
        let mut is_clear = false;
        for &corners in faces {
            let face = Face::new(corners, points);
            let outward = normal(face.now);
            let height = outward.dot(place - face.now[0]);
            is_clear |= height > self.distance * outward.length();
            // Out of what is closed, particles may go.
            if (!self.is_closed || height < 0.0)
                && let Some((share, side)) = face.passed(way, Self::SEAM * self.distance)
                && (!self.is_closed || side > 0.0)
                && first.is_none_or(|(least, ..)| share < least)
            {
                first = Some((share, side, face));
            }
        }
        // What is in front of one face of something convex is off all of it.
        let nearest = match first {
            None if !(self.is_convex && is_clear) => self.nearest(faces, points),
            _ => None,
        };
        let (now, old_gap, face) = match (first, nearest) {
            (Some((_, side, face)), _) => {
                let [outward, was] = [face.now, face.then].map(|corners| normal(corners).normalize_or_zero() * side);
                let weights = closest::on_triangle(place, face.now);
                let gap = outward.dot(place - face.now[0]);
                (At { weights, normal: outward, gap }, was.dot(before - face.then[0]), face)
            }
            (None, Some((now, face))) if now.gap < self.distance => {
                (now, at(before, face.then, self.is_closed).gap, face)
            }
            _ => return None,
        };
        let target = self.distance.min(old_gap + most_parted);
        if now.gap >= target {
            return None;
        }
        let gained = (old_gap.min(target) - now.gap).max(0.0);
        let [a, b, c] = face.corners.map(|i| i as usize);
        Some(Parting {
            points: [particle, a, b, c],
            weights: [1.0, -now.weights.x, -now.weights.y, -now.weights.z],
            normal: now.normal,
            gained,
            parted: target - now.gap - gained,
            friction: self.friction,
        })
    }

    /// The face that the particle is nearest to, and how.
    fn nearest(&self, faces: &[[u32; 3]], points: &Points) -> Option<(At, Face)> {
        let place = points.position[self.particle as usize];
        let mut nearest: Option<(At, f32, Face)> = None;
        for &corners in faces {
            let face = Face::new(corners, points);
            let at = at(place, face.now, self.is_closed);
            // Of faces that share the nearest place, the one that looks towards the particle knows the side that it is on.
            let steep = at.normal.dot(normal(face.now).normalize_or_zero()).abs();
            let is_nearer = nearest.is_none_or(|(best, best_steep, _)| {
                let (length, least) = (at.gap.abs(), best.gap.abs());
                length < least * (1.0 - 1e-5) || length <= least * (1.0 + 1e-5) && steep > best_steep
            });
            if is_nearer {
                nearest = Some((at, steep, face));
            }
        }
        nearest.map(|(at, _, face)| (at, face))
    }
}
