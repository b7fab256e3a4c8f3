//! Garments of one flat piece.

use core::f64::consts::{FRAC_PI_2, TAU};

use bevy::{
    math::{DVec2, DVec3},
    prelude::Mesh,
};

use super::{
    curve::{Curve, outline},
    garment::{Garment, symmetric},
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
    let middle = HALF - ROUND;
    // Corner after corner, each with the side that comes before it.
    let square = (0..4).flat_map(|corner| {
        let turn = DVec2::from_angle(f64::from(corner) * FRAC_PI_2);
        let side = Curve::new(|share| turn.rotate(DVec2::new(HALF, -middle + share * 2.0 * middle)));
        let round =
            Curve::new(|share| turn.rotate(DVec2::splat(middle) + ROUND * DVec2::from_angle(share * FRAC_PI_2)));
        [side, round]
    });
    let cut = |curve: Vec<Curve>| outline(&curve, garment.step());
    let diamond = cut(square.collect()).into_iter().map(|p| DVec2::from_angle(0.5 * FRAC_PI_2).rotate(p)).collect();
    let outlines = [diamond, cut(vec![Curve::ellipse(NECK, 0.0, TAU)])];
    garment.sew(&outlines, lying).mesh()
}

/// A cushion cover: two squares that are sewn together around, as a full cushion keeps them. It stands.
pub fn cushion(edge: f64) -> Mesh {
    const HALF: f64 = CUSHION;
    /// Half the thickness, m.
    const BULGE: f64 = 0.085;
    /// How far the sides are drawn in at their middle, as a share.
    const DRAWN_IN: f64 = 0.1;
    let place = |p: DVec2| {
        let full = (FRAC_PI_2 * p / HALF).map(f64::cos);
        let out = p * (1.0 - DRAWN_IN * DVec2::new(full.y, full.x));
        DVec3::new(out.x, -out.y, BULGE * (full.x * full.y).max(0.0))
    };
    let garment = Garment::new(edge);
    let right = outline(
        &[
            Curve::line((0.0, -HALF), (HALF, -HALF)),
            Curve::line((HALF, -HALF), (HALF, HALF)),
            Curve::line((HALF, HALF), (0.0, HALF)),
        ],
        garment.step(),
    );
    let square = symmetric([right, vec![DVec2::new(0.0, HALF)]].concat());
    let back = |p: DVec2| super::garment::turned_around(place(p));
    garment.sew(&[square.clone()], place).sew(&[square], back).mesh()
}

fn lying(p: DVec2) -> DVec3 {
    DVec3::new(p.x, 0.0, p.y)
}
