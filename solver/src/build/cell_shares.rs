//! What the springs of one cell carry of a sheet.
//!
//! ```text
//!     right angles                      others
//!        a                                   a
//!    o-------o   along a: C b/a - G a/b     o-------o      n: unit vectors of the sides 1, 2
//!    |  \ /  | b along b: C a/b - G b/a      \  \ /  \     and of the diagonals 3, 4, each of
//!    |  / \  |   diagonal:                    \ / \   \ b  length L
//!    o-------o   G (a² + b²) / (2 a b)         o-------o   of an area A
//! ```
//!
//! From the energy of a cell under strains ε: a spring of stiffness k along n takes k L² (n·ε n)²/2. Of right angles, both diagonals
//! together take G for the shear, and by the way G a²/b² and G b²/a² of what is along the sides; the sides take the rest. On squares,
//! whatever their size, that is C - G and G.
//!
//! Of other angles, threads go along the sides: C - G is theirs. What is left is the energy G ((εu + εv)² + γ²)/2 with u and v at
//! right angles and as near to the sides as can be, that is G (εx² + εy²) with x and y along the sum and the difference of the sides'
//! unit vectors. Four springs have four numbers where a sheet has five, so theirs, K = k L²/(G A), are those whose sum is nearest to it:
//!
//! ```text
//!    Σj (ni·nj)⁴ Kj = 2 ((ni·x)⁴ + (ni·y)⁴)
//! ```
//!
//! which is exact for right angles and for equal sides.

/// Sides of less than this |cos| between them are at right angles.
const RIGHT: f32 = 1e-3;

/// Parts of the moduli that the springs of a cell have, no unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CellShares {
    /// Parts of C and of G of each of the two sides along a, and of those along b.
    pub sides: [[f32; 2]; 2],
    /// Parts of G of the diagonal along a + b, and of the other.
    pub diagonals: [f32; 2],
}

impl CellShares {
    /// Those of a cell whose sides are `a` and `b` (m) long, with `cosine` between them.
    pub fn new(a: f32, b: f32, cosine: f32) -> Self {
        if cosine.abs() < RIGHT {
            let side = |a: f32, b: f32| [0.5 * b / a, -0.5 * a / b];
            return Self { sides: [side(a, b), side(b, a)], diagonals: [(a * a + b * b) / (2.0 * a * b); 2] };
        }
        let [a, b, cosine] = [a, b, cosine].map(f64::from);
        let area = a * b * (1.0 - cosine * cosine).sqrt();
        let ([one, other, falling, rising], squares) = (of_skewed(a, b, cosine), diagonals_squared(a, b, cosine));
        // In each of the two sides half of it.
        let side = |of_shear: f64, a: f64| [0.5 * area / (a * a), 0.5 * (of_shear - 1.0) * area / (a * a)];
        // A diagonal that would have to push apart is left out.
        let diagonal = |of_shear: f64, squared: f64| (of_shear * area / squared).max(0.0) as f32;
        Self {
            sides: [side(one, a), side(other, b)].map(|parts| parts.map(|part| part as f32)),
            diagonals: [diagonal(falling, squares[0]), diagonal(rising, squares[1])],
        }
    }
}

/// Squared lengths of the diagonals a + b and a - b, m².
fn diagonals_squared(a: f64, b: f64, cosine: f64) -> [f64; 2] {
    [1.0, -1.0].map(|sign| a * a + b * b + sign * 2.0 * a * b * cosine)
}

/// K of the sides and the diagonals.
fn of_skewed(a: f64, b: f64, cosine: f64) -> [f64; 4] {
    let squared = diagonals_squared(a, b, cosine);
    let [f, r] = squared.map(f64::sqrt);
    let cosines = [
        [1.0, cosine, (a + b * cosine) / f, (a - b * cosine) / r],
        [0.0, 1.0, (b + a * cosine) / f, (a * cosine - b) / r],
        [0.0, 0.0, 1.0, (a * a - b * b) / (f * r)],
        [0.0, 0.0, 0.0, 1.0],
    ];
    let mut matrix = [[0.0; 4]; 4];
    for i in 0..4 {
        for j in i..4 {
            matrix[i][j] = fourth(cosines[i][j]);
            matrix[j][i] = matrix[i][j];
        }
    }
    // Squared cosines between x and y and the sides: x halves the angle between them.
    let [x, y] = [0.5 * (1.0 + cosine), 0.5 * (1.0 - cosine)];
    let diagonal = |sum: f64, difference: f64, squared: f64| {
        2.0 * (fourth(sum) * x * x + fourth(difference) * y * y) / (squared * squared)
    };
    let side = 2.0 * (x * x + y * y);
    solve(matrix, [side, side, diagonal(a + b, a - b, squared[0]), diagonal(a - b, a + b, squared[1])])
}

