//! The drape coefficient of each preset, by Cusick's test: BS 5058.
//!
//! A disc of 15 cm radius lies on a support of 9 cm radius, held from above. Of the ring that hangs over, the coefficient is
//! the share that its shadow in light from straight above still covers.
//!
//! The disc is let go flat, with a roughness of a tenth of a millimetre that lets it fold. Folds may pass through each
//! other.

use bevy_drape::prelude::Fabric;
use fastrand::Rng;

use super::{
    Extent,
    bed::{self, Bed, GRAVITY, bare},
    literature::{PUBLISHED, Published},
    mesh::{self, Kind},
    record::{Case, Curve, Measurement, Outcome},
    shadow,
};

const NAME: &str = "cusick";

/// Radii of cloth and support, m.
const RADIUS: f64 = 0.15;
const SUPPORT: f64 = 0.09;

/// How near a published value it has to be.
const AS_PUBLISHED: f64 = 0.10;

/// How near to itself on a finer mesh and with more substeps.
const CONVERGED: f64 = 0.05;

/// Pairs that may be out of order on a coarser mesh than [`EDGES`]: since discs take implicit steps, one of them is, whose bending
/// lengths differ by more than 10 %. Why isn't known.
const SWAPPED_WHERE_COARSE: f64 = 1.0;

/// Mean height of what the cloth is roughened by, m.
const ROUGHNESS: f32 = 1e-4;

/// Edges along the radius where nothing else is said.
const EDGES: u32 = 20;

pub fn run(extent: Extent) -> Outcome {
    let mut outcome = Outcome::default();
    let edges = if extent == Extent::Brief { 12 } else { EDGES };
    let mut found: Vec<(f64, f64)> = Vec::new();
    let kinds = if extent == Extent::Brief { &[Kind::Grid][..] } else { &[Kind::Grid, Kind::Delaunay] };
    for &kind in kinds {
        let (mut names, mut points) = (Vec::new(), Vec::new());
        for (i, (name, fabric)) in by_bending_length().into_iter().enumerate() {
            let case = Case { fabric: name, mesh: kind.name(), n: edges, substeps: Some(8), ..Case::default() };
            let line = coefficient(&fabric, kind, case);
            names.push(name);
            points.push([i as f64, line.measured]);
            if kind == Kind::Grid {
                found.push((bending_length(&fabric), line.measured));
            }
            outcome.measurements.push(line);
        }
        outcome.curves.push(Curve { plot: NAME, series: kind.name().into(), is_expected: false, points, names });
    }
    outcome.measurements.push(order(&found, edges));
    if extent == Extent::Full {
        outcome.measurements.extend(PUBLISHED.iter().map(against_paper));
        converge(&mut outcome);
    }
    outcome
}

/// A fabric of a paper, with what was measured of it.
fn against_paper(published: &Published) -> Measurement {
    let case = Case { fabric: published.name, mesh: Kind::Grid.name(), n: EDGES, substeps: Some(8), ..Case::default() };
    let line = coefficient(&published.fabric(), Kind::Grid, case);
    Measurement { expected: Some(published.coefficient), ..line.of(published.coefficient).within(AS_PUBLISHED) }
}

/// c³ = B / (density g): what a cloth's folds are measured by, m.
fn bending_length(fabric: &Fabric) -> f64 {
    f64::from(fabric.bending_rigidity / (fabric.density * GRAVITY)).cbrt()
}

/// The presets, the limpest first.
fn by_bending_length() -> Vec<(&'static str, Fabric)> {
    let mut presets = bed::presets().collect::<Vec<_>>();
    presets.sort_by(|(_, a), (_, b)| bending_length(a).total_cmp(&bending_length(b)));
    presets
}

