//! The section of numbers.

use std::collections::VecDeque;

use bevy_egui::egui::{Ui, Vec2b};
use egui_plot::{HLine, Line, Plot, PlotPoints};

use super::{
    control::{Naming, explain, naming, reading, section},
    memory::Readings,
    model::Model,
    number,
};

/// Height of the plot, in points.
const PLOT_HEIGHT: f32 = 64.0;

/// What the chosen cloths are made of, what they cost, and how they fare.
pub(super) fn show(ui: &mut Ui, model: &Model, step_times: &VecDeque<f32>) {
    section(ui, naming("Numbers", "Measurements of the chosen cloth; of several, sums and extremes."), true, |ui| {
        show_cost(ui, &model.readings, step_times);
        show_state(ui, &model.readings);
    });
}

const STEP_TIME: Naming = naming(
    "Step time",
    "Time that a step takes on its thread, in ms, and its mean over the latest 300 steps. Several cloths are added up, \
     though they may be stepped side by side.",
);
const PARTICLES: Naming = naming("Particles", "Points with a mass: vertices at one place are one of them.");
const SPRINGS: Naming = naming("Springs", "Springs of all kinds.");
const WEAVE: Naming = naming(
    "Mesh",
    "What strands find in the mesh: rows and columns, which they hold best, strands that go straight on from edge to edge, \
     or nothing but springs; and the coarse levels that it has, whether they are used or not.",
);
const SUBSTEPS: Naming = naming(
    "Substeps taken",
    "Substeps of the latest step, and why so many. Of several cloths, those of the one that took most. A cloth at rest is \
     asleep, and takes none, until something changes near it.",
);
const CONTACTS: Naming = naming(
    "Contacts",
    "Contacts at the end of the latest step: particles at obstacles, and triangles and edges at each other and at what is sharp.",
);
const LARGEST_STRAIN: Naming = naming(
    "Largest strain",
    "Stretch of the thread that is stretched the most, over its length. A few percent can't be seen.",
);
const MEAN_STRAIN: Naming =
    naming("Mean strain", "Mean stretch of all threads; what is pressed together counts as nothing.");
const KINETIC: Naming = naming("Kinetic", "Energy of motion, in J.");
const ELASTIC: Naming = naming("Elastic", "Energy in the springs, in J.");
const TOTAL: Naming = naming("Total", "Energy of motion, springs and height, in J. Only its changes mean something.");

fn show_cost(ui: &mut Ui, readings: &Readings, step_times: &VecDeque<f32>) {
    let mean = step_times.iter().sum::<f32>() / step_times.len().max(1) as f32;
    let latest = step_times.back().copied().unwrap_or_default();
    reading(ui, STEP_TIME, format!("{latest:.2} ms, mean {mean:.2} ms"));
    plot(ui, step_times, mean);
    reading(ui, PARTICLES, readings.particles.to_string());
    reading(ui, SPRINGS, readings.springs.to_string());
    reading(ui, WEAVE, readings.structure.clone());
    let taken = format!("{}, {}", readings.substeps, readings.substep_reason);
    let is_asleep = readings.asleep > 0 && readings.substeps == 0;
    reading(ui, SUBSTEPS, if is_asleep { "none, asleep".into() } else { taken });
    reading(ui, CONTACTS, readings.contacts.to_string());
}

fn show_state(ui: &mut Ui, readings: &Readings) {
    let percent = |share: f32| format!("{:.2} %", share * 100.0);
    let joules = |energy: f32| format!("{} J", number::text(energy.into()));
    reading(ui, LARGEST_STRAIN, percent(readings.largest_strain));
    reading(ui, MEAN_STRAIN, percent(readings.mean_strain));
    reading(ui, KINETIC, joules(readings.kinetic));
    reading(ui, ELASTIC, joules(readings.elastic));
    reading(ui, TOTAL, joules(readings.total));
}

/// The time of the latest steps.
fn plot(ui: &mut Ui, step_times: &VecDeque<f32>, mean: f32) {
    let points: PlotPoints = step_times.iter().enumerate().map(|(i, &time)| [i as f64, time.into()]).collect();
    let color = ui.visuals().hyperlink_color;
    let mean_color = ui.visuals().weak_text_color();
    let plot = Plot::new("step times")
        .height(PLOT_HEIGHT)
        .show_axes(Vec2b::new(false, true))
        .show_grid(Vec2b::new(false, true))
        .y_axis_min_width(24.0)
        .allow_zoom(false)
        .allow_drag(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_double_click_reset(false)
        .show_crosshair(false)
        .show_x(false)
        .show_y(false)
        .include_x(0.0)
        .include_x(300.0)
        .include_y(0.0)
        .show(ui, |plot| {
            plot.line(Line::new("step time", points).color(color));
            plot.hline(HLine::new("mean", f64::from(mean)).color(mean_color));
        });
    explain(plot.response, "Time of the latest 300 steps in ms, the newest on the right, and their mean.");
}
