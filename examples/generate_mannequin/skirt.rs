//! The skirt: a tube from the waist to the knees, with a seam behind.

use bevy::math::Vec3;
use serde_json::json;

use super::{
    anatomy::Anatomy,
    field::{Loft, smooth},
    materials,
    mesh::{Model, fraction},
    sheet::tube,
    skin::{influences, of_skirt},
};

const COLUMNS: usize = 32;
const ROWS: usize = 24;

const WAIST: f32 = 1.08;
const HEM: f32 = 0.5;

/// Distance from the skin, m.
const CLEARANCE: f32 = 0.010;

/// Height; half width and half depth; centre towards x and z, m.
const SHAPE: [[f32; 5]; 5] = [
    [HEM, 0.330, 0.300, 0.0, 0.0],
    [0.70, 0.262, 0.220, 0.0, -0.006],
    [0.92, 0.195, 0.148, 0.0, -0.014],
    [1.00, 0.174, 0.120, 0.0, -0.006],
    [WAIST, 0.147, 0.106, 0.0, 0.002],
];

pub fn skirt(anatomy: &Anatomy) -> Model {
    let shape = Loft::new(Vec3::ZERO, Vec3::Y, Vec3::X, &SHAPE);
    let height = |row: usize| WAIST + (HEM - WAIST) * fraction(row, ROWS);
    let sheet = tube(anatomy, &shape, [COLUMNS, ROWS], height, CLEARANCE, |position, down| {
        (smooth(0.0, 0.125, down), influences(&of_skirt(position)))
    });
    Model {
        name: "Skirt",
        primitives: vec![sheet.primitive(materials::SKIRT)],
        extras: json!({ "cloth": "cotton_woven", "cloth_max_distance": 0.5, "cloth_self": true }),
    }
}
