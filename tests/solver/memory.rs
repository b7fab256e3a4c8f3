//! A step doesn't allocate.

use bevy::prelude::*;
use bevy_drape::prelude::{ClothGrid, ClothGrip, Fabric};

use crate::{
    bench_bed::{ALL, Bed},
    grabs::hand,
    lattices::hexagons,
};

#[test]
fn a_step_allocates_nothing_once_it_has_run() {
    let damped = Fabric { structural_damping: 0.01, shear_damping: 0.01, ..Fabric::default() };
    for (method, fabric) in ALL.into_iter().flat_map(|method| [(method, Fabric::default()), (method, damped.clone())]) {
        let sheets = [Mesh::from(ClothGrid::new(1.0, 1.0, 24, 24).lying()), hexagons(24).scaled_by(Vec3::splat(0.04))];
        for sheet in sheets {
            let bed = Bed::new(sheet, fabric.material().unwrap()).pinned([0, 23]).tethered(&[0, 23]).with_levels();
            let mut bed = Bed { method, ..bed };
            bed.grabs = vec![hand(&bed, 100, [0.2, 0.3, 0.5], ClothGrip::default())];
            bed.step(1.0 / 60.0);
            let info = allocation_counter::measure(|| {
                for _ in 0..10 {
                    bed.step(1.0 / 60.0);
                }
            });
            assert_eq!(info.count_total, 0, "{method:?}: {info:?}");
        }
    }
}
