//! A press takes hold of the point under the pointer.

use bevy::{
    picking::{
        backend::ray::{RayId, RayMap},
        events::{Pointer, Press},
        mesh_picking::ray_cast::{MeshRayCast, MeshRayCastSettings, RayCastVisibility, RayMeshHit},
        pointer::{PointerButton, PointerId, PointerPress},
    },
    prelude::*,
    window::{CursorGrabMode, CursorOptions},
};

use super::{
    ClothPickingSettings, PointerGrabs,
    hold::{Hold, is_pressed},
};
use crate::{build::weld::NO_PARTICLE, draw::mesh::ClothMesh, grab::ClothPoint, state::ClothState};

/// Grabs the cloth that is pressed, if it is the nearest thing under the pointer.
pub(super) fn on_press(
    press: On<Pointer<Press>>,
    mut cloths: Query<(&mut ClothState, &ClothMesh)>,
    cameras: Query<&GlobalTransform, With<Camera>>,
    pointers: Query<(&PointerId, &PointerPress)>,
    cursors: Query<&CursorOptions>,
    settings: Res<ClothPickingSettings>,
    mut grabs: ResMut<PointerGrabs>,
    rays: Res<RayMap>,
    mut ray_cast: MeshRayCast,
) {
    let (entity, pointer) = (press.entity, press.pointer_id);
    let is_other = entity != press.original_event_target();
    if is_other || !settings.enabled || press.button != settings.button || grabs.held_by(pointer).is_some() {
        return;
    }
    let Ok((mut state, mesh)) = cloths.get_mut(entity) else { return };
    // The pointer turns the camera: with another button, or locked in place by one that follows the mouse.
    let is_busy = pointers.iter().any(|(&id, press)| id == pointer && other_button(press, settings.button));
    let is_locked = cursors.iter().any(|cursor| cursor.grab_mode == CursorGrabMode::Locked);
    if is_busy || is_locked && pointer == PointerId::Mouse {
        return;
    }
    let camera = press.hit.camera;
    let (Ok(view), Some(&ray)) = (cameras.get(camera), rays.map.get(&RayId::new(camera, pointer))) else { return };
    let is_cloth = |hit: Entity| hit == entity;
    let only_cloth = MeshRayCastSettings::default().with_filter(&is_cloth).with_visibility(RayCastVisibility::Any);
    let Some((_, hit)) = ray_cast.cast_ray(ray, &only_cloth).first() else { return };
    let Some(point) = point_of(&state, mesh, hit) else { return };
    let Some(grab) = state.grab(point, settings.grip) else { return };
    let depth = (hit.point - view.translation()).dot(*view.forward());
    let target = press.pointer_location.target.clone();
    grabs.holds.push(Hold { pointer, target, camera, cloth: entity, grab, point, depth, spread: None });
}

fn other_button(press: &PointerPress, button: PointerButton) -> bool {
    PointerButton::iter().any(|other| other != button && is_pressed(press, other))
}

/// The point of the cloth that a ray has hit on its drawn mesh.
fn point_of(state: &ClothState, mesh: &ClothMesh, hit: &RayMeshHit) -> Option<ClothPoint> {
    let vertices = mesh.binding.triangles.get(hit.triangle_index?)?;
    let particles = vertices.map(|vertex| mesh.binding.particle_of_vertex[vertex as usize]);
    let weight_of = |particle: u32| {
        let corner = particles.iter().position(|&other| other == particle && other != NO_PARTICLE)?;
        Some(hit.barycentric_coords[corner].max(0.0))
    };
    let weights_in = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(weight_of);
        Some(Vec3::new(a?, b?, c?))
    };
    let mut found = (0..).zip(state.triangles()).filter_map(|(index, triangle)| Some((index, weights_in(triangle)?)));
    let (triangle, weights) = found.next()?;
    Some(ClothPoint { triangle, weights: weights / weights.element_sum() })
}
