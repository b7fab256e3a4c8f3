//! Numbers to turn: a slider for the sensible range, and a field for all that the solver accepts. What they are is said where
//! the field is declared, by its [`Parameter`] and its documentation.

use bevy::reflect::{PartialReflect, TypeInfo, Typed, enums::VariantInfo, structs::Struct};
use bevy_egui::egui::{DragValue, Response, Slider, SliderClamping, Ui, vec2};

use super::{
    control::{Aside, naming, row},
    number,
    wording::{prose, sentence},
};
use crate::parameter::{self, Parameter, Scale};

/// Width of values with their unit, in points.
const VALUE_WIDTH: f32 = 86.0;

/// A number to turn.
#[derive(Clone, Debug)]
pub(super) struct Knob {
    name: String,
    hover: String,
    parameter: Parameter,
}

/// A row for a field of `component`, unless it is no parameter or `None`.
pub(super) fn show<'a, C: Struct + Typed>(ui: &mut Ui, component: &mut C, field: &str, aside: impl Into<Aside<'a>>) {
    show_within(ui, component, field, (f32::MIN, f32::MAX), aside);
}

/// The same for a field that may only be within `limits`.
pub(super) fn show_within<'a, C: Struct + Typed>(
    ui: &mut Ui,
    component: &mut C,
    field: &str,
    limits: (f32, f32),
    aside: impl Into<Aside<'a>>,
) {
    if let Some(knob) = Knob::of::<C>(field)
        && let Some(place) = component.field_mut(field)
        && let Some(mut value) = parameter::number(place)
        && knob.within(limits).show(ui, &mut value, aside)
    {
        set(place, value);
    }
}

/// Writes a number into a field that is one.
fn set(field: &mut dyn PartialReflect, value: f32) {
    if let Some(field) = field.try_downcast_mut::<f32>() {
        *field = value;
    } else if let Some(field) = field.try_downcast_mut::<u32>() {
        *field = value as u32;
    } else if let Some(field) = field.try_downcast_mut::<Option<f32>>() {
        *field = Some(value);
    } else if let Some(field) = field.try_downcast_mut::<Option<u32>>() {
        *field = Some(value as u32);
    }
}

impl Knob {
    /// The knob of a field.
    pub fn of<C: Typed>(field: &str) -> Option<Self> {
        let info = C::type_info().as_struct().ok()?.field(field)?;
        Some(Self::new(*info.get_attribute()?, field, info.docs()))
    }

    /// The knob of a field of a variant, by its place there.
    pub fn of_variant<E: Typed>(variant: &str, place: usize) -> Option<Self> {
        match E::type_info().as_enum().ok()?.variant(variant)? {
            VariantInfo::Struct(info) => {
                let info = info.field_at(place)?;
                Some(Self::new(*info.get_attribute()?, info.name(), info.docs()))
            }
            VariantInfo::Tuple(info) => {
                let info = info.field_at(place)?;
                Some(Self::new(*info.get_attribute()?, variant, info.docs()))
            }
            VariantInfo::Unit(_) => None,
        }
    }

    /// The knob of what is a parameter as a whole.
    pub fn of_all<C: Typed>() -> Option<Self> {
        let TypeInfo::TupleStruct(info) = C::type_info() else { return None };
        Some(Self::new(*info.get_attribute()?, "", info.docs()))
    }

    fn new(parameter: Parameter, field: &str, docs: Option<&str>) -> Self {
        let mut hover = prose(docs.unwrap_or_default());
        let (shown, factor) = parameter.shown;
        if factor != 1.0 {
            hover += &format!(" Shown in {shown}.");
        }
        Self { name: parameter.title.map_or_else(|| sentence(field), Into::into), hover, parameter }
    }

    /// Takes only what is within these limits as well.
    pub fn within(mut self, (least, most): (f32, f32)) -> Self {
        let entered = &mut self.parameter.entered;
        *entered = (entered.0.max(least), entered.1.min(most));
        self
    }

    /// The nearest number that may be used, and none for what is no number.
    pub fn accept(&self, entered: f64) -> Option<f32> {
        let Parameter { entered: (least, most), shown: (_, factor), scale, .. } = self.parameter;
        let nearest = (entered / factor).clamp(least.into(), most.into());
        let nearest = if scale == Scale::Whole { nearest.round() } else { nearest };
        // The sum gets rid of a negative zero.
        entered.is_finite().then_some(nearest as f32 + 0.0)
    }

