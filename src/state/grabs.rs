//! Holding a cloth by hand: points of it that follow targets.

use std::sync::Arc;

use bevy::{math::Vec3A, prelude::*};

use super::{ClothPoint, ClothState};
use crate::solver::{self, GrabTether};

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
    /// Takes the nearest values that are in range in place of what is negative, NaN or too large to compute with.
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

/// A hold on a cloth, from [`ClothGrabs::grab`] to [`ClothGrabs::release`]. The next one on that cloth is another.
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

/// The hands that hold a cloth: for pointers, VR controllers and scripts. Comes with [`Cloth`](crate::prelude::Cloth).
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_drape::prelude::*;
/// fn lift(mut cloths: Query<(&ClothState, &mut ClothGrabs)>) {
///     for (state, mut grabs) in &mut cloths {
///         let Some(point) = state.nearest_point(Vec3::ZERO) else { continue };
///         if let Some(grab) = grabs.grab(state, point, ClothGrip::default()) {
///             grabs.move_grab(grab, Vec3::Y); // And later: grabs.release(grab).
///         }
///     }
/// }
/// ```
#[derive(Component, Clone, Debug, Default)]
#[component(clone_behavior = Ignore)]
pub struct ClothGrabs {
    pub(crate) held: Vec<HeldGrab>,
    /// Number of grabs so far.
    count: u32,
    /// Those that have ended and nobody has been told of, and where, if the cloth is elsewhere by now.
    pub(crate) ended: Vec<(HeldGrab, Option<Vec3>)>,
}

/// A grabbed point.
#[derive(Clone, Debug)]
pub(crate) struct HeldGrab {
    pub id: GrabId,
    pub point: ClothPoint,
    pub grip: ClothGrip,
    /// World position that the point is to go to, m.
    pub target: Vec3,
    /// How far it has been led there, m, relative to the cloth's origin.
    pub led: Vec3A,
    pub tethers: Arc<[GrabTether]>,
    pub is_told: bool,
}

impl ClothGrabs {
    /// Takes hold of a point of the cloth whose `state` this is, where it is now. None where there is no such point.
    ///
    /// Any number of hands can hold a cloth. What is pinned stays pinned.
    pub fn grab(&mut self, state: &ClothState, point: ClothPoint, grip: ClothGrip) -> Option<GrabId> {
        let position = state.point_position(point).filter(|_| point.is_on_triangle())?;
        let triangle = state.topology.triangles[point.triangle as usize];
        let tethers = solver::grab_tethers(&state.topology, triangle, point.weights.to_array()).into();
        let id = GrabId(self.count);
        self.count += 1;
        self.held.push(HeldGrab {
            id,
            point,
            grip: grip.in_range(),
            target: position,
            led: Vec3A::from(position - state.origin),
            tethers,
            is_told: false,
        });
        Some(id)
    }

    /// Leads a grabbed point to a world position, m. It follows at no more than its grip's speed and force. False where
    /// the hold has ended or the target isn't finite.
    pub fn move_grab(&mut self, grab: GrabId, target: Vec3) -> bool {
        let held = self.held.iter_mut().find(|held| held.id == grab).filter(|_| target.is_finite());
        held.map(|held| held.target = target).is_some()
    }

    /// Lets go of a grabbed point, which keeps the speed that it has. False where the hold has ended already.
    pub fn release(&mut self, grab: GrabId) -> bool {
        let found = self.held.iter().position(|held| held.id == grab);
        found.map(|index| self.ended.push((self.held.remove(index), None))).is_some()
    }

    /// All grabbed points and the world positions that they are led to, m.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (GrabId, ClothPoint, Vec3)> {
        self.held.iter().map(|held| (held.id, held.point, held.target))
    }

    /// Number of hands that hold the cloth.
    pub fn len(&self) -> usize {
        self.held.len()
    }

    /// Whether no hand holds the cloth.
    pub fn is_empty(&self) -> bool {
        self.held.is_empty()
    }

    /// Lets go of everything: the cloth whose `state` this is is about to be somewhere else.
    pub(crate) fn release_all(&mut self, state: &ClothState) {
        let ended = self.held.drain(..).map(|held| {
            let position = state.point_position(held.point).unwrap_or(held.target);
            (held, Some(position))
        });
        self.ended.extend(ended);
    }

    /// The cloth's origin has moved by `by` (m), and nothing else.
    pub(super) fn shift_origin(&mut self, by: Vec3A) {
        for held in &mut self.held {
            held.led -= by;
        }
    }

    /// The world has been shifted by `by` (m), and what is in it.
    pub(super) fn shift_world(&mut self, by: Vec3) {
        for held in &mut self.held {
            held.target += by;
        }
        for position in self.ended.iter_mut().filter_map(|(_, position)| position.as_mut()) {
            *position += by;
        }
    }
}
