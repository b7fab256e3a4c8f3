//! Contact: particles stay outside of obstacles, slide on them with friction, and let go without sticking.
//!
//! Particles are projected once a substep, as its last act, so that none ends a step inside an obstacle; where obstacles
//! overlap or pinch the cloth, the last one has its way. Friction is
//! Coulomb's at the level of positions: the way along the surface is cut by at most `friction` times the way that the
//! contact pushed (Müller et al., "Position Based Dynamics", 2007, section 3.6, with the normal push in place of a
//! damping constant). There is no restitution.

use core::ops::Range;

use bevy::math::{Isometry3d, Mat3A, Quat, Vec3A};

use super::{Lanes, Particles, StepContext};

pub mod mesh;
pub mod solid;

mod closest;
mod inside;
mod outline;
pub(super) mod pair;
mod search;
pub(super) mod surface;
pub(super) mod tangle;
pub(super) mod touch;

/// The way that a cloth may gain on an obstacle within a step by what pulls and pushes at it, m.
const GAINED: f32 = 0.01;

pub use mesh::MeshShape;
pub use solid::{Solid, Surface};

/// The shape of an obstacle, m, in its own frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// One whose signed distance has a formula.
    Solid(Solid),
    /// Triangles.
    Mesh(MeshShape),
}

impl From<Solid> for Shape {
    fn from(solid: Solid) -> Self {
        Self::Solid(solid)
    }
}

/// What it takes to move an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Inverse mass, 1/kg.
    pub inverse_mass: f32,
    /// Inverse of the tensor of inertia about the centre of mass, along the world's axes, 1/(kg m²).
    pub inverse_inertia: Mat3A,
    /// Centre of mass at the start of the step, m, relative to the cloth's origin.
    pub centre: Vec3A,
}

/// What a cloth has given to a body within a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Push {
    /// Momentum, N s.
    pub linear: Vec3A,
    /// Angular momentum about the body's centre of mass, N m s.
    pub angular: Vec3A,
    /// How far the body's centre of mass has come off its way by that until the step's end, m.
    pub shift: Vec3A,
    /// By how much the body has turned by that.
    pub turn: Quat,
}

/// Something that cloth can't enter, on its way over one step.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    /// Its shape.
    pub shape: Shape,
    /// Where it is when the step starts, m, relative to the cloth's origin.
    pub start: Isometry3d,
    /// Where it is when the step ends.
    pub end: Isometry3d,
    /// Factor on the cloth's friction, no unit.
    pub friction: f32,
    /// What it takes to move it. None for what no cloth moves.
    pub body: Option<Body>,
}

impl Obstacle {
    /// One that stays where it is, which no cloth moves.
    pub fn still(shape: impl Into<Shape>, pose: Isometry3d) -> Self {
        Self::moving(shape, pose, pose)
    }

    /// One that goes from `start` to `end`, which no cloth moves.
    pub fn moving(shape: impl Into<Shape>, start: Isometry3d, end: Isometry3d) -> Self {
        Self { shape: shape.into(), start, end, friction: 1.0, body: None }
    }

    /// Pose at the fraction `t` (0..=1) of the step.
    fn pose(&self, t: f32) -> Isometry3d {
        if self.start == self.end {
            return self.end;
        }
        Isometry3d::new(
            self.start.translation.lerp(self.end.translation, t),
            // Normalised linear interpolation: no transcendental function, and exact enough within a step.
            self.start.rotation.lerp(self.end.rotation, t),
        )
    }
}

