//! The principal axes of points.

use bevy::math::{DVec3, Vec3A};

/// Sweeps over a matrix of three rows, after which nothing is left off its diagonal: each squares what is left.
const SWEEPS: usize = 8;

/// The middle of points with weights, and three axes square to each other along which they spread most, least and in between, in no order.
///
/// The same points give the same bits: there is nothing but sums, products, quotients and roots.
pub(super) fn principal_axes(points: &[(Vec3A, f32)]) -> (Vec3A, [Vec3A; 3]) {
    let places = || points.iter().map(|&(place, weight)| (place.as_dvec3(), f64::from(weight)));
    let whole: f64 = places().map(|(_, weight)| weight).sum();
    let middle =
        if whole > 0.0 { places().map(|(place, weight)| weight * place).sum::<DVec3>() / whole } else { DVec3::ZERO };
    let mut spread = [[0.0; 3]; 3];
    for (place, weight) in places() {
        let offset = (place - middle).to_array();
        for (row, a) in spread.iter_mut().zip(offset) {
            row.iter_mut().zip(offset).for_each(|(sum, b)| *sum += weight * a * b);
        }
    }
    (middle.as_vec3a(), eigenvectors(spread).map(|axis| upright(axis).as_vec3a()))
}

/// Eigenvectors of a symmetric matrix, by Jacobi's rotations (Golub and Van Loan, "Matrix Computations", 8.5).
fn eigenvectors(mut matrix: [[f64; 3]; 3]) -> [DVec3; 3] {
    let mut axes = [DVec3::X, DVec3::Y, DVec3::Z];
    for (p, q) in [(0, 1), (0, 2), (1, 2)].into_iter().cycle().take(3 * SWEEPS) {
        let off = matrix[p][q];
        if off == 0.0 {
            continue;
        }
        // Tangent, cosine and sine of the turn after which `off` is zero.
        let theta = (matrix[q][q] - matrix[p][p]) / (2.0 * off);
        let t = 1.0_f64.copysign(theta) / (theta.abs() + (theta * theta + 1.0).sqrt());
        let c = 1.0 / (t * t + 1.0).sqrt();
        let s = t * c;
        for row in &mut matrix {
            (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
        }
        let (above, below) = (matrix[p], matrix[q]);
        matrix[p] = core::array::from_fn(|k| c * above[k] - s * below[k]);
        matrix[q] = core::array::from_fn(|k| s * above[k] + c * below[k]);
        (axes[p], axes[q]) = (c * axes[p] - s * axes[q], s * axes[p] + c * axes[q]);
    }
    axes
}

/// An axis or its opposite: of both, the one that points up.
fn upright(axis: DVec3) -> DVec3 {
    let is_down = axis.y < 0.0 || axis.y == 0.0 && (axis.x < 0.0 || axis.x == 0.0 && axis.z < 0.0);
    if is_down { -axis } else { axis }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_those_of_a_turned_box() {
        let turned = [Vec3A::new(0.6, 0.8, 0.0), Vec3A::new(-0.8, 0.6, 0.0), Vec3A::Z];
        let corner = |i: usize| {
            let sign = |bit: usize| if i >> bit & 1 == 0 { 1.0 } else { -1.0 };
            let place = 3.0 * sign(0) * turned[0] + 2.0 * sign(1) * turned[1] + sign(2) * turned[2];
            (Vec3A::new(5.0, 0.0, 1.0) + place, 0.1)
        };
        let (middle, axes) = principal_axes(&(0..8).map(corner).collect::<Vec<_>>());
        assert!(middle.abs_diff_eq(Vec3A::new(5.0, 0.0, 1.0), 1e-6));
        for axis in axes {
            assert!(turned.iter().any(|other| other.dot(axis).abs() > 1.0 - 1e-6), "{axis}");
            assert!(axis.y >= 0.0);
        }
    }

    #[test]
    fn points_in_one_place_have_axes_too() {
        let (middle, axes) = principal_axes(&[(Vec3A::ONE, 1.0); 5]);
        assert_eq!((middle, axes), (Vec3A::ONE, [Vec3A::X, Vec3A::Y, Vec3A::Z]));
        assert_eq!(principal_axes(&[]).0, Vec3A::ZERO);
    }
}
