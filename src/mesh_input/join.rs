//! Joins several meshes into one.

use core::ops::Range;

use bevy::{
    math::{Affine3A, Mat3A, Vec3A},
    mesh::{Indices, MeshMergeError, MeshVertexAttribute, PrimitiveTopology, VertexAttributeValues, VertexFormat},
    prelude::*,
};

use super::source::{ATTRIBUTE_WARP, read_positions, read_triangles};
use crate::error::ClothError;

/// Where a mesh is in the one that it has been joined to.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Span {
    pub vertices: Range<usize>,
    pub first_triangle: usize,
}

/// Several meshes as one.
#[derive(Debug)]
pub(crate) struct Joined {
    /// All of their triangles, in the order of the meshes, with the attributes that all of them have.
    pub mesh: Mesh,
    /// Where each of them is.
    pub spans: Vec<Span>,
    /// The names of attributes that only some of them have, and which are left out.
    pub left_out: Vec<&'static str>,
}

/// Joins meshes, each with the transform that takes it into the space of them all.
///
/// # Errors
///
/// With the number of the mesh that can't be joined.
pub(crate) fn join(meshes: &[(&Mesh, Affine3A)]) -> Result<Joined, (usize, String)> {
    let list = |(number, &(mesh, place))| as_list(mesh, place).map_err(|error| (number, error.to_string()));
    let mut lists: Vec<Mesh> = meshes.iter().enumerate().map(list).collect::<Result<_, _>>()?;
    let left_out = leave_out_what_some_lack(&mut lists);
    let (mut vertices, mut triangles) = (0, 0);
    let span = |mesh: &Mesh| {
        let span = Span { vertices: vertices..vertices + mesh.count_vertices(), first_triangle: triangles };
        vertices = span.vertices.end;
        triangles += mesh.indices().map_or(0, Indices::len) / 3;
        span
    };
    let spans = lists.iter().map(span).collect();
    let mut lists = lists.into_iter();
    let mut mesh = lists.next().ok_or((0, ClothError::NoPositions.to_string()))?;
    for (number, list) in (1..).zip(lists) {
        let refused = |error: MeshMergeError| (number, error.to_string());
        mesh.merge(&list).map_err(refused)?;
    }
    Ok(Joined { mesh, spans, left_out })
}

/// A copy with a list of triangles, in another space.
fn as_list(mesh: &Mesh, place: Affine3A) -> Result<Mesh, ClothError> {
    let count = read_positions(mesh)?.len();
    let mut triangles = read_triangles(mesh, count)?;
    // A mirrored mesh would be inside out.
    if place.matrix3.determinant() < 0.0 {
        triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
    let mut copy = Mesh::new(PrimitiveTopology::TriangleList, mesh.asset_usage);
    for (attribute, values) in mesh.try_attributes().into_iter().flatten() {
        // Bevy checks neither; and inserting values of another format panics.
        if values.len() == count && VertexFormat::from(values) == attribute.format {
            copy.insert_attribute(*attribute, values.clone());
        }
    }
    copy.insert_indices(Indices::U32(triangles.into_flattened()));
    // Meshes that are where they all are keep their very bits.
    if place != Affine3A::IDENTITY {
        transform(&mut copy, place);
    }
    Ok(copy)
}

/// Takes a mesh into another space.
pub(crate) fn transform(mesh: &mut Mesh, place: Affine3A) {
    let direction = |matrix: Mat3A| move |value: Vec3A| (matrix * value).normalize_or_zero();
    let along = direction(place.matrix3);
    let normal = direction(place.matrix3.inverse().transpose());
    let mut apply = |attribute, to: &dyn Fn(Vec3A) -> Vec3A| {
        if let Ok(VertexAttributeValues::Float32x3(values)) = mesh.try_attribute_mut(attribute) {
            values.iter_mut().for_each(|value| *value = to((*value).into()).to_array());
        }
    };
    apply(Mesh::ATTRIBUTE_POSITION, &|point| place.transform_point3a(point));
    apply(Mesh::ATTRIBUTE_NORMAL, &normal);
    apply(ATTRIBUTE_WARP, &along);
    if let Ok(VertexAttributeValues::Float32x4(values)) = mesh.try_attribute_mut(Mesh::ATTRIBUTE_TANGENT) {
        let side = 1.0_f32.copysign(place.matrix3.determinant());
        for [x, y, z, sign] in values {
            [*x, *y, *z] = along(Vec3A::new(*x, *y, *z)).to_array();
            *sign *= side;
        }
    }
}

/// Takes off all meshes the attributes that some of them lack, or have in another format. Returns their names.
fn leave_out_what_some_lack(meshes: &mut [Mesh]) -> Vec<&'static str> {
    let format = |mesh: &Mesh, id| mesh.attribute(id).map(VertexFormat::from);
    let is_in_all = |attribute: &MeshVertexAttribute| {
        let mut formats = meshes.iter().map(|mesh| format(mesh, attribute.id));
        formats.all(|format| format == Some(attribute.format))
    };
    let every = meshes.iter().flat_map(|mesh| mesh.attributes().map(|(attribute, _)| *attribute));
    let mut left_out: Vec<MeshVertexAttribute> = every.filter(|attribute| !is_in_all(attribute)).collect();
    left_out.sort_unstable_by_key(|attribute| attribute.id);
    left_out.dedup_by_key(|attribute| attribute.id);
    for attribute in &left_out {
        meshes.iter_mut().for_each(|mesh| drop(mesh.remove_attribute(*attribute)));
    }
    left_out.into_iter().map(|attribute| attribute.name).collect()
}

