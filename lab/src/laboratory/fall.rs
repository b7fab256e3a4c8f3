//! A cloth in a vacuum falls as everything does, and turns on for ever.

use bevy::math::{DVec3, Vec3A};
use bevy_drape::{
    prelude::{ClothGrid, Fabric},
    solver::Method,
};

use super::{
    Extent,
    bed::{Bed, GRAVITY, bare},
    record::{Case, Measurement, Outcome},
};

const NAME: &str = "free-fall";

const TOLERANCE: f64 = 0.005;

/// Along each side.
const CELLS: u32 = 15;

pub fn run(_: Extent) -> Outcome {
    let measurements = [Method::Strands, Method::Xpbd, Method::Explicit].into_iter().flat_map(|method| {
        let substeps = (method != Method::Explicit).then_some(8);
        let case = Case { fabric: "cotton_woven", mesh: "grid", n: CELLS, substeps, method, ..Case::default() };
        [falling(&case), drifting(&case)].into_iter().flatten()
    });
    Outcome { measurements: measurements.collect(), ..Outcome::default() }
}

/// A square metre.
fn sheet(case: &Case) -> Bed {
    let grid = ClothGrid::new(1.0, 1.0, CELLS + 1, CELLS + 1).lying();
    Bed::new(grid, bare(Fabric::COTTON_WOVEN)).solved_as_in(case)
}

/// Way and speed after a second.
fn falling(case: &Case) -> Vec<Measurement> {
    let mut bed = sheet(case);
    bed.run(1.0);
    let all: Vec<usize> = (0..bed.particles.len()).collect();
    let way = -bed.mean(&all, |p| p.y);
    let speed = -bed.particles.velocity.iter().map(|v| f64::from(v.y)).sum::<f64>() / all.len() as f64;
    let g = f64::from(GRAVITY);
    vec![
        Measurement::new(NAME, "way in 1 s, m", case.clone(), way, 0.5 * g).within(TOLERANCE),
        Measurement::new(NAME, "speed after 1 s, m/s", case.clone(), speed, g).within(TOLERANCE),
    ]
}

/// Momentum and angular momentum of a cloth that flies, turns and is thrown out of its plane, after two seconds without
/// gravity.
fn drifting(case: &Case) -> Vec<Measurement> {
    let mut bed = Bed { gravity: Vec3A::ZERO, ..sheet(case) };
    for (velocity, position) in bed.particles.velocity.iter_mut().zip(&bed.particles.position) {
        *velocity = Vec3A::new(1.0, position.x, 0.5) + 2.0 * Vec3A::Y.cross(*position);
    }
    let [linear, angular] = momenta(&bed);
    bed.run(2.0);
    let [linear_after, angular_after] = momenta(&bed);
    let drift = |quantity: &str, before: DVec3, after: DVec3| {
        Measurement::new(NAME, quantity, case.clone(), before.distance(after), 0.0).of(before.length())
    };
    let turning = drift("drift of angular momentum in 2 s of free flight, kg·m²/s", angular, angular_after);
    vec![
        drift("drift of momentum in 2 s of free flight, kg·m/s", linear, linear_after).within(TOLERANCE),
        // Constraints act where a particle comes to, not where it was: what turns by an angle in a substep keeps its cosine.
        if case.method == Method::Explicit { turning.within(TOLERANCE) } else { turning },
    ]
}

/// Momentum, and angular momentum about the moving centre.
fn momenta(bed: &Bed) -> [DVec3; 2] {
    let particles = || bed.particles.position.iter().zip(&bed.particles.velocity).enumerate();
    let parts = || particles().map(|(i, (p, v))| (bed.mass(i), p.as_dvec3(), v.as_dvec3()));
    let mass: f64 = parts().map(|(m, ..)| m).sum();
    let centre = parts().map(|(m, p, _)| m * p).sum::<DVec3>() / mass;
    [parts().map(|(m, _, v)| m * v).sum(), parts().map(|(m, p, v)| m * (p - centre).cross(v)).sum()]
}
