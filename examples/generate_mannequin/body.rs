//! The body: one closed surface.

use bevy::math::Vec3;
use serde_json::json;

use super::{
    anatomy::Anatomy,
    materials,
    mesh::{Model, Primitive},
    skeleton::{LEFT, PELVIS, RIGHT},
    skin::{Shares, influences, of_body},
    surface::{Surface, surface},
};

/// Distance of its vertices, m.
const CELL: f32 = 0.018;

/// More than half the body's width and depth, and its height, m.
const REACH: Vec3 = Vec3::new(0.72, 1.82, 0.22);

/// How often shares are mixed with those of the neighbours.
const SMOOTHINGS: usize = 4;

pub fn body(anatomy: &Anatomy) -> Model {
    let surface = surface(|point| anatomy.body(point), CELL, REACH);
    let mut primitive = Primitive {
        material: materials::BODY,
        positions: surface.points.iter().map(Vec3::to_array).collect(),
        normals: surface.normals.iter().map(Vec3::to_array).collect(),
        indices: surface.triangles.as_flattened().iter().map(|&index| index as u16).collect(),
        ..Primitive::default()
    };
    for shares in shares(anatomy, &surface) {
        primitive.push_skin(influences(&shares));
    }
    Model { name: "Body", primitives: vec![primitive], extras: json!(null) }
}

fn shares(anatomy: &Anatomy, surface: &Surface) -> Vec<Shares> {
    let mut shares: Vec<Shares> = surface.points.iter().map(|&point| of_body(anatomy, point)).collect();
    for _ in 0..SMOOTHINGS {
        let old = shares.clone();
        for ((shares, around), point) in shares.iter_mut().zip(&surface.neighbours).zip(&surface.points) {
            let mean: Shares = std::array::from_fn(|joint| {
                around.iter().map(|&other| old[other][joint]).sum::<f32>() / around.len() as f32
            });
            *shares = std::array::from_fn(|joint| 0.5 * (shares[joint] + mean[joint]));
            keep_sides(shares, point.x);
        }
    }
    shares
}

/// What the other side's limbs would get of a point goes to the pelvis: left and right never mix.
fn keep_sides(shares: &mut Shares, x: f32) {
    for side in [LEFT, RIGHT] {
        if x * side.sign <= 0.0 {
            for joint in [side.upper_arm, side.lower_arm, side.hand, side.thigh, side.shin, side.foot] {
                shares[PELVIS] += std::mem::take(&mut shares[joint]);
            }
        }
    }
}
