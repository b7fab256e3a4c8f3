//! Fields that are one of several: variants without fields of their own, and switches. What they are called and what they do is
//! said where they are declared.

use bevy::reflect::{NamedField, ReflectMut, TypeInfo, Typed, enums::DynamicEnum, structs::Struct};
use bevy_egui::egui::Ui;

use super::{
    control::{self, Aside, naming},
    wording::{prose, sentence},
};

/// A row with a list for a field of `component`, unless it is no enum.
pub(super) fn show<'a, C: Struct + Typed>(ui: &mut Ui, component: &mut C, field: &str, aside: impl Into<Aside<'a>>) {
    let Some(info) = declared::<C>(field) else { return };
    let Some(TypeInfo::Enum(variants)) = info.type_info() else { return };
    let Some(place) = component.field_mut(field) else { return };
    let ReflectMut::Enum(current) = place.reflect_mut() else { return };
    let texts: Vec<_> = variants.iter().map(|variant| prose(variant.docs().unwrap_or_default())).collect();
    let entries: Vec<_> =
        variants.iter().zip(&texts).map(|(variant, text)| (variant.name(), variant.name(), text.as_str())).collect();
    let (name, hover) = (sentence(field), prose(info.docs().unwrap_or_default()));
    let chosen = Some(current.variant_name()).and_then(|name| variants.variant(name)).map(|variant| variant.name());
    if let Some(chosen) = control::choice(ui, naming(&name, &hover), aside, chosen, "", &entries) {
        place.apply(&DynamicEnum::new(chosen, ()));
    }
}

/// A row with a box to tick for a field of `component` that is a switch.
pub(super) fn show_switch<C: Struct + Typed>(ui: &mut Ui, component: &mut C, field: &str, differs: bool) {
    let Some(info) = declared::<C>(field) else { return };
    let Some(is_on) = component.field_mut(field).and_then(|place| place.try_downcast_mut::<bool>()) else { return };
    control::tick(ui, naming(&sentence(field), &prose(info.docs().unwrap_or_default())), differs, is_on);
}

fn declared<C: Typed>(field: &str) -> Option<&'static NamedField> {
    C::type_info().as_struct().ok()?.field(field)
}
