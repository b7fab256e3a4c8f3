//! Settings that change while a cloth runs act in its next step; invalid ones are refused.

use bevy::prelude::*;

use crate::{anchor, cloth::Cloth, cloth::ClothStatus, fabric::Fabric, state::ClothState};

/// Reads changed [`Cloth`] and [`Fabric`] components.
pub(crate) fn update_settings(
    mut cloths: Query<
        (Entity, Ref<Cloth>, Ref<Fabric>, &mut ClothState, &ClothStatus),
        Or<(Changed<Cloth>, Changed<Fabric>)>,
    >,
) {
    for (entity, cloth, fabric, mut state, status) in &mut cloths {
        if *status != ClothStatus::Ready {
            continue;
        }
        if cloth.is_changed() {
            match cloth.validate() {
                Ok(()) => state.settings = Cloth::clone(&cloth),
                Err(error) => warn!("cloth {entity} keeps the settings that it had: {error}"),
            }
        }
        if fabric.is_changed() {
            match fabric.material() {
                Ok(material) => {
                    state.material = Some(material);
                    anchor::set_masses(&mut state);
                }
                Err(error) => warn!("cloth {entity} keeps the fabric that it had: {error}"),
            }
        }
    }
}