    /// A row with the name, a slider and a value to type. True where `value` has been changed.
    pub fn show<'a>(&self, ui: &mut Ui, value: &mut f32, aside: impl Into<Aside<'a>>) -> bool {
        let entered = row(ui, naming(&self.name, &self.hover), aside, |ui, name| {
            let mut slid = self.shown(*value);
            let (low, high) = self.parameter.slider;
            let slider = Slider::new(&mut slid, self.shown(low)..=self.shown(high))
                .show_value(false)
                .clamping(SliderClamping::Edits);
            let slider = match self.parameter.scale {
                Scale::Linear => slider,
                Scale::Logarithmic(smallest) => slider.logarithmic(true).smallest_positive(self.shown(smallest)),
                Scale::Whole => slider.step_by(1.0),
            };
            let beside = VALUE_WIDTH + ui.spacing().item_spacing.x;
            ui.spacing_mut().slider_width = (ui.available_width() - beside).max(40.0);
            let slider = ui.add(slider).labelled_by(name.id);
            let (field, typed) = self.field(ui, VALUE_WIDTH, *value, &name, self.parameter.shown.0);
            let slid = (slid != self.shown(*value)).then_some(slid);
            (name | slider | field, typed.or(slid))
        });
        self.take(entered, value)
    }

    /// A row with the name, the unit and three values to type.
    pub fn show_vector(&self, ui: &mut Ui, values: &mut [f32; 3]) -> bool {
        let name = format!("{}, {}", self.name, self.parameter.shown.0);
        let entered = row(ui, naming(&name, &self.hover), false, |ui, name| {
            let width = (ui.available_width() - 2.0 * ui.spacing().item_spacing.x) / 3.0;
            let fields = values.map(|value| self.field(ui, width, value, &name, ""));
            let response = fields.iter().fold(name, |all, (field, _)| all | field.clone());
            (response, fields.map(|(_, typed)| typed))
        });
        let mut is_changed = false;
        for (value, entered) in values.iter_mut().zip(entered) {
            is_changed |= self.take(entered, value);
        }
        is_changed
    }

    /// A value to type or to drag, and what was entered.
    fn field(&self, ui: &mut Ui, width: f32, value: f32, name: &Response, unit: &str) -> (Response, Option<f64>) {
        let Parameter { entered: (least, most), slider: (low, high), .. } = self.parameter;
        let shown = self.shown(value);
        let mut typed = shown;
        let speed = match self.parameter.scale {
            Scale::Linear => (self.shown(high) - self.shown(low)) / 300.0,
            Scale::Logarithmic(smallest) => (shown.abs() * 0.01).max(self.shown(smallest)),
            Scale::Whole => 0.1,
        };
        let field = DragValue::new(&mut typed)
            .range(self.shown(least)..=self.shown(most))
            .clamp_existing_to_range(false)
            // Half a number is no number that a cloth should have.
            .update_while_editing(false)
            .speed(speed)
            .custom_formatter(|value, _| number::text(value))
            .custom_parser(number::parse)
            .suffix(if unit.is_empty() { String::new() } else { format!(" {unit}") });
        let height = ui.spacing().interact_size.y;
        let response = ui.add_sized(vec2(width, height), field).labelled_by(name.id);
        // Leaving a field as it was must not round the value to the digits shown.
        let is_typed = number::text(typed) != number::text(shown);
        (response, is_typed.then_some(typed))
    }

    /// A value as it is drawn: a game may have made it NaN.
    fn shown(&self, value: f32) -> f64 {
        if value.is_nan() { 0.0 } else { f64::from(value) * self.parameter.shown.1 }
    }

    /// True where something that is accepted was entered.
    fn take(&self, entered: Option<f64>, value: &mut f32) -> bool {
        let accepted = entered.and_then(|entered| self.accept(entered));
        accepted.inspect(|&accepted| *value = accepted).is_some()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::prelude::*;

    fn knob(parameter: Parameter) -> Knob {
        Knob::new(parameter, "some_field", None)
    }

    proptest! {
        #[test]
        fn what_is_accepted_is_within_the_limits(entered in any::<f64>(), least in -1e6_f32..1e6, span in 0.0_f32..1e6) {
            let limits = (least, least + span);
            let accepted = knob(Parameter::within("", limits, limits)).accept(entered);
            prop_assert_eq!(accepted.is_some(), entered.is_finite());
            prop_assert!(accepted.is_none_or(|value| (limits.0..=limits.1).contains(&value)));
        }
    }

    #[test]
    fn what_is_shown_in_another_unit_is_entered_in_it() {
        let knob = knob(Parameter::within("m", (0.0, 1.0), (0.0, 1.0)).shown_as("mm", 1e3));
        assert_eq!(knob.accept(0.32), Some(0.000_32));
        assert_eq!(knob.accept(5000.0), Some(1.0));
        assert_eq!(number::text(knob.shown(0.000_32)), "0.32");
        assert_eq!(knob.within((0.5, 2.0)).accept(100.0), Some(0.5));
    }

    #[test]
    fn whole_numbers_are_whole() {
        let knob = knob(Parameter::within("", (1.0, 99.0), (1.0, 9.0)).whole());
        for (entered, accepted) in [(2.4, 2.0), (2.6, 3.0), (-7.0, 1.0), (1e30, 99.0)] {
            assert_eq!(knob.accept(entered), Some(accepted));
        }
    }

    #[test]
    fn names_and_texts_are_those_of_the_field() {
        let thickness = Knob::of::<Fabric>("thickness").unwrap();
        assert_eq!(thickness.name, "Thickness");
        assert!(thickness.hover.starts_with("Thickness in m, greater than 0. 0.0002 for silk"), "{}", thickness.hover);
        assert!(thickness.hover.ends_with(" Shown in mm."), "{}", thickness.hover);
        assert_eq!(Knob::of::<Fabric>("warp_stiffness").unwrap().name, "Warp stiffness");
        assert_eq!(Knob::of::<Wind>("velocity").unwrap().name, "Wind speed");
        assert_eq!(Knob::of_all::<ClothGravity>().unwrap().name, "Gravity");
        assert_eq!(Knob::of_variant::<ClothMap>("Painted", 0).unwrap().name, "Paint scale");
        let everywhere = Knob::of_variant::<ClothMap>("Uniform", 0).unwrap();
        assert_eq!(everywhere.name, "Everywhere");
        assert!(everywhere.hover.starts_with("For every vertex, m"), "{}", everywhere.hover);
        assert!(Knob::of_variant::<ClothMap>("Uniform", 1).is_none());
        assert!(Knob::of::<Wind>("seed").is_none() && Knob::of::<Fabric>("nothing").is_none());
    }

    /// All parameters of a component: field, parameter, documentation and default.
    fn parameters<C: Struct + Typed + Default>() -> Vec<(&'static str, Parameter, String, Option<f32>)> {
        let default = C::default();
        let fields = C::type_info().as_struct().unwrap().iter();
        let parameter = |field: &'static bevy::reflect::NamedField| {
            let default = default.field(field.name()).and_then(parameter::number);
            Some((field.name(), *field.get_attribute()?, prose(field.docs()?), default))
        };
        fields.filter_map(parameter).collect()
    }

    #[test]
    fn documentation_says_what_the_table_says() {
        let defaults = [
            parameters::<Cloth>(),
            parameters::<ClothSprings>(),
            parameters::<ClothSkin>(),
            parameters::<ClothInertia>(),
            parameters::<ClothTeleport>(),
            parameters::<Wind>(),
        ];
        for (field, .., docs, default) in defaults.iter().flatten() {
            let default = default.map_or_else(String::new, |default| format!(" {default}"));
            assert!(docs.contains(&format!("{default} by default")), "{field}:{default} in {docs:?}");
        }
        for (field, parameter, docs, _) in defaults.iter().flatten().chain(&parameters::<Fabric>()) {
            let says = |text: &str| assert!(docs.contains(text), "{field}: {text} in {docs:?}");
            says(match parameter.unit {
                "" if parameter.scale == Scale::Whole => "ubsteps per step",
                "" => "no unit",
                unit => unit,
            });
            says(match parameter.accepted {
                (f32::MIN, f32::MAX) => "",
                (0.0, f32::MAX) => "0 or more",
                (1.0, 10_000.0) => "1 to 10 000",
                (0.0, 1.0) => "0 to 1",
                _ => "greater than 0",
            });
        }
    }

    #[test]
    fn what_can_be_entered_is_accepted_and_sliders_have_nothing_else() {
        let all = [
            parameters::<Fabric>(),
            parameters::<Cloth>(),
            parameters::<ClothSprings>(),
            parameters::<ClothSkin>(),
            parameters::<ClothInertia>(),
            parameters::<ClothTeleport>(),
            parameters::<ClothBudget>(),
            parameters::<Wind>(),
        ];
        assert_eq!(all.each_ref().map(Vec::len), [15, 12, 6, 4, 4, 4, 1, 6]);
        let maps = [("Painted", 0), ("Painted", 1), ("Uniform", 0)];
        let maps = maps.map(|(variant, place)| Knob::of_variant::<ClothMap>(variant, place).unwrap());
        let maps = maps.iter().map(|knob| (knob.name.as_str(), knob.parameter));
        let fields = all.iter().flatten().map(|&(field, parameter, ..)| (field, parameter));
        for (field, Parameter { accepted, entered, slider, .. }) in fields.chain(maps) {
            assert!(accepted.0 <= entered.0 && entered.1 <= accepted.1, "{field}");
            assert!(entered.0 <= slider.0 && slider.0 < slider.1 && slider.1 <= entered.1, "{field}");
        }
    }
}
