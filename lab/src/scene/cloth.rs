//! One cloth of a scene, and what it hangs by.

use bevy::{math::Vec3A, prelude::*};
use bevy_drape::solver::{Particles, PinMotion, Scratch, StepSettings, Tethers, Topology};

/// A cloth.
pub struct Cloth {
    pub topology: Topology,
    pub particles: Particles,
    pub rig: Rig,
    pub scratch: Scratch,
    /// Time that the topology took, ms.
    pub build_ms: f64,
    /// Time that the tethers took, ms.
    pub tethers_ms: f64,
}

/// What a cloth hangs by, and how it is solved.
pub struct Rig {
    pub pin_motions: Vec<PinMotion>,
    pub tethers: Option<Tethers>,
    pub settings: StepSettings,
}

impl Cloth {
    /// Puts each particle where `place` says for its place at rest.
    pub fn placed(mut self, place: impl Fn(Vec3) -> Vec3A) -> Self {
        for (position, &rest) in self.particles.position.iter_mut().zip(&self.topology.rest) {
            *position = place(rest);
        }
        self
    }

    /// Holds the particles of which `is_held` is true at rest, where they are now.
    pub fn held(mut self, is_held: impl Fn(Vec3) -> bool) -> Self {
        let held: Vec<u32> =
            (0..).zip(&self.topology.rest).filter(|(_, rest)| is_held(**rest)).map(|(i, _)| i).collect();
        self.hold(&held);
        self
    }

    /// Holds these particles where they are.
    pub fn hold(&mut self, pins: &[u32]) {
        for &particle in pins {
            let place = self.particles.position[particle as usize];
            self.particles.inverse_mass[particle as usize] = 0.0;
            self.rig.pin_motions.push(PinMotion { particle, start: place, end: place });
        }
    }

    /// Leads all that is held to where `place` says for its place at rest, within the next frame.
    pub fn lead(&mut self, place: impl Fn(Vec3) -> Vec3A) {
        for anchor in &mut self.rig.pin_motions {
            anchor.start = anchor.end;
            anchor.end = place(self.topology.rest[anchor.particle as usize]);
        }
    }
}
