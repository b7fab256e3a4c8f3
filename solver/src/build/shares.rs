//! What each spring carries of a sheet: the springs of a cell together have the sheet's [moduli](super::cell_shares), each side of it
//! half of its part from each of the two cells beside it.

use bevy_math::Vec3;

use super::{cell_shares::CellShares, cells::Cells};
use crate::{Spring, SpringKind};

/// Gives the springs along and across each cell their share of it. `springs` are sorted by kind and lower end; `warp` is
/// the direction of the warp in each triangle. What has no area, as `slivers`, is held by springs of the mean stiffness.
pub(super) fn share_out(
    rest: &[Vec3],
    cells: &Cells,
    slivers: &[[u32; 3]],
    warp: &[Vec3],
    springs: &mut [(SpringKind, Spring)],
) {
    let find = Finder::new(rest.len(), springs);
    for (&[i, j, k, l], warp) in cells.corners.iter().zip(cells.warp(warp)) {
        let at = |particle: u32| rest[particle as usize];
        let along = (at(j) - at(i)) + (at(k) - at(l));
        let across = (at(l) - at(i)) + (at(k) - at(j));
        let (a, b) = (along.length() / 2.0, across.length() / 2.0);
        if !(a > 0.0 && b > 0.0) {
            continue;
        }
        let is_warp = along.dot(warp).abs() * b >= across.dot(warp).abs() * a;
        let CellShares { sides: [of_along, of_across], diagonals } =
            CellShares::new(a, b, along.dot(across) / (4.0 * a * b));
        let side = |is_warp: bool, [part, shear]: [f32; 2]| {
            if is_warp { [part, 0.0, shear] } else { [0.0, part, shear] }
        };
        let [falling, rising] = diagonals.map(|shear| [0.0, 0.0, shear]);
        for (kind, p, q, share) in [
            (SpringKind::Structural, i, j, side(is_warp, of_along)),
            (SpringKind::Structural, l, k, side(is_warp, of_along)),
            (SpringKind::Structural, i, l, side(!is_warp, of_across)),
            (SpringKind::Structural, j, k, side(!is_warp, of_across)),
            (SpringKind::Shear, i, k, falling),
            (SpringKind::Shear, j, l, rising),
        ] {
            if let Some(number) = find.spring(springs, kind, p, q) {
                for (sum, part) in springs[number].1.share.iter_mut().zip(share) {
                    *sum += part;
                }
            }
        }
    }
    for &[i, j, k] in slivers {
        for (p, q) in [(i, j), (j, k), (k, i)] {
            if let Some(number) = find.spring(springs, SpringKind::Structural, p, q)
                && springs[number].1.share == [0.0; 3]
            {
                springs[number].1.share = SIDE_OF_SLIVER;
            }
        }
    }
}

/// What a side of a triangle without area has of a sheet.
const SIDE_OF_SLIVER: [f32; 3] = [0.5, 0.5, 0.0];

/// Where the springs of each kind begin at each particle.
struct Finder([Vec<usize>; SpringKind::ALL.len()]);

impl Finder {
    fn new(count: usize, springs: &[(SpringKind, Spring)]) -> Self {
        Self(SpringKind::ALL.map(|kind| {
            let mut at = springs.partition_point(|(other, _)| *other < kind);
            let mut starts = Vec::with_capacity(count + 1);
            for particle in 0..=count as u32 {
                while springs.get(at).is_some_and(|(other, spring)| *other == kind && spring.a < particle) {
                    at += 1;
                }
                starts.push(at);
            }
            starts
        }))
    }

    fn spring(&self, springs: &[(SpringKind, Spring)], kind: SpringKind, p: u32, q: u32) -> Option<usize> {
        let (low, high) = (p.min(q), p.max(q));
        let starts = &self.0[kind.index()];
        (starts[low as usize]..starts[low as usize + 1]).find(|&number| springs[number].1.b == high)
    }
}
