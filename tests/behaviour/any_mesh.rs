//! Triangles of every kind become cloth, and the user's mesh is never touched.

use std::sync::Arc;

use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};
use bevy_drape::prelude::*;

use crate::common::*;

/// A cloth of one mesh after one step, and its app.
fn cloth_of(mesh: impl Into<Mesh>) -> (App, Entity) {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, mesh, undamped());
    run(&mut app, 1);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready);
    (app, cloth)
}

/// Number of particles, triangles and springs.
fn counts(mesh: impl Into<Mesh>) -> [usize; 3] {
    let (app, cloth) = cloth_of(mesh);
    let state = state(&app, cloth);
    [state.particle_count(), state.triangles().len(), state.topology().springs.len()]
}

/// Structural, shear and bending springs of a grid of m x n particles: m (n - 1) + n (m - 1), 2 (m - 1) (n - 1) and
/// m (n - 2) + n (m - 2).
fn grid_counts(m: usize, n: usize) -> [usize; 3] {
    let springs = m * (n - 1) + n * (m - 1) + 2 * (m - 1) * (n - 1) + m * (n - 2) + n * (m - 2);
    [m * n, 2 * (m - 1) * (n - 1), springs]
}

#[test]
fn a_grid_is_the_same_cloth_however_its_triangles_are_stored() {
    let grid: Mesh = ClothGrid::new(1.0, 1.0, 5, 4).into();
    let Some(Indices::U32(long)) = grid.indices() else { panic!("a grid has long indices") };
    let short = grid.clone().with_inserted_indices(Indices::U16(long.iter().map(|&i| i as u16).collect()));
    let unindexed = grid.clone().with_duplicated_vertices();
    let expected = grid_counts(5, 4);
    assert_eq!(counts(grid), expected);
    assert_eq!(counts(short), expected);
    assert_eq!(unindexed.count_vertices(), 3 * expected[1]);
    assert_eq!(counts(unindexed), expected);
}

#[test]
fn a_strip_of_triangles_faces_one_way() {
    let positions = [[0., 1., 0.], [0., 0., 0.], [1., 1., 0.], [1., 0., 0.], [2., 1., 0.], [2., 0., 0.]];
    let strip = || {
        Mesh::new(PrimitiveTopology::TriangleStrip, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions.to_vec())
    };
    let indexed = strip().with_inserted_indices(Indices::U16((0..6).collect()));
    for mesh in [strip(), indexed] {
        // 7 threads, 4 diagonals, and one bending spring along each long side.
        assert_eq!(counts(mesh.clone()), [6, 4, 13]);
        let (app, cloth) = cloth_of(mesh);
        for normal in state(&app, cloth).normals() {
            assert_close(normal, Vec3::Z, 1e-6);
        }
    }
}

#[test]
fn a_uv_seam_is_one_particle_and_stays_two_vertices() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, seamed_strip(), Pins::indices([0]));
    run(&mut app, 60);
    let state = state(&app, cloth);
    assert_eq!(state.particle_count(), 6);
    let particles: Vec<_> = (0..8).map(|vertex| state.particle_of_vertex(vertex)).collect();
    assert_eq!(particles[1], particles[4]);
    assert_eq!(particles[3], particles[5]);
    let mesh = drawn(&app, cloth);
    assert_eq!(mesh.count_vertices(), 8);
    assert_eq!(points(mesh)[1], points(mesh)[4]);
    assert_eq!(normals(mesh)[1], normals(mesh)[4], "shading is smooth across the seam");
    assert_eq!(mesh.attribute(Mesh::ATTRIBUTE_UV_0), seamed_strip().attribute(Mesh::ATTRIBUTE_UV_0));
}

#[test]
fn hard_edges_stay_hard() {
    let (app, cloth) = cloth_of(Cuboid::new(1.0, 1.0, 1.0));
    assert_eq!(state(&app, cloth).particle_count(), 8);
    let mesh = drawn(&app, cloth);
    assert_eq!(mesh.count_vertices(), 24);
    for (shown, of_box) in normals(mesh).into_iter().zip(normals(&Cuboid::new(1.0, 1.0, 1.0).into())) {
        assert_close(shown, of_box, 1e-3);
    }
}

#[test]
fn a_ball_is_closed() {
    let ball = Sphere::new(0.5).mesh().uv(12, 8);
    let [particles, triangles, _] = counts(ball);
    // 7 rings of 12 and two poles; Euler: triangles = 2 (particles - 2).
    assert_eq!(particles, 7 * 12 + 2);
    assert_eq!(triangles, 2 * (particles - 2));
}

#[test]
fn cloths_of_one_mesh_move_apart_and_leave_it_alone() {
    let mut app = headless();
    let original: Mesh = ClothGrid::new(1.0, 1.0, 5, 5).into();
    let handle = add_mesh(&mut app, original.clone());
    let bundle = || (Mesh3d(handle.clone()), Cloth::default());
    let one = app.world_mut().spawn((bundle(), Pins::corners())).id();
    let other = app.world_mut().spawn(bundle()).id();
    run(&mut app, 30);

    let source = app.world().resource::<Assets<Mesh>>().get(&handle).unwrap();
    assert_eq!(points(source), points(&original));
    assert_eq!(normals(source), normals(&original));
    assert_eq!(source.final_aabb, None);
    let meshes = [&handle, &get::<Mesh3d>(&app, one).0, &get::<Mesh3d>(&app, other).0];
    assert!(meshes[0] != meshes[1] && meshes[1] != meshes[2] && meshes[2] != meshes[0]);
    assert_ne!(points(drawn(&app, one)), points(drawn(&app, other)));
}

#[test]
fn equal_cloths_share_their_springs() {
    let mut app = headless();
    let handle = add_mesh(&mut app, ClothGrid::new(1.0, 1.0, 5, 5));
    let mut spawn = |scale| {
        let place = Transform::from_xyz(scale, 0.0, 0.0).with_scale(Vec3::splat(scale));
        app.world_mut().spawn((Mesh3d(handle.clone()), Cloth::default(), place)).id()
    };
    let [one, other, larger] = [spawn(1.0), spawn(1.0), spawn(2.0)];
    run(&mut app, 1);
    let topology = |cloth| state(&app, cloth).topology();
    assert!(Arc::ptr_eq(topology(one), topology(other)));
    assert_eq!(topology(larger).springs[0].rest, 2.0 * topology(one).springs[0].rest);
}

#[test]
fn a_mesh_without_normals_or_uvs_is_cloth_too() {
    let mut bare: Mesh = ClothGrid::new(1.0, 1.0, 4, 4).into();
    bare.remove_attribute(Mesh::ATTRIBUTE_NORMAL);
    bare.remove_attribute(Mesh::ATTRIBUTE_UV_0);
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, bare, Pins::indices([0]));
    run(&mut app, 30);
    assert!(points(drawn(&app, cloth))[3].y < 0.0, "it hangs from the other corner");
    assert_eq!(drawn(&app, cloth).attribute(Mesh::ATTRIBUTE_NORMAL), None);
}

#[test]
fn an_unused_vertex_far_away_changes_nothing() {
    let mut app = headless();
    let mut mesh = Mesh::from(ClothGrid::new(1.0, 1.0, 5, 5));
    let mut places = points(&mesh);
    places.push(Vec3::splat(1e6));
    let count = places.len();
    mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, places);
    mesh.insert_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 0.0, 1.0]; count]);
    mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, vec![[0.0, 0.0]; count]);
    let cloth = spawn_cloth(&mut app, mesh, Cloth::default());
    run(&mut app, 2);
    assert_eq!(state(&app, cloth).particle_count(), 25);
}
