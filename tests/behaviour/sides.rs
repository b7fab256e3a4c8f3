//! Cloth is lit from the side that its mesh's own normals face, whatever the winding of its triangles.

use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};
use bevy_drape::prelude::*;

use crate::common::*;

/// A quad in the XY plane of vertices 0 1 above 2 3, whose normals face +Z, with these triangles.
fn quad(triangles: &[[u32; 3]]) -> Mesh {
    let positions = vec![[-0.5, 0.5, 0.0], [0.5, 0.5, 0.0], [-0.5, -0.5, 0.0], [0.5, -0.5, 0.0]];
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 0.0, 1.0]; 4])
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
        .with_inserted_indices(Indices::U32(triangles.as_flattened().to_vec()))
}

/// Normals of a mesh that hangs in a breath of wind: as drawn, and of the state.
fn blown(mesh: Mesh) -> [Vec<Vec3>; 2] {
    let mut app = headless();
    app.world_mut().spawn(Wind { velocity: Vec3::new(0.3, 0.0, 1.0), ..default() });
    let cloth = spawn_cloth(&mut app, mesh, Pins::region(Vec3::new(-1.0, 0.45, -1.0), Vec3::ONE));
    run(&mut app, 60);
    [normals(drawn(&app, cloth)), state(&app, cloth).normals()]
}

#[test]
fn doubled_and_turned_triangles_do_not_change_the_side_that_is_lit() {
    let plain = blown(quad(&[[0, 2, 1], [1, 2, 3]]));
    assert!(plain[0].iter().all(|normal| normal.z > 0.5), "{:?}", plain[0]);
    for triangles in [
        &[[0, 2, 1], [1, 2, 3], [0, 1, 2], [1, 3, 2]][..],
        &[[0, 1, 2], [1, 3, 2], [0, 2, 1], [1, 2, 3]],
        &[[0, 2, 1], [1, 3, 2]],
        &[[0, 1, 2], [1, 2, 3]],
        &[[0, 1, 2], [1, 3, 2]],
    ] {
        for (plain, found) in plain.iter().zip(blown(quad(triangles))) {
            for (&plain, found) in plain.iter().zip(found) {
                assert_close(plain, found, 0.05);
            }
        }
    }
}

#[test]
fn a_back_of_its_own_vertices_is_lit_as_their_normals_say() {
    let front = quad(&[[0, 2, 1], [1, 2, 3]]);
    let windings = [[[0, 2, 1], [1, 2, 3]], [[0, 1, 2], [1, 3, 2]]];
    for (back_normal, winding) in [Vec3::Z, Vec3::NEG_Z].into_iter().flat_map(|n| windings.map(|w| (n, w))) {
        let mut back = quad(&winding);
        back.insert_attribute(Mesh::ATTRIBUTE_NORMAL, vec![back_normal.to_array(); 4]);
        let mut mesh = front.clone();
        mesh.merge(&back).expect("both have the same attributes");
        let [drawn, _] = blown(mesh);
        assert!(drawn[..4].iter().all(|normal| normal.z > 0.5), "{drawn:?}");
        assert!(drawn[4..].iter().all(|normal| normal.dot(back_normal) > 0.5), "{drawn:?}");
    }
}

#[test]
fn tangents_follow_the_texture_where_triangles_are_turned_over() {
    let shown = |triangles: &[[u32; 3]]| {
        let mesh = quad(triangles).with_inserted_attribute(Mesh::ATTRIBUTE_TANGENT, vec![[1.0, 0.0, 0.0, 1.0]; 4]);
        let mut app = headless();
        let cloth = spawn_cloth(&mut app, mesh, Pins::region(Vec3::new(-1.0, 0.45, -1.0), Vec3::ONE));
        run(&mut app, 30);
        match drawn(&app, cloth).attribute(Mesh::ATTRIBUTE_TANGENT) {
            Some(bevy::mesh::VertexAttributeValues::Float32x4(values)) => values.clone(),
            other => panic!("no tangents but {other:?}"),
        }
    };
    for triangles in [&[[0, 2, 1], [1, 2, 3], [0, 1, 2], [1, 3, 2]][..], &[[0, 2, 1], [1, 3, 2]]] {
        for tangent in shown(triangles) {
            assert_close(Vec4::from(tangent).truncate(), Vec3::X, 0.05);
            assert_eq!(tangent[3], 1.0);
        }
    }
}

#[test]
fn a_curved_mesh_with_turned_triangles_keeps_its_outside() {
    let mut mesh = Mesh::from(Sphere::new(0.5));
    let rest = normals(&mesh);
    if let Some(Indices::U32(indices)) = mesh.indices_mut() {
        indices.as_chunks_mut::<3>().0.iter_mut().step_by(3).for_each(|triangle| triangle.swap(0, 1));
    }
    let mut app = headless();
    let still = Cloth { gravity_scale: 0.0, ..default() };
    let cloth = spawn_cloth(&mut app, mesh, still);
    run(&mut app, 2);
    for (shown, rest) in normals(drawn(&app, cloth)).into_iter().zip(rest) {
        assert!(shown.dot(rest) > 0.9, "{shown} instead of {rest}");
    }
}
