//! Which way the warp runs in each triangle.

use bevy_math::{Mat3A, Vec3};

use super::source::SourceMesh;

/// Cosine between an axis and a normal from which on the axis lies across the triangle.
const ACROSS: f32 = 0.95;

/// Unit vector along the warp of each triangle of `source`, in its plane: of the rest shape that `to_world` makes.
///
/// It is the mean of its corners' attribute, where the mesh has it; else the way along which V grows and U doesn't; else
/// the mesh's own Y axis, or its Z axis in triangles that lie across that.
pub(super) fn find(source: &SourceMesh, to_world: Mat3A) -> Vec<Vec3> {
    let of_triangle = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|vertex| to_world * source.positions[vertex as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let in_plane = |direction: Vec3| direction.reject_from(normal.try_normalize()?).try_normalize();
        let attribute =
            source.warp.as_ref().map(|warp| corners.map(|vertex| warp[vertex as usize]).iter().sum::<Vec3>());
        let attribute = attribute.and_then(|direction| in_plane(to_world * direction));
        let texture = || {
            let [p, q, r] = corners.map(|vertex| source.uvs.as_ref().map(|uvs| uvs[vertex as usize]));
            let (along, across) = (q? - p?, r? - p?);
            // What takes the corners' UVs to their places takes (0, 1) there.
            let determinant = along.perp_dot(across);
            let down = (c - a) * along.x - (b - a) * across.x;
            (determinant != 0.0).then(|| in_plane(down * determinant.signum())).flatten()
        };
        let axis = || {
            let [y, z] = [to_world * Vec3::Y, to_world * Vec3::Z];
            let lies_across = y.normalize_or_zero().dot(normal).abs() > ACROSS;
            in_plane(if lies_across { z } else { y })
        };
        attribute.or_else(texture).or_else(axis).unwrap_or(Vec3::Y)
    };
    source.triangles.iter().map(of_triangle).collect()
}
