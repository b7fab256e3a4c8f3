//! Meshes that can't be cloth are refused with the reason, and those that are merely odd are handled.

use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};
use bevy_drape::prelude::*;

use crate::common::*;

/// A mesh of points and triangles without anything else.
fn bare(positions: Vec<[f32; 3]>, triangles: &[[u32; 3]]) -> Mesh {
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_indices(Indices::U32(triangles.as_flattened().to_vec()))
}

/// Corners of a unit square and `more` points.
fn square(more: &[[f32; 3]]) -> Vec<[f32; 3]> {
    [&[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [1., 1., 0.]], more].concat()
}

const SQUARE: [[u32; 3]; 2] = [[0, 1, 2], [2, 1, 3]];

/// What becomes of a mesh: an error, or a cloth that has run for a while and is finite.
fn result(mesh: Mesh, more: impl Bundle) -> Result<(App, Entity), ClothError> {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, mesh, more);
    run(&mut app, 20);
    let heard = app.world().resource::<Heard>();
    match get::<ClothStatus>(&app, cloth).clone() {
        ClothStatus::Ready | ClothStatus::Asleep => {
            assert!(positions(&app, cloth).into_iter().all(Vec3::is_finite));
            assert!(points(drawn(&app, cloth)).into_iter().all(Vec3::is_finite));
            assert_eq!(*heard, Heard { ready: vec![cloth], ..default() });
            Ok((app, cloth))
        }
        ClothStatus::Failed(error) => {
            assert_eq!(*heard, Heard { failed: vec![(cloth, error.clone())], ..default() });
            Err(error)
        }
        ClothStatus::Waiting => panic!("the mesh is there"),
        ClothStatus::Building => panic!("the mesh is small"),
    }
}

#[track_caller]
fn assert_refused(mesh: Mesh, expected: ClothError) {
    assert_eq!(result(mesh, ()).map(drop), Err(expected));
}

#[test]
fn meshes_without_triangles_are_refused() {
    let line = Mesh::new(PrimitiveTopology::LineList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, square(&[]));
    assert_refused(line, ClothError::NotTriangles { topology: "LineList".into() });
    let nothing = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default());
    assert_refused(nothing, ClothError::NoPositions);
    assert_refused(bare(vec![], &[]), MeshError::Empty.into());
    assert_refused(bare(square(&[]), &[]), MeshError::Empty.into());
}

#[test]
fn positions_of_another_format_are_refused() {
    let format = bevy::mesh::VertexFormat::Float32x2;
    let flat = bevy::mesh::MeshVertexAttribute { format, ..Mesh::ATTRIBUTE_POSITION };
    let mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(flat, vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    assert_refused(mesh, ClothError::NoPositions);
}

#[test]
fn a_mesh_that_has_gone_to_the_gpu_is_refused() {
    let mut mesh: Mesh = ClothGrid::new(1.0, 1.0, 3, 3).into();
    mesh.take_gpu_data().unwrap();
    assert_refused(mesh, ClothError::NotInMainWorld);
}

#[test]
fn a_mesh_that_will_go_to_the_gpu_is_refused() {
    let mut mesh: Mesh = ClothGrid::new(1.0, 1.0, 3, 3).into();
    mesh.asset_usage = RenderAssetUsages::RENDER_WORLD;
    assert_refused(mesh, ClothError::NotInMainWorld);
}

#[test]
fn positions_that_are_not_finite_are_refused() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mesh = bare(square(&[[0.0, bad, 0.0]]), &SQUARE);
        assert_refused(mesh, MeshError::PositionNotFinite { vertex: 4 }.into());
    }
}

#[test]
fn positions_that_are_too_large_to_compute_with_are_refused() {
    for size in [1.1e7, 1e12, 1e18] {
        let mesh = bare(square(&[]).into_iter().map(|p| p.map(|x| x * size)).collect(), &SQUARE);
        assert_refused(mesh, MeshError::PositionTooFar { vertex: 1, distance: size }.into());
    }
}

#[test]
fn indices_past_the_last_vertex_are_refused() {
    assert_refused(
        bare(square(&[]), &[[0, 1, 2], [1, 4, 2]]),
        MeshError::IndexOutOfRange { vertex: 4, count: 4 }.into(),
    );
}

