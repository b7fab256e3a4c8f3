//! The tunic: a garment of two materials, a tube from the chest to below the hips, held by two straps.
//!
//! Straps and the band at the hem are trim. Where trim meets the cloth, both have vertices with the same bits.

use core::f32::consts::PI;

use bevy::math::{Vec2, Vec3};
use serde_json::json;

use super::{
    anatomy::Anatomy,
    field::{Loft, smooth},
    materials,
    mesh::{Model, Primitive, Sheet, Vertex, fraction},
    sheet::{cast, tube},
    skin::{influences, of_skirt},
};

const COLUMNS: usize = 40;
const ROWS: usize = 21;

/// The last rows, which are trim.
const BAND: usize = 3;

const CHEST: f32 = 1.31;
const HEM: f32 = 0.80;

/// Distance from the skin, m.
const CLEARANCE: f32 = 0.014;

/// Height; half width and half depth; centre towards x and z, m.
const SHAPE: [[f32; 5]; 6] = [
    [HEM, 0.265, 0.222, 0.0, -0.008],
    [0.92, 0.222, 0.172, 0.0, -0.014],
    [1.02, 0.184, 0.136, 0.0, -0.008],
    [1.12, 0.160, 0.116, 0.0, 0.002],
    [1.22, 0.164, 0.122, 0.0, 0.004],
    [CHEST, 0.176, 0.130, 0.0, 0.006],
];

/// Columns of the left strap from the middle of the front, and its quads from back to front.
const STRAP: [usize; 2] = [3, 6];
const STRAP_ROWS: usize = 18;

pub fn tunic(anatomy: &Anatomy) -> Model {
    let shape = Loft::new(Vec3::ZERO, Vec3::Y, Vec3::X, &SHAPE);
    let height = |row: usize| CHEST + (HEM - CHEST) * fraction(row, ROWS);
    let tube = tube(anatomy, &shape, [COLUMNS, ROWS], height, CLEARANCE, |position, down| {
        (smooth(0.0, 0.3, down), influences(&of_skirt(position)))
    });
    let normals = tube.normals();

    let mut cloth = Primitive { material: materials::TUNIC, ..Primitive::default() };
    add_rows(&mut cloth, &tube, &normals, 0..ROWS - BAND);
    let mut trim = Primitive { material: materials::TRIM, ..Primitive::default() };
    add_rows(&mut trim, &tube, &normals, ROWS - BAND..ROWS);
    for columns in strap_columns() {
        add_strap(&mut trim, anatomy, &tube, &normals, &columns);
    }
    Model {
        name: "Tunic",
        primitives: vec![cloth, trim],
        extras: json!({
            "cloth": "cotton_jersey", "cloth_max_distance": 0.2, "cloth_backstop": 0.005, "cloth_backstop_radius": 0.2,
        }),
    }
}

/// The quads of some rows of the tube, with the vertices around them.
fn add_rows(primitive: &mut Primitive, tube: &Sheet, normals: &[Vec3], rows: core::ops::Range<usize>) {
    let first = rows.start * tube.columns;
    let end = (rows.end + 1) * tube.columns;
    for (vertex, &normal) in tube.vertices[first..end].iter().zip(&normals[first..end]) {
        primitive.push(vertex, normal);
    }
    primitive.indices.extend(tube.triangles(rows).as_flattened().iter().map(|index| (index - first) as u16));
}

/// For each strap, from its left to its right as seen from the front: columns of the tube in front and behind.
fn strap_columns() -> [Vec<[usize; 2]>; 2] {
    let middle = COLUMNS / 2;
    let left = (STRAP[0]..=STRAP[1]).map(|column| [middle + column, COLUMNS - column]).collect();
    let right = (STRAP[0]..=STRAP[1]).rev().map(|column| [middle - column, column]).collect();
    [left, right]
}

/// A sheet from the tube's upper edge behind, over the shoulder, to that in front.
fn add_strap(trim: &mut Primitive, anatomy: &Anatomy, tube: &Sheet, normals: &[Vec3], columns: &[[usize; 2]]) {
    let mut vertices = Vec::new();
    for row in 0..=STRAP_ROWS {
        for &[front, back] in columns {
            vertices.push(match row {
                // The strap's own UV: behind, the tube's goes the other way.
                0 => Vertex { uv: Vec2::new(tube.vertices[front].uv.x, -0.5), ..tube.vertices[back] },
                STRAP_ROWS => tube.vertices[front],
                _ => over_shoulder(anatomy, tube.vertices[back], tube.vertices[front], fraction(row, STRAP_ROWS)),
            });
        }
    }
    let strap = Sheet { columns: columns.len(), vertices, is_closed: false };
    let mut own = strap.normals();
    for (column, &[front, back]) in columns.iter().enumerate() {
        own[column] = normals[back];
        own[STRAP_ROWS * columns.len() + column] = normals[front];
    }
    let first = trim.positions.len();
    for (vertex, normal) in strap.vertices.iter().zip(own) {
        trim.push(vertex, normal);
    }
    trim.indices.extend(strap.triangles(0..STRAP_ROWS).as_flattened().iter().map(|index| (first + index) as u16));
}

/// Part of the way from behind to the front.
fn over_shoulder(anatomy: &Anatomy, back: Vertex, front: Vertex, part: f32) -> Vertex {
    let rise = libm::sinf(PI * part);
    let mut centre = back.position.lerp(front.position, 0.5);
    // On top it is narrower, clear of where the neck rises.
    centre.x -= rise * (0.3 * centre.x - 0.048 * centre.x.signum());
    let out = Vec3::new(0.0, rise, -libm::cosf(PI * part));
    let position = cast(anatomy, centre, centre + out, CLEARANCE);
    let uv = Vec2::new(front.uv.x, -0.5 * (1.0 - part));
    Vertex { position, uv, looseness: 0.0, skin: influences(&of_skirt(position)) }
}
