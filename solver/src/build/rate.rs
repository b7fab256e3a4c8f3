//! How fast a sheet's bends may move its particles.

use crate::{Bend, noise::noise};

/// Rounds in which the fastest of all ways to move is looked for. It is found within some per cent.
const ROUNDS: u32 = 32;

/// What is added to make sure.
const MARGIN: f32 = 1.1;

/// The largest eigenvalue of A⁻¹ Cᵀ C, 1/m⁴, with the weights of the bends in C and the `areas` of the particles (m²) in A:
/// times rigidity over areal density, the square of the fastest frequency. By the power method.
pub(super) fn of_bends(bends: &[Bend], areas: &[f32]) -> f32 {
    // Starts with something of every way to move in them: neighbours go apart.
    let far: Vec<f32> = (0..areas.len() as u32).map(noise).collect();
    // Of particles that are much lighter than others, that has so little that the rounds don't bring it out.
    let hard = far.iter().zip(areas).map(|(way, area)| way / area.sqrt()).collect();
    let (usual, of_light) = (fastest(bends, areas, far), fastest(bends, areas, hard));
    MARGIN * if of_light > MARGIN * usual { of_light } else { usual }
}

/// The fastest that is found from a `way` to start with.
fn fastest(bends: &[Bend], areas: &[f32], mut way: Vec<f32>) -> f32 {
    let mut pull = vec![0.0; areas.len()];
    let mut rate = 0.0_f32;
    for _ in 0..ROUNDS {
        pull.fill(0.0);
        for Bend { particles, weights, .. } in bends {
            let sum: f32 = particles.iter().zip(weights).map(|(&i, weight)| weight * way[i as usize]).sum();
            for (&i, weight) in particles.iter().zip(weights) {
                pull[i as usize] += weight * sum;
            }
        }
        let (mut work, mut motion) = (0.0, 0.0);
        for ((way, pull), area) in way.iter().zip(&pull).zip(areas) {
            work += way * pull;
            motion += way * way * area;
        }
        if !(work > 0.0 && motion > 0.0) {
            return rate;
        }
        rate = rate.max(work / motion);
        let scale = work.sqrt().recip();
        for ((way, pull), area) in way.iter_mut().zip(&pull).zip(areas) {
            *way = pull / area * scale;
        }
    }
    rate
}

/// What that is at most, by Gershgorin's circles.
pub(super) fn bound(bends: &[Bend], areas: &[f32]) -> f32 {
    let mut sums = vec![0.0; areas.len()];
    for Bend { particles, weights, .. } in bends {
        let all: f32 = weights.iter().map(|weight| weight.abs()).sum();
        for (&i, weight) in particles.iter().zip(weights) {
            sums[i as usize] += weight.abs() * all;
        }
    }
    sums.iter().zip(areas).map(|(sum, area)| sum / area).fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_of_one_bend_and_of_two_that_share_a_particle() {
        let weights = [3.0, 3.0, -6.0, 0.0];
        let one = Bend { particles: [0, 2, 1, 3], weights, ..Bend::default() };
        let other = Bend { particles: [4, 5, 1, 3], weights, ..Bend::default() };
        let areas = [2.0; 6];
        let rate = of_bends(&[one], &areas);
        assert!((rate / (MARGIN * 54.0 / 2.0) - 1.0).abs() < 1e-3, "{rate}");
        // Both have 36 of 54 in common.
        let rate = of_bends(&[one, other], &areas);
        assert!((rate / (MARGIN * 90.0 / 2.0) - 1.0).abs() < 1e-3, "{rate}");
        assert_eq!(of_bends(&[], &areas), 0.0);
    }

    #[test]
    fn the_rate_of_particles_that_are_much_lighter_than_others_is_found() {
        let weights = [3.0, 3.0, -6.0, 0.0];
        let bend = |first: u32, scale: f32| Bend {
            particles: [first, first + 1, first + 2, first + 3],
            weights: weights.map(|weight| weight * scale),
            ..Bend::default()
        };
        // Faster than the others by three tenths, and a billion times lighter.
        let light = 1e-9_f32;
        let bends = [bend(0, 1.0), bend(4, (1.3 * light).sqrt())];
        let areas = [[1.0; 4], [light; 4]].concat();
        let rate = of_bends(&bends, &areas);
        assert!((rate / (MARGIN * 1.3 * 54.0) - 1.0).abs() < 1e-2, "{rate}");
    }
}
