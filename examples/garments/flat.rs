//! Garments of one flat piece.

use core::f64::consts::{FRAC_PI_2, TAU};

use bevy::{
    math::{DVec2, DVec3},
    prelude::Mesh,
};

use super::{
    curve::{Curve, outline},
    garment::{Garment, turned_around},
};

/// Radius of the skirt's waist, m.
pub const WAIST: f64 = 0.115;

/// Semi-axes of the poncho's neck opening, m.
pub const NECK: DVec2 = DVec2::new(0.14, 0.10);

/// Half the cushion's side, m.
pub const CUSHION: f64 = 0.22;

/// A circle skirt: a full circle with a hole for the waist. It lies.
pub fn skirt(edge: f64) -> Mesh {
    /// From waist to hem, m.
    const LENGTH: f64 = 0.58;
    let garment = Garment::new(edge);
    let ring = |radius: f64| outline(&[Curve::ellipse((radius, radius), 0.0, TAU)], garment.step());
    let outlines = [ring(WAIST + LENGTH), ring(WAIST)];
    garment.sew(&outlines, lying).mesh()
}

/// A poncho: a square with rounded corners, one of which is in front, and a neck opening. It lies.
pub fn poncho(edge: f64) -> Mesh {
    /// Half the side, and the radius of the corners, m.
    const HALF: f64 = 0.62;
    const ROUND: f64 = 0.12;
    let garment = Garment::new(edge);
    let square = outline(&rounded_square(HALF, ROUND), garment.step());
    let diamond = square.into_iter().map(|p| DVec2::from_angle(0.5 * FRAC_PI_2).rotate(p)).collect();
    let outlines = [diamond, outline(&[Curve::ellipse(NECK, 0.0, TAU)], garment.step())];
    garment.sew(&outlines, lying).mesh()
}

/// A cushion cover: two squares that are sewn together around, as a full cushion keeps them. It stands.
pub fn cushion(edge: f64) -> Mesh {
    const HALF: f64 = CUSHION;
    /// Half the thickness, m.
    const BULGE: f64 = 0.085;
    /// Radius of the corners, m: a triangle with all of its own in the seam would be there twice.
    const ROUND: f64 = 0.03;
    /// What the product of both cosines is at the rounded corners, or a bit more: there the seam closes.
    const CORNER: f64 = 0.005;
    /// How far the sides are drawn in at their middle, as a share.
    const DRAWN_IN: f64 = 0.1;
    let place = |p: DVec2| {
        let full = (FRAC_PI_2 * p / HALF).map(f64::cos);
        let out = p * (1.0 - DRAWN_IN * DVec2::new(full.y, full.x));
        DVec3::new(out.x, -out.y, BULGE * (full.x * full.y - CORNER).max(0.0))
    };
    let garment = Garment::new(edge);
    let square = [outline(&rounded_square(HALF, ROUND), garment.step())];
    let back = |p: DVec2| turned_around(place(p));
    garment.sew(&square, place).sew(&square, back).mesh()
}

/// The outline of a square of which `half` is half the side, and `round` the radius of its corners, m.
fn rounded_square(half: f64, round: f64) -> Vec<Curve> {
    let middle = half - round;
    // Corner after corner, each with the side that comes before it.
    let corner = |corner: u32| {
        let turn = DVec2::from_angle(f64::from(corner) * FRAC_PI_2);
        let side = Curve::new(|share| turn.rotate(DVec2::new(half, -middle + share * 2.0 * middle)));
        let arc = Curve::new(|share| turn.rotate(middle + round * DVec2::from_angle(share * FRAC_PI_2)));
        [side, arc]
    };
    (0..4).flat_map(corner).collect()
}

fn lying(p: DVec2) -> DVec3 {
    DVec3::new(p.x, 0.0, p.y)
}
