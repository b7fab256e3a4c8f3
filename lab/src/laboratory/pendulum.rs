//! Small swings of a single cell, which is a pendulum, and of a hanging sheet, which is a heavy chain.

use bevy_drape::prelude::{ClothGrid, Fabric};

use super::{
    BRIEF, EFFORTS, Extent,
    bed::{Bed, GRAVITY, bare},
    record::{Case, Measurement, Outcome},
    roots,
};

const NAME: &str = "pendulum";

const TOLERANCE: f64 = 0.005;

/// Angle of the swing, rad: 5°.
const AMPLITUDE: f64 = 5.0 * core::f64::consts::PI / 180.0;

/// Length, m.
const LENGTH: f64 = 0.5;

/// Turning points that are waited for.
const SWINGS: usize = 10;

pub fn run(extent: Extent) -> Outcome {
    let efforts = if extent == Extent::Brief { &BRIEF[..] } else { &EFFORTS };
    let measurements = efforts.iter().flat_map(|&(method, substeps)| {
        let case = |n| Case { fabric: "cotton_woven", mesh: "grid", n, substeps, method, ..Case::default() };
        [cell(case(1)), sheet(case(24))]
    });
    Outcome { measurements: measurements.collect(), ..Outcome::default() }
}

/// T = 2π √(L/g) (1 + θ²/16), and the next term is less than a millionth.
fn cell(case: Case) -> Measurement {
    let expected = core::f64::consts::TAU * rate().recip() * (1.0 + AMPLITUDE * AMPLITUDE / 16.0);
    let measured = period(hung(&case, |way| way * AMPLITUDE.sin()));
    Measurement::new(NAME, "period of one cell, s", case, measured, expected).within(TOLERANCE)
}

/// A chain of length L swings in the shape J0(2 ω √(s/g)), with s from its lower end up, where J0 is zero at the upper.
/// (Daniel Bernoulli, 1732.)
fn sheet(case: Case) -> Measurement {
    let zero = roots::bisect(50, 2.0, 3.0, |x| -bessel(x));
    let omega = 0.5 * zero * rate();
    // The angle is that of the lower end.
    let reach = AMPLITUDE.sin() * 4.0 * LENGTH / (zero * zero);
    let measured = period(hung(&case, |way| reach * bessel(zero * (1.0 - way / LENGTH).max(0.0).sqrt())));
    Measurement::new(NAME, "period of a hanging sheet, s", case, measured, core::f64::consts::TAU / omega)
        .within(TOLERANCE)
}

/// √(g/L), 1/s.
fn rate() -> f64 {
    (f64::from(GRAVITY) / LENGTH).sqrt()
}

/// Bessel's J0 by its series.
fn bessel(x: f64) -> f64 {
    let mut term = 1.0;
    (1..30).fold(1.0, |sum, k| {
        term *= -0.25 * x * x / f64::from(k * k);
        sum + term
    })
}

/// A strip that hangs from its upper edge and is moved to the side by so much (m) where it is so far from there (m). It is
/// nowhere stretched.
fn hung(case: &Case, aside: impl Fn(f64) -> f64) -> Bed {
    let columns = if case.n == 1 { 2 } else { 4 };
    let grid = ClothGrid::new(0.1, LENGTH as f32, columns, case.n + 1);
    let bed = Bed::new(grid, bare(Fabric::COTTON_WOVEN)).solved_as_in(case);
    let mut bed = bed.pinned(|p| p.y > 0.499 * LENGTH as f32);
    let step = LENGTH / f64::from(case.n);
    let mut depths = vec![0.0];
    for row in 0..case.n {
        let [before, after] = [row, row + 1].map(|row| aside(f64::from(row) * step));
        depths.push(depths[row as usize] + (step * step - (after - before) * (after - before)).sqrt());
    }
    for position in &mut bed.particles.position {
        let row = ((0.5 * LENGTH - f64::from(position.y)) / step).round();
        position.y = (0.5 * LENGTH - depths[row as usize]) as f32;
        position.z = aside(row * step) as f32;
    }
    bed
}

/// Twice the mean time between passages of the lower end through the middle, s.
fn period(mut bed: Bed) -> f64 {
    // Fine enough in time that a straight line between two steps will do.
    let lower = bed.chosen(|p| p.y < -0.499 * LENGTH as f32);
    let mut passages = Vec::new();
    let (mut time, mut before) = (0.0, bed.mean(&lower, |p| p.z));
    while passages.len() <= SWINGS && time < 30.0 {
        bed.step();
        let now = bed.mean(&lower, |p| p.z);
        if before * now < 0.0 {
            passages.push(time + f64::from(bed.dt) * before / (before - now));
        }
        (time, before) = (time + f64::from(bed.dt), now);
    }
    let (first, last) = (passages.first().unwrap_or(&0.0), passages.last().unwrap_or(&0.0));
    2.0 * (last - first) / (passages.len() as f64 - 1.0)
}
