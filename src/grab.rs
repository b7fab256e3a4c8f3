//! Holding a cloth by hand: points of it follow targets. For pointers, VR hands and scripts.

use std::sync::Arc;

use bevy::{math::Vec3A, prelude::*};

use crate::{
    build,
    cloth::ClothStatus,
    solver::{Grab, GrabTether},
    state::ClothState,
};

mod point;

pub use point::ClothPoint;
#[cfg(feature = "debug")]
pub(crate) use point::blend;

/// How firmly a hand holds a cloth. A value out of its range counts as the nearest one within.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub struct ClothGrip {
    /// Stiffness of the pull in N/m. 1000 and more hold a cloth's weight within millimetres.
    pub stiffness: f32,
    /// Damping of the pull in N·s/m. 0 to 50.
    pub damping: f32,
    /// Largest force of the pull in N. 20 for a firm hand. It lifts more than that: tethers carry cloth along without
    /// weighing on the hand.
    pub max_force: f32,
    /// How fast the target may lead the cloth in m/s. 2 to 6: one that jumps is caught up with.
    pub max_speed: f32,
    /// Mass of the hand in kg, which the point that it holds has in addition. 0.02 to 0.2: the heavier, the more steadily
    /// it leads the cloth, and the less it is held back by it.
    pub mass: f32,
}

impl Default for ClothGrip {
    fn default() -> Self {
        Self { stiffness: 5000.0, damping: 10.0, max_force: 20.0, max_speed: 4.0, mass: 0.05 }
    }
}

impl ClothGrip {
    /// The same without anything negative, NaN or too large to reckon with.
    fn in_range(self) -> Self {
        let bounded = |value: f32| if value.is_nan() { 0.0 } else { value.clamp(0.0, 1e9) };
        Self {
            stiffness: bounded(self.stiffness),
            damping: bounded(self.damping),
            max_force: bounded(self.max_force),
            max_speed: bounded(self.max_speed),
            mass: bounded(self.mass),
        }
    }
}

/// A hold on a cloth, from [`ClothState::grab`] to [`ClothState::release`]. The next one on that cloth is another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Reflect)]
#[reflect(Debug, Clone, PartialEq, Hash)]
pub struct GrabId(u32);

/// A cloth has been grabbed. Sent in `PostUpdate` of the frame in which that happened.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq)]
pub struct ClothGrabbed {
    /// The cloth.
    pub entity: Entity,
    /// The hold.
    pub grab: GrabId,
    /// Where on the cloth.
    pub point: ClothPoint,
    /// Where in the world, m.
    pub position: Vec3,
}

/// A hold on a cloth has ended: it was let go, or the cloth was reset, rebuilt or teleported. Sent in `PostUpdate` of the
/// frame in which that happened, and not at all where the cloth is gone.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq)]
pub struct ClothReleased {
    /// The cloth.
    pub entity: Entity,
    /// The hold that has ended.
    pub grab: GrabId,
    /// Where on the cloth.
    pub point: ClothPoint,
    /// Where in the world, m.
    pub position: Vec3,
}

/// All that holds a cloth, and what nobody has been told of yet.
#[derive(Clone, Debug, Default)]
pub(crate) struct Grabs {
    held: Vec<HeldGrab>,
    /// Number of grabs so far.
    count: u32,
    /// Those that have ended, and where.
    ended: Vec<(HeldGrab, Vec3)>,
}

/// A grabbed point.
#[derive(Clone, Debug)]
struct HeldGrab {
    id: GrabId,
    point: ClothPoint,
    grip: ClothGrip,
    /// World position that the point is to go to, m.
    target: Vec3,
    /// How far it has been led there, m, relative to the cloth's origin.
    led: Vec3A,
    tethers: Arc<[GrabTether]>,
    is_told: bool,
}

impl ClothState {
    /// Takes hold of a point of the cloth, where it is now. None where there is no such point.
    ///
    /// Any number of hands can hold a cloth. What is pinned stays pinned.
    pub fn grab(&mut self, point: ClothPoint, grip: ClothGrip) -> Option<GrabId> {
        let position = self.point_position(point).filter(|_| point.is_on_triangle())?;
        let triangle = self.topology.triangles[point.triangle as usize];
        let tethers = build::grab_tethers(&self.topology, triangle, point.weights.to_array()).into();
        let id = GrabId(self.grabs.count);
        self.grabs.count += 1;
        self.grabs.held.push(HeldGrab {
            id,
            point,
            grip: grip.in_range(),
            target: position,
            led: Vec3A::from(position - self.origin),
            tethers,
            is_told: false,
        });
        Some(id)
    }

