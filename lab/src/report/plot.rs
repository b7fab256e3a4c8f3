//! Plots of what was measured beside what is expected.

use std::{io, ops::Range};

use plotters::{coord::Shift, prelude::*};

use crate::laboratory::Curve;

const SIZE: (u32, u32) = (900, 560);

/// Told apart by the colour-blind too.
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
];

/// How the curves of one plot are drawn.
struct Look {
    caption: &'static str,
    x: &'static str,
    y: &'static str,
    legend: SeriesLabelPosition,
}

fn look(name: &str) -> Look {
    let look = |caption, x, y, legend| Look { caption, x, y, legend };
    match name {
        "energy" => look(
            "Energy of a swinging cloth that nothing damps",
            "time, s",
            "share of the energy set free, %",
            SeriesLabelPosition::LowerLeft,
        ),
        "pull" => look(
            "Cotton jersey, pulled along warp and weft",
            "strain, %",
            "force over width, N/m",
            SeriesLabelPosition::UpperLeft,
        ),
        "cantilever" => look(
            "Woven cotton over an edge",
            "along the level, bending lengths",
            "height, bending lengths",
            SeriesLabelPosition::LowerLeft,
        ),
        "cusick" => {
            look("Drape by Cusick's test", "the limpest first", "drape coefficient, %", SeriesLabelPosition::UpperLeft)
        }
        "cusick-resolution" => look(
            "Drape on ever finer meshes",
            "edges along the radius",
            "drape coefficient, %",
            SeriesLabelPosition::LowerLeft,
        ),
        "cusick-substeps" => {
            look("Drape with ever more substeps", "substeps", "drape coefficient, %", SeriesLabelPosition::LowerRight)
        }
        _ => look("", "", "", SeriesLabelPosition::UpperRight),
    }
}

/// The plot of a name.
pub fn svg(name: &str, curves: &[Curve]) -> io::Result<String> {
    let mut image = String::new();
    let area = SVGBackend::with_string(&mut image, SIZE).into_drawing_area();
    draw(&area, &look(name), curves).map_err(|error| io::Error::other(error.to_string()))?;
    drop(area);
    Ok(image)
}

fn draw<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    look: &Look,
    curves: &[Curve],
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    area.fill(&WHITE)?;
    let values = |axis: usize| curves.iter().flat_map(move |curve| curve.points.iter().map(move |point| point[axis]));
    let mut chart = ChartBuilder::on(area)
        .caption(look.caption, ("sans-serif", 20))
        .margin(16)
        .x_label_area_size(48)
        .y_label_area_size(72)
        .build_cartesian_2d(span(values(0)), span(values(1)))?;
    let names = curves.first().map_or(&[][..], |curve| &curve.names);
    let x_label = |x: &f64| match names {
        [] => label(*x),
        names => names.get(x.round() as usize).map_or_else(String::new, |name| name.replace('_', " ")),
    };
    chart
        .configure_mesh()
        .x_desc(look.x)
        .y_desc(look.y)
        .x_label_formatter(&x_label)
        .y_label_formatter(&|y| label(*y))
        .label_style(("sans-serif", 14))
        .light_line_style(TRANSPARENT)
        .draw()?;
    for (number, Curve { series, is_expected, points, .. }) in curves.iter().enumerate() {
        let colour = COLOURS[number % COLOURS.len()];
        let places = || points.iter().map(|[x, y]| (*x, *y));
        if *is_expected {
            let line = LineSeries::new(places(), BLACK.mix(0.6).stroke_width(2));
            let legend = |(x, y)| PathElement::new([(x, y), (x + 20, y)], BLACK.mix(0.6).stroke_width(2));
            chart.draw_series(line)?.label(series).legend(legend);
            continue;
        }
        chart.draw_series(LineSeries::new(places(), colour.mix(0.6)))?;
        // A curve of many points needs no marks.
        let marked = if points.len() > 60 { 0 } else { points.len() };
        let marks = places().take(marked).map(|place| Circle::new(place, 4, colour.filled()));
        let legend = move |(x, y)| Circle::new((x + 10, y), 4, colour.filled());
        chart.draw_series(marks)?.label(series).legend(legend);
    }
    chart
        .configure_series_labels()
        .position(look.legend.clone())
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.3))
        .label_font(("sans-serif", 14))
        .draw()?;
    area.present()
}

/// Without the dust of f64: 0.3 instead of 0.30000000000000004, and zero.
fn label(value: f64) -> String {
    // Minus zero plus zero is zero.
    ((value * 1e6).round() / 1e6 + 0.0).to_string()
}

/// All of `values`, with some room at both ends.
fn span(values: impl Iterator<Item = f64>) -> Range<f64> {
    let finite = values.filter(|value| value.is_finite());
    let (low, high) = finite.fold((f64::MAX, f64::MIN), |(low, high), value| (value.min(low), value.max(high)));
    if low >= high {
        return low.min(0.0)..low.max(1.0);
    }
    let room = 0.05 * (high - low);
    low - room..high + room
}
