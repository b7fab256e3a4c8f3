//! What brings particles back to a surface, with friction: it also pushes the body that has the surface.

use bevy_math::Vec3A;
use fearless_simd::{f32x8, prelude::*};

use crate::{
    contact::{
        body::Bodies,
        friction,
        particle::{Contacts8, ccd::Correction},
    },
    layout::simd::{Lane, Vec3x8},
};

/// Below this length (m) a slide has no direction and rests.
const SHORTEST: f32 = 1e-12;

/// How an obstacle holds against particles.
pub(crate) trait Response {
    /// Whether particles move it.
    const MOVES: bool;

    /// Where the particles of a block are then, and where they are to have been before the substep: what was inside leaves
    /// without gaining speed from it.
    fn resolve<S: Simd>(
        simd: S,
        touching: &Contacts8<S>,
        friction: f32,
        bodies: &mut Bodies,
        obstacle: usize,
    ) -> (Vec3x8<S>, Vec3x8<S>);
}

/// One that nothing moves.
pub(crate) struct Kinematic;

/// A body.
pub(crate) struct Dynamic;

impl Response for Kinematic {
    const MOVES: bool = false;

    #[inline(always)]
    fn resolve<S: Simd>(
        _: S,
        touching: &Contacts8<S>,
        friction: f32,
        _: &mut Bodies,
        _: usize,
    ) -> (Vec3x8<S>, Vec3x8<S>) {
        let Contacts8 { place, before, touches, normal, penetration, parted, clamped, slide, .. } = *touching;
        // Where only the particle moves, all directions have its inverse mass, which cancels out: what is held is a length, and
        // particles that stick all need neither a root nor a division.
        let (squared, hold) = (slide.dot(slide), penetration * friction);
        let slides = squared.simd_gt(hold * hold);
        let mut held = slide;
        if slides.any_true() {
            held = (slide * (hold / squared.sqrt())).or(slides, slide);
        }
        let parting = normal * parted;
        (
            (place + normal * (penetration - clamped) + parting - held).or(touches, place),
            (before + parting).or(touches, before),
        )
    }
}

impl Response for Dynamic {
    const MOVES: bool = true;

    /// All eight push at once. Each sees a body of its share of the mass, so that together they don't push it too far
    /// (Tonge et al., "Mass Splitting for Jitter-Free Parallel Rigid Body Simulation", 2012).
    #[inline(always)]
    fn resolve<S: Simd>(
        simd: S,
        touching: &Contacts8<S>,
        friction: f32,
        bodies: &mut Bodies,
        obstacle: usize,
    ) -> (Vec3x8<S>, Vec3x8<S>) {
        let Contacts8 { place, before, inverse_mass, touches, normal, penetration, parted, clamped, slide, .. } =
            *touching;
        let Some(body) = bodies.get(obstacle) else { return (place, before) };
        let zero = f32x8::splat(simd, 0.0);
        let count = touches.to_bitmask().count_ones() as f32;
        let beside = place + normal * penetration - Vec3x8::splat(simd, body.centre.to_array());
        let inertia = body.inverse_inertia;
        let axes = [
            Vec3x8::splat(simd, inertia.x_axis.to_array()),
            Vec3x8::splat(simd, inertia.y_axis.to_array()),
            Vec3x8::splat(simd, inertia.z_axis.to_array()),
        ];
        let own = inverse_mass + count * body.inverse_mass;
        let along_normal = own + turning_inverse_mass(beside, normal, &axes) * count;
        let lambda = penetration / along_normal;
        let length = slide.dot(slide).sqrt();
        let slides = touches & length.simd_gt(SHORTEST);
        let along = slide * (f32x8::splat(simd, 1.0) / length);
        let along_slide = own + turning_inverse_mass(beside, along, &axes) * count;
        let drag = slides.select(friction::drag(length / along_slide, lambda, friction), zero);
        let nothing = Vec3x8::splat(simd, [0.0; 3]);
        let push = (normal * lambda - along.or(slides, nothing) * drag).or(touches, nothing);
        let lever = beside.cross(push);
        let sum = |lanes: Vec3x8<S>| Vec3A::new(sum(lanes.x), sum(lanes.y), sum(lanes.z));
        bodies.push(obstacle, -sum(push), -sum(lever));
        let parting = normal * parted;
        (
            (place + push * inverse_mass - normal * clamped + parting).or(touches, place),
            (before + parting).or(touches, before),
        )
    }
}

/// What a body's turning adds to its inverse mass at places beside its centre, along unit vectors: (r x n) · I⁻¹ (r x n), as
/// in [`MovedBody::inverse_mass_at`](crate::contact::body::MovedBody::inverse_mass_at), but for the order of the sums.
#[inline(always)]
fn turning_inverse_mass<S: Simd>(beside: Vec3x8<S>, direction: Vec3x8<S>, axes: &[Vec3x8<S>; 3]) -> f32x8<S> {
    let lever = beside.cross(direction);
    let [x, y, z] = *axes;
    lever.dot(x * lever.x + y * lever.y + z * lever.z)
}

/// The sum of all lanes, whatever the instructions in the same order.
#[inline(always)]
fn sum<S: Simd>(lanes: f32x8<S>) -> f32 {
    let lanes: Lane = lanes.into();
    let mut sum = 0.0;
    for value in lanes {
        sum += value;
    }
    sum
}

/// Brings one particle back to a surface, with friction: at `position` and before the substep at `previous`.
pub(crate) fn one(
    correction: &Correction,
    [position, previous]: [&mut Vec3A; 2],
    inverse_mass: f32,
    friction: f32,
    bodies: &mut Bodies,
    obstacle: usize,
) {
    let Correction { normal, penetration, parted, clamped, surface_way } = *correction;
    let displacement = *position - *previous - surface_way;
    let beside = |centre: Vec3A| *position + normal * penetration - centre;
    let effective_inverse_mass = |direction: Vec3A| {
        let of_body = bodies.get(obstacle).map_or(0.0, |body| body.inverse_mass_at(beside(body.centre), direction));
        inverse_mass + of_body
    };
    let lambda = penetration / effective_inverse_mass(normal);
    let push = friction::impulse([normal, displacement], lambda, friction, effective_inverse_mass);
    if let Some(centre) = bodies.get(obstacle).map(|body| body.centre) {
        bodies.push(obstacle, -push, -beside(centre).cross(push));
    }
    *position += push * inverse_mass + normal * (parted - clamped);
    *previous += normal * parted;
}
