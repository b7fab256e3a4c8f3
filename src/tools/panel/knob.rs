//! Numbers to turn: a slider for the sensible range, and a field for all that the solver accepts.

use bevy_egui::egui::{DragValue, Response, Slider, SliderClamping, Ui, vec2};

use super::{
    control::{Aside, Naming, naming, row},
    number,
};

/// Width of values with their unit, in points.
const VALUE_WIDTH: f32 = 86.0;

/// A number to turn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knob {
    naming: Naming,
    unit: &'static str,
    /// What is shown and entered over the value: 1000 where a value in m is shown in mm.
    factor: f64,
    /// The ends of the slider: the sensible range.
    range: (f32, f32),
    scale: Scale,
    /// Smallest and largest value that can be entered: what the solver accepts and can still work with.
    limits: (f32, f32),
}

/// How a knob's values lie on its slider.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Scale {
    Linear,
    /// With the smallest value besides zero.
    Logarithmic(f32),
    /// Linear, whole numbers only.
    Whole,
}

impl Knob {
    /// A linear knob whose slider goes over `range`, and which takes what is within `limits`.
    pub const fn new(
        name: &'static str,
        unit: &'static str,
        range: (f32, f32),
        limits: (f32, f32),
        hover: &'static str,
    ) -> Self {
        Self { naming: naming(name, hover), unit, factor: 1.0, range, scale: Scale::Linear, limits }
    }

    /// A slider over orders of magnitude, with the smallest value besides zero.
    pub const fn logarithmic(self, smallest: f32) -> Self {
        Self { scale: Scale::Logarithmic(smallest), ..self }
    }

    /// Whole numbers only.
    pub const fn whole(self) -> Self {
        Self { scale: Scale::Whole, ..self }
    }

    /// The value is shown in a unit of which so many are one of its own.
    pub const fn shown_as(self, unit: &'static str, factor: f64) -> Self {
        Self { unit, factor, ..self }
    }

    /// Takes only what is within these limits as well.
    pub fn within(self, (least, most): (f32, f32)) -> Self {
        Self { limits: (self.limits.0.max(least), self.limits.1.min(most)), ..self }
    }

    /// The nearest number that may be used, and none for what is no number.
    pub fn accept(&self, entered: f64) -> Option<f32> {
        let nearest = (entered / self.factor).clamp(self.limits.0.into(), self.limits.1.into());
        let nearest = if self.scale == Scale::Whole { nearest.round() } else { nearest };
        // The sum gets rid of a negative zero.
        entered.is_finite().then_some(nearest as f32 + 0.0)
    }

    /// A row with the name, a slider and a value to type. True where `value` has been changed.
    pub fn show<'a>(&self, ui: &mut Ui, value: &mut f32, aside: impl Into<Aside<'a>>) -> bool {
        let entered = row(ui, self.naming, aside, |ui, name| {
            let mut slid = self.shown(*value);
            let (low, high) = self.range;
            let slider = Slider::new(&mut slid, self.shown(low)..=self.shown(high))
                .show_value(false)
                .clamping(SliderClamping::Edits);
            let slider = match self.scale {
                Scale::Linear => slider,
                Scale::Logarithmic(smallest) => slider.logarithmic(true).smallest_positive(self.shown(smallest)),
                Scale::Whole => slider.step_by(1.0),
            };
            let beside = VALUE_WIDTH + ui.spacing().item_spacing.x;
            ui.spacing_mut().slider_width = (ui.available_width() - beside).max(40.0);
            let slider = ui.add(slider).labelled_by(name.id);
            let (field, typed) = self.field(ui, VALUE_WIDTH, *value, &name);
            let slid = (slid != self.shown(*value)).then_some(slid);
            (name | slider | field, typed.or(slid))
        });
        self.take(entered, value)
    }

    /// The same for a count.
    pub fn show_count(&self, ui: &mut Ui, value: &mut u32, differs: bool) -> bool {
        let mut number = *value as f32;
        let is_changed = self.show(ui, &mut number, differs);
        if is_changed {
            *value = number as u32;
        }
        is_changed
    }

    /// A row with the name and three values to type.
    pub fn show_vector(&self, ui: &mut Ui, values: &mut [f32; 3]) -> bool {
        let entered = row(ui, self.naming, false, |ui, name| {
            let width = (ui.available_width() - 2.0 * ui.spacing().item_spacing.x) / 3.0;
            let fields = values.map(|value| self.field(ui, width, value, &name));
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
    fn field(&self, ui: &mut Ui, width: f32, value: f32, name: &Response) -> (Response, Option<f64>) {
        let shown = self.shown(value);
        let mut typed = shown;
        let (low, high) = (self.shown(self.range.0), self.shown(self.range.1));
        let speed = match self.scale {
            Scale::Linear => (high - low) / 300.0,
            Scale::Logarithmic(smallest) => (shown.abs() * 0.01).max(self.shown(smallest)),
            Scale::Whole => 0.1,
        };
        let field = DragValue::new(&mut typed)
            .range(self.shown(self.limits.0)..=self.shown(self.limits.1))
            .clamp_existing_to_range(false)
            // Half a number is no number that a cloth should have.
            .update_while_editing(false)
            .speed(speed)
            .custom_formatter(|value, _| number::text(value))
            .custom_parser(number::parse)
            .suffix(if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) });
        let height = ui.spacing().interact_size.y;
        let response = ui.add_sized(vec2(width, height), field).labelled_by(name.id);
        // Leaving a field as it was must not round the value to the digits shown.
        let is_typed = number::text(typed) != number::text(shown);
        (response, is_typed.then_some(typed))
    }

    /// A value as it is drawn: a game may have made it NaN.
    fn shown(&self, value: f32) -> f64 {
        if value.is_nan() { 0.0 } else { f64::from(value) * self.factor }
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

    proptest! {
        #[test]
        fn what_is_accepted_is_within_the_limits(entered in any::<f64>(), least in -1e6_f32..1e6, span in 0.0_f32..1e6) {
            let limits = (least, least + span);
            let knob = Knob::new("", "", limits, limits, "");
            let accepted = knob.accept(entered);
            prop_assert_eq!(accepted.is_some(), entered.is_finite());
            prop_assert!(accepted.is_none_or(|value| (limits.0..=limits.1).contains(&value)));
        }
    }

    #[test]
    fn what_is_shown_in_another_unit_is_entered_in_it() {
        let knob = Knob::new("", "m", (0.0, 1.0), (0.0, 1.0), "").shown_as("mm", 1e3);
        assert_eq!(knob.accept(0.32), Some(0.000_32));
        assert_eq!(knob.accept(5000.0), Some(1.0));
        assert_eq!(number::text(knob.shown(0.000_32)), "0.32");
        assert_eq!(knob.within((0.5, 2.0)).accept(100.0), Some(0.5));
    }

    #[test]
    fn whole_numbers_are_whole() {
        let knob = Knob::new("", "", (1.0, 9.0), (1.0, 99.0), "").whole();
        for (entered, accepted) in [(2.4, 2.0), (2.6, 3.0), (-7.0, 1.0), (1e30, 99.0)] {
            assert_eq!(knob.accept(entered), Some(accepted));
        }
    }
}
