//! What is painted arrives on the mesh, in whatever format it is in the file.

use bevy::{
    gltf::{GltfPlugin, convert_coordinates::GltfConvertCoordinates},
    mesh::{MeshVertexAttribute, VertexAttributeValues},
    prelude::*,
};
use bevy_drape::prelude::*;
use serde_json::json;

use super::{
    file::*,
    shop::{Shop, warnings},
};
use crate::common::{points, vec3s};

fn numbers(mesh: &Mesh, attribute: MeshVertexAttribute) -> Vec<f32> {
    match mesh.attribute(attribute) {
        Some(VertexAttributeValues::Float32(values)) => values.clone(),
        other => panic!("no numbers but {other:?}"),
    }
}

/// The looseness that a sheet has in Bevy, painted in one way.
fn looseness(path: &str, paint: impl FnOnce(&mut File)) -> Vec<f32> {
    let mut file = sheet();
    paint(&mut file);
    let (shop, root) = Shop::show(path, file);
    assert_eq!(warnings(path), [""; 0]);
    numbers(shop.only_mesh(root), ATTRIBUTE_CLOTH)
}

#[test]
fn paint_of_every_format_says_the_same() {
    let expected = by_row(|down| down);
    let whole = |most: f32| expected.iter().map(move |value| value * most + 0.5);
    let scalar = |values: Vec<u8>, component| {
        move |file: &mut File| file.attribute("_CLOTH", "SCALAR", component, true, &values)
    };
    let colours = colours(&expected);
    let triples: Vec<u8> = expected.iter().flat_map(|&value| floats(&[value, 0.5, 0.5])).collect();
    // As they have to be aligned, with a gap behind each colour.
    let bytes: Vec<u8> = whole(255.0).flat_map(|value| [value as u8, 7, 9, 0]).collect();
    let found = [
        looseness("float.glb", |file| file.attribute("_CLOTH", "SCALAR", FLOAT, false, &floats(&expected))),
        looseness("lower_case.glb", |file| file.attribute("_cloth", "SCALAR", FLOAT, false, &floats(&expected))),
        looseness("byte_colour.glb", |file| file.attribute("_CLOTH", "VEC4", UNSIGNED_SHORT, true, &colours)),
        looseness("vector.glb", |file| file.attribute("_CLOTH", "VEC3", FLOAT, false, &triples)),
        looseness("bytes.glb", |file| {
            file.attribute("_CLOTH", "VEC4", UNSIGNED_BYTE, true, &bytes);
            let accessor = file.primitive()["attributes"]["_CLOTH"].as_u64().expect("a number") as usize;
            let view = file.json["accessors"][accessor]["bufferView"].as_u64().expect("a number") as usize;
            file.json["accessors"][accessor]["type"] = json!("VEC3");
            file.json["bufferViews"][view]["byteStride"] = json!(4);
        }),
        looseness(
            "short_numbers.glb",
            scalar(whole(32_767.0).flat_map(|value| (value as i16).to_le_bytes()).collect(), SHORT),
        ),
        looseness("byte.glb", scalar(whole(127.0).map(|value| value as u8).collect(), BYTE)),
    ];
    for found in found {
        let is_near = |(found, expected): (&f32, &f32)| (found - expected).abs() < 0.005;
        assert!(found.iter().zip(&expected).all(is_near), "{found:?}");
    }
}

#[test]
fn numbers_that_arent_normalised_count_as_they_are() {
    let metres: Vec<u8> = by_row(|down| (4.0 * down).floor()).into_iter().map(|value| value as u8).collect();
    let found = looseness("whole.glb", |file| file.attribute("_CLOTH", "SCALAR", UNSIGNED_BYTE, false, &metres));
    assert_eq!(found, by_row(|down| (4.0 * down).floor()));
}

#[test]
fn paint_that_lists_only_what_isnt_zero_is_read() {
    let found = looseness("sparse.glb", |file| {
        let indices = file.view(&[3, 0, 20, 0]);
        let values = file.view(&floats(&[0.5, 2.0]));
        let accessor = file.add(
            "accessors",
            json!({
                "componentType": FLOAT, "count": SIDE * SIDE, "type": "SCALAR",
                "sparse": {
                    "count": 2,
                    "indices": { "bufferView": indices, "componentType": UNSIGNED_SHORT },
                    "values": { "bufferView": values },
                },
            }),
        );
        file.primitive()["attributes"]["_CLOTH"] = accessor.into();
    });
    let expected: Vec<f32> =
        (0..SIDE * SIDE).map(|i| [0.0, 0.5, 2.0][usize::from(i == 3) + 2 * usize::from(i == 20)]).collect();
    assert_eq!(found, expected);
}

