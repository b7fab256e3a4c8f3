//! Trousers of four panels, two for each leg, which are sewn together from the waist over the crotch to the other side.

use core::f64::consts::{FRAC_PI_2, PI};

use bevy::{
    math::{DVec2, DVec3},
    prelude::Mesh,
};

use super::{
    curve::{Curve, outline},
    garment::{Garment, turned_around},
};

/// Half the width of the waist, m.
pub const WAIST: f64 = 0.16;

/// From waist to hem, m.
const LENGTH: f64 = 1.0;

/// Depth below the waist at which the crotch seam begins to turn, and of the crotch, m.
const TURN: f64 = 0.08;
const CROTCH: f64 = 0.28;

/// Depth below the waist, and there half the width of both legs, half their depth and half the gap between them, m.
const SHAPE: [(f64, [f64; 3]); 5] = [
    (0.0, [WAIST, 0.110, 0.0]),
    (0.18, [0.195, 0.125, 0.0]),
    (CROTCH, [0.200, 0.110, 0.0]),
    (0.60, [0.195, 0.080, 0.035]),
    (LENGTH, [0.200, 0.072, 0.050]),
];

/// Stands upright, with the waist at its origin.
pub fn trousers(edge: f64) -> Mesh {
    let garment = Garment::new(edge);
    let right = panel(garment.step());
    let left: Vec<DVec2> = right.iter().map(|&p| mirrored(p)).collect();
    let on_left = |p: DVec2| {
        let place = on_leg(mirrored(p));
        DVec3::new(-place.x, place.y, place.z)
    };
    let (right, left) = ([right], [left]);
    garment
        .sew(&right, on_leg)
        .sew(&left, on_left)
        .sew(&right, |p| turned_around(on_leg(p)))
        .sew(&left, |p| turned_around(on_left(p)))
        .mesh()
}

fn mirrored(p: DVec2) -> DVec2 {
    DVec2::new(-p.x, p.y)
}

/// The outline of the right front, whose outer seam is at X = 0.
fn panel(step: f64) -> Vec<DVec2> {
    let inner = |depth: f64| DVec2::new(-section(depth).1.length(), depth);
    // Dense below the turn, where the seam runs backwards more than down.
    let rise = Curve::new(|share| inner(CROTCH * share * (2.0 - share)));
    let leg = Curve::new(|share| inner(CROTCH + share * (LENGTH - CROTCH)));
    // Points of a curve are on its chords. On the seam itself, those of both sides meet.
    let inside = rise.steps(step).chain(leg.steps(step)).map(|p| inner(p.y));
    let waist = outline(&[Curve::line((0.0, LENGTH), (0.0, 0.0)), Curve::line((0.0, 0.0), inner(0.0))], step);
    let hem = Curve::line(inner(LENGTH), (0.0, LENGTH));
    waist.into_iter().chain(inside).chain(hem.steps(step)).collect()
}

/// Where a point of the right front is.
fn on_leg(p: DVec2) -> DVec3 {
    let (middle, around) = section(p.y);
    let place = around.at(-p.x / around.length());
    DVec3::new(middle + place.x, -p.y, place.y)
}

/// The middle of the right front's cross-section at a depth below the waist, and the arc of an ellipse around that, from the
/// outer seam on: a quarter at the waist, where it ends in front of the body, and half of it below the crotch, where it ends at
/// the inner side of the leg.
fn section(depth: f64) -> (f64, Curve) {
    let [width, thickness, gap] = shape(depth);
    let turned = ((depth - TURN) / (CROTCH - TURN)).clamp(0.0, 1.0).powi(2);
    let half = (width - gap) / (1.0 + turned);
    let end = if turned < 1.0 { FRAC_PI_2 + turned.asin() } else { PI };
    (width - half, Curve::ellipse((half, thickness), 0.0, end))
}

/// What [`SHAPE`] is in between, without corners.
fn shape(depth: f64) -> [f64; 3] {
    let below = SHAPE.iter().position(|row| row.0 >= depth).unwrap_or(SHAPE.len() - 1).max(1);
    let ((from, upper), (to, lower)) = (SHAPE[below - 1], SHAPE[below]);
    let share = ((depth - from) / (to - from)).clamp(0.0, 1.0);
    let eased = share * share * (3.0 - 2.0 * share);
    [0, 1, 2].map(|i| upper[i] + eased * (lower[i] - upper[i]))
}
