//! The panel's controls. None can be made without the text that explains it.

use bevy_egui::egui::{
    Align, Button, CollapsingHeader, ComboBox, DragValue, Label, Layout, Response, RichText, Slider, SliderClamping,
    Ui, UiBuilder, vec2,
};

use super::number;

/// Width of names, in points.
const NAME_WIDTH: f32 = 96.0;
/// Width of values with their unit, in points.
const VALUE_WIDTH: f32 = 86.0;

/// What a control is called, and what it does: with the unit, a sensible range, and what to expect.
#[derive(Clone, Copy, Debug)]
pub(super) struct Naming {
    pub name: &'static str,
    pub hover: &'static str,
}

pub(super) const fn naming(name: &'static str, hover: &'static str) -> Naming {
    Naming { name, hover }
}

/// A number to turn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knob {
    pub naming: Naming,
    pub unit: &'static str,
    /// The ends of the slider: the sensible range.
    pub range: (f32, f32),
    pub scale: Scale,
    /// The least and the most that can be entered: what the solver accepts and can still work with.
    pub limits: (f32, f32),
}

/// How a knob's values lie on its slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Scale {
    Linear,
    /// With the smallest value besides zero.
    Logarithmic(f32),
    /// Linear, whole numbers only.
    Whole,
}

impl Knob {
    /// The nearest number that may be used, and none for what is no number.
    pub fn accept(&self, entered: f64) -> Option<f64> {
        let (least, most) = (f64::from(self.limits.0), f64::from(self.limits.1));
        let nearest = entered.clamp(least, most);
        let nearest = if self.scale == Scale::Whole { nearest.round() } else { nearest };
        // The sum gets rid of a negative zero.
        entered.is_finite().then_some(nearest + 0.0)
    }

    /// A row with the name, a slider and a value to type. True where `value` has been changed.
    pub fn show(&self, ui: &mut Ui, value: &mut f32, differs: bool) -> bool {
        let entered = row(ui, self.naming, differs, |ui, name| {
            // A value that a game has made NaN can't be drawn.
            let shown = if value.is_nan() { 0.0 } else { f64::from(*value) };
            let (mut slid, mut typed) = (shown, shown);
            let mut slider = Slider::new(&mut slid, f64::from(self.range.0)..=f64::from(self.range.1))
                .show_value(false)
                .clamping(SliderClamping::Edits);
            slider = match self.scale {
                Scale::Linear => slider,
                Scale::Logarithmic(smallest) => slider.logarithmic(true).smallest_positive(smallest.into()),
                Scale::Whole => slider.step_by(1.0),
            };
            ui.spacing_mut().slider_width =
                (ui.available_width() - VALUE_WIDTH - ui.spacing().item_spacing.x).max(40.0);
            let slider = ui.add(slider).labelled_by(name.id);
            let field = ui.add_sized(vec2(VALUE_WIDTH, ui.spacing().interact_size.y), self.field(&mut typed));
            let field = field.labelled_by(name.id);
            // Leaving a field as it was must not round the value to the digits shown.
            let is_typed = number::text(typed) != number::text(shown);
            let entered = if is_typed { Some(typed) } else { (slid != shown).then_some(slid) };
            (name | slider | field, entered)
        });
        let accepted = entered.and_then(|entered| self.accept(entered)).map(|accepted| accepted as f32);
        accepted.inspect(|&accepted| *value = accepted).is_some()
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

    /// A value to type or to drag.
    fn field<'a>(&self, value: &'a mut f64) -> DragValue<'a> {
        let (low, high) = self.range;
        let speed = match self.scale {
            Scale::Linear => f64::from(high - low) / 300.0,
            Scale::Logarithmic(smallest) => (value.abs() * 0.01).max(f64::from(smallest)),
            Scale::Whole => 0.1,
        };
        DragValue::new(value)
            .range(self.limits.0..=self.limits.1)
            .clamp_existing_to_range(false)
            // Half a number is no number that a cloth should have.
            .update_while_editing(false)
            .speed(speed)
            .custom_formatter(|value, _| number::text(value))
            .custom_parser(number::parse)
            .suffix(if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) })
    }
}

/// A row with a name and, behind it, what `content` adds and joins to the name's response.
pub(super) fn row<R>(
    ui: &mut Ui,
    naming: Naming,
    differs: bool,
    content: impl FnOnce(&mut Ui, Response) -> (Response, R),
) -> R {
    let content = |ui: &mut Ui| {
        let height = ui.spacing().interact_size.y;
        let name = ui
            .allocate_ui_with_layout(vec2(NAME_WIDTH, height), Layout::left_to_right(Align::Center), |ui| {
                ui.set_min_width(NAME_WIDTH);
                let text = RichText::new(naming.name);
                ui.add(Label::new(if differs { text.italics() } else { text }).selectable(false))
            })
            .inner;
        let (response, result) = content(ui, name);
        if differs {
            explain(response, &format!("{}\n\nThe cloths differ here; the first one's is shown.", naming.hover));
        } else {
            explain(response, naming.hover);
        }
        result
    };
    group(ui, naming.name, |ui| ui.horizontal(content).inner)
}

