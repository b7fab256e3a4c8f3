//! Triangles that carry a sheet's moduli by themselves: those that are in no cell of a lattice.

use core::ops::Range;

use bevy_math::{Vec2, Vec3};

use super::{cells::Cells, coloring};
use crate::Face;

/// The faces, and runs of up to eight that share no particle. `warp` is the direction of the warp in each of `triangles`.
pub(super) fn find(
    rest: &[Vec3],
    triangles: &[[u32; 3]],
    cells: &Cells,
    warp: &[Vec3],
) -> (Vec<Face>, Vec<Range<usize>>) {
    let free = triangles.iter().zip(&cells.of_triangle).zip(warp).filter(|((_, cell), _)| cell.is_none());
    let faces = free.filter_map(|((&triangle, _), &warp)| face(rest, triangle, warp)).collect();
    coloring::runs(faces, |face: &Face| face.particles)
}

/// The triangle as a patch of cloth. With its sides' coordinates along warp and weft as columns of a matrix, the weights of
/// the sides that make a step along the warp are the first column of its inverse, and those along the weft the second.
pub(super) fn face(rest: &[Vec3], particles: [u32; 3], warp: Vec3) -> Option<Face> {
    let [a, b, c] = particles.map(|i| rest[i as usize]);
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac).try_normalize()?;
    let warp = warp.reject_from_normalized(normal).try_normalize().unwrap_or(ab.normalize_or_zero());
    let weft = normal.cross(warp);
    let (ab, ac) = (Vec2::new(ab.dot(warp), ab.dot(weft)), Vec2::new(ac.dot(warp), ac.dot(weft)));
    let twice = ab.perp_dot(ac);
    let face = Face {
        particles,
        warp: [ac.y / twice, -ab.y / twice],
        weft: [-ac.x / twice, ab.x / twice],
        area: twice.abs() / 2.0,
    };
    face.warp.iter().chain(&face.weft).all(|weight| weight.is_finite()).then_some(face)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{
        cells::{self, CellBounds},
        edges::Edges,
    };

    #[test]
    fn a_face_takes_one_step_along_warp_and_weft_whatever_its_shape() {
        let rest = [Vec3::new(0.2, 0.1, 0.0), Vec3::new(0.5, 0.15, 0.1), Vec3::new(0.3, 0.6, -0.1)];
        let normal = (rest[1] - rest[0]).cross(rest[2] - rest[0]).normalize();
        let warp = Vec3::Y.reject_from_normalized(normal).normalize();
        let triangles = [[0, 1, 2]];
        let cells = cells::find(&rest, &triangles, &Edges::new(3, &triangles), CellBounds::EVEN);
        let (faces, batches) = find(&rest, &triangles, &cells, &[warp]);
        let step = |[b, c]: [f32; 2]| (rest[1] - rest[0]) * b + (rest[2] - rest[0]) * c;
        assert!(matches!(&batches[..], [batch] if *batch == (0..1)));
        assert!(step(faces[0].warp).distance(warp) < 1e-5);
        assert!(step(faces[0].weft).distance(normal.cross(warp)) < 1e-5);
        let area = (rest[1] - rest[0]).cross(rest[2] - rest[0]).length() / 2.0;
        assert!((faces[0].area / area - 1.0).abs() < 1e-5);
    }

    #[test]
    fn triangles_of_a_cell_are_no_faces_and_no_run_has_a_particle_twice() {
        let rest = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y, Vec3::new(2.5, 0.5, 0.0), Vec3::NEG_Y];
        let triangles = [[0, 1, 2], [0, 2, 3], [1, 4, 2], [1, 5, 4]];
        let cells = cells::find(&rest, &triangles, &Edges::new(rest.len(), &triangles), CellBounds::EVEN);
        let (faces, batches) = find(&rest, &triangles, &cells, &[Vec3::Y; 4]);
        assert_eq!(faces.len(), 2);
        assert_eq!(batches, [0..1, 1..2]);
    }
}
