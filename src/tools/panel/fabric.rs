//! The section that edits what a cloth is made of.

use bevy::reflect::Typed;
use bevy_egui::egui::{Label, RichText, Ui};

use super::{
    control::{Aside, Naming, choice, naming, section},
    knob,
    model::{Ask, Model},
};
use crate::{
    fabric::{Fabric, FabricPreset},
    solver::Moduli,
};

/// The fields in the order of the panel: first those that plain springs take the place of.
fn fields(has_springs: bool) -> impl Iterator<Item = &'static str> {
    let elastic: &[_] = if has_springs { &[] } else { &Fabric::ELASTIC };
    let all = Fabric::type_info().as_struct().into_iter().flat_map(|info| info.field_names());
    elastic.iter().chain(all.filter(|field| !Fabric::ELASTIC.contains(field))).copied()
}

pub(super) fn show(ui: &mut Ui, model: &mut Model) {
    let Model { settings, differing, follows_asset, asks, .. } = model;
    let Some((_, fabric)) = &mut settings.cloth else { return };
    section(ui, naming("Fabric", "What the cloth is made of. Changes act in the next step."), true, |ui| {
        let preset = Fabric::PRESETS.into_iter().find(|preset| preset.fabric == *fabric);
        asks.extend(show_presets(ui, preset.as_ref(), *follows_asset).map(Ask::Preset));
        if settings.springs.is_some() {
            let text = RichText::new("Its springs (below) are in force, not its stiffness.").weak();
            ui.add(Label::new(text).wrap().selectable(false));
        }
        for field in fields(settings.springs.is_some()) {
            let note = preset.as_ref().map(|preset| note(preset, field)).unwrap_or_default();
            let aside = Aside { differs: differing.fabric.contains(&field), note: &note };
            let limits = fitting(fabric, field);
            knob::show_within(ui, fabric, field, limits, aside);
        }
    });
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
fn show_presets(ui: &mut Ui, current: Option<&FabricPreset>, follows_asset: bool) -> Option<Fabric> {
    const PRESET: Naming = naming(
        "Preset",
        "Fabrics to begin with. A cloth that follows its asset does so until one is chosen or a value is edited.",
    );
    let presets = Fabric::PRESETS;
    let names = presets.each_ref().map(|preset| spaced(preset.name));
    let abouts = presets.each_ref().map(|preset| format!("Takes all values of this fabric. {}", preset.about()));
    let entries: Vec<_> = (0..presets.len()).map(|i| (i, names[i].as_str(), abouts[i].as_str())).collect();
    let about = current.map(FabricPreset::about).unwrap_or_default();
    let current = current.and_then(|current| presets.iter().position(|preset| preset == current));
    let current = current.filter(|_| !follows_asset);
    let otherwise = if follows_asset { "follows its asset" } else { "own values" };
    let chosen = choice(ui, PRESET, Aside { differs: false, note: &about }, current, otherwise, &entries)?;
    presets.into_iter().nth(chosen).map(|preset| preset.fabric)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use bevy::reflect::structs::GetField;

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
        let mut shown: Vec<_> = fields(false).collect();
        shown.sort_unstable();
        let mut all = Fabric::type_info().as_struct().unwrap().field_names().to_vec();
        all.sort_unstable();
        assert_eq!(shown, all);
        assert!(shown.iter().all(|field| Knob::of::<Fabric>(field).is_some()));
        assert_eq!(fields(true).count(), all.len() - Fabric::ELASTIC.len());
    }
}