fn fourth(x: f64) -> f64 {
    x * x * x * x
}

/// Solves a positive definite system by elimination.
fn solve(mut matrix: [[f64; 4]; 4], mut right: [f64; 4]) -> [f64; 4] {
    for i in 0..4 {
        for j in i + 1..4 {
            let factor = matrix[j][i] / matrix[i][i];
            (i..4).for_each(|k| matrix[j][k] -= factor * matrix[i][k]);
            right[j] -= factor * right[i];
        }
    }
    for i in (0..4).rev() {
        let known: f64 = (i + 1..4).map(|k| matrix[i][k] * right[k]).sum();
        right[i] = (right[i] - known) / matrix[i][i];
    }
    right
}

#[cfg(test)]
mod tests {
    use bevy_math::{Mat2, Vec2};

    use super::*;

    /// Energy over area of a cell of moduli C and G under a strain, by its springs and by the sheet's law.
    fn energies([a, b, cosine]: [f32; 3], [c, g]: [f32; 2], strain: Mat2) -> [f32; 2] {
        let shares = CellShares::new(a, b, cosine);
        let sine = (1.0 - cosine * cosine).sqrt();
        let [along, across] = [Vec2::X * a, Vec2::new(cosine, sine) * b];
        let taken = |side: Vec2, k: f32| 0.5 * k * side.dot(strain * side).powi(2) / side.length_squared();
        let of_sides: f32 = [along, across]
            .into_iter()
            .zip(shares.sides)
            .map(|(side, [of_c, of_g])| 2.0 * taken(side, of_c * c + of_g * g))
            .sum();
        let diagonals = [along + across, along - across].into_iter().zip(shares.diagonals);
        let of_diagonals: f32 = diagonals.map(|(side, of_g)| taken(side, of_g * g)).sum();
        let of = |direction: Vec2| direction.dot(strain * direction);
        let [u, v] = [along, across].map(Vec2::normalize);
        let [x, y] = [(u + v).normalize(), (u - v).normalize()];
        let threads = 0.5 * (c - g) * (of(u).powi(2) + of(v).powi(2));
        [(of_sides + of_diagonals) / (a * b * sine), threads + g * (of(x).powi(2) + of(y).powi(2))]
    }

    /// Strains along the sides, across them, and of shear.
    fn strains(cosine: f32) -> [Mat2; 5] {
        let along = |u: Vec2| Mat2::from_cols(u * u.x, u * u.y);
        let side = Vec2::new(cosine, (1.0 - cosine * cosine).sqrt());
        let shear = Mat2::from_cols(Vec2::Y, Vec2::X);
        [along(Vec2::X), along(side), along(Vec2::Y), shear, Mat2::IDENTITY]
    }

    #[track_caller]
    fn assert_energies(cell: [f32; 3], moduli: [f32; 2], within: f32) {
        for strain in strains(cell[2]) {
            let [of_springs, of_sheet] = energies(cell, moduli, strain);
            assert!((of_springs / of_sheet - 1.0).abs() < within, "{cell:?} {strain}: {of_springs} for {of_sheet}");
        }
    }

    #[test]
    fn cells_with_right_angles_or_equal_sides_are_the_sheet() {
        for moduli in [[4000.0, 50.0], [70.0, 37.0]] {
            for ratio in [0.3, 1.0, 2.5] {
                assert_energies([ratio, 1.0, 0.0], moduli, 1e-4);
            }
            for cosine in [-0.7, -0.2, 0.1, 0.5] {
                assert_energies([1.0, 1.0, cosine], moduli, 1e-3);
            }
        }
    }

    #[test]
    fn other_cells_are_nearly_the_sheet() {
        for ratio in [0.4, 0.6, 1.7, 2.5] {
            for cosine in [-0.342, -0.17, 0.17, 0.342] {
                assert_energies([ratio, 1.0, cosine], [4000.0, 50.0], 0.035);
            }
            assert_energies([ratio, 1.0, 0.5], [4000.0, 50.0], 0.06);
        }
    }

    #[test]
    fn what_counts_as_right_angles_makes_no_step() {
        for ratio in [0.5, 1.0, 2.0] {
            let [right, skewed] = [0.99 * RIGHT, 1.01 * RIGHT].map(|cosine| CellShares::new(ratio, 1.0, cosine));
            let all = |it: CellShares| [it.sides[0], it.sides[1], it.diagonals];
            let pairs = all(right).into_iter().flatten().zip(all(skewed).into_iter().flatten());
            assert!(pairs.into_iter().all(|(one, other)| (one / other - 1.0).abs() < 0.02), "{right:?} {skewed:?}");
        }
    }
}
