//! Normals and tangents of the deformed mesh, in its own space.

use bevy::math::{Vec3A, Vec4};

use super::binding::{Binding, Groups, Tangents};

/// Writes the normal of each group into `normals`: the sum of its triangles' normals, weighted by area.
pub(super) fn normals(binding: &Binding, groups: &Groups, positions: &[[f32; 3]], normals: &mut Vec<Vec3A>) {
    normals.clear();
    normals.resize(groups.count, Vec3A::ZERO);
    for triangle in &binding.triangles {
        let (first, second) = sides(positions, triangle);
        add(groups, triangle, first.cross(second), normals);
    }
    for normal in normals {
        *normal = normal.normalize_or(Vec3A::Y);
    }
}

/// Writes the tangent of each vertex into `shown`: the direction of growing u, made orthogonal to the normal.
pub(super) fn tangents(
    binding: &Binding,
    tangents: &Tangents,
    positions: &[[f32; 3]],
    vertex_normals: &[[f32; 3]],
    sums: &mut Vec<Vec3A>,
    shown: &mut Vec<[f32; 4]>,
) {
    sums.clear();
    sums.resize(tangents.groups.count, Vec3A::ZERO);
    for (triangle, along) in binding.triangles.iter().zip(&tangents.along) {
        let (first, second) = sides(positions, triangle);
        let area = first.cross(second).length();
        let direction = (first * along.x + second * along.y).normalize_or_zero();
        add(&tangents.groups, triangle, direction * area, sums);
    }
    shown.clear();
    for (vertex, &group) in tangents.groups.of_vertex.iter().enumerate() {
        let normal = Vec3A::from(vertex_normals[vertex]);
        let tangent = sums[group as usize].reject_from_normalized(normal);
        let tangent = tangent.normalize_or(normal.any_orthonormal_vector());
        shown.push(Vec4::from((tangent, tangents.sign[vertex])).to_array());
    }
}

/// The two sides that leave a triangle's first corner.
fn sides(positions: &[[f32; 3]], triangle: &[u32; 3]) -> (Vec3A, Vec3A) {
    let [a, b, c] = triangle.map(|i| Vec3A::from(positions[i as usize]));
    (b - a, c - a)
}

/// Adds a triangle's share to the groups of its corners.
fn add(groups: &Groups, triangle: &[u32; 3], share: Vec3A, sums: &mut [Vec3A]) {
    for &vertex in triangle {
        sums[groups.of_vertex[vertex as usize] as usize] += share;
    }
}
