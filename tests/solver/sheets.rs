//! Sheets of triangles in no order, with the moduli that a laboratory measures.

use std::f32::consts::PI;

use bevy::{
    asset::RenderAssetUsages,
    math::{Quat, Vec2, Vec3, Vec3A, ops},
    mesh::{Indices, Mesh, PrimitiveTopology},
};
use bevy_drape::solver::{Effort, Elasticity, Material, Method, Moduli, measure};

use crate::bench_bed::{ALL, Bed, GRAVITY, STABLE};

/// Points of a strip along x, moved at random inside, in cells of about `cell`, m, joined by Delaunay's triangulation.
fn strewn(length: f32, width: f32, cell: f32) -> (Vec<Vec2>, Vec<u32>) {
    let mut random = fastrand::Rng::with_seed(7);
    let [columns, rows] = [length, width].map(|side| (side / cell).round() as u32);
    let mut points = Vec::new();
    for (i, j) in (0..=columns).flat_map(|i| (0..=rows).map(move |j| (i, j))) {
        let mut shift = |k: u32, count: u32| if k > 0 && k < count { 0.5 * (random.f32() - 0.5) } else { 0.0 };
        let at = Vec2::new(i as f32 + shift(i, columns), j as f32 + shift(j, rows));
        points.push(at * Vec2::new(length / columns as f32, width / rows as f32));
    }
    let corners: Vec<_> = points.iter().map(|p| delaunator::Point { x: p.x.into(), y: p.y.into() }).collect();
    let triangles = delaunator::triangulate(&corners).triangles;
    let area = |t: &[usize; 3]| (points[t[1]] - points[t[0]]).perp_dot(points[t[2]] - points[t[0]]).abs();
    let triangles = triangles.as_chunks().0.iter().filter(|t| area(t) > 1e-3 * cell * cell);
    let indices = triangles.flat_map(|t| t.map(|i| i as u32)).collect();
    (points, indices)
}

/// The mesh of a strip, put into space. The warp is along its length.
fn mesh(&(ref points, ref indices): &(Vec<Vec2>, Vec<u32>), place: impl Fn(Vec2) -> Vec3) -> Mesh {
    let positions: Vec<[f32; 3]> = points.iter().map(|&p| place(p).to_array()).collect();
    let uvs: Vec<[f32; 2]> = points.iter().map(|p| [p.y, p.x]).collect();
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
        .with_inserted_indices(Indices::U32(indices.clone()))
}

fn lying(p: Vec2) -> Vec3 {
    Vec3::new(p.x, 0.0, p.y)
}

fn sheet(density: f32, moduli: Moduli) -> Material {
    Material::bare(density, Elasticity::Moduli(moduli))
}

/// The places of particles, by their x.
fn where_x(bed: &Bed, is: impl Fn(f32) -> bool) -> Vec<u32> {
    (0..).zip(&bed.topology.rest).filter(|(_, p)| is(p.x)).map(|(i, _)| i).collect()
}

#[test]
fn a_strip_that_is_pulled_gets_longer_by_the_force_over_its_stiffness() {
    let (length, width) = (0.5, 0.2);
    for (pulled, shear) in [([400.0, 400.0], 60.0), ([100.0, 300.0], 40.0)] {
        for (method, substeps) in [(Method::Explicit, 1), (Method::Xpbd, 64), (Method::Strands, 64), (Method::Strands, 8)] {
            let moduli = Moduli::from_strips(pulled, shear, [0.0; 2], 1.0).unwrap();
            let material = Material { damping: 20.0, ..sheet(0.2, moduli) };
            let bed = Bed::new(mesh(&strewn(length, width, 0.025), lying), material);
            let (held, free) = (where_x(&bed, |x| x < 1e-4), where_x(&bed, |x| x > length - 1e-4));
            let mut bed = Bed { method, gravity: Vec3A::ZERO, ..bed.with_substeps(substeps) }.pinned(held);
            // 5 % of stretch.
            let force = 0.05 * pulled[0] * width;
            let at = |i: &u32| bed.topology.rest[*i as usize].z;
            let mut by_place = free.clone();
            by_place.sort_by(|p, q| at(p).total_cmp(&at(q)));
            let last = by_place.len() - 1;
            for (k, &i) in by_place.iter().enumerate() {
                let share = if k == 0 || k == last { 0.5 } else { 1.0 };
                bed.particles.force[i as usize] = Vec3A::X * force * share / last as f32;
            }
            bed.run(4.0);
            // Away from the ends, which are held in their width.
            let between = |from: f32, to: f32| {
                let near = |x: f32| -> f32 {
                    let those: Vec<_> = (0..bed.particles.len()).filter(|&i| (bed.topology.rest[i].x - x).abs() < 0.02).collect();
                    those.iter().map(|&i| bed.particles.position[i].x - bed.topology.rest[i].x).sum::<f32>() / those.len() as f32
                };
                (near(to) - near(from)) / (to - from)
            };
            let strain = between(0.15, 0.35);
            println!("{method:?} {substeps} {pulled:?}: strain {strain}, speed {}", bed.fastest());
        }
    }
}

fn cantilever(method: Method, substeps: u32, fineness: f32, overhang: f32) -> f32 {
    let (density, rigidity) = (0.3, 0.3 * GRAVITY * 0.03_f32.powi(3));
    let cell = 0.03 * fineness;
    let moduli = Moduli { stretch: [3000.0; 2], shear: 500.0, compression: 1.0, bending: rigidity, ..Moduli::default() };
    let material = Material { damping: 4.0, ..sheet(density, moduli) };
    let (clamp, length) = (2.0 * cell, 0.03 * overhang);
    let bed = Bed::new(mesh(&strewn(clamp + length, 0.06, cell), lying), material);
    let (held, free) = (where_x(&bed, |x| x < clamp + 0.1 * cell), where_x(&bed, |x| x > clamp + length - 1e-4));
    let mut bed = Bed { method, ..bed.with_substeps(substeps) }.pinned(held.clone());
    if method == Method::Strands { bed = bed.tethered(&held); }
    bed.run(3.0);
    println!("rate {} bends {} speed {}", bed.topology.bend_rate, bed.topology.bends.len(), bed.fastest());
    -free.iter().map(|&i| bed.particles.position[i as usize].y).sum::<f32>() / free.len() as f32
}

#[test]
fn a_cantilever_hangs_as_deep_as_the_textbook_solver_has_it() {
    for fineness in [0.5, 0.33, 0.2] {
        let truth = cantilever(Method::Explicit, 1, fineness, 1.2);
        let beam = 1.2_f32.powi(4) / 8.0 * 0.03;
        for (method, substeps) in [(Method::Xpbd, 8), (Method::Strands, 8), (Method::Strands, 2)] {
            let depth = cantilever(method, substeps, fineness, 1.2);
            println!("{fineness} {method:?} {substeps}: {depth} truth {truth} beam {beam} ratio {}", depth / truth);
        }
    }
}
