//! Colours of what is drawn.

use bevy::prelude::*;

use crate::{pins::PinTarget, solver::SpringKind};

const PRESSED: LinearRgba = LinearRgba::rgb(0.02, 0.12, 1.0);
const AT_REST: LinearRgba = LinearRgba::rgb(0.4, 0.4, 0.4);
const HALF_STRETCHED: LinearRgba = LinearRgba::rgb(1.0, 0.75, 0.02);
const STRETCHED: LinearRgba = LinearRgba::rgb(1.0, 0.01, 0.01);

pub(super) const TAUT: LinearRgba = LinearRgba::rgb(1.0, 0.25, 0.0);
pub(super) const SLACK: LinearRgba = LinearRgba::new(0.4, 0.4, 0.4, 0.1);
pub(super) const NORMAL: LinearRgba = LinearRgba::rgb(0.1, 0.6, 1.0);
pub(super) const GRAB: LinearRgba = LinearRgba::rgb(1.0, 0.6, 0.0);
pub(super) const BOUNDS: LinearRgba = LinearRgba::rgb(0.6, 0.6, 0.1);
pub(super) const COLLIDER: LinearRgba = LinearRgba::new(0.1, 0.8, 0.5, 0.7);
pub(super) const WIND: LinearRgba = LinearRgba::rgb(0.2, 0.9, 1.0);

/// The colour of a spring: a diverging scale from blue through grey and yellow to red, full at `full_strain`.
pub(super) fn spring(kind: SpringKind, strain: f32, full_strain: f32) -> LinearRgba {
    // Each kind paler than the one before: all lie on one another, and strain has the hue.
    let alpha = [1.0, 0.45, 0.2][kind.index()];
    // `max` takes the other value for NaN.
    let share = (strain / full_strain.max(f32::MIN_POSITIVE)).clamp(-1.0, 1.0);
    let color = if share < 0.0 {
        AT_REST.mix(&PRESSED, -share)
    } else if share < 0.5 {
        AT_REST.mix(&HALF_STRETCHED, 2.0 * share)
    } else {
        HALF_STRETCHED.mix(&STRETCHED, 2.0 * share - 1.0)
    };
    color.with_alpha(alpha)
}

/// The colour of a pin.
pub(super) fn pin(target: PinTarget) -> LinearRgba {
    match target {
        PinTarget::Cloth => LinearRgba::rgb(0.05, 1.0, 0.1),
        PinTarget::World => LinearRgba::rgb(0.1, 0.2, 1.0),
        PinTarget::Entity(_) => LinearRgba::rgb(1.0, 0.05, 0.8),
        // Not a pin.
        PinTarget::Free => LinearRgba::NONE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_goes_from_blue_through_grey_and_yellow_to_red() {
        let at = |share: f32| spring(SpringKind::Structural, 0.08 * share, 0.08);
        assert_eq!([at(-1.0), at(0.0), at(0.5), at(1.0)], [PRESSED, AT_REST, HALF_STRETCHED, STRETCHED]);
        assert_eq!([at(-7.0), at(7.0)], [PRESSED, STRETCHED], "it is full there");
        assert!(at(0.25).red > at(0.25).blue && at(-0.25).blue > at(-0.25).red);
    }

    #[test]
    fn kinds_differ_at_any_strain() {
        for strain in [-0.05, 0.0, 0.01, 0.05] {
            let colors = SpringKind::ALL.map(|kind| spring(kind, strain, 0.05));
            assert!(colors[0] != colors[1] && colors[1] != colors[2] && colors[2] != colors[0]);
        }
    }

    #[test]
    fn a_full_strain_out_of_its_range_gives_a_colour() {
        for full in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            for strain in [-0.1, 0.0, 0.1] {
                assert!(spring(SpringKind::Bend, strain, full).to_vec4().is_finite(), "{strain} of {full}");
            }
        }
    }
}
