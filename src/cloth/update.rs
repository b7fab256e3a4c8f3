//! Settings that change while a cloth runs act in its next step; invalid ones are refused.

use bevy::prelude::*;

use super::{Cloth, InForce, margin, resolution};
use crate::{
    fabric::{ClothSprings, Fabric},
    frame::Steps,
    state::{ClothAttachments, ClothState, ClothStatus, StepInput, Warned},
};

/// Reads changed [`Cloth`], [`Fabric`] and [`ClothSprings`] components. Refusals are told once, until all is valid again: a
/// slider that is held at a bad value sends one every frame.
pub(crate) fn update_settings(
    mut cloths: Query<
        (
            Entity,
            (&Cloth, &Fabric, Option<&ClothSprings>),
            (&ClothStatus, &ClothAttachments, &StepInput),
            (&mut ClothState, &mut InForce, &mut Warned),
        ),
        Or<(Changed<Cloth>, Changed<Fabric>, Changed<ClothSprings>)>,
    >,
    steps: Res<Steps>,
) {
    for (entity, (cloth, fabric, springs), (status, attachments, input), (mut state, mut in_force, mut warned)) in
        &mut cloths
    {
        if !status.is_running() || input.pass != steps.pass() {
            continue;
        }
        let material = fabric.material_with(springs).map(|material| {
            state.material = Some(material);
            state.set_masses(&attachments.pins);
            resolution::warn_if_coarse(entity, fabric, springs, &state, &mut warned);
        });
        let settings = cloth.validate().map(|()| {
            *in_force = InForce::new(cloth, &state);
            state.is_disturbed = true;
            margin::warn_if_too_large(entity, &state, &in_force, &mut warned);
        });
        let refusals: Vec<_> = settings.err().into_iter().chain(material.err()).collect();
        if !warned.refused {
            for error in &refusals {
                warn!("cloth {entity} keeps what it had: {error}");
            }
        }
        warned.refused = !refusals.is_empty();
    }
}

/// Without plain springs, the fabric's moduli are in force again.
pub(crate) fn on_springs_removed(removed: On<Remove, ClothSprings>, mut fabrics: Query<&mut Fabric>) {
    if let Ok(mut fabric) = fabrics.get_mut(removed.entity) {
        fabric.set_changed();
    }
}
