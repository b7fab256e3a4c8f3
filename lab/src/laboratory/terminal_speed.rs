//! A sheet that falls flat is as fast as its weight and the air's drag agree on.

use bevy_drape::prelude::{ClothGrid, Fabric};

use super::{
    Extent,
    bed::{Bed, GRAVITY},
    record::{Case, Measurement, Outcome},
};

/// Of air at 15 °C, kg/m³.
const AIR: f32 = 1.225;

/// Half of density · v² · drag holds the density of the cloth times g.
pub fn run(_: Extent) -> Outcome {
    let fabrics = [("silk", Fabric::SILK), ("cotton_woven", Fabric::COTTON_WOVEN), ("leather", Fabric::LEATHER)];
    let measurements = fabrics.map(|(name, fabric)| {
        let case = Case { fabric: name, mesh: "grid", n: 8, substeps: Some(8), ..Case::default() };
        // Lift would make a sheet glide that is tilted by the slightest.
        let fabric = Fabric { damping: 0.0, lift: 0.0, ..fabric };
        let expected = (2.0 * fabric.density * GRAVITY / (AIR * fabric.drag)).sqrt();
        let material = fabric.material().expect("a preset");
        let mut bed = Bed::new(ClothGrid::new(0.5, 0.5, 9, 9).lying(), material).solved_as_in(&case);
        bed.fluid_density = AIR;
        bed.run(4.0);
        let speed = -bed.particles.velocity.iter().map(|v| f64::from(v.y)).sum::<f64>() / bed.particles.len() as f64;
        Measurement::new("terminal-speed", "speed, m/s", case, speed, expected.into()).within(0.02)
    });
    Outcome { measurements: measurements.into(), ..Outcome::default() }
}