#[cfg(test)]
mod tests {
    use bevy::asset::RenderAssetUsages;

    use super::*;

    fn triangle(at: f32) -> Mesh {
        let mesh: Mesh = Triangle3d::new(Vec3::ZERO, Vec3::X, Vec3::Y).into();
        mesh.translated_by(Vec3::Z * at)
    }

    #[test]
    fn meshes_are_numbered_through_and_keep_their_bits() {
        let strip = Mesh::new(PrimitiveTopology::TriangleStrip, RenderAssetUsages::default()).with_inserted_attribute(
            Mesh::ATTRIBUTE_POSITION,
            vec![[0.0; 3], [0.1, 0.0, 0.0], [0.0, 0.3, 0.0], [1.0; 3]],
        );
        let Joined { mesh, spans, left_out } =
            join(&[(&strip, Affine3A::IDENTITY), (&triangle(0.7), Affine3A::IDENTITY)]).unwrap();
        assert_eq!(spans[0], Span { vertices: 0..4, first_triangle: 0 });
        assert_eq!(spans[1], Span { vertices: 4..7, first_triangle: 2 });
        let Some(Indices::U32(indices)) = mesh.indices() else { panic!("a list of triangles") };
        assert_eq!(indices, &[0, 1, 2, 1, 3, 2, 4, 5, 6]);
        let positions = read_positions(&mesh).unwrap();
        assert_eq!((positions[1], positions[5]), (Vec3::X * 0.1, Vec3::new(1.0, 0.0, 0.7)));
        assert_eq!(left_out, ["Vertex_Normal", "Vertex_Uv"], "the strip has neither");
        assert!(mesh.attribute(Mesh::ATTRIBUTE_NORMAL).is_none());
    }

    #[test]
    fn a_mesh_that_stands_elsewhere_is_taken_along_and_a_mirrored_one_stays_right_side_out() {
        let mirrored = Affine3A::from_scale_rotation_translation(
            Vec3::new(-2.0, 2.0, 2.0),
            Quat::from_rotation_y(core::f32::consts::PI),
            Vec3::X * 5.0,
        );
        let joined = join(&[(&triangle(0.0), mirrored)]).unwrap().mesh;
        let positions = read_positions(&joined).unwrap();
        let [a, b, c] = read_triangles(&joined, 3).unwrap()[0].map(|i| positions[i as usize]);
        assert!(a.distance(Vec3::X * 5.0) < 1e-5, "{a}");
        let Some(VertexAttributeValues::Float32x3(normals)) = joined.attribute(Mesh::ATTRIBUTE_NORMAL) else {
            panic!("it has normals")
        };
        let faces = (b - a).cross(c - a).normalize();
        assert!(faces.dot(normals[0].into()) > 0.999, "{faces} {normals:?}");
    }

    #[test]
    fn the_mesh_that_cant_be_joined_is_named() {
        let lines = Mesh::new(PrimitiveTopology::LineList, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, vec![[0.0; 3]; 2]);
        let (number, error) = join(&[(&triangle(0.0), Affine3A::IDENTITY), (&lines, Affine3A::IDENTITY)]).unwrap_err();
        assert_eq!(number, 1);
        assert!(error.contains("LineList"), "{error}");
    }
}
