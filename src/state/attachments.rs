//! What a cloth hangs on: its pins, the anchors that these follow, and its tethers.

use bevy::{math::Vec3A, prelude::*};

use super::{ClothState, PinAnchor};
use crate::{
    pins::PinTarget,
    solver::{
        Tether, Tethers,
        build::{
            blend::{BlendWeightBuild, BlendWeights},
            geodesic::TetherBuild,
        },
    },
};

/// What a cloth hangs on: pins and tethers. Comes with [`Cloth`](crate::prelude::Cloth).
#[derive(Component, Clone, Debug, Default)]
#[component(clone_behavior = Ignore)]
pub struct ClothAttachments {
    /// Fixed particles and what they follow, by their number.
    pub(crate) pins: Vec<HeldPin>,
    /// What the pins follow: one for each of their targets.
    pub(crate) anchors: Vec<PinAnchor>,
    /// Particles that are fixed to bodies which give way: they hold no tethers.
    pub(crate) on_bodies: Vec<u32>,
    /// Tethers to the pins, as long as they are at the present scale.
    pub(super) tethers: Tethers,
    /// The same as long as they were built, while the cloth is at another scale.
    pub(super) built_tethers: Option<Box<Tethers>>,
    /// Tethers that are being worked out anew.
    pub(crate) tether_build: Option<Box<TetherBuild>>,
    /// By which weights particles are drawn with several anchors.
    pub(crate) blend_weights: Option<BlendWeights>,
    /// Weights that are being worked out anew.
    pub(crate) blend_build: Option<Box<BlendWeightBuild>>,
}

/// A fixed particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeldPin {
    pub particle: u32,
    pub target: PinTarget,
    /// Which of the cloth's anchors that is.
    pub anchor: u32,
    /// Its place in the target's own space, once the target has a pose that can be followed; for
    /// [`PinTarget::World`] its place relative to the cloth's origin.
    pub offset: Option<Vec3A>,
}

impl ClothAttachments {
    /// Tethers to the pins, as pairs of a particle and the particle that holds it.
    pub fn tethers(&self) -> impl Iterator<Item = Tether> {
        self.tethers.iter()
    }

    /// The tethers as the solver takes them.
    pub(crate) fn as_tethers(&self) -> &Tethers {
        &self.tethers
    }

    /// Takes tethers of the cloth as it was built.
    pub(crate) fn set_tethers(&mut self, state: &mut ClothState, tethers: Tethers) {
        if let Some(built) = &mut self.built_tethers {
            (**built).clone_from(&tethers);
            // They are as long as they are to be once the scale has been looked at.
            state.rest_scale.forget_metric();
        }
        self.tethers = tethers;
        state.is_disturbed = true;
    }

    /// Drops the tethers to all pins but some.
    pub(crate) fn keep_tethers(&mut self, is_kept: impl Fn(u32) -> bool) {
        if let Some(built) = &mut self.built_tethers {
            built.keep(&is_kept);
        }
        self.tethers.keep(is_kept);
    }

    /// Begins to work out the tethers to the pins that are on no body: a tether doesn't pull at its pin.
    pub(crate) fn begin_tethers(&mut self) {
        let pins = self.pins.iter().map(|pin| pin.particle);
        let holding = pins.filter(|particle| !self.on_bodies.contains(particle));
        self.tether_build = Some(Box::new(TetherBuild::begin(holding.collect())));
    }

    /// Places of the pins to the world, which are relative to the cloth's origin.
    pub(super) fn world_places(&mut self) -> impl Iterator<Item = &mut Vec3A> {
        self.pins.iter_mut().filter(|pin| pin.target == PinTarget::World).filter_map(|pin| pin.offset.as_mut())
    }
}

impl ClothState {
    /// Gives free particles their mass, and `pins` none that could be moved.
    pub(crate) fn set_masses(&mut self, pins: &[HeldPin]) {
        let Some(material) = &self.material else { return };
        self.is_disturbed = true;
        let mut is_fixed = vec![false; self.particles.len()];
        for pin in pins {
            is_fixed[pin.particle as usize] = true;
        }
        self.particles.set_masses(&self.topology, material, |i| is_fixed[i]);
    }
}
