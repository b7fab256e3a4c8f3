//! A step doesn't allocate.

use bevy_drape::{
    build,
    prelude::{ClothGrip, Fabric},
    solver::Method,
};

use crate::{bench_bed::Bed, grabs::hand};

#[test]
fn a_step_allocates_nothing_once_it_has_run() {
    for method in [Method::Xpbd, Method::Explicit] {
        let mut bed = Bed { method, ..Bed::lying(24, Fabric::default().material().unwrap()).pinned([0, 23]) };
        bed.tethers = build::tethers(&bed.topology, &[0, 23]);
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
