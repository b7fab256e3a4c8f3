//! How far cloth is stretched where the settings say nothing of substeps.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

/// The largest strain of a sheet that has hung by two corners for three seconds.
fn strain(settings: Cloth) -> f32 {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 32, 32), (Pins::edge_corners(ClothEdge::Top), settings));
    run(&mut app, 180);
    state(&app, cloth).strain().largest
}

#[test]
fn a_cloth_is_stretched_by_no_more_than_it_may_be_and_its_tethers_give() {
    for max_strain in [0.01, 0.005] {
        let cloth = Cloth { max_strain, ..default() };
        let most = max_strain + cloth.tether_slack.unwrap();
        let strain = strain(cloth);
        assert!(strain <= most, "{strain} for {max_strain}");
    }
}

#[test]
fn without_tethers_it_is_stretched_by_no_more_than_with_the_solver_before() {
    let [strands, xpbd] = [ClothSolver::Strands, ClothSolver::Xpbd]
        .map(|solver| strain(Cloth { solver, tether_slack: None, ..default() }));
    assert!(strands <= xpbd, "{strands} for {xpbd}");
}
