//! The way of a particle past an obstacle within one substep.

use bevy_math::{Isometry3d, Quat, Vec3A, primitives::InfinitePlane3d};

use crate::{
    input::{Obstacle, StepContext},
    shape::{
        Solid,
        solid::{SurfacePoint, field::SignedDistanceField},
    },
};

/// An obstacle within one substep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ObstacleSweep {
    /// Pose at the start of the substep.
    pub start: Isometry3d,
    /// Pose at its end.
    pub end: Isometry3d,
    /// Distance that particles keep from it, m.
    pub distance: f32,
    /// Coulomb friction, no unit.
    pub friction: f32,
    /// Largest depenetration of a particle that was inside before, m.
    pub parting: f32,
}

/// What brings a particle back to the surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Correction {
    /// Outward normal of the surface.
    pub normal: Vec3A,
    /// How far it came to be behind the surface within the substep, m.
    pub penetration: f32,
    /// How far it leaves of what it was inside before, m.
    pub parted: f32,
    /// How far it goes back that was inside before and left faster than it may, m.
    pub clamped: f32,
    /// Way of the surface at the point of contact within the substep, m.
    pub surface_way: Vec3A,
}

impl ObstacleSweep {
    /// That of `obstacle`, which goes from one pose to the other within a substep of `h` seconds.
    pub fn new(obstacle: &Obstacle, [start, end]: [Isometry3d; 2], ctx: &StepContext, h: f32) -> Self {
        let distance = ctx.contact_distance() + obstacle.rounding;
        let friction = ctx.material.friction * obstacle.friction;
        Self { start, end, distance, friction, parting: ctx.settings.max_depenetration_velocity * h }
    }

    /// What stays, without a rotation where its `solid` needs none.
    pub fn unturned(self, solid: Solid) -> (Self, Solid) {
        let unturned = match solid {
            Solid::Sphere(_) => solid,
            Solid::HalfSpace(plane) => Solid::HalfSpace(InfinitePlane3d { normal: self.end.rotation * plane.normal }),
            _ => return (self, solid),
        };
        let [start, end] = [self.start, self.end].map(|pose| Isometry3d { rotation: Quat::IDENTITY, ..pose });
        (Self { start, end, ..self }, unturned)
    }

    /// Whether it goes anywhere.
    pub fn moves(&self) -> bool {
        self.start != self.end
    }

    /// The correction of a particle that went from `previous` to `position` past a solid: the way in decides.
    pub fn correction(&self, solid: &impl SignedDistanceField, position: Vec3A, previous: Vec3A) -> Option<Correction> {
        let to = self.end.inverse().transform_point(position);
        let from = self.start.inverse().transform_point(previous);
        let (entry, surface) = self.enter(solid, from, to)?;
        let penetration = surface.normal.dot(entry - to);
        let was_inside = (-surface.distance).max(0.0);
        let parted = was_inside.min(self.parting) + penetration.min(0.0);
        let clamped = if was_inside > self.parting { (-parted).max(0.0) } else { 0.0 };
        if penetration <= 0.0 && parted <= 0.0 && clamped <= 0.0 {
            return None;
        }
        let touched = to + surface.normal * penetration;
        let surface_way = self.end.transform_point(touched) - self.start.transform_point(touched);
        let normal = self.end.rotation * surface.normal;
        Some(Correction { normal, penetration: penetration.max(0.0), parted: parted.max(0.0), clamped, surface_way })
    }

    /// Where the straight way from `from` to `to` enters a solid, and the surface there. Sphere tracing (Hart 1996).
    fn enter(&self, solid: &impl SignedDistanceField, from: Vec3A, to: Vec3A) -> Option<(Vec3A, SurfacePoint)> {
        const CLOSE: f32 = 1e-5;
        const STEPS: u32 = 32;
        let (direction, length) = (to - from).normalize_and_length();
        let mut way = 0.0;
        let mut last = None;
        for _ in 0..STEPS {
            let point = from + direction * way;
            let mut surface = SurfacePoint::from(solid.sample(point.into()));
            surface.distance -= self.distance;
            if surface.distance < CLOSE {
                return Some((point, surface));
            }
            way += surface.distance;
            if way > length {
                return None;
            }
            last = Some((point, surface));
        }
        // Along a surface it goes by small steps: whether it comes to be behind it is seen from there.
        last
    }
}

/// Upper bound of how far a place within `far` (m) of the origin goes between two poses, m.
pub(crate) fn way_between(from: &Isometry3d, to: &Isometry3d, far: f32) -> f32 {
    from.translation.distance(to.translation) + turn_between(from.rotation, to.rotation, far)
}

/// Upper bound of how far a place within `far` (m) of the origin goes between two rotations, m.
pub(crate) fn turn_between(from: Quat, to: Quat, far: f32) -> f32 {
    // |q1 - q0| is 2 sin(angle / 4), on the shorter of the two ways around; a place goes by 2 sin(angle / 2) of its
    // distance, which is no more than twice that.
    2.0 * far * (to - from).length().min((to + from).length())
}
