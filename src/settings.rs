//! Settings that change while a cloth runs act in its next step; invalid ones are refused.

use bevy::prelude::*;

use crate::{anchor, cloth::Cloth, cloth::ClothStatus, fabric::Fabric, state::ClothState};

/// Reads changed [`Cloth`] and [`Fabric`] components. Refusals are told once, until all is valid again: a slider that
/// is held at a bad value sends one every frame.
pub(crate) fn update_settings(
    mut cloths: Query<(Entity, &Cloth, &Fabric, &mut ClothState, &ClothStatus), Or<(Changed<Cloth>, Changed<Fabric>)>>,
) {
    for (entity, cloth, fabric, mut state, status) in &mut cloths {
        if *status != ClothStatus::Ready {
            continue;
        }
        let settings = cloth.validate().map(|()| {
            state.effort = cloth.effort(&state.topology);
            state.settings = cloth.clone();
        });
        let material = fabric.material().map(|material| {
            state.material = Some(material);
            anchor::set_masses(&mut state);
        });
        let refusals: Vec<_> = settings.err().into_iter().chain(material.err()).collect();
        if !state.said.refused {
            for error in &refusals {
                warn!("cloth {entity} keeps what it had: {error}");
            }
        }
        state.said.refused = !refusals.is_empty();
    }
}
