//! The cape: a sheet from the shoulders down the back, and a finer one of the same shape.

use core::f32::consts::PI;

use bevy::math::{Vec2, Vec3};
use serde_json::json;

use super::{
    anatomy::Anatomy,
    field::smooth,
    materials,
    mesh::{Model, Sheet, Vertex, fraction},
    sheet::{cast, fine, keep_clear, relax},
    skin::{influences, of_cape},
};

const COLUMNS: usize = 24;
const ROWS: usize = 32;

/// How many columns of the fine cape there are to each of the coarse one.
const FINENESS: usize = 4;

/// Distance from the skin, m.
const CLEARANCE: f32 = 0.024;

/// How often the sheet is smoothed on its way into shape.
const RELAXATIONS: usize = 60;

/// Where the cape has come over the shoulders, of its length.
const SHOULDERS: f32 = 0.09;

pub fn cape(anatomy: &Anatomy) -> Model {
    let sheet = sheet(anatomy, &positions(anatomy), COLUMNS, ROWS);
    Model {
        name: "Cape",
        primitives: vec![sheet.primitive(materials::CAPE)],
        extras: json!({
            "cloth": "wool_flannel", "cloth_max_distance": 1.0, "cloth_backstop": 0.01, "cloth_backstop_radius": 0.3,
            "cloth_self": true,
        }),
    }
}

pub fn cape_fine(anatomy: &Anatomy) -> Model {
    let positions = fine(&positions(anatomy), COLUMNS + 1, FINENESS);
    let sheet = sheet(anatomy, &positions, COLUMNS * FINENESS, ROWS * FINENESS);
    Model {
        name: "CapeFine",
        primitives: vec![sheet.primitive(materials::CAPE)],
        extras: json!({ "cloth_proxy": "Cape" }),
    }
}

fn sheet(anatomy: &Anatomy, positions: &[Vec3], columns: usize, rows: usize) -> Sheet {
    let vertex = |(index, &position): (usize, &Vec3)| {
        let (row, column) = (index / (columns + 1), index % (columns + 1));
        let down = fraction(row, rows);
        let looseness = smooth(0.0, 0.125, down);
        Vertex {
            position,
            uv: Vec2::new(fraction(column, columns), down),
            looseness,
            skin: influences(&of_cape(anatomy, position, looseness)),
        }
    };
    let vertices = positions.iter().enumerate().map(vertex).collect();
    Sheet { columns: columns + 1, vertices, is_closed: false }
}

/// Draped over the body by smoothing and keeping clear of it in turn.
fn positions(anatomy: &Anatomy) -> Vec<Vec3> {
    let place = |row: usize, column: usize| {
        // From the left edge, which is on the left of those who look at the back.
        let side = 1.0 - 2.0 * fraction(column, COLUMNS);
        let down = fraction(row, ROWS);
        if down < SHOULDERS {
            collar(anatomy, side).lerp(shoulders(side), down / SHOULDERS)
        } else {
            shoulders(side).lerp(hem(side), (down - SHOULDERS) / (1.0 - SHOULDERS))
        }
    };
    let mut positions: Vec<Vec3> =
        (0..=ROWS).flat_map(|row| (0..=COLUMNS).map(move |column| place(row, column))).collect();
    for _ in 0..RELAXATIONS {
        relax(&mut positions, COLUMNS + 1, false);
        for position in &mut positions {
            *position = keep_clear(anatomy, *position, CLEARANCE);
        }
    }
    positions
}

fn collar(anatomy: &Anatomy, side: f32) -> Vec3 {
    let angle = side * 0.5 * PI;
    let place = Vec3::new(0.15 * libm::sinf(angle), 1.525 - 0.03 * side * side, -0.02 - 0.078 * libm::cosf(angle));
    cast(anatomy, Vec3::new(0.8 * place.x, 1.4, -0.01), place, CLEARANCE)
}

fn shoulders(side: f32) -> Vec3 {
    let angle = side * 0.5 * PI;
    Vec3::new(0.215 * libm::sinf(angle), 1.405, -0.115 - 0.035 * libm::cosf(angle))
}

fn hem(side: f32) -> Vec3 {
    let angle = side * 0.36 * PI;
    Vec3::new(0.48 * libm::sinf(angle), 0.36, -0.14 - 0.26 * libm::cosf(angle))
}
