//! Each selector chooses the vertices that it says.

use bevy::{
    math::Rect,
    mesh::{MeshVertexAttribute, VertexAttributeValues, VertexFormat},
    prelude::*,
};
use bevy_drape::prelude::*;

use crate::common::*;

/// ```text
///  0  1  2  3     1.5 m x 1 m, 0.5 m from vertex to vertex
///  4  5  6  7
///  8  9 10 11
/// ```
fn sheet() -> Mesh {
    ClothGrid::new(1.5, 1.0, 4, 3).into()
}

fn chosen(mesh: Mesh, pins: Pins) -> Vec<usize> {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, mesh, pins);
    run(&mut app, 1);
    pinned(&app, cloth)
}

/// The sheet with one value a vertex: `there` for 1, 6 and 7, `elsewhere` for all others.
fn marked<T: Copy>(attribute: MeshVertexAttribute, there: T, elsewhere: T) -> Mesh
where
    VertexAttributeValues: From<Vec<T>>,
{
    let values: Vec<T> = (0..12).map(|i| if [1, 6, 7].contains(&i) { there } else { elsewhere }).collect();
    sheet().with_inserted_attribute(attribute, values)
}

#[test]
fn indices_are_the_meshs_own() {
    assert_eq!(chosen(sheet(), Pins::indices([7, 0, 7])), [0, 7]);
}

#[test]
fn an_index_across_a_uv_seam_pins_both_of_its_vertices() {
    // Vertex 4 of this strip of two quads stands where vertex 1 does, and 5 where 3 does.
    let pins = Pins::indices([6]);
    assert_eq!(chosen(seamed_strip(), pins), [6]);
    assert_eq!(chosen(seamed_strip(), Pins::indices([4])), [1, 4]);
}

#[test]
fn a_region_is_a_box_in_the_meshs_own_space() {
    let region = || Pins::region(Vec3::new(-0.3, 0.6, 0.1), Vec3::new(0.8, -0.1, -0.1));
    assert_eq!(chosen(sheet(), region()), [1, 2, 3, 5, 6, 7]);
    let mut app = headless();
    let place = Transform::from_xyz(50.0, 0.0, 0.0).with_scale(Vec3::splat(9.0));
    let cloth = spawn_cloth(&mut app, sheet(), (region(), place));
    run(&mut app, 1);
    assert_eq!(pinned(&app, cloth), [1, 2, 3, 5, 6, 7]);
}

#[test]
fn a_uv_region_is_a_rectangle_of_uvs() {
    assert_eq!(chosen(sheet(), Pins::uv_region(Rect::new(0.6, 0.4, 1.0, 1.0))), [6, 7, 10, 11]);
}

#[test]
fn a_vertex_color_is_found_in_floats() {
    let red = LinearRgba::RED.to_f32_array();
    let nearly = [1.0, 0.01, 0.0, 1.0];
    assert_eq!(chosen(marked(Mesh::ATTRIBUTE_COLOR, red, nearly), Pins::vertex_color(LinearRgba::RED)), [1, 6, 7]);
}

#[test]
fn a_vertex_color_is_found_in_bytes() {
    let bytes = MeshVertexAttribute { format: VertexFormat::Unorm8x4, ..Mesh::ATTRIBUTE_COLOR };
    let values = (0..12).map(|i| if i % 5 == 0 { [255, 0, 128, 255] } else { [255, 0, 120, 255] }).collect();
    let mesh = sheet().with_inserted_attribute(bytes, VertexAttributeValues::Unorm8x4(values));
    assert_eq!(chosen(mesh, Pins::vertex_color(LinearRgba::new(1.0, 0.0, 0.5, 1.0))), [0, 5, 10]);
}

#[test]
fn an_attribute_counts_from_one_half() {
    assert_eq!(chosen(marked(ATTRIBUTE_PIN, 0.5, 0.49), Pins::attribute(ATTRIBUTE_PIN)), [1, 6, 7]);
    let own = MeshVertexAttribute::new("Sewn", 77, VertexFormat::Float32);
    assert_eq!(chosen(marked(own, 1.0, 0.0), Pins::attribute(own)), [1, 6, 7]);
}

#[test]
fn corners_edges_and_their_ends_are_those_of_the_sheet() {
    let cases = [
        (Pins::corners(), &[0, 3, 8, 11][..]),
        (Pins::edge(ClothEdge::Top), &[0, 1, 2, 3]),
        (Pins::edge(ClothEdge::Bottom), &[8, 9, 10, 11]),
        (Pins::edge(ClothEdge::Left), &[0, 4, 8]),
        (Pins::edge(ClothEdge::Right), &[3, 7, 11]),
        (Pins::edge_corners(ClothEdge::Top), &[0, 3]),
        (Pins::edge_corners(ClothEdge::Right), &[3, 11]),
    ];
    for (pins, expected) in cases {
        let what = format!("{:?}", pins.groups[0].select);
        assert_eq!(chosen(sheet(), pins), expected, "{what}");
    }
}

#[test]
fn corners_of_bevys_own_plane_are_its_corners() {
    let plane = || Plane3d::default().mesh().size(1.0, 1.0).subdivisions(3).build();
    assert_eq!(chosen(plane(), Pins::corners()), [0, 4, 20, 24]);
    assert_eq!(chosen(plane(), Pins::edge(ClothEdge::Top)), [0, 1, 2, 3, 4]);
}

#[test]
fn a_predicate_sees_index_position_and_uv() {
    let predicate = |wanted: fn(&PinVertex) -> bool| chosen(sheet(), Pins::predicate(wanted));
    assert_eq!(predicate(|v| v.index % 4 == 1), [1, 5, 9]);
    assert_eq!(predicate(|v| v.position.x < -0.5 && v.position.y >= 0.0), [0, 4]);
    assert_eq!(predicate(|v| v.uv == Some(Vec2::new(1.0, 0.5))), [7]);
    let mut bare = sheet();
    bare.remove_attribute(Mesh::ATTRIBUTE_UV_0);
    assert_eq!(chosen(bare, Pins::predicate(|v| v.uv.is_none() && v.index > 9)), [10, 11]);
}