#[test]
fn without_normals_paint_stays_where_it_was_painted() {
    let (shop, root) = Shop::show("flat.glb", sheet().without_normals().paint("_CLOTH", &by_row(|down| down)));
    let mesh = shop.only_mesh(root);
    assert!(mesh.indices().is_none(), "Bevy gives each corner a vertex of its own");
    let painted = numbers(mesh, ATTRIBUTE_CLOTH);
    assert_eq!(painted.len(), 6 * (SIDE - 1) * (SIDE - 1));
    for (place, painted) in points(mesh).into_iter().zip(painted) {
        assert!((painted + place.y).abs() < 1e-6, "{painted} at {place}");
    }
}

#[test]
fn pins_backstops_and_warp_are_read() {
    let warp = [1.0, 0.25, 2.0].repeat(SIDE * SIDE);
    let mut file = sheet()
        .paint("_PIN", &by_row(|down| f32::from(down == 0.0)))
        .paint("_CLOTH_BACKSTOP", &by_row(|down| 0.1 * down));
    file.attribute("_WARP", "VEC3", FLOAT, false, &floats(&warp));
    let (shop, root) = Shop::show("all_kinds.glb", file.clone());
    let mesh = shop.only_mesh(root);
    assert_eq!(numbers(mesh, ATTRIBUTE_PIN), by_row(|down| f32::from(down == 0.0)));
    assert_eq!(numbers(mesh, ATTRIBUTE_CLOTH_BACKSTOP), by_row(|down| 0.1 * down));
    assert_eq!(vec3s(mesh, ATTRIBUTE_WARP), [Vec3::new(1.0, 0.25, 2.0); SIDE * SIDE]);
    assert_eq!(warnings("all_kinds.glb"), [""; 0]);

    let convert_coordinates = GltfConvertCoordinates { rotate_meshes: true, ..default() };
    let mut shop = Shop::with(GltfPlugin { convert_coordinates, ..default() });
    shop.write("turned.glb", file);
    let root = shop.spawn("turned.glb", Transform::default());
    let mesh = shop.only_mesh(root);
    assert_close_all(&vec3s(mesh, ATTRIBUTE_WARP), Vec3::new(-1.0, 0.25, -2.0));
}

#[track_caller]
fn assert_close_all(found: &[Vec3], expected: Vec3) {
    assert!(found.iter().all(|found| *found == expected), "{found:?} isn't {expected}");
}

#[test]
fn attributes_that_are_registered_with_bevy_are_the_same() {
    let loader = GltfPlugin::default()
        .add_custom_vertex_attribute("CLOTH", ATTRIBUTE_CLOTH)
        .add_custom_vertex_attribute("PIN", ATTRIBUTE_PIN);
    let mut shop = Shop::with(loader);
    let pins = by_row(|down| f32::from(down == 0.0));
    shop.write("registered.glb", sheet().without_normals().paint("_CLOTH", &by_row(|down| down)).paint("_PIN", &pins));
    let root = shop.spawn("registered.glb", Transform::default());
    let mesh = shop.only_mesh(root);
    for ((place, painted), pin) in
        points(mesh).into_iter().zip(numbers(mesh, ATTRIBUTE_CLOTH)).zip(numbers(mesh, ATTRIBUTE_PIN))
    {
        assert!((painted + place.y).abs() < 1e-6 && (pin == 1.0) == (place.y == 0.0), "{painted}, {pin} at {place}");
    }
}

#[test]
fn colours_reach_a_mesh_whose_pins_they_are() {
    let mut file = sheet().property("/nodes/0", "cloth", true);
    file.attribute("_PIN", "VEC4", UNSIGNED_SHORT, true, &colours(&by_row(|down| f32::from(down == 0.0))));
    let (shop, root) = Shop::show("painted_pins.glb", file);
    let cloth = shop.cloth(root);
    assert_eq!(*shop.get::<ClothStatus>(cloth), ClothStatus::Ready);
    assert_eq!(crate::common::pinned(&shop.app, cloth), (0..SIDE).collect::<Vec<_>>());
}
