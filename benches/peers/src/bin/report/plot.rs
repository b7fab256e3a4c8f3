//! The plot: what a frame costs against how far the cloth stretches, both logarithmic.

use std::{collections::BTreeMap, error::Error, ops::Range};

use bevy_drape_peers::line::Line;
use plotters::{coord::Shift, prelude::*};

const SIZE: (u32, u32) = (900, 600);

/// A colour a system, told apart by the colour-blind too.
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
];

/// Settings of one system that differ in the number that is swept alone.
struct Series {
    name: String,
    colour: RGBColor,
    /// Which series of its system, hence how a point is drawn.
    variant: usize,
    /// Time per frame, ms, and largest strain, %; the fastest first.
    points: Vec<(f64, f64)>,
}

/// A plot of `lines`, whose cloth has `n` particles along each side.
pub fn svg(lines: &[&Line], n: usize) -> Result<String, Box<dyn Error>> {
    let mut image = String::new();
    let area = SVGBackend::with_string(&mut image, SIZE).into_drawing_area();
    draw(&area, &series(lines), n).map_err(|error| error.to_string())?;
    drop(area);
    Ok(image)
}

fn series(lines: &[&Line]) -> Vec<Series> {
    let mut points: BTreeMap<(&str, &str), Vec<(f64, f64)>> = BTreeMap::new();
    for line in lines {
        // What blew up has no place on a logarithmic axis, nor has cloth that doesn't stretch at all.
        let Some(strain) = line.max_strain.filter(|strain| line.finite && *strain > 0.0) else { continue };
        let variant = line.setting.split_once(", ").map_or("", |(_, variant)| variant);
        // Whatever the levels are, they make one series.
        let variant = variant.find(" levels ").map_or(variant, |end| &variant[..end + 7]);
        let point = (line.us_per_frame_median / 1e3, f64::from(strain) * 100.0);
        points.entry((&line.system, variant)).or_default().push(point);
    }
    let mut systems: Vec<&str> = points.keys().map(|(system, _)| *system).collect();
    systems.dedup();
    let mut series: Vec<Series> = Vec::new();
    for ((system, variant), mut points) in points {
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let place = systems.iter().position(|other| *other == system).unwrap_or_default();
        let colour = COLOURS[place % COLOURS.len()];
        let name = if variant.is_empty() { system.to_owned() } else { format!("{system}, {variant}") };
        let variant = series.iter().filter(|other| other.colour == colour).count();
        series.push(Series { name, colour, variant, points });
    }
    series
}

fn draw<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    series: &[Series],
    n: usize,
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    area.fill(&WHITE)?;
    let points = || series.iter().flat_map(|series| &series.points);
    let mut chart = ChartBuilder::on(area)
        .caption(format!("A cloth of {n} x {n} swings from two corners"), ("sans-serif", 20))
        .margin(16)
        .x_label_area_size(48)
        .y_label_area_size(72)
        .build_cartesian_2d(
            span(points().map(|point| point.0)).log_scale(),
            span(points().map(|point| point.1)).log_scale(),
        )?;
    chart
        .configure_mesh()
        .x_desc("CPU time per frame, ms")
        .y_desc("largest strain, %")
        // As f32, or 0.3 would be 0.30000000000000004.
        .x_label_formatter(&|x| (*x as f32).to_string())
        .y_label_formatter(&|y| (*y as f32).to_string())
        .label_style(("sans-serif", 14))
        .light_line_style(TRANSPARENT)
        .draw()?;
    for Series { name, colour, variant, points } in series {
        let (colour, variant) = (*colour, *variant);
        chart.draw_series(LineSeries::new(points.iter().copied(), colour.mix(0.5)))?;
        chart
            .draw_series(points.iter().map(|point| mark(variant, *point, colour)))?
            .label(name)
            .legend(move |(x, y)| mark(variant, (x + 10, y), colour));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::MiddleLeft)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.3))
        .label_font(("sans-serif", 14))
        .draw()?;
    area.present()
}

/// A point of a system's first, second or another series: a disc, a ring or a dot.
fn mark<C>(variant: usize, at: C, colour: RGBColor) -> Circle<C, i32> {
    match variant {
        0 => Circle::new(at, 5, colour.filled()),
        1 => Circle::new(at, 5, colour.stroke_width(2)),
        _ => Circle::new(at, 3, colour.filled()),
    }
}

/// All of `values`, with some room at both ends.
fn span(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (least, most) = values.fold((f64::MAX, 0.0), |(least, most), value| (value.min(least), value.max(most)));
    if most == 0.0 { 0.1..10.0 } else { least / 1.6..most * 1.6 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(setting: &str, strain: Option<f32>) -> Line {
        Line {
            system: "Jolt".into(),
            version: "1".into(),
            setting: setting.into(),
            n: 64,
            us_per_frame_median: 500.0,
            max_strain: strain,
            mean_strain: None,
            finite: strain.is_some(),
            mean_height_at_quarter_second: None,
        }
    }

    #[test]
    fn a_variant_is_a_series_in_the_colour_of_its_system() {
        let lines = [line("5", Some(0.1)), line("5, tied", Some(0.1)), line("10", None)];
        let series = series(&lines.iter().collect::<Vec<_>>());
        assert_eq!(series.iter().map(|s| s.name.as_str()).collect::<Vec<_>>(), ["Jolt", "Jolt, tied"]);
        assert_eq!(series[0].colour, series[1].colour);
        assert_eq!(series[0].points.len(), 1);
    }

    #[test]
    fn the_plot_names_its_series_and_may_be_empty() {
        assert!(svg(&[&line("5", Some(0.1))], 64).unwrap().contains("Jolt"));
        assert!(svg(&[], 64).unwrap().contains("</svg>"));
    }
}
