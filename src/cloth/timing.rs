//! When in a frame a cloth steps.

use bevy::prelude::*;

use super::Cloth;
use crate::{
    frame::{Pass, Steps},
    pins::Pins,
    state::{ClothAttachments, ClothState, Skinning, StepInput},
};

/// When a cloth steps: in the plugin's schedule, or late in the frame, with what is drawn.
///
/// Bevy animates in `PostUpdate`, after all fixed steps. Those see the pose of the frame before, and drawing is up to a step
/// behind them: a collar would hang behind a runner's neck. A late step comes after animation and ends at
/// the moment that is drawn.
///
/// | what | timing |
/// |---|---|
/// | clothes, and whatever else hangs on a character that is animated: a cape, or the flag on a pole in its hand | `Late` |
/// | what is held or pushed by something that moves in `Update` | `Late` |
/// | motion that has to be the same on every run, whatever the frames: servers, replays, tests | `Fixed` |
/// | what pushes bodies of a physics engine, or is pinned to such | `Fixed` |
///
/// Late, the motion depends on the frames' times, as far as the length of the step counts: the same frames give the same bits.
/// Only cloths of the same timing meet each other. A change while the cloth runs is in force from the next frame on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Default, Debug, Clone, PartialEq, Hash)]
pub enum ClothTiming {
    /// `Late` for cloth on a skinned mesh, and `Fixed` for any other.
    #[default]
    Auto,
    /// In the schedule of [`ClothPlugin`](crate::prelude::ClothPlugin), `FixedPostUpdate` by default.
    Fixed,
    /// Once a frame, by the frame's time, in [`ClothSystems::Late`](crate::prelude::ClothSystems::Late).
    Late,
}

impl ClothTiming {
    /// The pass that a cloth steps in.
    fn pass(self, is_skinned: bool) -> Pass {
        match self {
            Self::Late => Pass::Late,
            Self::Auto if is_skinned => Pass::Late,
            Self::Auto | Self::Fixed => Pass::Fixed,
        }
    }
}

/// Has every cloth step in the pass that its timing asks for, from this frame on.
pub(crate) fn choose_passes(
    mut cloths: Query<(&mut Cloth, &mut Pins, &mut ClothState, &mut ClothAttachments, &mut StepInput, &Skinning)>,
    steps: Res<Steps>,
) {
    for (mut cloth, mut pins, mut state, mut attachments, mut input, skinning) in &mut cloths {
        let pass = cloth.timing.pass(skinning.0.is_some());
        if pass == input.pass {
            continue;
        }
        let (latest, now) = (steps.latest_of(input.pass), steps.present());
        input.pass = pass;
        // What has changed with it is read in the new pass, and the old one may have passed it over already.
        cloth.set_changed();
        pins.set_changed();
        // What only the other pass fills.
        input.body_attachments.clear();
        input.attachment_owners.clear();
        input.attached_pins.clear();
        attachments.anchors.iter_mut().for_each(|anchor| anchor.change_pass(latest, now));
        // Until the next step, it is drawn where it is by now: drawing doesn't go back into the step before.
        let state = &mut *state;
        state.step_start.clone_from(&state.particles.position);
    }
}

/// Whether any cloth steps in the late pass.
pub(crate) fn any_is_late(cloths: Query<&StepInput>) -> bool {
    cloths.iter().any(|input| input.pass == Pass::Late)
}
