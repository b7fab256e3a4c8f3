//! What is held follows its pointer, until it is let go.

use bevy::{
    camera::NormalizedRenderTarget,
    ecs::system::SystemParam,
    input::mouse::MouseScrollUnit,
    math::{ops, primitives::InfinitePlane3d},
    picking::{
        backend::ray::{RayId, RayMap},
        pointer::{Location, PointerAction, PointerButton, PointerId, PointerInput, PointerLocation, PointerPress},
    },
    prelude::*,
};

use super::{ClothPickingSettings, PointerGrabs};
use crate::{
    commands::ClothCommands,
    pins::Pins,
    state::{ClothGrabs, ClothPoint, ClothState, GrabId},
};

/// Pixels of a wheel that counts in pixels for one line.
const PIXELS_PER_LINE: f32 = 40.0;

/// A cloth in the grip of a pointer.
#[derive(Clone, Debug)]
pub(super) struct Hold {
    pub pointer: PointerId,
    /// Window or image that the pointer is on.
    pub target: NormalizedRenderTarget,
    pub camera: Entity,
    pub cloth: Entity,
    pub grab: GrabId,
    /// Distance of the plane that the point moves in from the camera, m, along its view.
    pub depth: f32,
    /// Distance to the second finger, pixels, while there is one.
    pub spread: Option<f32>,
}

/// The pointers and what they see.
#[derive(SystemParam)]
pub(super) struct Pointers<'w, 's> {
    all: Query<'w, 's, (&'static PointerId, &'static PointerLocation, &'static PointerPress)>,
    cameras: Query<'w, 's, (&'static Camera, &'static GlobalTransform)>,
    rays: Res<'w, RayMap>,
}

/// Leads every held point to its pointer, and lets go of those whose pointer has.
pub(super) fn follow_pointers(
    mut commands: Commands,
    mut grabs: ResMut<PointerGrabs>,
    mut cloths: Query<(&ClothState, &mut ClothGrabs)>,
    mut inputs: MessageReader<PointerInput>,
    pointers: Pointers,
    settings: Res<ClothPickingSettings>,
    keys: Option<Res<ButtonInput<KeyCode>>>,
) {
    let inputs: Vec<&PointerInput> = inputs.read().collect();
    let is_pinning =
        settings.pin_on_release || keys.is_some_and(|keys| keys.any_pressed(settings.pin_keys.iter().copied()));
    let busy: Vec<PointerId> = grabs.holds.iter().map(|hold| hold.pointer).collect();
    grabs.holds.retain_mut(|hold| {
        // The cloth may be gone, or was put back, and the hold with it.
        let Ok((state, mut held)) = cloths.get_mut(hold.cloth) else { return false };
        let Some((_, point, _)) = held.iter().find(|&(grab, ..)| grab == hold.grab) else { return false };
        let own = || inputs.iter().filter(|input| input.pointer_id == hold.pointer);
        let is_cancelled = own().any(|input| matches!(input.action, PointerAction::Cancel));
        if is_cancelled || !pointers.presses(hold.pointer, settings.button) {
            held.release(hold.grab);
            if is_pinning && !is_cancelled {
                commands.entity(hold.cloth).pin_cloth(pins_at(state, point).to(settings.pin_to));
            }
            return false;
        }
        let lines: f32 = own().map(|input| lines_of(&input.action)).sum();
        hold.depth *= ops::exp(lines * settings.wheel_step) * hold.pinch(&pointers, &busy);
        if let Some(place) = pointers.place_of(hold) {
            held.move_grab(hold.grab, place);
        }
        true
    });
}

/// How far the wheel has been turned away from the user.
fn lines_of(action: &PointerAction) -> f32 {
    match *action {
        PointerAction::Scroll { unit: MouseScrollUnit::Line, y, .. } => y,
        PointerAction::Scroll { unit: MouseScrollUnit::Pixel, y, .. } => y / PIXELS_PER_LINE,
        _ => 0.0,
    }
}

/// Pins for the particles of a point's triangle, by a vertex of each.
fn pins_at(state: &ClothState, point: ClothPoint) -> Pins {
    let particles = state.triangles().get(point.triangle as usize).into_iter().flatten();
    let vertex_of = |particle| (0..).zip(&*state.particle_of_vertex).find(|&(_, other)| other == particle);
    Pins::indices(particles.filter_map(vertex_of).map(|(vertex, _)| vertex))
}

pub(super) fn is_pressed(press: &PointerPress, button: PointerButton) -> bool {
    match button {
        PointerButton::Primary => press.is_primary_pressed(),
        PointerButton::Secondary => press.is_secondary_pressed(),
        PointerButton::Middle => press.is_middle_pressed(),
    }
}

impl Hold {
    /// Factor on the distance from the camera by which a second finger has moved since the last frame: as in a zoom,
    /// fingers that part bring the point nearer.
    fn pinch(&mut self, pointers: &Pointers, busy: &[PointerId]) -> f32 {
        let before = self.spread;
        self.spread = pointers.spread(self, busy);
        match (before, self.spread) {
            (Some(before), Some(now)) if before > 0.0 && now > 0.0 => before / now,
            _ => 1.0,
        }
    }
}

impl Pointers<'_, '_> {
    fn presses(&self, pointer: PointerId, button: PointerButton) -> bool {
        self.all.iter().any(|(&id, _, press)| id == pointer && is_pressed(press, button))
    }

    fn location(&self, hold: &Hold) -> Option<&Location> {
        let (_, location, _) = self.all.iter().find(|&(&id, ..)| id == hold.pointer)?;
        location.location().filter(|location| location.target == hold.target)
    }

    /// Where a pointer leads what it holds, m: its ray meets the plane at the hold's distance. None while the pointer is
    /// nowhere, or the camera is gone.
    fn place_of(&self, hold: &Hold) -> Option<Vec3> {
        let (camera, view) = self.cameras.get(hold.camera).ok()?;
        let ray = self.rays.map.get(&RayId::new(hold.camera, hold.pointer)).copied();
        // Beyond the camera's viewport, the pointer has a place in its plane all the same.
        let ray = ray.or_else(|| camera.viewport_to_world(view, self.location(hold)?.position).ok())?;
        let (place, forward) = (view.translation(), view.forward());
        ray.plane_intersection_point(place + forward * hold.depth, InfinitePlane3d::new(forward))
    }

    /// Distance to a finger that is down elsewhere and holds nothing, pixels.
    fn spread(&self, hold: &Hold, busy: &[PointerId]) -> Option<f32> {
        let own = self.location(hold).filter(|_| hold.pointer.is_touch())?;
        let other = self.all.iter().find_map(|(id, location, press)| {
            let is_free = id.is_touch() && press.is_any_pressed() && !busy.contains(id);
            location.location().filter(|location| is_free && location.target == own.target)
        })?;
        Some(own.position.distance(other.position))
    }
}
