//! The energy of a swinging cloth that nothing damps.

use bevy::math::{Vec3A, ops};
use bevy_drape::{
    prelude::{ClothGrid, Fabric},
    solver::{Method, measure},
};

use super::{
    Extent,
    bed::{Bed, GRAVITY, bare},
    record::{Case, Curve, Measurement, Outcome},
};

const NAME: &str = "energy";

/// The most that the explicit solver may lose or gain.
const EXPLICIT: f64 = 0.01;

/// The most that 32 substeps of strands may lose.
const LOSS: f64 = 0.12;

/// The most that anything may gain.
const GAIN: f64 = 0.005;

const SECONDS: f32 = 10.0;

/// From hanging straight down to where it is let go, rad: 30°.
const ASIDE: f32 = core::f32::consts::FRAC_PI_6;

/// Along each side.
const CELLS: u32 = 16;

/// All is a share of the energy that the cloth sets free on its way down: the weight times what its centre sinks from where
/// it is let go to where it hangs at rest. Any other zero of the height would make the same loss look larger or smaller.
pub fn run(_: Extent) -> Outcome {
    let mut outcome = Outcome::default();
    for substeps in [Some(4), Some(8), Some(32), None] {
        let method = if substeps.is_some() { Method::Strands } else { Method::Explicit };
        let case = Case { fabric: "cotton_woven", mesh: "grid", n: CELLS, substeps, method, ..Case::default() };
        let (reference, energies) = swing(&case);
        let share = |energy: f64| (energy - energies[0]) / reference;
        let most = energies.iter().copied().map(share).fold(0.0, f64::max);
        let end = share(energies[energies.len() - 1]);
        let of_all = |quantity, measured| Measurement::new(NAME, quantity, case.clone(), measured, 0.0).of(1.0);
        let loss = of_all("loss in 10 s, share", -end);
        outcome.measurements.push(match substeps {
            None => loss.within(EXPLICIT),
            Some(32) => loss.within(LOSS),
            Some(_) => loss,
        });
        outcome.measurements.push(of_all("most above the start in 10 s, share", most).within(GAIN));
        let points = energies.iter().enumerate().step_by(6);
        let points = points.map(|(step, &energy)| [step as f64 / 60.0, 100.0 * (1.0 + share(energy))]).collect();
        outcome.curves.push(Curve {
            plot: NAME,
            series: case.effort(),
            is_expected: false,
            points,
            ..Curve::default()
        });
    }
    outcome
}

/// A square metre that hangs by one edge is let go, flat, from 30° aside. The reference, and the energy at the start and
/// after each step, J.
fn swing(case: &Case) -> (f64, Vec<f64>) {
    let side = 1.0;
    let grid = ClothGrid::new(side, side, CELLS + 1, CELLS + 1).lying();
    let mut bed = Bed::new(grid, bare(Fabric::COTTON_WOVEN)).solved_as_in(case);
    bed = bed.pinned(|p| p.z < -0.499 * side);
    for position in &mut bed.particles.position {
        let way = position.z + 0.5 * side;
        position.z = way * ops::sin(ASIDE) - 0.5 * side;
        position.y = -way * ops::cos(ASIDE);
    }
    let start = bed.centre().y;
    let mut hanging = bed.clone();
    (hanging.method, hanging.substeps) = (Method::Strands, 8);
    hanging.settle(2.0, 30.0);
    let reference = f64::from(bed.material.density * side * side * GRAVITY * (start - hanging.centre().y));
    let mut energies = vec![energy(&bed)];
    for _ in 0..(SECONDS / bed.dt).round() as u32 {
        bed.step();
        energies.push(energy(&bed));
    }
    (reference, energies)
}

fn energy(bed: &Bed) -> f64 {
    let energy = measure::energy(&bed.particles, &bed.topology, &bed.material, Vec3A::NEG_Y * GRAVITY);
    energy.total().into()
}
