//! A table of measurements.

use crate::laboratory::Measurement;

/// Heads of the columns, and what is in them.
const COLUMNS: [(&str, fn(&Measurement) -> String); 10] = [
    ("quantity", |m| m.quantity.clone()),
    ("fabric", |m| m.case.fabric.replace('_', " ")),
    ("mesh", |m| m.case.mesh.into()),
    ("cells", |m| if m.case.n > 0 { m.case.n.to_string() } else { String::new() }),
    ("direction", |m| m.case.direction.into()),
    ("solver", |m| if m.case.mesh == "elastica" { String::new() } else { m.case.effort() }),
    ("expected", |m| m.expected.map_or_else(String::new, number)),
    ("measured", |m| number(m.measured)),
    ("off by", |m| m.error().filter(|error| error.is_finite()).map_or_else(String::new, percent)),
    ("allowed", allowed),
];

/// A row each, without the columns that are empty all over or everywhere the same word.
pub fn markdown(measurements: &[Measurement]) -> String {
    let is_empty = |of: fn(&Measurement) -> String| measurements.iter().all(|m| of(m).is_empty());
    let columns: Vec<_> = COLUMNS.into_iter().filter(|(_, of)| !is_empty(*of)).collect();
    let row = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let heads = row(columns.iter().map(|(head, _)| (*head).into()).collect());
    let rule = row(columns.iter().map(|_| "---".into()).collect());
    let rows = measurements.iter().map(|m| row(columns.iter().map(|(_, of)| of(m)).collect()));
    heads + &rule + &rows.collect::<String>()
}

/// The tolerance, and a word where it is missed.
fn allowed(measurement: &Measurement) -> String {
    let Some(tolerance) = measurement.tolerance else { return String::new() };
    let missed = match measurement.is_ok() {
        Some(true) => "",
        _ if !measurement.is_at_rest => " **not at rest**",
        _ => " **missed**",
    };
    format!("{}{missed}", percent(tolerance))
}

/// Four digits.
fn number(value: f64) -> String {
    let digits = if value == 0.0 { 0.0 } else { 3.0 - value.abs().log10().floor() };
    match digits as i32 {
        0..=3 => format!("{value:.*}", digits as usize),
        4..=5 => format!("{value:.5}"),
        ..0 => format!("{value:.0}"),
        _ => format!("{value:.1e}"),
    }
}

fn percent(share: f64) -> String {
    match 100.0 * share {
        0.0 => "0 %".into(),
        percent if percent.abs() >= 10.0 => format!("{percent:.0} %"),
        percent if percent.abs() >= 1.0 => format!("{percent:.1} %"),
        percent => format!("{percent:.2} %"),
    }
}
