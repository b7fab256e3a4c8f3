//! A T-shirt of two panels, front and back, which are sewn together at the shoulders and the sides, and two sleeves.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use bevy::{
    math::{DVec2, DVec3},
    prelude::Mesh,
};

use super::{
    curve::{Curve, outline},
    garment::{Garment, symmetric, turned_around},
};

/// Half the width and half the depth of the chest, m.
const CHEST: DVec2 = DVec2::new(0.235, 0.11);

/// Height from the arms to the shoulders, and from the hem to the arms, m.
const SHOULDER: f64 = 0.23;
const BODY: f64 = 0.42;

/// By how much the shoulders slope, and within what of the middle they get level, m.
const SLOPE: f64 = 0.25;
const NECK_ROUND: f64 = 0.05;

/// Half the width of the neckline, and how deep it is in front and in the back, m.
const NECK: f64 = 0.10;
const NECKLINES: [f64; 2] = [0.105, 0.025];

/// How far the armholes cut into the panels, as a share of these.
const ARMHOLE: f64 = 0.26;

/// Radius of the sleeves' hems, and where the middle of the right one is, m, and how far it points down, rad.
const CUFF: f64 = 0.075;
const CUFF_PLACE: DVec2 = DVec2::new(0.385, 0.035);
const SLEEVE_DOWN: f64 = 0.75;

/// Stands upright, with the height of the arms at its origin.
pub fn shirt(edge: f64) -> Mesh {
    let garment = Garment::new(edge);
    let step = garment.step();
    let [front, back] = NECKLINES.map(|neckline| panel(neckline, step));
    // From under the arm over the front and the back of the shoulder.
    let half: Vec<DVec3> = armhole().steps(step).map(on_body).collect();
    let over = half[1..].iter().rev().map(|&p| p * DVec3::new(1.0, 1.0, -1.0));
    let tip = on_body(armhole().at(1.0));
    let hole: Vec<DVec3> = half.iter().copied().chain([tip]).chain(over).chain([half[0]]).collect();
    let (sleeve, place) = sleeve(&hole, step);
    let sleeve = [sleeve];
    garment
        .sew(&[front], on_body)
        .sew(&[back], |p| turned_around(on_body(p)))
        .sew(&sleeve, &place)
        .sew(&sleeve, |p| turned_around(place(p)))
        .mesh()
}

/// Half the width of a panel, m.
fn half_width() -> f64 {
    Curve::ellipse(CHEST, 0.0, FRAC_PI_2).length()
}

/// The outline of a panel whose neckline is so deep, with Y = 0 at the shoulders.
fn panel(neckline: f64, step: f64) -> Vec<DVec2> {
    let width = half_width();
    let hem = SHOULDER + BODY;
    let armhole: Vec<DVec2> = armhole().steps(step).collect();
    // On this side the armhole comes from the shoulder.
    let down = [&[DVec2::new(width, 0.0)], armhole[1..].iter().rev().copied().collect::<Vec<_>>().as_slice()].concat();
    let neck = outline(
        &[
            Curve::new(|share| DVec2::from_angle((1.0 - share) * FRAC_PI_2) * DVec2::new(NECK, neckline)),
            Curve::line((NECK, 0.0), (width, 0.0)),
        ],
        step,
    );
    let sides = outline(&[Curve::line((width, SHOULDER), (width, hem)), Curve::line((width, hem), (0.0, hem))], step);
    symmetric([neck, down, sides, vec![DVec2::new(0.0, hem)]].concat())
}

/// The armhole's border on a panel's right, from under the arm up to the shoulder.
fn armhole() -> Curve {
    let width = half_width();
    Curve::new(|share| DVec2::new(width * (1.0 - ARMHOLE * (PI * share).sin()), SHOULDER * (1.0 - share)))
}

/// Where a point of the front panel is: around an ellipse, which gets flatter from the arms up to the shoulders.
fn on_body(p: DVec2) -> DVec3 {
    let up = 1.0 - p.y / SHOULDER;
    let depth = CHEST.y * (FRAC_PI_2 * up.max(0.0)).cos().max(0.0);
    let around = Curve::ellipse((CHEST.x, depth), FRAC_PI_2, 0.0).at(p.x.abs() / half_width());
    let x = around.x.copysign(p.x);
    let height = if up > 0.0 { up * shoulder(x) } else { up * SHOULDER };
    DVec3::new(x, height, around.y)
}

/// Height of the shoulder's seam above the arms at `x` from the middle, m.
pub fn shoulder(x: f64) -> f64 {
    SHOULDER - SLOPE * (x.hypot(NECK_ROUND) - CHEST.x)
}

/// Outline and place of the right sleeve: a tube from the armhole to its hem, which is sewn together under the arm.
fn sleeve(hole: &[DVec3], step: f64) -> (Vec<DVec2>, impl Fn(DVec2) -> DVec3) {
    let lengths: f64 = hole.windows(2).map(|ends| ends[0].distance(ends[1])).sum();
    let count = hole.len() - 1;
    let hem = Curve::ellipse((CUFF, CUFF), 0.0, TAU).length();
    let middle = DVec3::new(CUFF_PLACE.x, CUFF_PLACE.y, 0.0);
    let up = DVec3::new(SLEEVE_DOWN.sin(), SLEEVE_DOWN.cos(), 0.0);
    let cuff = move |around: f64| {
        let (sin, cos) = (TAU * around).sin_cos();
        middle + CUFF * (DVec3::Z * sin - up * cos)
    };
    let rim = hole.to_vec();
    let at_rim = move |around: f64| {
        let place = (around * count as f64).clamp(0.0, count as f64);
        let begin = (place as usize).min(count - 1);
        rim[begin].lerp(rim[begin + 1], place - begin as f64)
    };
    let width = 0.5 * (lengths + hem);
    let length = 0.5 * (at_rim(0.0).distance(cuff(0.0)) + at_rim(0.5).distance(cuff(0.5)));
    let top = (0..count).map(|i| DVec2::new(width * i as f64 / count as f64, 0.0));
    let rest = outline(
        &[
            Curve::line((width, 0.0), (width, length)),
            Curve::line((width, length), (0.0, length)),
            Curve::line((0.0, length), (0.0, 0.0)),
        ],
        step,
    );
    let place = move |p: DVec2| at_rim(p.x / width).lerp(cuff(p.x / width), p.y / length);
    (top.chain(rest).collect(), place)
}
