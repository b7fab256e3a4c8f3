//! Which springs run along the warp.

use bevy_math::{Mat3A, UVec2, Vec2, Vec2Swizzles, Vec3};
use drape_solver::{Grain, SourceMesh, Spring, SpringKind, Topology};

use crate::fixtures::mesh::{Grid, scaled_topology};

/// 7 x 5 cells, each of 0.1 m.
const GRID: Grid = Grid { size: Vec2::new(0.7, 0.5), particles: UVec2::new(8, 6), is_lying: false };

fn way(topology: &Topology, spring: &Spring) -> Vec3 {
    (topology.rest[spring.b as usize] - topology.rest[spring.a as usize]).normalize()
}

/// Structural springs along `axis` are warp and the others weft, with the shares that springs of square cells have.
#[track_caller]
fn assert_warp_along(mesh: &SourceMesh, to_world: Mat3A, axis: Vec3) {
    let topology = scaled_topology(mesh.clone(), to_world);
    let mut counts = [0; 2];
    for spring in topology.springs_of(SpringKind::Structural) {
        let is_along = way(&topology, spring).dot(axis).abs() > 0.99;
        let grain = if is_along { Grain::Warp } else { Grain::Weft };
        assert_eq!(spring.grain(), grain, "{spring:?} along {}", way(&topology, spring));
        // C - G of its direction, and half of it at the border.
        let [own, other] = [spring.share[grain.index()], spring.share[1 - grain.index()]];
        assert!((own - 1.0).abs() < 1e-4 || (own - 0.5).abs() < 1e-4, "{spring:?}");
        assert!(other == 0.0 && (spring.share[2] + own).abs() < 1e-4, "{spring:?}");
        counts[grain.index()] += 1;
    }
    assert!(counts.into_iter().all(|count| count == 7 * 6 || count == 8 * 5), "{counts:?}");
    for spring in topology.springs_of(SpringKind::Shear) {
        assert!(spring.share[..2] == [0.0; 2] && (spring.share[2] - 1.0).abs() < 1e-4, "{spring:?}");
    }
}

/// The mesh with other UVs.
fn with_uvs(mut mesh: SourceMesh, change: impl Fn(Vec2) -> Vec2) -> SourceMesh {
    mesh.uvs.iter_mut().flatten().for_each(|uv| *uv = change(*uv));
    mesh
}

fn with_warp(mesh: SourceMesh, warp: Vec3) -> SourceMesh {
    SourceMesh { warp: Some(vec![warp; mesh.positions.len()]), ..mesh }
}

#[test]
fn the_warp_runs_down_the_texture() {
    assert_warp_along(&GRID.into(), Mat3A::IDENTITY, Vec3::Y);
    assert_warp_along(&GRID.lying().into(), Mat3A::IDENTITY, Vec3::Z);
    let turned = |uv: Vec2| Vec2::new(uv.y, 1.0 - uv.x);
    assert_warp_along(&with_uvs(GRID.into(), turned), Mat3A::IDENTITY, Vec3::X);
    let mirrored = |uv: Vec2| uv.yx();
    assert_warp_along(&with_uvs(GRID.lying().into(), mirrored), Mat3A::IDENTITY, Vec3::X);
    let aslant = |uv: Vec2| Vec2::from_angle(0.6).rotate(uv * GRID.size);
    assert_warp_along(&with_uvs(GRID.into(), aslant), Mat3A::IDENTITY, Vec3::Y);
}

#[test]
fn the_attribute_says_otherwise() {
    assert_warp_along(&with_warp(GRID.into(), Vec3::X * 7.0), Mat3A::IDENTITY, Vec3::X);
    assert_warp_along(&with_warp(GRID.into(), Vec3::new(0.3, 0.2, -5.0)), Mat3A::IDENTITY, Vec3::X);
    assert_warp_along(&with_warp(GRID.into(), Vec3::NEG_Y), Mat3A::IDENTITY, Vec3::Y);
    let mesh = with_uvs(with_warp(GRID.into(), Vec3::Y), |uv| uv.yx());
    assert_warp_along(&mesh, Mat3A::IDENTITY, Vec3::Y);
    assert_warp_along(&with_warp(GRID.into(), Vec3::ZERO), Mat3A::IDENTITY, Vec3::Y);
    assert_warp_along(&with_warp(GRID.into(), Vec3::Z), Mat3A::IDENTITY, Vec3::Y);
}

#[test]
fn without_either_it_runs_along_the_meshs_own_axis() {
    let bare = |grid: Grid| SourceMesh { uvs: None, ..grid.into() };
    assert_warp_along(&bare(GRID), Mat3A::IDENTITY, Vec3::Y);
    assert_warp_along(&bare(GRID.lying()), Mat3A::IDENTITY, Vec3::Z);
    let one_place = with_uvs(GRID.into(), |_| Vec2::splat(0.5));
    assert_warp_along(&one_place, Mat3A::IDENTITY, Vec3::Y);
}

#[test]
fn it_turns_with_the_cloth() {
    let turn = Mat3A::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), 1.1);
    assert_warp_along(&GRID.into(), turn, turn * Vec3::Y);
    assert_warp_along(&with_warp(GRID.into(), Vec3::X), turn, turn * Vec3::X);
    let mirrored = Mat3A::from_diagonal(Vec3::new(-1.0, 1.0, 1.0)) * turn;
    assert_warp_along(&GRID.into(), mirrored, mirrored * Vec3::Y);
}
