//! Sound meshes to begin with.

use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};
use bevy_drape::prelude::*;

use super::super::dice::Dice;

/// A sound mesh of about `most` particles at most, and what it is in words.
pub fn roll(dice: &mut Dice, most: u32) -> (String, Mesh) {
    let size = if dice.wild(0.1) { dice.spread(1e-5, 1e5) } else { dice.spread(0.1, 3.0) };
    let side = most.isqrt().max(3);
    let (told, mesh) = match dice.count(0..=9) {
        0..=3 => grid(dice, size, side),
        4 => strip(dice, size, most),
        5 => scattered(dice, size, most),
        6 => ball(dice, size, side),
        7 => tube(dice, size, side),
        8 => ("a cuboid".into(), Cuboid::new(size, size * dice.within(0.1, 1.0), size * dice.within(0.1, 1.0)).into()),
        _ => band(dice, size, most),
    };
    (format!("{told} of {size} m"), mesh)
}

fn grid(dice: &mut Dice, size: f32, side: u32) -> (String, Mesh) {
    let (columns, rows) = (dice.count(2..=side), dice.count(2..=side));
    let grid = ClothGrid::new(size, size * dice.spread(0.3, 3.0), columns, rows);
    let grid = if dice.chance(0.5) { grid.lying() } else { grid };
    (format!("a grid of {columns} x {rows}"), grid.into())
}

/// A grid that is long and narrow.
fn strip(dice: &mut Dice, size: f32, most: u32) -> (String, Mesh) {
    let (columns, rows) = (dice.count(2..=3), dice.count(3..=(most / 3).max(3)));
    let mesh = ClothGrid::new(size * dice.spread(0.01, 0.2), size, columns, rows).into();
    (format!("a strip of {columns} x {rows}"), mesh)
}

fn ball(dice: &mut Dice, size: f32, side: u32) -> (String, Mesh) {
    let ball = Sphere::new(size / 2.0).mesh();
    if dice.chance(0.5) {
        let (sectors, stacks) = (dice.count(3..=side), dice.count(2..=side.max(2)));
        return (format!("a ball of {sectors} x {stacks}"), ball.uv(sectors, stacks));
    }
    // Of 10 (n + 1)² + 2 particles.
    let most = (side / 3).saturating_sub(1).min(4);
    let divisions = dice.count(0..=most);
    let mesh = ball.ico(divisions).unwrap_or_else(|_| Sphere::new(size / 2.0).into());
    (format!("a ball of {divisions} divisions"), mesh)
}

fn tube(dice: &mut Dice, size: f32, side: u32) -> (String, Mesh) {
    let (around, along) = (dice.count(3..=side), dice.count(1..=side));
    let width = size * dice.spread(0.1, 0.5);
    if dice.chance(0.5) {
        let torus = Torus { minor_radius: width / 4.0, major_radius: size / 2.0 }.mesh();
        let torus = torus.minor_resolution(around as usize).major_resolution(along.max(3) as usize);
        return (format!("a torus of {around} x {along}"), torus.into());
    }
    let tube = Cylinder::new(width, size).mesh().resolution(around).segments(along);
    if dice.chance(0.5) {
        return (format!("a sleeve of {around} x {along}"), tube.without_caps().into());
    }
    (format!("a cylinder of {around} x {along}"), tube.into())
}

/// Points anywhere in a square, joined as Delaunay would.
fn scattered(dice: &mut Dice, size: f32, most: u32) -> (String, Mesh) {
    let count = dice.count(3..=most);
    let points: Vec<Vec2> = (0..count).map(|_| Vec2::new(dice.within(-0.5, 0.5), dice.within(-0.5, 0.5))).collect();
    let places: Vec<delaunator::Point> =
        points.iter().map(|point| delaunator::Point { x: point.x.into(), y: point.y.into() }).collect();
    let corners = delaunator::triangulate(&places).triangles;
    let mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(
            Mesh::ATTRIBUTE_POSITION,
            points.iter().map(|point| (*point * size).extend(0.0).to_array()).collect::<Vec<_>>(),
        )
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 0.0, 1.0]; points.len()])
        .with_inserted_attribute(
            Mesh::ATTRIBUTE_UV_0,
            points.iter().map(|point| (*point + 0.5).to_array()).collect::<Vec<_>>(),
        )
        .with_inserted_indices(Indices::U32(corners.into_iter().map(|corner| corner as u32).collect()));
    (format!("{count} points"), mesh)
}

/// A triangle strip, whose vertices are no list of triangles.
fn band(dice: &mut Dice, size: f32, most: u32) -> (String, Mesh) {
    let count = dice.count(3..=most);
    let step = size / count as f32;
    let positions = (0..count).map(|i| [(i % 2) as f32 * 2.0 * step, i as f32 * -step, 0.0]).collect::<Vec<_>>();
    let mesh = Mesh::new(PrimitiveTopology::TriangleStrip, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions);
    (format!("a triangle strip of {count}"), mesh)
}