    /// Leads a grabbed point to a world position, m. It follows at no more than its grip's speed and force. False where
    /// the hold has ended or the target isn't finite.
    pub fn move_grab(&mut self, grab: GrabId, target: Vec3) -> bool {
        let held = self.grabs.held.iter_mut().find(|held| held.id == grab).filter(|_| target.is_finite());
        held.map(|held| held.target = target).is_some()
    }

    /// Lets go of a grabbed point, which keeps the speed that it has. False where the hold has ended already.
    pub fn release(&mut self, grab: GrabId) -> bool {
        let found = self.grabs.held.iter().position(|held| held.id == grab);
        found.map(|index| self.end_grab(index)).is_some()
    }

    /// All grabbed points and the world positions that they are led to, m.
    pub fn grabs(&self) -> impl ExactSizeIterator<Item = (GrabId, ClothPoint, Vec3)> {
        self.grabs.held.iter().map(|held| (held.id, held.point, held.target))
    }

    /// Whether anything holds the cloth by hand.
    pub fn is_grabbed(&self) -> bool {
        !self.grabs.held.is_empty()
    }

    /// Lets go of everything: the cloth is about to be somewhere else.
    pub(crate) fn release_all(&mut self) {
        while !self.grabs.held.is_empty() {
            self.end_grab(0);
        }
    }

    fn end_grab(&mut self, index: usize) {
        let held = self.grabs.held.remove(index);
        let position = self.point_position(held.point).unwrap_or(held.target);
        self.grabs.ended.push((held, position));
    }
}

impl Grabs {
    /// Carries the points' ways along with the cloth's origin.
    pub fn shift(&mut self, shift: Vec3A) {
        for held in &mut self.held {
            held.led -= shift;
        }
    }

    /// Carries what is in the world along with it.
    pub fn shift_targets(&mut self, by: Vec3) {
        for held in &mut self.held {
            held.target += by;
        }
        for (_, position) in &mut self.ended {
            *position += by;
        }
    }
}

/// Plans the way of every grabbed point over the coming step.
pub(crate) fn lead_grabs(mut cloths: Query<(&mut ClothState, &ClothStatus)>, time: Res<Time>) {
    for (mut state, status) in &mut cloths {
        if *status != ClothStatus::Ready || state.grabs.held.is_empty() && state.work.grabs.is_empty() {
            continue;
        }
        let ClothState { grabs, work, topology, origin, settings, .. } = &mut *state;
        let has_tethers = settings.tether_slack.is_some();
        work.grabs.clear();
        work.grabs.extend(grabs.held.iter_mut().map(|held| {
            let triangle = topology.triangles[held.point.triangle as usize];
            let start = held.led;
            held.led = start.move_towards(Vec3A::from(held.target - *origin), held.grip.max_speed * time.delta_secs());
            Grab {
                particles: triangle,
                weights: held.point.weights.to_array(),
                start,
                end: held.led,
                stiffness: held.grip.stiffness,
                damping: held.grip.damping,
                max_force: held.grip.max_force,
                mass: held.grip.mass,
                tethers: if has_tethers { held.tethers.clone() } else { Arc::default() },
            }
        }));
    }
}

/// Tells of grabs that have begun or ended.
pub(crate) fn send_grab_events(mut commands: Commands, mut cloths: Query<(Entity, &mut ClothState)>) {
    for (entity, mut state) in &mut cloths {
        let state = state.bypass_change_detection();
        if state.grabs.held.iter().all(|held| held.is_told) && state.grabs.ended.is_empty() {
            continue;
        }
        let mut grabs = core::mem::take(&mut state.grabs);
        let grabbed = |held: &HeldGrab, position| ClothGrabbed { entity, grab: held.id, point: held.point, position };
        for (held, position) in grabs.ended.drain(..) {
            if !held.is_told {
                commands.trigger(grabbed(&held, position));
            }
            commands.trigger(ClothReleased { entity, grab: held.id, point: held.point, position });
        }
        for held in grabs.held.iter_mut().filter(|held| !held.is_told) {
            held.is_told = true;
            commands.trigger(grabbed(held, state.point_position(held.point).unwrap_or(held.target)));
        }
        state.grabs = grabs;
    }
}
