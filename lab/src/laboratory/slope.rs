//! A cloth on a slope begins to slide where the slope's tangent is its friction.

use bevy::{
    math::{Dir3, Isometry3d, primitives::InfinitePlane3d},
    prelude::*,
};
use bevy_drape::{
    prelude::{ClothGrid, Fabric},
    solver::{Method, Obstacle, Solid},
};

use super::{
    Extent,
    bed::{Bed, bare},
    record::{Case, Measurement, Outcome},
    roots,
};

/// Degrees that the angle may be off.
const TOLERANCE: f64 = 2.0;

/// A cloth that has come so far (m) slides.
const SLID: f32 = 0.01;

pub fn run(_: Extent) -> Outcome {
    let frictions = [("silk", Fabric::SILK), ("cotton_woven", Fabric::COTTON_WOVEN), ("rubber", Fabric::RUBBER)];
    let cases = frictions.into_iter().flat_map(|fabric| [(fabric.clone(), Method::Strands), (fabric, Method::Xpbd)]);
    let measurements = cases.map(|((name, fabric), method)| {
        let case = Case { fabric: name, mesh: "grid", n: 8, substeps: Some(8), method, ..Case::default() };
        let expected = f64::from(fabric.friction).atan().to_degrees();
        let slides = |angle: f64| if slides(&case, &fabric, angle as f32) { 1.0 } else { -1.0 };
        let measured = roots::bisect(10, expected - 10.0, expected + 10.0, slides);
        let within = TOLERANCE / expected;
        Measurement::new("slope", "angle at which it slides, °", case, measured, expected).within(within)
    });
    Outcome { measurements: measurements.collect(), ..Outcome::default() }
}

/// Whether a cloth that is laid on a slope of so many degrees goes down within two seconds.
fn slides(case: &Case, fabric: &Fabric, angle: f32) -> bool {
    let turn = Quat::from_rotation_z(-angle.to_radians());
    let mut bed = Bed::new(ClothGrid::new(0.5, 0.5, 9, 9).lying(), bare(fabric.clone())).solved_as_in(case);
    for position in &mut bed.particles.position {
        *position = turn * *position;
    }
    let shape = Solid::HalfSpace(InfinitePlane3d { normal: Dir3::new_unchecked(turn * Vec3::Y) });
    bed.obstacles = vec![Obstacle::still(shape, Isometry3d::IDENTITY)];
    bed.run(2.0);
    bed.centre().length() > SLID
}
