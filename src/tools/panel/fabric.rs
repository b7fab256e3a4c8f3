//! The section that edits what a cloth is made of.

use bevy::reflect::structs::Struct;
use bevy_egui::egui::Ui;

use super::{
    control::{Aside, Naming, choice, naming, remark, section, subsection},
    fields, knob,
    list::Differing,
    model::{Ask, Model},
};
use crate::{
    fabric::{Fabric, FabricPreset},
    solver::Moduli,
};

const FABRIC: Naming = naming("Fabric", "What the cloth is made of. Changes act in the next step.");

/// What belongs to no group: it counts in each of them.
const WEIGHT: &str = "density";

type Group = (Naming<'static>, &'static [&'static str]);

/// The other fields, by what they act on.
const GROUPS: [Group; 4] = [
    (
        naming("Stretch", "How the cloth resists being pulled, pressed together and pulled askew in its plane."),
        &[
            "warp_stiffness",
            "weft_stiffness",
            "warp_stiffening",
            "weft_stiffening",
            "compression",
            "shear_stiffness",
            "stretch_damping",
        ],
    ),
    (naming("Bending", "How the cloth resists folds."), &["bending_rigidity", "bend_damping"]),
    (naming("Air", "How the cloth is moved and braked by the air."), &["drag", "lift", "damping"]),
    (naming("Contact", "What obstacles feel of the cloth."), &["friction", "thickness"]),
];

/// The fields of a group that are in force.
fn in_force(group: &[&'static str], has_springs: bool) -> impl Iterator<Item = &'static str> {
    group.iter().copied().filter(move |field| !has_springs || !Fabric::ELASTIC.contains(field))
}

pub(super) fn show(ui: &mut Ui, model: &mut Model) {
    let Model { settings, differing, follows_asset, asks, .. } = model;
    let has_springs = settings.beside.springs.is_some();
    let Some((_, fabric)) = &mut settings.cloth else { return };
    section(ui, FABRIC, true, |ui| {
        let preset = nearest(fabric);
        asks.extend(show_presets(ui, fabric, preset.as_ref(), *follows_asset).map(Ask::Preset));
        remark(ui, preset.as_ref().map_or("Own values, from no source.".into(), source));
        if has_springs {
            remark(ui, "Its springs (below) are in force, not its stiffness.");
        }
        show_field(ui, fabric, WEIGHT, preset.as_ref(), differing);
        for (naming, group) in GROUPS {
            if in_force(group, has_springs).next().is_some() {
                subsection(ui, naming, |ui| {
                    for field in in_force(group, has_springs) {
                        show_field(ui, fabric, field, preset.as_ref(), differing);
                    }
                });
            }
        }
    });
}

fn show_field(ui: &mut Ui, fabric: &mut Fabric, field: &str, preset: Option<&FabricPreset>, differing: &Differing) {
    let preset = preset.filter(|preset| has(fabric, preset, field));
    let is_measured = preset.is_some_and(|preset| preset.measured.contains(&field));
    let note = preset.map(|preset| note(preset, field)).unwrap_or_default();
    let aside = Aside { differs: differing.fabric.contains(&field), is_marked: is_measured, note: &note };
    let limits = fitting(fabric, field);
    knob::show_within(ui, fabric, field, limits, aside);
}

/// How many fields may be edited before a fabric is no longer told by its preset.
const MOST_EDITED: usize = 3;

/// The preset that a fabric is, or was made from by a few edits.
fn nearest(fabric: &Fabric) -> Option<FabricPreset> {
    let edited = |preset: &FabricPreset| fields::differing(fabric, &preset.fabric).count();
    Fabric::PRESETS.into_iter().min_by_key(edited).filter(|preset| edited(preset) <= MOST_EDITED)
}

/// Whether a fabric has a preset's value in a field.
fn has(fabric: &Fabric, preset: &FabricPreset, field: &str) -> bool {
    match (fabric.field(field), preset.fabric.field(field)) {
        (Some(own), Some(preset)) => fields::same(own, preset),
        _ => false,
    }
}

/// Where a preset's values come from.
fn source(preset: &FabricPreset) -> String {
    let how = if preset.measured.is_empty() { "Nothing is measured." } else { "• measured, all else is plausible." };
    format!("{how} {}", preset.source)
}

/// What a field may be, as far as that follows from the other fields: shear has to fit warp and weft.
fn fitting(fabric: &Fabric, field: &str) -> (f32, f32) {
    let Fabric { warp_stiffness: warp, weft_stiffness: weft, shear_stiffness: shear, .. } = *fabric;
    // A little more than there is has to fit, by a stiffness a little nearer: numbers are rounded.
    let (shear, nearer) = (shear * (1.0 + 1e-6), 1e-4);
    let near = |other: f32| {
        let least = (shear * other / (shear + other) * (1.0 + nearer)).min(other);
        let most = (shear * other / (shear - other) * (1.0 - nearer)).max(other);
        (least, if shear > other { most } else { f32::MAX })
    };
    match field {
        "warp_stiffness" => near(weft),
        "weft_stiffness" => near(warp),
        "shear_stiffness" => (0.0, Moduli::most_shear([warp, weft])),
        _ => (f32::MIN, f32::MAX),
    }
}

/// Whether a preset's field was measured.
fn note(preset: &FabricPreset, field: &str) -> String {
    let how = if preset.measured.contains(&field) { "Measured" } else { "Plausible, not measured" };
    format!("{how}: the preset {}.", spaced(preset.name))
}

/// The name of a preset, as it is read.
fn spaced(name: &str) -> String {
    name.replace('_', " ")
}

/// Gives the preset that is chosen.
fn show_presets(ui: &mut Ui, fabric: &Fabric, nearest: Option<&FabricPreset>, follows_asset: bool) -> Option<Fabric> {
    const PRESET: Naming = naming(
        "Preset",
        "Fabrics to begin with. A cloth that follows its asset does so until one is chosen or a value is edited.",
    );
    let presets = Fabric::PRESETS;
    let names = presets.each_ref().map(|preset| spaced(preset.name));
    let abouts = presets.each_ref().map(|preset| format!("Takes all values of this fabric. {}", preset.about()));
    let entries: Vec<_> = (0..presets.len()).map(|i| (i, names[i].as_str(), abouts[i].as_str())).collect();
    let about = nearest.map(FabricPreset::about).unwrap_or_default();
    let otherwise = match nearest {
        _ if follows_asset => "follows its asset".into(),
        Some(preset) => format!("{}, edited", spaced(preset.name)),
        None => "own values".into(),
    };
    let current = presets.iter().position(|preset| preset.fabric == *fabric).filter(|_| !follows_asset);
    let aside = Aside { note: &about, ..Aside::default() };
    let chosen = choice(ui, PRESET, aside, current, &otherwise, &entries)?;
    presets.into_iter().nth(chosen).map(|preset| preset.fabric)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use bevy::reflect::{Typed, structs::GetField};

    use super::{super::knob::Knob, *};

    proptest! {
        #[test]
        fn what_fits_is_valid(exponents in prop::array::uniform3(-2.0_f32..8.0), ends in any::<[bool; 3]>()) {
            let [warp_stiffness, weft_stiffness, shear] = exponents.map(|e| bevy::math::ops::powf(10.0, e));
            let shear_stiffness = shear.min(Moduli::most_shear([warp_stiffness, weft_stiffness]));
            let mut fabric = Fabric { warp_stiffness, weft_stiffness, shear_stiffness, ..Fabric::default() };
            prop_assume!(fabric.material().is_ok());
            for (field, is_high) in ["warp_stiffness", "weft_stiffness", "shear_stiffness"].into_iter().zip(ends) {
                let entered = if is_high { f64::MAX } else { f64::MIN };
                let value = Knob::of::<Fabric>(field).unwrap().within(fitting(&fabric, field)).accept(entered);
                *fabric.get_field_mut::<f32>(field).unwrap() = value.unwrap();
                prop_assert!(fabric.material().is_ok(), "{field}: {:?}", fabric.material());
            }
        }
    }

    #[test]
    fn every_field_is_shown_once() {
        let shown = |has_springs| {
            let grouped = GROUPS.iter().flat_map(move |(_, group)| in_force(group, has_springs));
            let mut shown: Vec<_> = grouped.chain([WEIGHT]).collect();
            shown.sort_unstable();
            shown
        };
        let mut all = Fabric::type_info().as_struct().unwrap().field_names().to_vec();
        all.sort_unstable();
        assert_eq!(shown(false), all);
        assert!(all.iter().all(|field| Knob::of::<Fabric>(field).is_some()));
        all.retain(|field| !Fabric::ELASTIC.contains(field));
        assert_eq!(shown(true), all);
    }

    #[test]
    fn a_preset_is_told_until_more_than_a_few_of_its_values_are_edited() {
        for preset in Fabric::PRESETS {
            assert_eq!(nearest(&preset.fabric).as_ref(), Some(&preset));
            let edited = Fabric { density: 7.0, thickness: 7.0, lift: 7.0, ..preset.fabric.clone() };
            assert_eq!(nearest(&edited).as_ref(), Some(&preset), "three values are edited");
            assert!(!has(&edited, &preset, "density") && has(&edited, &preset, "drag"));
            assert_eq!(nearest(&Fabric { drag: 7.0, ..edited }), None);
        }
    }
}
