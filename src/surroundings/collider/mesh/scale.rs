//! What a transform does to a shape before it turns and moves it: what is worked into the triangles of a collider.

use bevy::math::{Affine3A, Isometry3d, Mat3A, Quat, Vec3A};

use crate::frame::SCALE_ROUNDING;

/// Scales are told apart by this share of their power of two, far finer than any that shows.
const FINENESS: f32 = 1.0 / (1 << 20) as f32;

/// The pose within a transform and what comes before it: scale, mirror and shear.
pub(super) fn split(pose: Affine3A) -> (Isometry3d, Mat3A) {
    let (_, rotation, translation) = pose.to_scale_rotation_translation();
    let rotation: Quat = rotation.normalize();
    (Isometry3d::new(translation, rotation), Mat3A::from_quat(rotation.inverse()) * pose.matrix3)
}

/// The scale that stands for `scale` and all that differ from it by rounding only, so that they share their triangles.
pub(super) fn rounded(scale: Mat3A) -> Mat3A {
    let round = |column: Vec3A| {
        let power_of_two = f32::from_bits(column.abs().max_element().to_bits() & 0x7f80_0000);
        let step = (power_of_two * FINENESS).max(f32::MIN_POSITIVE);
        // Adding zero makes -0 the same as 0.
        (column / step).round() * step + Vec3A::ZERO
    };
    Mat3A::from_cols(round(scale.x_axis), round(scale.y_axis), round(scale.z_axis))
}

/// Whether two scales are the same but for rounding.
pub(super) fn is_same(one: Mat3A, other: Mat3A) -> bool {
    let is_near = |a: Vec3A, b: Vec3A| (a - b).abs().max_element() <= SCALE_ROUNDING * a.abs().max_element();
    is_near(one.x_axis, other.x_axis) && is_near(one.y_axis, other.y_axis) && is_near(one.z_axis, other.z_axis)
}

#[cfg(test)]
mod tests {
    use bevy::prelude::*;

    use super::*;

    fn transforms() -> impl Iterator<Item = Affine3A> {
        let scales = [Vec3::ONE, Vec3::new(0.3, 5.0, 1.7), Vec3::new(-2.0, 0.01, 700.0), -Vec3::ONE];
        scales.into_iter().flat_map(|scale| {
            (0..50).map(move |i| {
                let turn = Quat::from_euler(EulerRot::XYZ, i as f32 * 0.7, i as f32 * 1.3, i as f32 * 2.9);
                Transform { translation: Vec3::ONE, rotation: turn, scale }.compute_affine()
            })
        })
    }

    #[test]
    fn pose_and_scale_make_up_the_transform_sheared_or_not() {
        let shear = Affine3A::from_scale(Vec3::new(1.0, 3.0, 0.5));
        for transform in transforms().chain(transforms().map(|transform| shear * transform)) {
            let (pose, scale) = split(transform);
            let again = Affine3A::from(pose) * Affine3A::from_mat3(scale.into());
            let tolerance = 1e-5 * transform.matrix3.to_cols_array().into_iter().fold(0.0, |a: f32, b| a.max(b.abs()));
            assert!(again.abs_diff_eq(transform, tolerance), "{transform} and {again}");
            assert!(pose.rotation.is_normalized());
        }
    }

    #[test]
    fn a_scale_stays_the_same_however_it_is_turned() {
        for scale in [Vec3::ONE, Vec3::new(0.3, 5.0, 1.7), Vec3::new(-2.0, 0.01, 700.0)] {
            let upright = rounded(Mat3A::from_diagonal(scale));
            assert!(is_same(upright, Mat3A::from_diagonal(scale)));
            for i in 0..1000 {
                let turn = Quat::from_euler(EulerRot::XYZ, i as f32 * 0.37, i as f32 * 0.13, i as f32 * 0.29);
                let turned = split(Transform { scale, rotation: turn, ..default() }.compute_affine()).1;
                assert!(is_same(upright, turned), "{upright} and {turned}");
            }
        }
        assert!(!is_same(Mat3A::IDENTITY, Mat3A::from_diagonal(Vec3::new(1.0, 1.0001, 1.0))));
        assert!(!is_same(Mat3A::IDENTITY, Mat3A::from_diagonal(Vec3::new(1.0, 1.0, -1.0))));
        assert!(!is_same(Mat3A::IDENTITY, Mat3A::NAN));
    }

    #[test]
    fn rounding_changes_next_to_nothing() {
        for i in 1..1000 {
            let scale = Mat3A::from_diagonal(Vec3::new(i as f32 * 0.0137, 1.0 / i as f32, -(i as f32)));
            let difference = (rounded(scale) - scale).to_cols_array().into_iter().zip(scale.to_cols_array());
            assert!(difference.into_iter().all(|(difference, of)| difference.abs() <= 1e-6 * of.abs()), "{scale}");
        }
        let one = Mat3A::from_diagonal(Vec3::new(1.0, 2.0, 0.5));
        assert_eq!(rounded(one * (1.0 + 1e-7)), one);
    }
}
