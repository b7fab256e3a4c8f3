//! The bending length of strips by the cantilever test, ASTM D1388.
//!
//! A strip is clamped level over an edge and hangs down by its own weight. Its overhang is such that its end should just
//! meet the plane at 41.5°; from the angle at which it does end, the numeric elastica gives the bending length.
//!
//! The last two rows of particles that are clamped stand half a cell before and behind the edge. A cloth of particles bends
//! at each as over half a cell to both sides of it, so this is where a clamp of real cloth is.

use bevy::math::Vec3A;
use bevy_drape::{prelude::Fabric, solver::Method};

use super::{
    Extent,
    bed::{self, Bed, GRAVITY, bare},
    elastica::{self, Elastica, PLANE},
    mesh::{Kind, Strip},
    record::{Case, Curve, Measurement, Outcome},
};

const NAME: &str = "cantilever";

/// On grids along the threads.
const ALONG_THREADS: f64 = 0.05;

/// At 45°, and without rows and columns.
const ELSEWHERE: f64 = 0.10;

pub fn run(extent: Extent) -> Outcome {
    let mut outcome = Outcome { measurements: vec![oracle(), rule()], curves: vec![profile()] };
    let cotton = ("cotton_woven", Fabric::COTTON_WOVEN);
    let grid = [("warp", Kind::Grid), ("weft", Kind::Grid)];
    let other = [("45°", Kind::Bias), ("warp", Kind::Delaunay), ("weft", Kind::Delaunay), ("45°", Kind::Delaunay)];
    let cells = if extent == Extent::Brief { &[12][..] } else { &[12, 24][..] };
    for &cells in cells {
        for (direction, kind) in grid.into_iter().chain(other) {
            hang(&mut outcome, &cotton, kind, direction, cells, Method::Strands, Some(8));
        }
    }
    if extent == Extent::Brief {
        return outcome;
    }
    for (kind, cells, substeps) in [(Kind::Grid, 12, 4), (Kind::Grid, 12, 32), (Kind::Delaunay, 24, 32)] {
        hang(&mut outcome, &cotton, kind, "warp", cells, Method::Strands, Some(substeps));
    }
    for (kind, method) in [Kind::Grid, Kind::Bias, Kind::Delaunay]
        .into_iter()
        .flat_map(|kind| [(kind, Method::Xpbd), (kind, Method::Explicit)])
    {
        let direction = if kind == Kind::Bias { "45°" } else { "warp" };
        let substeps = (method == Method::Xpbd).then_some(8);
        hang(&mut outcome, &cotton, kind, direction, 12, method, substeps);
    }
    for preset in bed::presets().filter(|preset| preset.0 != "cotton_woven") {
        for kind in [Kind::Grid, Kind::Delaunay] {
            hang(&mut outcome, &preset, kind, "warp", 12, Method::Strands, Some(8));
        }
    }
    outcome
}

/// The numeric elastica beside the textbook's deflection of a stiff beam, w l⁴ / 8 B.
fn oracle() -> Measurement {
    let stiff = Elastica::with_tip(1e-3);
    let case = Case { mesh: "elastica", ..Case::default() };
    let depth = stiff.chord().tan() * stiff.overhang();
    Measurement::new(NAME, "deflection of a stiff beam, bending lengths", case, depth, stiff.overhang().powi(4) / 8.0)
        .within(1e-3)
}

/// And beside the rule of the standard, which is Peirce's formula rounded.
fn rule() -> Measurement {
    let case = Case { mesh: "elastica", ..Case::default() };
    let measured = Elastica::with_chord(PLANE).overhang();
    let quantity = "overhang at 41.5°, bending lengths, against Peirce";
    Measurement::new(NAME, quantity, case, measured, elastica::peirce(PLANE).recip()).within(0.02)
}

/// The elastica at 41.5°.
fn profile() -> Curve {
    let elastica = Elastica::with_chord(PLANE);
    let points = elastica
        .profile()
        .map(|[along, depth]| [along, -depth])
        .enumerate()
        .filter(|(i, _)| i % 40 == 0)
        .map(|(_, point)| point)
        .collect();
    Curve { plot: NAME, series: "numeric elastica".into(), is_expected: true, points, ..Curve::default() }
}

fn hang(
    outcome: &mut Outcome,
    (name, fabric): &(&'static str, Fabric),
    kind: Kind,
    direction: &'static str,
    cells: u32,
    method: Method,
    substeps: Option<u32>,
) {
    let case = Case { fabric: name, mesh: kind.name(), n: cells, substeps, direction, method };
    let expected = f64::from(fabric.bending_rigidity / (fabric.density * GRAVITY)).cbrt();
    let overhang = expected * Elastica::with_chord(PLANE).overhang();
    // Half a cell of the first is clamped.
    let cell = overhang / (f64::from(cells) - 0.5);
    let strip = Strip { kind, cells, cell, cells_across: 6, direction };
    let mut bed =
        Bed::new(strip.mesh(), bare(fabric.clone())).solved_as_in(&case).pinned(|p| strip.along(p) < 1.01 * cell);
    // Near the critical damping of its slowest swing.
    let rest = bed.settle(2.0 * (f64::from(GRAVITY) / expected).sqrt() as f32, 20.0);
    let end = bed.chosen(|p| strip.along(p) > strip.length() - 0.01 * cell);
    let (reach, depth) = (bed.mean(&end, |p| strip.along(p) as f32) - 0.5 * cell, -bed.mean(&end, |p| p.y));
    let measured = overhang / Elastica::with_chord(depth.atan2(reach)).overhang();
    let tolerance = if kind == Kind::Grid { ALONG_THREADS } else { ELSEWHERE };
    let line = Measurement::new(NAME, "bending length, m", case.clone(), measured, expected);
    outcome.measurements.push(line.within(tolerance).after(rest));
    outcome.curves.extend(curve(&bed, &strip, &case, expected));
}

/// The strip from the side, in bending lengths, where it is one of those that are plotted.
fn curve(bed: &Bed, strip: &Strip, case: &Case, bending_length: f64) -> Option<Curve> {
    let is_plotted = case.fabric == "cotton_woven" && case.n == 12 && case.method == Method::Strands;
    if !is_plotted || case.substeps != Some(8) || case.direction == "weft" {
        return None;
    }
    let middle = 0.5 * strip.width();
    let is_near = |place: Vec3A| (strip.across(place) - middle).abs() < 0.51 * strip.cell;
    let mut points: Vec<[f64; 2]> = bed
        .chosen(is_near)
        .into_iter()
        .map(|i| bed.particles.position[i])
        .map(|p| [(strip.along(p) - 0.5 * strip.cell) / bending_length, f64::from(p.y) / bending_length])
        .collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let series = format!("{}, {}", case.mesh, case.direction);
    Some(Curve { plot: NAME, series, is_expected: false, points, ..Curve::default() })
}
