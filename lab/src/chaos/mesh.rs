//! Meshes of every kind, sound ones and such as no tool should write.

use bevy::prelude::*;

use super::dice::Dice;

mod harm;
mod shape;

/// What a mesh is, in words, and the mesh: of about `most` particles at most.
pub fn roll(dice: &mut Dice, most: u32) -> (String, Mesh) {
    let (mut told, mut mesh) = shape::roll(dice, most);
    if dice.chance(0.4) {
        for _ in 0..dice.count(1..=3) {
            harm::harm(dice, &mut mesh, &mut told);
        }
    }
    let count = mesh.count_vertices();
    let is_readable = mesh.indices().is_none_or(|indices| indices.iter().all(|vertex| vertex < count));
    if dice.chance(0.1) && is_readable {
        mesh.duplicate_vertices();
        told += ", no vertex shared";
    }
    if dice.chance(0.1) {
        mesh.remove_attribute(Mesh::ATTRIBUTE_NORMAL);
        told += ", without normals";
    }
    if dice.chance(0.1) {
        mesh.remove_attribute(Mesh::ATTRIBUTE_UV_0);
        told += ", without UVs";
    }
    if dice.chance(0.2) && is_readable && mesh.generate_tangents().is_ok() {
        told += ", with tangents";
    }
    (told, mesh)
}
