//! Eight triangles side by side.

use crate::{
    layout::simd::{LANES, Lane},
    topology::Face,
};

/// Up to eight [faces](Face) that share no particle, component by component. Where there is no face, the corners are one
/// more than there are particles, and the area is zero.
#[derive(Clone, Debug, PartialEq)]
pub struct FacePack {
    /// First, second and third corners.
    pub particles: [[u32; LANES]; 3],
    /// [`Face::warp`], 1/m.
    pub warp: [Lane; 2],
    /// [`Face::weft`], 1/m.
    pub weft: [Lane; 2],
    /// Area, m².
    pub area: Lane,
}

impl FacePack {
    /// Up to eight faces; `nobody` is the particle of those that aren't there.
    pub fn new(faces: &[Face], nobody: u32) -> Self {
        let mut pack = Self {
            particles: [[nobody; LANES]; 3],
            warp: [Lane::default(); 2],
            weft: [Lane::default(); 2],
            area: Lane::default(),
        };
        for (lane, face) in faces.iter().enumerate().take(LANES) {
            for (corners, corner) in pack.particles.iter_mut().zip(face.particles) {
                corners[lane] = corner;
            }
            for side in 0..2 {
                pack.warp[side][lane] = face.warp[side];
                pack.weft[side][lane] = face.weft[side];
            }
            pack.area[lane] = face.area;
        }
        pack
    }
}
