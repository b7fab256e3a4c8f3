//! Settings that change while a cloth runs act in its next step; invalid ones are refused.

use bevy::prelude::*;

use crate::{
    anchor,
    cloth::{Cloth, ClothStatus},
    fabric::{ClothSprings, Fabric, resolution},
    margin,
    state::ClothState,
};

/// Reads changed [`Cloth`], [`Fabric`] and [`ClothSprings`] components. Refusals are told once, until all is valid again: a
/// slider that is held at a bad value sends one every frame.
pub(crate) fn update_settings(
    mut cloths: Query<
        (Entity, &Cloth, &Fabric, Option<&ClothSprings>, &mut ClothState, &ClothStatus),
        Or<(Changed<Cloth>, Changed<Fabric>, Changed<ClothSprings>)>,
    >,
) {
    for (entity, cloth, fabric, springs, mut state, status) in &mut cloths {
        if *status != ClothStatus::Ready {
            continue;
        }
        let settings = cloth.validate().map(|()| {
            state.effort = cloth.effort(&state.topology);
            state.settings = cloth.clone();
            margin::warn_if_too_large(entity, &mut state);
        });
        let material = fabric.material_with(springs).map(|material| {
            state.material = Some(material);
            anchor::set_masses(&mut state);
            resolution::warn_if_coarse(entity, fabric, springs, &mut state);
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

/// Without plain springs, the fabric's moduli are in force again.
pub(crate) fn on_springs_removed(removed: On<Remove, ClothSprings>, mut fabrics: Query<&mut Fabric>) {
    if let Ok(mut fabric) = fabrics.get_mut(removed.entity) {
        fabric.set_changed();
    }
}
