//! The way of one particle past the faces that it knows: it is kept in front of the first one that it goes through within a
//! substep, and at its distance from the nearest one.
//!
//! That takes no memory: which side it was on is seen from where it was.

use bevy_math::Vec3A;

use crate::{
    contact::{
        mesh::MeshDistanceQuery,
        particle::ccd::{Correction, ObstacleSweep},
    },
    geometry::closest_point,
};

/// How far beyond its edges a face is gone through all the same, as a share of the distance that particles keep: nothing slips
/// between two.
const SEAM: f32 = 0.1;

/// A face when a substep begins and now, in the frame of its mesh.
#[derive(Clone, Copy)]
struct MovingFace {
    then: [Vec3A; 3],
    now: [Vec3A; 3],
}

/// A particle at a face.
#[derive(Clone, Copy)]
struct ParticleAtFace {
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

fn weighted(weights: Vec3A, [a, b, c]: [Vec3A; 3]) -> Vec3A {
    a * weights.x + b * weights.y + c * weights.z
}

impl MovingFace {
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
        let off = met - weighted(closest_point::on_triangle(met, corners), corners);
        (off.length_squared() <= tolerance * tolerance).then_some((share, if start >= 0.0 { 1.0 } else { -1.0 }))
    }
}

/// How a place is to a triangle.
fn at(place: Vec3A, corners: [Vec3A; 3], is_closed: bool) -> ParticleAtFace {
    let weights = closest_point::on_triangle(place, corners);
    let between = place - weighted(weights, corners);
    let outward = normal(corners);
    let (direction, length) = between.normalize_and_length();
    if length == 0.0 {
        return ParticleAtFace { weights, normal: outward.normalize_or(Vec3A::Y), gap: 0.0 };
    }
    let is_behind = is_closed && outward.dot(between) < 0.0;
    if is_behind {
        ParticleAtFace { weights, normal: -direction, gap: -length }
    } else {
        ParticleAtFace { weights, normal: direction, gap: length }
    }
}

/// What brings the particle in lane `i` back that went from `previous` to `position`, if it has to.
pub(crate) fn correction(
    query: &MeshDistanceQuery,
    i: usize,
    sweep: &ObstacleSweep,
    position: Vec3A,
    previous: Vec3A,
) -> Option<Correction> {
    let known = query.known();
    if known.beyond[i] > 0.0 {
        return None;
    }
    let is_closed = query.mesh.is_closed;
    let place = sweep.end.inverse().transform_point(position);
    let before = sweep.start.inverse().transform_point(previous);
    let [then, now] = query.points;
    let faces = || {
        known
            .faces
            .iter()
            .map(|faces| MovingFace { then: query.corners(then, faces[i]), now: query.corners(now, faces[i]) })
    };
    let mut first: Option<(f32, f32, MovingFace)> = None;
    for face in faces() {
        // Out of what is closed, particles may go.
        if let Some((share, side)) = face.passed([before, place], SEAM * sweep.distance)
            && (!is_closed || side > 0.0)
            && first.is_none_or(|(least, ..)| share < least)
        {
            first = Some((share, side, face));
        }
    }
    let (now, old_gap, face) = match first {
        Some((_, side, face)) => {
            let [outward, was] = [face.now, face.then].map(|corners| normal(corners).normalize_or_zero() * side);
            let weights = closest_point::on_triangle(place, face.now);
            let gap = outward.dot(place - face.now[0]);
            (ParticleAtFace { weights, normal: outward, gap }, was.dot(before - face.then[0]), face)
        }
        None => {
            let (now, face) = nearest(faces(), place, is_closed)?;
            (now, at(before, face.then, is_closed).gap, face)
        }
    };
    let target = sweep.distance.min(old_gap + sweep.parting);
    if now.gap >= target {
        return None;
    }
    let penetration = (old_gap.min(target) - now.gap).max(0.0);
    let places = (weighted(now.weights, face.then), weighted(now.weights, face.now));
    Some(Correction {
        normal: sweep.end.rotation * now.normal,
        penetration,
        parted: target - now.gap - penetration,
        clamped: 0.0,
        surface_way: sweep.end.transform_point(places.1) - sweep.start.transform_point(places.0),
    })
}

/// The face that a place is nearest to, and how.
fn nearest(
    faces: impl Iterator<Item = MovingFace>,
    place: Vec3A,
    is_closed: bool,
) -> Option<(ParticleAtFace, MovingFace)> {
    let mut nearest: Option<(ParticleAtFace, f32, MovingFace)> = None;
    for face in faces {
        let at = at(place, face.now, is_closed);
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