/// Whether an obstacle is so near that the cloth may touch it within a step of `dt` seconds.
pub(super) fn is_any_near(particles: &Particles, ctx: &StepContext, dt: f32) -> bool {
    if ctx.obstacles.is_empty() {
        return false;
    }
    let ends = ctx.anchors.iter().map(|anchor| anchor.end).chain(ctx.grabs.iter().map(|grab| grab.end));
    let places = particles.position.iter().copied().chain(ends);
    let (low, high) = places.fold((Vec3A::INFINITY, Vec3A::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let fastest = particles.velocity.iter().map(|v| v.length_squared()).fold(0.0, f32::max).sqrt();
    let (centre, radius) = ((low + high) / 2.0, low.distance(high) / 2.0);
    // A step ahead, and once more for what it gains in speed.
    let reach = radius + ctx.contact_distance() + 2.0 * fastest * dt + GAINED;
    ctx.obstacles.iter().any(|obstacle| {
        let Obstacle { start, end, shape: Shape::Solid(solid), .. } = obstacle else { return true };
        let way = start.translation.distance(end.translation);
        let is_reached =
            |pose: &Isometry3d| solid.surface(pose.inverse().transform_point(centre)).distance <= reach + way;
        // What turns sweeps over more than it covers at both ends.
        start.rotation != end.rotation || is_reached(start) || is_reached(end)
    })
}

/// Projects all free particles out of all obstacles within the part `span` (0..=1) of the step. Returns the number of
/// contacts.
pub(super) fn project(lanes: &mut Lanes, ctx: &StepContext, span: Range<f32>) -> u32 {
    let mut contacts = 0;
    for obstacle in ctx.obstacles {
        let Shape::Solid(solid) = obstacle.shape else { continue };
        let moving = MovingShape::new(solid, obstacle, ctx.contact_distance(), span.clone());
        let friction = ctx.material.friction * obstacle.friction;
        for i in 0..lanes.slot_count() {
            if lanes.inverse_mass(i) == 0.0 {
                continue;
            }
            let (mut position, mut previous) = (lanes.position.get(i), lanes.previous.get(i));
            if let Some(correction) = moving.correction(position, previous) {
                correction.apply(&mut position, &mut previous, friction);
                lanes.position.set(i, position);
                lanes.previous.set(i, previous);
                contacts += 1;
            }
        }
    }
    contacts
}

/// An obstacle's shape within one substep.
struct MovingShape {
    shape: Solid,
    /// Distance that particles keep from it, m.
    distance: f32,
    start: Isometry3d,
    end: Isometry3d,
    from_world_start: Isometry3d,
    from_world_end: Isometry3d,
    /// Angle that the obstacle turns by, rad.
    turn: f32,
}

/// What brings a particle back to the surface.
struct Correction {
    /// Outward normal of the surface.
    normal: Vec3A,
    /// How far to push along it, m.
    depth: f32,
    /// How deep inside the particle was before the substep, m.
    old_depth: f32,
    /// Way of the surface at the point of contact within the substep, m.
    surface_way: Vec3A,
}

impl MovingShape {
    fn new(shape: Solid, obstacle: &Obstacle, distance: f32, span: Range<f32>) -> Self {
        let (start, end) = (obstacle.pose(span.start), obstacle.pose(span.end));
        // |q1 - q0| is half of the angle, to first order, on the shorter of the two ways around.
        let (q0, q1) = (start.rotation, end.rotation);
        let turn = 2.0 * shorter_way(q0, q1);
        Self { shape, distance, from_world_start: start.inverse(), from_world_end: end.inverse(), start, end, turn }
    }

    /// The correction that a particle needs which went from `previous` to `position`, if it needs one.
    fn correction(&self, position: Vec3A, previous: Vec3A) -> Option<Correction> {
        let local = self.from_world_end.transform_point(position);
        let after = self.surface(local);
        // A particle that is farther away than it can have come this substep is left alone.
        let reach = position.distance(previous)
            + self.start.translation.distance(self.end.translation)
            + self.turn * local.length();
        if after.distance > reach {
            return None;
        }
        let old_local = self.from_world_start.transform_point(previous);
        let before = self.surface(old_local);
        // Seen from another side, a thin or sharp shape would be left on the wrong one: the way in decides.
        let (normal, depth, old_depth) = if before.normal.dot(after.normal) > 0.0 {
            (after.normal, -after.distance, (-before.distance).max(0.0))
        } else {
            let (entry, normal) = self.sweep(old_local, local)?;
            (normal, normal.dot(entry - local), 0.0)
        };
        if depth <= 0.0 {
            return None;
        }
        let touched = local + normal * depth;
        let surface_way = if self.start == self.end {
            Vec3A::ZERO
        } else {
            self.end.transform_point(touched) - self.start.transform_point(touched)
        };
        let normal = self.end.rotation * normal;
        Some(Correction { normal, depth, old_depth: old_depth.min(depth), surface_way })
    }

    /// The surface that particles stay out of, seen from `local`: the shape and the distance kept around it.
    fn surface(&self, local: Vec3A) -> Surface {
        let surface = self.shape.surface(local);
        Surface { distance: surface.distance - self.distance, ..surface }
    }

    /// Where the straight way from `from` to `to` enters the shape, and the normal there. Sphere tracing (Hart 1996).
    fn sweep(&self, from: Vec3A, to: Vec3A) -> Option<(Vec3A, Vec3A)> {
        const CLOSE: f32 = 1e-5;
        const STEPS: u32 = 32;
        let (direction, length) = (to - from).normalize_and_length();
        let mut way = 0.0;
        for _ in 0..STEPS {
            let point = from + direction * way;
            let surface = self.surface(point);
            if surface.distance < CLOSE {
                return Some((point, surface.normal));
            }
            way += surface.distance;
            if way > length {
                return None;
            }
        }
        None
    }
}

impl Correction {
    fn apply(&self, position: &mut Vec3A, previous: &mut Vec3A, friction: f32) {
        *position += self.normal * self.depth;
        // What was inside before this substep leaves without gaining speed from it.
        *previous += self.normal * self.old_depth;
        let way = *position - *previous - self.surface_way;
        let slide = way - self.normal * way.dot(self.normal);
        let hold = friction * (self.depth - self.old_depth);
        let length = slide.length();
        *position -= if length > hold { slide * (hold / length) } else { slide };
    }
}

/// Distance between two unit quaternions as rotations.
fn shorter_way(a: Quat, b: Quat) -> f32 {
    (a - b).length().min((a + b).length())
}
