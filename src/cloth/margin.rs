//! The margin that a cloth keeps from obstacles: that of its settings, as far as it is large enough for it.

use bevy::prelude::*;

use super::InForce;
use crate::state::{ClothState, Warned};

/// Says so where a cloth is too small for the margin that it is given, once until it isn't.
pub(crate) fn warn_if_too_large(entity: Entity, state: &ClothState, in_force: &InForce, warned: &mut Warned) {
    let (given, kept) = (in_force.settings.collision_margin, in_force.solver.margin);
    let is_less = kept < given;
    if is_less && !warned.margin {
        warn!(
            "cloth {entity} is {:.2} mm wide, too small for a margin of {:.2} mm, and keeps {:.2} mm from obstacles, a quarter \
             of its width: set Cloth::collision_margin to that or less",
            state.width * 1e3,
            given * 1e3,
            kept * 1e3
        );
    }
    warned.margin = is_less;
}