/// Buttons side by side.
pub(super) fn buttons(ui: &mut Ui, name: &str, content: impl FnOnce(&mut Ui)) {
    group(ui, name, |ui| ui.horizontal_wrapped(content));
}

/// A part whose ids come from `name` alone: warnings and rows that come and go before it neither change them nor end a
/// drag.
fn group<R>(ui: &mut Ui, name: &str, content: impl FnOnce(&mut Ui) -> R) -> R {
    let id = ui.id().with(name);
    ui.scope_builder(UiBuilder::new().id(id), content).inner
}

/// A row that shows a value and changes nothing.
pub(super) fn reading(ui: &mut Ui, naming: Naming, value: String) {
    row(ui, naming, false, |ui, name| (name | ui.add(Label::new(value).selectable(false)), ()));
}

/// Three numbers in a row.
pub(super) fn vector(ui: &mut Ui, knob: &Knob, values: &mut [f32; 3]) -> bool {
    let entered = row(ui, knob.naming, false, |ui, name| {
        let width = (ui.available_width() - 2.0 * ui.spacing().item_spacing.x) / 3.0;
        let mut response = name.clone();
        let mut entered = [None; 3];
        for (value, entered) in values.iter().zip(&mut entered) {
            let shown = if value.is_nan() { 0.0 } else { f64::from(*value) };
            let mut typed = shown;
            let field = ui.add_sized(vec2(width, ui.spacing().interact_size.y), knob.field(&mut typed));
            response |= field.labelled_by(name.id);
            *entered = (number::text(typed) != number::text(shown)).then_some(typed);
        }
        (response, entered)
    });
    for (value, entered) in values.iter_mut().zip(entered) {
        if let Some(accepted) = entered.and_then(|entered| knob.accept(entered)) {
            *value = accepted as f32;
        }
    }
    entered.iter().any(Option::is_some)
}

/// A box to tick.
pub(super) fn tick(ui: &mut Ui, naming: Naming, differs: bool, is_on: &mut bool) -> bool {
    let before = *is_on;
    row(ui, naming, differs, |ui, name| {
        let tick = ui.checkbox(is_on, "").labelled_by(name.id);
        (name | tick, ())
    });
    *is_on != before
}

/// A button, among [`buttons`]. True once it is pressed.
pub(super) fn button(ui: &mut Ui, naming: Naming, is_enabled: bool) -> bool {
    explain(ui.add_enabled(is_enabled, Button::new(naming.name)), naming.hover).clicked()
}

/// A button that opens a menu.
pub(super) fn menu(ui: &mut Ui, naming: Naming, content: impl FnOnce(&mut Ui)) {
    explain(ui.menu_button(format!("{} ⏷", naming.name), content).response, naming.hover);
}

/// An entry of a menu. True once it is chosen.
pub(super) fn entry(ui: &mut Ui, naming: Naming) -> bool {
    let is_chosen = explain(ui.button(naming.name), naming.hover).clicked();
    if is_chosen {
        ui.close();
    }
    is_chosen
}

/// A row with a list to choose from. `entries` are what is chosen, its name and its explanation.
pub(super) fn choice<T: Copy + PartialEq>(
    ui: &mut Ui,
    naming: Naming,
    differs: bool,
    chosen: Option<T>,
    otherwise: &str,
    entries: &[(T, &str, &str)],
) -> Option<T> {
    row(ui, naming, differs, |ui, name| {
        let text = entries.iter().find(|(value, ..)| Some(*value) == chosen).map_or(otherwise, |(_, text, _)| text);
        let mut new = None;
        let list = ComboBox::from_id_salt(naming.name).selected_text(text).width(ui.available_width()).truncate();
        let response = list.show_ui(ui, |ui| {
            for (value, text, hover) in entries {
                if explain(ui.selectable_label(chosen == Some(*value), *text), hover).clicked() {
                    new = Some(*value);
                }
            }
        });
        (name.clone() | response.response.labelled_by(name.id), new)
    })
}

/// A part of the panel that can be folded.
pub(super) fn section(ui: &mut Ui, naming: Naming, is_open: bool, content: impl FnOnce(&mut Ui)) {
    group(ui, naming.name, |ui| {
        let section = CollapsingHeader::new(RichText::new(naming.name).strong()).default_open(is_open);
        explain(section.show_unindented(ui, content).header_response, naming.hover);
    });
}

/// Explains a control, also one that can't be used now.
pub(super) fn explain(response: Response, hover: &str) -> Response {
    response.on_hover_text(hover).on_disabled_hover_text(hover)
}
