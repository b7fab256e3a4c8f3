//! Marks on a cloth: pins, grabs, normals and bounds.

use bevy::{math::Vec3A, prelude::*};

use super::{Lines, Shown, palette};
use crate::state::{blend, shown_normals};

pub(super) fn draw_pins(lines: &mut Lines, shown: &Shown, size: f32) {
    for pin in &shown.attachments.pins {
        lines.cross(shown.places[pin.particle as usize], size, palette::pin(pin.target));
    }
}

/// Draws where the cloth is held, and where to.
pub(super) fn draw_grabs(lines: &mut Lines, shown: &Shown, size: f32) {
    for (_, point, target) in shown.grabs.iter() {
        let Some(triangle) = shown.state.triangles().get(point.triangle as usize) else { continue };
        let held = blend(triangle.map(|i| shown.drawn.particles[i as usize]), point.weights);
        let held = Vec3::from(shown.to_world.transform_point3a(held));
        lines.sphere(held, size, palette::GRAB).resolution(12);
        lines.line(held, target, palette::GRAB);
    }
}

pub(super) fn draw_normals(lines: &mut Lines, shown: &Shown, length: f32) {
    let to_world = shown.to_world.matrix3;
    // In the world's directions, but not at its distances: those have precision near the entity.
    let particles: Vec<Vec3A> = shown.drawn.particles.iter().map(|&p| to_world * p).collect();
    let normals = shown_normals(shown.state.triangles(), &particles, &to_world);
    for (&place, normal) in shown.places.iter().zip(normals) {
        lines.ray(place, normal * length, palette::NORMAL);
    }
}

pub(super) fn draw_bounds(lines: &mut Lines, shown: &Shown) {
    if let Some(bounds) = shown.drawn.bounds {
        lines.aabb_3d(bounds, shown.to_world, palette::BOUNDS);
    }
}
