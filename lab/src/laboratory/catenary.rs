//! A strip that hangs from both ends takes the catenary.

use bevy::math::Vec3A;
use bevy_drape::prelude::Fabric;

use super::{
    BRIEF, EFFORTS, Extent,
    bed::{Bed, bare},
    mesh::{Kind, Strip},
    record::{Case, Measurement, Outcome},
    roots,
};

/// Length of the strip over the span.
const SLACK: f64 = 1.5;

/// Share of the span that the strip may be off the curve.
const TOLERANCE: f64 = 0.01;

pub fn run(extent: Extent) -> Outcome {
    let mut measurements = Vec::new();
    for &(method, substeps) in if extent == Extent::Brief { &BRIEF[..] } else { &EFFORTS } {
        for (mesh, direction) in [(Kind::Grid, "warp"), (Kind::Grid, "weft"), (Kind::Delaunay, "warp")] {
            // Triangles stretch too much with fewer.
            let is_brief_of_triangles = extent == Extent::Brief && mesh == Kind::Delaunay;
            let substeps = if is_brief_of_triangles { substeps.map(|_| 32) } else { substeps };
            let fabric = "cotton_woven, limp";
            let case = Case { fabric, mesh: mesh.name(), n: 30, substeps, direction, method };
            measurements.push(farthest(mesh, case));
        }
    }
    Outcome { measurements, ..Outcome::default() }
}

/// The farthest that a particle is from where a chain would have it, m.
fn farthest(kind: Kind, case: Case) -> Measurement {
    // A chain doesn't resist bending; the threads of this cloth don't give.
    let fabric = Fabric { bending_rigidity: 0.0, ..Fabric::COTTON_WOVEN };
    let strip = Strip { kind, cells: case.n, cell: 0.02, cells_across: 3, direction: case.direction };
    let length = strip.length();
    let span = length / SLACK;
    let close = 0.01 * strip.cell;
    let mut bed = Bed::new(strip.mesh(), bare(fabric)).solved_as_in(&case);
    let chain = Chain::new(length, span);
    let axis = strip.axis();
    // Let go as a V: the ends are at the span, the middle is below.
    let half_depth = 0.5 * (length * length - span * span).sqrt();
    for position in &mut bed.particles.position {
        let along = strip.along(*position);
        let depth = half_depth * (1.0 - (2.0 * along / length - 1.0).abs());
        *position += axis * (along * (1.0 / SLACK - 1.0)) as f32 + Vec3A::NEG_Y * depth as f32;
    }
    bed = bed.pinned(|p| strip.along(p) < close || strip.along(p) > length - close);
    let rest = bed.settle(4.0, 30.0);
    let distances = bed.particles.position.iter().zip(&bed.topology.rest).map(|(position, place)| {
        let [along, depth] = chain.at(strip.along(Vec3A::from(*place)));
        (strip.along(*position) - along).hypot(f64::from(-position.y) - depth)
    });
    let farthest = distances.fold(0.0, f64::max);
    let quantity = "distance from the catenary, m";
    Measurement::new("catenary", quantity, case, farthest, 0.0).of(span).within(TOLERANCE).after(rest)
}

/// y = a cosh(x / a) between two points at the same height.
struct Chain {
    a: f64,
    length: f64,
    span: f64,
}

impl Chain {
    /// 2 a sinh(span / 2a) is the length.
    fn new(length: f64, span: f64) -> Self {
        let excess = |a: f64| length - 2.0 * a * (0.5 * span / a).sinh();
        Self { a: roots::bisect(60, 0.01 * span, 100.0 * span, excess), length, span }
    }

    /// How far along and how deep the point at an arc length is, m.
    fn at(&self, arc: f64) -> [f64; 2] {
        let x = self.a * ((arc - 0.5 * self.length) / self.a).asinh();
        [0.5 * self.span + x, self.a * ((0.5 * self.span / self.a).cosh() - (x / self.a).cosh())]
    }
}
