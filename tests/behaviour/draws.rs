//! What is drawn is where the particles are.

use bevy::{mesh::MeshVertexAttribute, prelude::*};
use bevy_drape::prelude::*;

use crate::common::*;

/// An app that draws the latest step, not one in between.
fn latest() -> App {
    headless_with(ClothPlugin::new(Update))
}

/// Transforms of parent and cloth, from none to all that a scene can do.
fn poses() -> Vec<(Transform, Transform)> {
    let turn = Quat::from_euler(EulerRot::XYZ, 0.3, 0.8, -0.5);
    let parent = Transform::from_xyz(-4.0, 1.0, 2.5).with_rotation(turn.inverse()).with_scale(Vec3::new(1.0, 2.0, 0.5));
    let own = Transform::from_xyz(1.0, 2.0, 3.0).with_rotation(turn);
    vec![
        (Transform::IDENTITY, Transform::IDENTITY),
        (Transform::IDENTITY, own),
        (Transform::IDENTITY, own.with_scale(Vec3::new(0.5, 2.0, 1.5))),
        (Transform::IDENTITY, own.with_scale(Vec3::new(-1.0, 1.0, 1.0))),
        (parent, own.with_scale(Vec3::new(1.5, -0.7, 1.0))),
    ]
}

fn spawn_under(app: &mut App, parent: Transform, more: impl Bundle) -> Entity {
    let cloth = spawn_cloth(app, ClothGrid::new(1.0, 1.0, 6, 6), more);
    app.world_mut().spawn(parent).add_child(cloth);
    cloth
}

#[test]
fn the_mesh_is_where_the_particles_are_under_any_transform() {
    for (parent, own) in poses() {
        let mut app = latest();
        let cloth = spawn_under(&mut app, parent, (own, Pins::indices([0, 5])));
        for frame in 0..30 {
            get_mut::<Transform>(&mut app, cloth).translation.z += 0.02 * frame as f32;
            run(&mut app, 1);
        }
        let to_world = get::<GlobalTransform>(&app, cloth).affine();
        let points = points(drawn(&app, cloth));
        assert!(points[14].distance(points[15]) > 0.0);
        for (vertex, point) in points.into_iter().enumerate() {
            assert_close(to_world.transform_point3(point), place(&app, cloth, vertex as u32), 1e-5);
        }
    }
}

#[test]
fn a_flat_sheet_has_the_normals_that_it_came_with() {
    for (parent, own) in poses() {
        let mut app = latest();
        let floating = Cloth { gravity_scale: 0.0, ..default() };
        let cloth = spawn_under(&mut app, parent, (own, floating));
        run(&mut app, 10);
        let mesh = drawn(&app, cloth);
        for normal in normals(mesh).into_iter().chain(normals(&mesh.clone().with_computed_normals())) {
            assert_close(normal, Vec3::Z, 1e-3);
        }
        // As Bevy's shader does.
        let to_world = get::<GlobalTransform>(&app, cloth).affine().matrix3.inverse().transpose();
        let expected = (to_world * Vec3::Z).normalize();
        for normal in state(&app, cloth).normals() {
            assert_close(normal, expected, 1e-3);
        }
    }
}

#[test]
fn a_bent_sheet_has_the_normals_that_bevy_gives_it() {
    for (parent, own) in poses() {
        let mut app = latest();
        app.insert_resource(ClothGravity(Vec3::new(3.0, -8.0, 5.0)));
        let cloth = spawn_under(&mut app, parent, (own, Pins::indices([0, 17])));
        run(&mut app, 40);
        let mesh = drawn(&app, cloth);
        let shown = normals(mesh);
        let bevys = normals(&mesh.clone().with_computed_area_weighted_normals());
        assert!(shown.iter().any(|normal| normal.z < 0.9), "the sheet is bent");
        for (shown, bevys) in shown.into_iter().zip(bevys) {
            assert_close(shown, bevys, 1e-4);
        }
    }
}

fn with_tangents(u: f32, w: f32) -> Mesh {
    let mesh: Mesh = ClothGrid::new(1.0, 1.0, 6, 6).into();
    let uvs: Vec<[f32; 2]> = points(&mesh).iter().map(|p| [u * p.x, -p.y]).collect();
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
        .with_inserted_attribute(Mesh::ATTRIBUTE_TANGENT, vec![[u, 0.0, 0.0, w]; 36])
}

fn tangents(mesh: &Mesh) -> Vec<Vec4> {
    const TANGENT: MeshVertexAttribute = Mesh::ATTRIBUTE_TANGENT;
    let Some(bevy::mesh::VertexAttributeValues::Float32x4(values)) = mesh.attribute(TANGENT) else {
        panic!("the mesh has tangents")
    };
    values.iter().copied().map(Vec4::from).collect()
}

#[test]
fn tangents_follow_the_cloth_and_keep_their_handedness() {
    for (u, w) in [(1.0, 1.0), (-1.0, -1.0)] {
        let mut app = latest();
        app.insert_resource(ClothGravity(Vec3::new(3.0, -8.0, 5.0)));
        let flat = spawn_cloth(&mut app, with_tangents(u, w), Cloth { gravity_scale: 0.0, ..default() });
        let bent = spawn_cloth(&mut app, with_tangents(u, w), Pins::indices([0, 17]));
        run(&mut app, 40);
        for tangent in tangents(drawn(&app, flat)) {
            assert!(tangent.distance(Vec4::new(u, 0.0, 0.0, w)) < 1e-3, "{tangent}");
        }
        let mesh = drawn(&app, bent);
        for (tangent, normal) in tangents(mesh).into_iter().zip(normals(mesh)) {
            assert_eq!(tangent.w, w);
            assert!((tangent.truncate().length() - 1.0).abs() < 1e-5);
            assert!((normal.length() - 1.0).abs() < 1e-5);
            assert!(tangent.truncate().dot(normal).abs() < 1e-5);
        }
        assert!(normals(mesh).iter().any(|normal| normal.x.abs() > 0.1), "the sheet is bent along u");
        let along = (points(mesh)[15] - points(mesh)[14]) * u;
        assert!(tangents(mesh)[14].truncate().dot(along.normalize()) > 0.9);
    }
}

#[test]
fn the_bounds_hold_all_vertices_in_every_frame() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 6, 6), Pins::indices([0]));
    for _ in 0..60 {
        run(&mut app, 1);
        let mesh = drawn(&app, cloth);
        let bounds = mesh.final_aabb.expect("a cloth has bounds");
        let (low, high) =
            points(mesh).into_iter().fold((Vec3::MAX, Vec3::MIN), |(low, high), p| (low.min(p), high.max(p)));
        assert_eq!((Vec3::from(bounds.min), Vec3::from(bounds.max)), (low, high));
    }
}