#[test]
fn triangles_without_area_are_refused_when_there_are_no_others() {
    let line = vec![[0., 0., 0.], [1., 0., 0.], [2., 0., 0.]];
    assert_refused(bare(line, &[[0, 1, 2]]), MeshError::Empty.into());
    assert_refused(bare(vec![[1.0; 3]; 3], &[[0, 1, 2]]), MeshError::Empty.into());
    assert_refused(bare(square(&[]), &[[0, 0, 1], [3, 3, 3]]), MeshError::Empty.into());
}

#[test]
fn triangles_without_area_are_handled_among_others() {
    // A sliver on the upper edge, a repeated corner and the square's back.
    let mesh = bare(square(&[[0.5, 1.0, 0.0]]), &[[0, 1, 2], [2, 1, 3], [2, 3, 4], [0, 0, 1], [2, 1, 0]]);
    let (app, cloth) = result(mesh, Pins::indices([2, 3])).unwrap();
    assert_eq!(state(&app, cloth).triangles().len(), 2);
    assert_eq!(state(&app, cloth).particle_count(), 5);
    assert!(place(&app, cloth, 4).y > 0.9, "the sliver hangs on its neighbours");
}

#[test]
fn a_vertex_in_no_triangle_stays_where_it_is() {
    let (app, cloth) = result(bare(square(&[[5.0, 5.0, 5.0]]), &SQUARE), ()).unwrap();
    assert_eq!(state(&app, cloth).particle_count(), 4);
    assert_eq!(state(&app, cloth).particle_of_vertex(4), None);
    assert_eq!(points(drawn(&app, cloth))[4], Vec3::splat(5.0));
    assert!(points(drawn(&app, cloth))[0].y < -0.2);
}

#[test]
fn three_triangles_may_share_an_edge() {
    let fins = bare(square(&[[0.5, 0.5, 1.0]]), &[[0, 1, 2], [2, 1, 3], [1, 2, 4]]);
    let (app, cloth) = result(fins, Pins::indices([1])).unwrap();
    assert_eq!(state(&app, cloth).triangles().len(), 3);
    assert!((place(&app, cloth, 4) - place(&app, cloth, 1)).length() < 1.5);
}

#[test]
fn sheets_that_do_not_touch_are_one_cloth() {
    let apart = square(&square(&[]).into_iter().map(|[x, y, _]| [x, y, 2.0]).collect::<Vec<_>>());
    let (app, cloth) = result(bare(apart, &[SQUARE, SQUARE.map(|t| t.map(|i| i + 4))].concat()), ()).unwrap();
    assert_eq!(state(&app, cloth).particle_count(), 8);
}

#[test]
fn attributes_of_another_length_are_left_alone() {
    let mesh = || bare(square(&[]), &SQUARE);
    let short = |mesh: Mesh| mesh.with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 0.0, 1.0]; 2]);
    let uvs = |mesh: Mesh, n| mesh.with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, vec![[0.0, 0.0]; n]);
    let tangents = |mesh: Mesh| mesh.with_inserted_attribute(Mesh::ATTRIBUTE_TANGENT, vec![[1.0, 0.0, 0.0, 1.0]; 2]);
    let normals = |mesh: Mesh| mesh.with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 0.0, 1.0]; 4]);
    result(short(mesh()), ()).map(drop).unwrap();
    result(tangents(uvs(normals(mesh()), 4)), ()).map(drop).unwrap();
    result(tangents(uvs(normals(mesh()), 1)), ()).map(drop).unwrap();
    result(uvs(mesh(), 9), Pins::edge(ClothEdge::Top)).map(drop).unwrap_err();
}

#[test]
fn errors_name_the_mend() {
    let errors = [
        MeshError::Empty.into(),
        ClothError::NotInMainWorld,
        ClothError::FlatTransform,
        ClothError::PinOutOfRange { vertex: 7, count: 4 },
    ];
    for error in errors {
        assert!(error.to_string().contains("; "), "cause; mend: {error}");
    }
}
