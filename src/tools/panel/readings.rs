//! What the chosen cloths cost and how they fare, at the top of the panel; and what they are made of, farther down.

use std::collections::VecDeque;

use bevy_egui::egui::{Ui, Vec2b};
use egui_plot::{HLine, Line, Plot, PlotPoints};

use super::{
    control::{Naming, explain, figures, long_reading, naming, reading, section},
    memory::Readings,
    model::Model,
    number,
};

/// Height of the plot, in points.
const PLOT_HEIGHT: f32 = 42.0;

const READINGS: Naming = naming("Readings", "Measurements of the chosen cloth; of several, sums and extremes.");
const STEP_TIME: Naming = naming(
    "Step time, ms",
    "Time that a step takes on its thread, in ms: of the latest step, and mean and largest of the latest 300. Several cloths are added \
     up, though they may be stepped side by side.",
);
const HISTORY: &str = "Time of the latest 300 steps in ms, the newest on the right, and their mean.";
const SUBSTEPS: Naming = naming(
    "Substeps taken",
    "Substeps of the latest step, and why so many. Of several cloths, those of the one that took most. A cloth at rest is \
     asleep, and takes none, until something changes near it.",
);
const STRETCH: Naming = naming(
    "Stretch, %",
    "Stretch of threads over their length: of the one that is stretched the most, and the mean of all, where what is pressed together \
     counts as nothing. A few percent can't be seen.",
);
const ENERGY: Naming = naming(
    "Energy, J",
    "Energy of motion; energy in the springs; and the sum of both and that of height, of which only changes mean something.",
);
const CONTACTS: Naming = naming(
    "Contacts",
    "Contacts at the end of the latest step: particles at obstacles, and triangles and edges at each other and at what is sharp.",
);
const MESH: Naming = naming("Mesh", "What the cloth is made of.");
const PARTICLES: Naming = naming("Particles", "Points with a mass: vertices at one place are one of them.");
const SPRINGS: Naming = naming("Springs", "Springs of all kinds.");
const STRUCTURE: Naming = naming(
    "Structure",
    "What strands find in the mesh: rows and columns, which they hold best, strands that go straight on from edge to edge, \
     or nothing but springs; and the coarse levels that it has, whether they are used or not.",
);

/// What the chosen cloths cost, and how they fare.
pub(super) fn show(ui: &mut Ui, model: &Model, step_times: &VecDeque<f32>) {
    let readings = &model.readings;
    section(ui, READINGS, true, |ui| {
        show_time(ui, step_times);
        long_reading(ui, SUBSTEPS, substeps(readings));
        let percent = |share: f32| format!("{:.2}", share * 100.0);
        figures(ui, STRETCH, &[(percent(readings.largest_strain), "largest"), (percent(readings.mean_strain), "mean")]);
        let joules = |energy: f32| number::brief(energy.into());
        let energies = [(readings.kinetic, "kinetic"), (readings.elastic, "elastic"), (readings.total, "total")];
        figures(ui, ENERGY, &energies.map(|(energy, of)| (joules(energy), of)));
        reading(ui, CONTACTS, readings.contacts.to_string());
    });
}

/// What the chosen cloths are made of.
pub(super) fn show_mesh(ui: &mut Ui, readings: &Readings) {
    section(ui, MESH, false, |ui| {
        reading(ui, PARTICLES, readings.particles.to_string());
        reading(ui, SPRINGS, readings.springs.to_string());
        long_reading(ui, STRUCTURE, readings.structure.clone());
    });
}

fn substeps(readings: &Readings) -> String {
    let Readings { substeps, needed_substeps, substep_reason, asleep, .. } = readings;
    if *asleep > 0 && *substeps == 0 {
        "none, asleep".into()
    } else if substeps < needed_substeps {
        format!("{substeps} of {needed_substeps}, {substep_reason}")
    } else {
        format!("{substeps}, {substep_reason}")
    }
}

fn show_time(ui: &mut Ui, step_times: &VecDeque<f32>) {
    let mean = step_times.iter().sum::<f32>() / step_times.len().max(1) as f32;
    let latest = step_times.back().copied().unwrap_or_default();
    let largest = step_times.iter().copied().fold(0.0, f32::max);
    let times = [(latest, "latest"), (mean, "mean"), (largest, "worst")];
    figures(ui, STEP_TIME, &times.map(|(time, of)| (format!("{time:.2}"), of)));
    plot(ui, step_times, mean);
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
    explain(plot.response, HISTORY);
}