/// Cusick found that bending length decides: what differs in it by more than 5 % has to come in its order.
fn order(found: &[(f64, f64)], edges: u32) -> Measurement {
    let pairs = found.iter().enumerate().flat_map(|(i, a)| found[i + 1..].iter().map(move |b| (a, b)));
    let swapped = pairs.filter(|(a, b)| b.0 > 1.05 * a.0 && b.1 < a.1).count();
    let case = Case { mesh: Kind::Grid.name(), n: edges, substeps: Some(8), ..Case::default() };
    let quantity = "pairs of presets that aren't in the order of their bending length";
    let allowed = if edges < EDGES { SWAPPED_WHERE_COARSE } else { 0.0 };
    Measurement::new(NAME, quantity, case, swapped as f64, 0.0).of(1.0).within(allowed)
}

/// The same on coarser and finer meshes and with more substeps, against the finest and the most.
fn converge(outcome: &mut Outcome) {
    for (name, fabric) in bed::presets().filter(|(name, _)| ["cotton_woven", "denim", "leather"].contains(name)) {
        let of = |n, substeps| {
            let case = Case { fabric: name, mesh: Kind::Grid.name(), n, substeps: Some(substeps), ..Case::default() };
            coefficient(&fabric, Kind::Grid, case)
        };
        let finest = of(2 * EDGES, 8);
        let [most, finest_most] = [EDGES, 2 * EDGES].map(|edges| of(edges, 32));
        let against = |line: Measurement, other: &Measurement, what: &str| {
            let expected = other.measured;
            let line = Measurement { quantity: format!("drape coefficient, %, against {what}"), ..line };
            Measurement { expected: Some(expected), ..line.of(expected).within(CONVERGED) }
        };
        let [eight, sixteen] = [8, 16].map(|substeps| of(EDGES, substeps));
        let coarse = of(EDGES / 2, 8);
        let finer = format!("{} edges", 2 * EDGES);
        outcome.measurements.push(against(eight.clone(), &finest, &finer));
        outcome.measurements.push(against(most.clone(), &finest_most, &finer));
        outcome.measurements.push(against(eight.clone(), &most, "32 substeps"));
        outcome.measurements.push(against(sixteen.clone(), &most, "32 substeps"));
        let curve = |plot, of: &str, points| {
            let series = format!("{}, {of}", name.replace('_', " "));
            Curve { plot, series, points, ..Curve::default() }
        };
        let edges = [&coarse, &eight, &finest].map(|line| [f64::from(line.case.n), line.measured]);
        outcome.curves.push(curve("cusick-resolution", "8 substeps", edges.into()));
        let edges = [&most, &finest_most].map(|line| [f64::from(line.case.n), line.measured]);
        outcome.curves.push(curve("cusick-resolution", "32 substeps", edges.into()));
        let substeps = [(8.0, &eight), (16.0, &sixteen), (32.0, &most)].map(|(n, line)| [n, line.measured]);
        outcome.curves.push(curve("cusick-substeps", "20 edges", substeps.into()));
    }
}

/// Drapes a disc and measures its shadow, in % of the ring.
fn coefficient(fabric: &Fabric, kind: Kind, case: Case) -> Measurement {
    let edge = RADIUS / f64::from(case.n);
    let mut bed = Bed::new(mesh::disc(kind, RADIUS, SUPPORT, edge), bare(fabric.clone())).solved_as_in(&case);
    bed = bed.pinned(|p| f64::from(p.length()) < SUPPORT + 0.6 * edge);
    let mut rng = Rng::with_seed(0);
    for (position, &w) in bed.particles.position.iter_mut().zip(&bed.particles.inverse_mass) {
        let height = 2.0 * ROUGHNESS * (2.0 * rng.f32() - 1.0);
        position.y = if w > 0.0 { height } else { 0.0 };
    }
    let rest = bed.settle(4.0, 30.0);
    let shadow = shadow::area(&bed.particles.position, &bed.topology.triangles);
    let disc = |radius: f64| core::f64::consts::PI * radius * radius;
    let share = (shadow - disc(SUPPORT)) / (disc(RADIUS) - disc(SUPPORT));
    Measurement::shown(NAME, "drape coefficient, %", case, 100.0 * share).after(rest)
}
