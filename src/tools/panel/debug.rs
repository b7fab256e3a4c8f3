//! The section that switches gizmos.

use bevy::prelude::*;
use bevy_egui::egui::{Label, RichText, Ui};

use super::{
    control::{Naming, explain, naming, row, section, tick},
    fields,
    model::Model,
};
use crate::tools::debug::{ClothDebugConfig, ClothDebugView};

/// What is drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Switches {
    /// Of all cloths. None without the plugin that draws.
    config: Option<ClothDebugConfig>,
    /// Of the first chosen cloth.
    view: ClothDebugView,
}

impl Switches {
    pub fn read(world: &World, chosen: &[Entity]) -> Self {
        let view = chosen.first().and_then(|&cloth| world.get::<ClothDebugView>(cloth).copied());
        Self { config: world.get_resource::<ClothDebugConfig>().copied(), view: view.unwrap_or_default() }
    }

    pub fn write(&self, world: &mut World, before: &Self, chosen: &[Entity]) {
        if let Some(config) = self.config.filter(|_| self.config != before.config)
            && let Some(mut own) = world.get_resource_mut::<ClothDebugConfig>()
        {
            *own = config;
        }
        if self.view == before.view {
            return;
        }
        for &cloth in chosen {
            if world.get::<ClothDebugView>(cloth).is_none() {
                world.commands().entity(cloth).try_insert(self.view);
            } else {
                fields::write(world, cloth, &before.view, &self.view);
            }
        }
    }
}

type Switch = (Naming<'static>, fn(&mut ClothDebugView) -> &mut bool);

/// What can be drawn of a cloth.
const SWITCHES: [Switch; 8] = [
    (
        naming(
            "Stretch springs",
            "Springs along the threads: grey at rest, blue pressed together, yellow to red stretched.",
        ),
        |view| &mut view.structural_springs,
    ),
    (naming("Shear springs", "Springs along the diagonals, in the same colours and paler."), |view| {
        &mut view.shear_springs
    }),
    (
        naming(
            "Bend springs",
            "Springs between particles two steps apart, paler still. They act where a cloth has ClothSprings.",
        ),
        |view| &mut view.bend_springs,
    ),
    (
        naming(
            "Pins",
            "A cross at each pin: green on the cloth's own entity, blue in the world, magenta on another entity.",
        ),
        |view| &mut view.pins,
    ),
    (naming("Tethers", "Lines from particles to their pins: orange where taut."), |view| &mut view.tethers),
    (naming("Normals", "The normal of each particle."), |view| &mut view.normals),
    (naming("Grabs", "Where hands hold the cloth and where they lead it."), |view| &mut view.grabs),
    (naming("Bounds", "The box that the cloth is culled by."), |view| &mut view.bounds),
];

pub(super) fn show(ui: &mut Ui, model: &mut Model) {
    let has_cloth = !model.chosen.is_empty();
    let Switches { config, view } = &mut model.settings.debug;
    section(ui, naming("Drawing", "Gizmos that show what is inside."), false, |ui| {
        let Some(config) = config else {
            ui.add(Label::new(RichText::new("Add ClothDebugPlugin to draw what is inside.").weak()).wrap());
            return;
        };
        let columns = naming("", "Left: drawn of all cloths. Right: drawn of the chosen one.");
        row(ui, columns, false, |ui, name| (name | ui.add(Label::new("All   Chosen").selectable(false)), ()));
        for (naming, switch) in SWITCHES {
            row(ui, naming, false, |ui, name| {
                let all = ui.checkbox(switch(&mut config.view), "").labelled_by(name.id);
                ui.add_space(6.0);
                let own = ui.add_enabled_ui(has_cloth, |ui| ui.checkbox(switch(view), "")).inner.labelled_by(name.id);
                (name | explain(all, naming.hover) | explain(own, naming.hover), ())
            });
        }
        tick(ui, naming("Colliders", "All obstacles, where the latest step saw them."), false, &mut config.colliders);
        tick(ui, naming("Wind", "Arrows of the wind around each cloth."), false, &mut config.wind);
    });
}
