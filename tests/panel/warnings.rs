//! The panel warns of settings that can't be solved well, and only of those.

use bevy::prelude::*;
use bevy_drape::prelude::*;
use egui_kittest::kittest::NodeT;

use crate::common::*;

/// A sheet of 24 x 24 particles with plain springs.
fn hang(app: &mut App, cloth: Cloth, pins: Pins, stiffness: f32) -> Entity {
    let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(Mesh::from(ClothGrid::new(1.2, 1.2, 24, 24)));
    let fabric = Fabric { density: 0.2, ..default() };
    let springs = ClothSprings { structural_stiffness: stiffness, shear_stiffness: stiffness / 10.0, ..default() };
    app.world_mut().spawn((Mesh3d(mesh), cloth, fabric, springs, pins, Name::new("Sheet"))).id()
}

fn untethered(solver: ClothSolver, substeps: u32) -> Cloth {
    Cloth { solver, substeps: Some(substeps), tether_slack: None, ..default() }
}

/// What the panel warns of once a sheet has hung for a while.
fn warning(cloth: Cloth, pins: Pins, stiffness: f32) -> Option<String> {
    let mut app = app();
    hang(&mut app, cloth, pins, stiffness);
    let mut desk = Desk::new(app);
    desk.frames(210);
    shown(&desk)
}

/// The advice in full.
fn shown(desk: &Desk) -> Option<String> {
    let texts = desk.harness.root().children_recursive().filter_map(|node| node.accesskit_node().value());
    texts.filter(|text| text.contains('⚠')).max_by_key(String::len)
}

const XPBD: ClothSolver = ClothSolver::Xpbd;
const STRANDS: ClothSolver = ClothSolver::Strands;

#[test]
fn too_few_substeps_are_told() {
    let text = warning(untethered(XPBD, 2), Pins::edge(ClothEdge::Top), 5000.0).expect("a warning");
    assert!(text.contains("2 substeps are too few for 5000 N/m") && text.contains("tethers"), "{text}");
    assert!(warning(untethered(XPBD, 4), Pins::edge_corners(ClothEdge::Top), 1e6).is_some());
}

#[test]
fn too_few_substeps_of_strands_without_levels_are_told_too() {
    let cloth = Cloth { levels: Some(Vec::new()), ..untethered(STRANDS, 1) };
    let text = warning(cloth, Pins::edge_corners(ClothEdge::Top), 5000.0).expect("a warning");
    assert!(text.contains("1 substep is too few for 5000 N/m") && text.contains("tethers"), "{text}");
}

#[test]
fn of_a_fabric_it_is_told_by_what_is_in_force_there() {
    let mut app = app();
    let cloth = hang(&mut app, untethered(XPBD, 2), Pins::edge(ClothEdge::Top), 5000.0);
    app.world_mut().entity_mut(cloth).remove::<ClothSprings>();
    let mut desk = Desk::new(app);
    desk.frames(210);
    let text = shown(&desk).expect("a warning");
    assert!(text.contains("2 substeps are too few for 4000 N/m") && text.contains("lower warp and weft"), "{text}");
}

#[test]
fn what_is_solved_well_is_left_in_peace() {
    assert_eq!(warning(Cloth::default(), Pins::edge_corners(ClothEdge::Top), 5000.0), None, "the default holds it");
    for solver in [XPBD, STRANDS] {
        let tethered = Cloth { solver, ..default() };
        assert_eq!(warning(untethered(solver, 32), Pins::edge(ClothEdge::Top), 5000.0), None);
        assert_eq!(warning(tethered, Pins::edge(ClothEdge::Top), 5000.0), None, "tethers hold it");
        let soft = untethered(solver, 64);
        assert_eq!(warning(soft, Pins::edge_corners(ClothEdge::Top), 150.0), None, "it is soft");
    }
}

#[test]
fn a_cloth_whose_pins_are_pulled_apart_is_left_in_peace() {
    let mut app = app();
    let [left, right] = [-0.6, 0.6].map(|x| app.world_mut().spawn(Transform::from_xyz(x, 0.6, 0.0)).id());
    let pins = Pins::indices([0]).to_entity(left).and(Pins::indices([23]).to_entity(right));
    hang(&mut app, untethered(XPBD, 8), pins, 5000.0);
    app.update();
    app.update();
    app.world_mut().get_mut::<Transform>(right).expect("a transform").translation.x = 0.9;
    let mut desk = Desk::new(app);
    desk.frames(210);
    assert_eq!(shown(&desk), None);
}

#[test]
fn the_explicit_solver_asks_for_the_substeps_that_it_needs() {
    let mut app = app();
    let settings = Cloth { solver: ClothSolver::Explicit, max_substeps: 20, ..default() };
    let cloth = hang(&mut app, settings, Pins::edge(ClothEdge::Top), 5000.0);
    let mut desk = Desk::new(app);
    desk.frames(3);
    let text = shown(&desk).expect("a warning");
    assert!(text.contains("20 substeps carry only"), "{text}");
    let asked = text.split("most substeps to ").nth(1).and_then(|rest| rest.split(',').next()).expect("a number");
    let asked: u32 = asked.parse().expect("a number");
    desk.get_mut::<Cloth>(cloth).max_substeps = asked;
    desk.frames(3);
    assert_eq!(shown(&desk), None, "what it asks for is enough");
    desk.get_mut::<Cloth>(cloth).max_substeps = asked - 1;
    desk.frames(3);
    assert!(shown(&desk).is_some(), "and no less is");
}
