//! Tethers: a particle may not be farther from a pin than the cloth between them is long.
//!
//! ```text
//!   pin o~~~~~~~~~~~~~~~~ particle       |x - pin| <= length (1 + slack)
//! ```
//!
//! Kim, Chentanez and Müller-Fischer, "Long Range Attachments" (2012). One-sided: a slack tether does nothing.

use bevy_math::Vec3A;
use fearless_simd::{dispatch, f32x8, prelude::*};

use crate::{
    input::{TetherBlock, Tethers},
    layout::{
        points::Block,
        simd::{Lane, SimdLevel, Vec3x8, lane},
    },
    particles::lanes::Lanes,
};

/// Where the pins of tethers are, m.
#[derive(Clone, Debug, Default)]
pub(crate) struct PinPlaces(Vec<[f32; 3]>);

impl PinPlaces {
    /// Looks up where the pins are by now.
    pub fn read(&mut self, tethers: &Tethers, lanes: &Lanes) {
        self.0.clear();
        let place = |&pin: &u32| lanes.position.get(lanes.order.slot(pin)).to_array();
        self.0.extend(tethers.pins.iter().map(place));
    }
}

/// Pulls every particle that is too far out back to the end of its tether: those of the blocks from that with the number
/// `first` on, which are all that is given. `tethers` are those of all blocks.
pub(crate) fn solve(
    position: &mut [Block],
    inverse_mass: &[Lane],
    first: usize,
    tethers: &[TetherBlock],
    pins: &PinPlaces,
    slack: f32,
    simd_level: SimdLevel,
) {
    let before = |block: usize| tethers.partition_point(|tether| (tether.block as usize) < block);
    let tethers = &tethers[before(first)..before(first + position.len())];
    let pins = &pins.0;
    dispatch!(simd_level.level(), simd => solve_blocks(simd, position, inverse_mass, first, tethers, pins, slack));
}

#[inline(always)]
fn solve_blocks<S: Simd>(
    simd: S,
    position: &mut [Block],
    inverse_mass: &[Lane],
    first: usize,
    tethers: &[TetherBlock],
    pins: &[[f32; 3]],
    slack: f32,
) {
    for tether in tethers {
        let at = tether.block as usize - first;
        let place = Vec3x8::load(simd, &position[at]);
        let pin = match tether.only_pin {
            Some(pin) => Vec3x8::splat(simd, pins[pin as usize]),
            None => {
                let mut places = Block::default();
                for (l, pin) in tether.pins.iter().enumerate() {
                    (places[0][l], places[1][l], places[2][l]) = pins[*pin as usize].into();
                }
                Vec3x8::load(simd, &places)
            }
        };
        let away = place - pin;
        let squared = away.dot(away);
        let reach = lane(simd, &tether.lengths) * (1.0 + slack);
        let is_free = lane(simd, &inverse_mass[at]).simd_gt(f32x8::splat(simd, 0.0));
        let is_taut = is_free & squared.simd_gt(reach * reach);
        if is_taut.any_true() {
            let end = pin + away * (reach / squared.sqrt());
            end.or(is_taut, place).store(&mut position[at]);
        }
    }
}

/// Moves a free particle that is farther than `reach` from `hold` straight back to that distance.
#[inline]
pub(crate) fn pull_back(lanes: &mut Lanes, particle: u32, hold: Vec3A, reach: f32) {
    let slot = lanes.order.slot(particle);
    let away = lanes.position.get(slot) - hold;
    let distance_squared = away.length_squared();
    if distance_squared > reach * reach && lanes.inverse_mass(slot) > 0.0 {
        lanes.position.set(slot, hold + away * (reach / distance_squared.sqrt()));
    }
}
