//! A press takes hold of the point under the pointer.

use bevy::{
    ecs::system::SystemParam,
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
use crate::{
    draw::{ClothMesh, DrawnMesh},
    garment::ClothPartOf,
    proxy::ClothProxy,
    state::{ClothGrabs, ClothPoint, ClothState},
};

/// Who points, from where, and at what.
#[derive(SystemParam)]
pub(super) struct Sight<'w, 's> {
    pointers: Query<'w, 's, (&'static PointerId, &'static PointerPress)>,
    cursors: Query<'w, 's, &'static CursorOptions>,
    cameras: Query<'w, 's, &'static GlobalTransform, With<Camera>>,
    rays: Res<'w, RayMap>,
    ray_cast: MeshRayCast<'w, 's>,
    #[cfg(feature = "panel")]
    egui: Query<'w, 's, &'static mut bevy_egui::EguiContext>,
}

/// Grabs the cloth that is pressed, if it is the nearest thing under the pointer.
pub(super) fn on_press(
    press: On<Pointer<Press>>,
    mut cloths: Query<(&ClothState, &mut ClothGrabs, &ClothMesh)>,
    (parts, proxies): (Query<&ClothPartOf>, Query<&ClothProxy>),
    mut grabs: ResMut<PointerGrabs>,
    settings: Res<ClothPickingSettings>,
    mut sight: Sight,
) {
    let (entity, pointer, camera) = (press.entity, press.pointer_id, press.hit.camera);
    // Presses are told to the parents of what was pressed as well.
    let is_other = entity != press.original_event_target() || press.button != settings.button;
    if is_other || !settings.enabled || grabs.held_by(pointer).is_some() || sight.turns_camera(pointer, press.button) {
        return;
    }
    #[cfg(feature = "panel")]
    if sight.has_egui_at(press.pointer_location.position) {
        return;
    }
    let whole = parts.get(entity).map_or(entity, |part| part.0);
    let driver = proxies.get(whole).ok().map(|proxy| proxy.driver);
    let cloth = driver.unwrap_or(whole);
    let Ok((state, mut held, mesh)) = cloths.get_mut(cloth) else { return };
    let Some((hit, depth)) = sight.look(entity, pointer, camera) else { return };
    let point = match driver {
        // A fine mesh, and the coarse cloth beneath it.
        Some(_) => state.nearest_point(hit.point),
        None => mesh.drawn_by(entity).and_then(|drawn| point_of(state, mesh, drawn, &hit)),
    };
    let Some(point) = point else { return };
    let Some(grab) = held.grab(state, point, settings.grip) else { return };
    let target = press.pointer_location.target.clone();
    grabs.holds.push(Hold { pointer, target, camera, cloth, grab, depth, spread: None });
}

impl Sight<'_, '_> {
    /// Whether a pointer turns the camera: with another button, or locked in place by one that follows the mouse.
    fn turns_camera(&self, pointer: PointerId, button: PointerButton) -> bool {
        let is_busy = |(&id, press): (&PointerId, &PointerPress)| id == pointer && other_button(press, button);
        let is_locked = |cursor: &CursorOptions| cursor.grab_mode == CursorGrabMode::Locked;
        self.pointers.iter().any(is_busy) || pointer == PointerId::Mouse && self.cursors.iter().any(is_locked)
    }

    /// Whether egui has anything at a position, in logical pixels. It keeps pointers that it knows of away from the scene
    /// by itself, but of a finger that has just come down it knows in the next frame only.
    #[cfg(feature = "panel")]
    fn has_egui_at(&mut self, position: Vec2) -> bool {
        use bevy_egui::egui::{Order, pos2};
        self.egui.iter_mut().any(|mut egui| {
            let layer = egui.get_mut().layer_id_at(pos2(position.x, position.y));
            layer.is_some_and(|layer| layer.order != Order::Background)
        })
    }

    /// Where a pointer's ray hits an entity's mesh, and how far from the camera that is, m, along its view.
    fn look(&mut self, entity: Entity, pointer: PointerId, camera: Entity) -> Option<(RayMeshHit, f32)> {
        let view = self.cameras.get(camera).ok()?;
        let &ray = self.rays.map.get(&RayId::new(camera, pointer))?;
        let is_it = |hit: Entity| hit == entity;
        let only = MeshRayCastSettings::default().with_filter(&is_it).with_visibility(RayCastVisibility::Any);
        let (_, hit) = self.ray_cast.cast_ray(ray, &only).first()?;
        Some((hit.clone(), (hit.point - view.translation()).dot(*view.forward())))
    }
}

fn other_button(press: &PointerPress, button: PointerButton) -> bool {
    PointerButton::iter().any(|other| other != button && is_pressed(press, other))
}

/// The point of the cloth that a ray has hit on its drawn mesh.
fn point_of(state: &ClothState, mesh: &ClothMesh, drawn: &DrawnMesh, hit: &RayMeshHit) -> Option<ClothPoint> {
    let vertices = mesh.binding.triangles.get(drawn.span.first_triangle + hit.triangle_index?)?;
    let particles = vertices.map(|vertex| mesh.binding.particle_of_vertex[vertex as usize]);
    let weight_of = |particle: u32| {
        let corner = particles.iter().position(|&other| other == particle)?;
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
