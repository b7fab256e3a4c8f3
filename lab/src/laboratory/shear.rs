//! A square in a shear frame.
//!
//! Forces along its four sides, all towards the same two corners, are what the bars of a hinged frame do to a cloth. Each
//! particle of a side also has the mass that Earth pulls so hard at.

use bevy::math::{DMat2, DVec2, Vec3A};
use bevy_drape::prelude::Fabric;

use super::{
    BRIEF, BRIEF_OF_TRIANGLES, EFFORTS, Extent,
    bed::{self, Bed, GRAVITY, bare},
    mesh::{Kind, Strip},
    record::{Case, Measurement, Outcome},
};

const TOLERANCE: f64 = 0.10;

/// What the square is to be sheared by, rad: 1°.
const ANGLE: f64 = core::f64::consts::PI / 180.0;

pub fn run(extent: Extent) -> Outcome {
    let fabrics = ["cotton_woven", "denim", "cotton_jersey", "silk", "leather"];
    let fabrics = if extent == Extent::Brief { &fabrics[..3] } else { &fabrics };
    let mut measurements = Vec::new();
    for (name, fabric) in bed::presets().filter(|(name, _)| fabrics.contains(name)) {
        for kind in [Kind::Grid, Kind::Delaunay] {
            let efforts = match (extent, kind) {
                (Extent::Full, _) => &EFFORTS[..],
                (Extent::Brief, Kind::Delaunay) => &BRIEF_OF_TRIANGLES,
                (Extent::Brief, _) => &BRIEF,
            };
            for &(method, substeps) in efforts {
                let case = Case { fabric: name, mesh: kind.name(), n: 12, substeps, method, ..Case::default() };
                measurements.push(shear(kind, &fabric, case));
            }
        }
    }
    Outcome { measurements, ..Outcome::default() }
}

fn shear(kind: Kind, fabric: &Fabric, case: Case) -> Measurement {
    let square = Strip { kind, cells: case.n, cell: 0.01, cells_across: case.n, direction: "warp" };
    let modulus = f64::from(fabric.shear_stiffness);
    let traction = modulus * ANGLE;
    let mut bed = Bed::new(square.mesh(), bare(fabric.clone())).solved_as_in(&case);
    bed.gravity = Vec3A::ZERO;
    let (side, close) = (square.length(), 0.01 * square.cell);
    // -1 and 1 at a side, 0 between.
    let of_side = |at: f64| f64::from(u8::from(at > side - close)) - f64::from(u8::from(at < close));
    for particle in 0..bed.particles.len() {
        let rest = bed.topology.rest[particle];
        let [x, z] = [rest.x, rest.z].map(|at| of_side(at.into()));
        let share = if x != 0.0 && z != 0.0 { 0.5 } else { 1.0 };
        let force = Vec3A::new(z as f32, 0.0, x as f32) * (share * traction * square.cell) as f32;
        bed.particles.force[particle] = force;
        bed.particles.inverse_mass[particle] = (bed.mass(particle) as f32 + force.length() / GRAVITY).recip();
    }
    let rate = (f64::from(GRAVITY) / (side * ANGLE)).sqrt();
    let rest = bed.settle(2.0 * rate as f32, 10.0);
    let measured = traction / angle(&bed);
    Measurement::new("shear", "shear modulus, N/m", case, measured, modulus).within(TOLERANCE).after(rest)
}

/// By how much less than a right angle warp and weft enclose, in the affine map that fits all particles best, rad.
fn angle(bed: &Bed) -> f64 {
    let flat = |p: Vec3A| DVec2::new(p.x.into(), p.z.into());
    let pairs =
        || bed.particles.position.iter().map(|p| flat(*p)).zip(bed.topology.rest.iter().map(|p| flat((*p).into())));
    let count = bed.particles.len() as f64;
    let [centre, rest_centre] =
        [pairs().map(|(p, _)| p).sum::<DVec2>() / count, pairs().map(|(_, r)| r).sum::<DVec2>() / count];
    let outer = |p: DVec2, q: DVec2| DMat2::from_cols(p * q.x, p * q.y);
    let mixed = pairs().fold(DMat2::ZERO, |sum, (p, r)| sum + outer(p - centre, r - rest_centre));
    let own = pairs().fold(DMat2::ZERO, |sum, (_, r)| sum + outer(r - rest_centre, r - rest_centre));
    let map = mixed * own.inverse();
    core::f64::consts::FRAC_PI_2 - map.x_axis.angle_to(map.y_axis).abs()
}
