//! The panel's controls. None can be made without the text that explains it.

use bevy_egui::egui::{
    Align, Button, CollapsingHeader, ComboBox, Label, Layout, Response, RichText, Sense, TextStyle, Ui, UiBuilder, vec2,
};

/// Width of names, in points.
const NAME_WIDTH: f32 = 112.0;

/// What a control is called, and what it does: with the unit, a sensible range, and what to expect.
#[derive(Clone, Copy, Debug)]
pub(super) struct Naming<'a> {
    pub name: &'a str,
    pub hover: &'a str,
}

pub(super) const fn naming<'a>(name: &'a str, hover: &'a str) -> Naming<'a> {
    Naming { name, hover }
}

/// What there is to say of a value besides what it is.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Aside<'a> {
    /// The chosen cloths don't have it in common.
    pub differs: bool,
    /// It has a dot behind its name.
    pub is_marked: bool,
    /// A sentence, or nothing.
    pub note: &'a str,
}

impl From<bool> for Aside<'_> {
    fn from(differs: bool) -> Self {
        Self { differs, ..Self::default() }
    }
}

/// A row with a name and, behind it, what `content` adds and joins to the name's response.
pub(super) fn row<'a, R>(
    ui: &mut Ui,
    naming: Naming<'_>,
    aside: impl Into<Aside<'a>>,
    content: impl FnOnce(&mut Ui, Response) -> (Response, R),
) -> R {
    let Aside { differs, is_marked, note } = aside.into();
    let content = |ui: &mut Ui| {
        let height = ui.spacing().interact_size.y;
        let name = ui
            .allocate_ui_with_layout(vec2(NAME_WIDTH, height), Layout::left_to_right(Align::Center), |ui| {
                ui.set_min_width(NAME_WIDTH);
                ui.spacing_mut().item_spacing.x = 4.0;
                let text = RichText::new(naming.name);
                let name = ui.add(Label::new(if differs { text.italics() } else { text }).selectable(false));
                if is_marked {
                    ui.add(Label::new(RichText::new("•").small().weak()).selectable(false));
                }
                name
            })
            .inner;
        let (response, result) = content(ui, name);
        let differs = if differs { "The cloths differ here; the first one's is shown." } else { "" };
        let parts = [naming.hover, note, differs].into_iter().filter(|part| !part.is_empty());
        explain(response, &parts.collect::<Vec<_>>().join("\n\n"));
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
pub(super) fn group<R>(ui: &mut Ui, name: &str, content: impl FnOnce(&mut Ui) -> R) -> R {
    let id = ui.id().with(name);
    ui.scope_builder(UiBuilder::new().id(id), content).inner
}

/// A row that shows a value and changes nothing.
pub(super) fn reading(ui: &mut Ui, naming: Naming<'_>, value: String) {
    row(ui, naming, false, |ui, name| (name | ui.add(Label::new(value).selectable(false)), ()));
}

/// The same with room for two lines, so that what comes below stays where it is.
pub(super) fn long_reading(ui: &mut Ui, naming: Naming<'_>, value: String) {
    row(ui, naming, false, |ui, name| {
        let lines = vec2(ui.available_width(), 2.0 * ui.text_style_height(&TextStyle::Body));
        let value = ui.allocate_ui_with_layout(lines, Layout::top_down(Align::Min), |ui| {
            ui.set_min_size(lines);
            ui.add(Label::new(value).wrap().selectable(false))
        });
        (name | value.inner, ())
    });
}

/// A row of up to three numbers, each above what it is of. Their places don't depend on their digits: a row that is too wide would widen
/// all others.
pub(super) fn figures(ui: &mut Ui, naming: Naming<'_>, figures: &[(String, &str)]) {
    row(ui, naming, false, |ui, name| {
        let height = ui.text_style_height(&TextStyle::Body) + ui.text_style_height(&TextStyle::Small);
        let size = vec2((ui.available_width() - 2.0 * ui.spacing().item_spacing.x) / 3.0, height);
        let figure = |ui: &mut Ui, (value, of): &(String, &str)| {
            let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
            let mut ui = ui.new_child(UiBuilder::new().max_rect(rect).layout(Layout::top_down(Align::Min)));
            ui.spacing_mut().item_spacing.y = 0.0;
            let value = ui.add(Label::new(value).selectable(false).truncate());
            value | ui.add(Label::new(RichText::new(*of).small().weak()).selectable(false).truncate())
        };
        (figures.iter().fold(name, |all, one| all | figure(ui, one)), ())
    });
}

/// A box to tick.
pub(super) fn tick(ui: &mut Ui, naming: Naming<'_>, differs: bool, is_on: &mut bool) -> bool {
    let before = *is_on;
    row(ui, naming, differs, |ui, name| {
        let tick = ui.checkbox(is_on, "").labelled_by(name.id);
        (name | tick, ())
    });
    *is_on != before
}

/// A button, among [`buttons`]. True once it is pressed.
pub(super) fn button(ui: &mut Ui, naming: Naming<'_>, is_enabled: bool) -> bool {
    explain(ui.add_enabled(is_enabled, Button::new(naming.name)), naming.hover).clicked()
}

/// A button that opens a menu.
pub(super) fn menu(ui: &mut Ui, naming: Naming<'_>, content: impl FnOnce(&mut Ui)) {
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
pub(super) fn choice<'a, T: Copy + PartialEq>(
    ui: &mut Ui,
    naming: Naming<'_>,
    aside: impl Into<Aside<'a>>,
    chosen: Option<T>,
    otherwise: &str,
    entries: &[(T, &str, &str)],
) -> Option<T> {
    row(ui, naming, aside, |ui, name| {
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
pub(super) fn section(ui: &mut Ui, naming: Naming<'_>, is_open: bool, content: impl FnOnce(&mut Ui)) {
    fold(ui, naming, RichText::new(naming.name).strong(), is_open, content);
}

/// A part of a section that can be folded.
pub(super) fn subsection(ui: &mut Ui, naming: Naming<'_>, content: impl FnOnce(&mut Ui)) {
    fold(ui, naming, RichText::new(naming.name), true, content);
}

fn fold(ui: &mut Ui, naming: Naming<'_>, header: RichText, is_open: bool, content: impl FnOnce(&mut Ui)) {
    group(ui, naming.name, |ui| {
        let section = CollapsingHeader::new(header).default_open(is_open);
        explain(section.show_unindented(ui, content).header_response, naming.hover);
    });
}

/// Small text over the width of the panel.
pub(super) fn remark(ui: &mut Ui, text: impl Into<String>) {
    ui.add(Label::new(RichText::new(text).small().weak()).wrap().selectable(false));
}

/// Explains a control, also one that can't be used now.
pub(super) fn explain(response: Response, hover: &str) -> Response {
    response.on_hover_text(hover).on_disabled_hover_text(hover)
}
