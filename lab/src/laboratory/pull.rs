//! Strips that are pulled at both ends, with free sides.
//!
//! Both ends are drawn apart by known forces, as by weights over pulleys: each particle of an end also has the mass that
//! Earth pulls so hard at. Nothing else holds the strip, so it may get narrower all along, and the strain is the same
//! everywhere.

use bevy::math::Vec3A;
use bevy_drape::{prelude::Fabric, solver::Method};

use super::{
    BRIEF, EFFORTS, Extent,
    bed::{self, Bed, GRAVITY, bare},
    mesh::{Kind, Strip},
    record::{Case, Curve, Measurement, Outcome},
};

const NAME: &str = "pull";

/// On grids where the force is in proportion to the strain.
const LINEAR: f64 = 0.02;

/// On grids where it isn't: beyond a few per cent, springs and threads turn as the strip gets narrower.
const STIFFENING: f64 = 0.06;

/// Without rows and columns.
const DELAUNAY: f64 = 0.10;

/// A small strain, no unit.
const SMALL: f64 = 0.005;

/// Strains of a strip that stiffens.
const LARGE: [f64; 5] = [0.02, 0.05, 0.1, 0.15, 0.2];

pub fn run(extent: Extent) -> Outcome {
    let mut outcome = Outcome::default();
    let fabrics = ["cotton_woven", "denim", "cotton_jersey"];
    for (name, fabric) in bed::presets().filter(|(name, _)| fabrics.contains(name)) {
        for kind in [Kind::Grid, Kind::Delaunay] {
            // With few substeps only threads that carry nearly all of it are as stiff as they are.
            let efforts = match (extent, kind, name) {
                (Extent::Full, ..) => &EFFORTS[..],
                (Extent::Brief, Kind::Grid, "cotton_woven") => &BRIEF,
                (Extent::Brief, ..) => &[(Method::Explicit, None)],
            };
            for (&(method, substeps), direction) in efforts.iter().flat_map(|e| [(e, "warp"), (e, "weft")]) {
                let case = Case { fabric: name, mesh: kind.name(), n: 16, substeps, direction, method };
                let strip = Strip { kind, cells: case.n, cell: 0.01, cells_across: 8, direction };
                series(&mut outcome, &fabric, &strip, &case);
            }
        }
    }
    outcome
}

/// Pulls a little, and ever harder what stiffens.
fn series(outcome: &mut Outcome, fabric: &Fabric, strip: &Strip, case: &Case) {
    let law = Law::of(fabric, strip.direction);
    if law.stiffening == 0.0 {
        pull(outcome, fabric, strip, case, &law, SMALL);
        return;
    }
    let mut points = vec![[0.0, 0.0]];
    for strain in [SMALL].into_iter().chain(LARGE) {
        let measured = pull(outcome, fabric, strip, case, &law, strain);
        points.push([100.0 * measured, law.tension(strain)]);
    }
    let curve = |series, is_expected, points| Curve { plot: NAME, series, is_expected, points, ..Curve::default() };
    let (direction, effort) = (strip.direction, case.effort());
    if case.method == Method::Explicit && strip.kind == Kind::Grid {
        let of_law = (0..=40).map(|i| f64::from(i) / 200.0).map(|e| [100.0 * e, law.tension(e)]).collect();
        outcome.curves.push(curve(format!("{direction}, the fabric's law"), true, of_law));
    }
    if strip.kind == Kind::Grid && [None, Some(8)].contains(&case.substeps) && case.method != Method::Xpbd {
        outcome.curves.push(curve(format!("{direction}, {effort}"), false, points));
    }
}

/// What a strip takes: k (ε + s ε² / 2), which is k (1 + s ε) for any more.
struct Law {
    stiffness: f64,
    stiffening: f64,
}

impl Law {
    fn of(fabric: &Fabric, direction: &str) -> Self {
        let (stiffness, stiffening) = match direction {
            "warp" => (fabric.warp_stiffness, fabric.warp_stiffening),
            _ => (fabric.weft_stiffness, fabric.weft_stiffening),
        };
        Self { stiffness: stiffness.into(), stiffening: stiffening.into() }
    }

    /// Force over width, N/m.
    fn tension(&self, strain: f64) -> f64 {
        self.stiffness * strain * (1.0 + 0.5 * self.stiffening * strain)
    }
}

/// Pulls with the force that should lead to `strain`, and returns what it leads to.
fn pull(outcome: &mut Outcome, fabric: &Fabric, strip: &Strip, case: &Case, law: &Law, strain: f64) -> f64 {
    let mut bed = Bed::new(strip.mesh(), bare(fabric.clone())).solved_as_in(case);
    bed.gravity = Vec3A::ZERO;
    let close = 0.01 * strip.cell;
    let ends = [
        (bed.chosen(|p| strip.along(p) < close), -1.0),
        (bed.chosen(|p| strip.along(p) > strip.length() - close), 1.0),
    ];
    for (end, way) in &ends {
        for &particle in end {
            let across = strip.across(Vec3A::from(bed.topology.rest[particle]));
            let is_corner = across < close || across > strip.width() - close;
            let force = law.tension(strain) * strip.cell * if is_corner { 0.5 } else { 1.0 };
            bed.particles.force[particle] = strip.axis() * (way * force) as f32;
            bed.particles.inverse_mass[particle] = (bed.mass(particle) + force / f64::from(GRAVITY)).recip() as f32;
        }
    }
    // The ends swing against each other with ω² = 2 g / (length strain).
    let rate = (2.0 * f64::from(GRAVITY) / (strip.length() * strain)).sqrt();
    let rest = bed.settle(2.0 * rate as f32, 10.0);
    let [start, end] = ends.map(|(end, _)| bed.mean(&end, |p| strip.along(p) as f32));
    let measured = (end - start) / strip.length() - 1.0;
    let tolerance = match strip.kind {
        Kind::Delaunay => DELAUNAY,
        _ if strain > SMALL => STIFFENING,
        _ => LINEAR,
    };
    let quantity = format!("strain under {:.3} N/m", law.tension(strain));
    let line = Measurement::new(NAME, &quantity, case.clone(), measured, strain);
    outcome.measurements.push(line.within(tolerance).after(rest));
    measured
}
