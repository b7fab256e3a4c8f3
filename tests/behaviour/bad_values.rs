//! Settings out of their range: refused at first, and ignored while the cloth runs.

use bevy::prelude::*;
use bevy_drape::{prelude::*, solver::LevelPass};

use crate::common::*;

const GRID: ClothGrid = ClothGrid { size: Vec2::ONE, particles: UVec2::new(4, 4), lying: false };
const NOT_FINITE: [f32; 3] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];

type Field<C> = (&'static str, fn(&mut C, f32));

const FABRIC: [Field<Fabric>; 12] = [
    ("Fabric::density", |fabric, value| fabric.density = value),
    ("Fabric::structural_stiffness", |fabric, value| fabric.structural_stiffness = value),
    ("Fabric::shear_stiffness", |fabric, value| fabric.shear_stiffness = value),
    ("Fabric::bend_stiffness", |fabric, value| fabric.bend_stiffness = value),
    ("Fabric::structural_damping", |fabric, value| fabric.structural_damping = value),
    ("Fabric::shear_damping", |fabric, value| fabric.shear_damping = value),
    ("Fabric::bend_damping", |fabric, value| fabric.bend_damping = value),
    ("Fabric::damping", |fabric, value| fabric.damping = value),
    ("Fabric::thickness", |fabric, value| fabric.thickness = value),
    ("Fabric::friction", |fabric, value| fabric.friction = value),
    ("Fabric::drag", |fabric, value| fabric.drag = value),
    ("Fabric::lift", |fabric, value| fabric.lift = value),
];

const CLOTH: [Field<Cloth>; 7] = [
    ("Cloth::max_strain", |cloth, value| cloth.max_strain = value),
    ("Cloth::substeps", |cloth, value| cloth.substeps = Some(value as u32)),
    ("Cloth::max_substeps", |cloth, value| cloth.max_substeps = value as u32),
    ("Cloth::gravity_scale", |cloth, value| cloth.gravity_scale = value),
    ("Cloth::max_velocity", |cloth, value| cloth.max_velocity = value),
    ("Cloth::tether_slack", |cloth, value| cloth.tether_slack = Some(value)),
    ("Cloth::fluid_density", |cloth, value| cloth.fluid_density = value),
];

/// The component with one field of it changed.
fn with<C: Default>(set: fn(&mut C, f32), value: f32) -> C {
    let mut component = C::default();
    set(&mut component, value);
    component
}

/// The parameter that a cloth with these components is refused for, if it is.
fn refused_for(app: &mut App, more: impl Bundle) -> Option<String> {
    let cloth = spawn_cloth(app, GRID, more);
    run(app, 3);
    let status = get::<ClothStatus>(app, cloth).clone();
    let is_finite = positions(app, cloth).into_iter().all(Vec3::is_finite);
    app.world_mut().despawn(cloth);
    match status {
        ClothStatus::Failed(ClothError::InvalidParameter { name, .. }) => Some(name),
        ClothStatus::Ready if is_finite => None,
        other => panic!("{other:?}"),
    }
}

#[test]
fn fabrics_are_checked_field_by_field() {
    let mut app = headless();
    for (name, set) in FABRIC {
        let mut refused = |value| refused_for(&mut app, with(set, value));
        for bad in NOT_FINITE.into_iter().chain([-1.0]) {
            assert_eq!(refused(bad).as_deref(), Some(name), "{name} of {bad}");
        }
        let is_density = name == "Fabric::density";
        assert_eq!(refused(0.0).as_deref(), is_density.then_some(name), "{name} of 0");
        assert_eq!(refused(1.0), None, "{name} of 1");
    }
}

#[test]
fn cloths_are_checked_field_by_field() {
    let mut app = headless();
    for (name, set) in CLOTH {
        let mut refused = |value| refused_for(&mut app, with(set, value));
        let is_count = name.ends_with("substeps");
        if is_count {
            assert_eq!(refused(0.0).as_deref(), Some(name));
        } else {
            for bad in NOT_FINITE {
                assert_eq!(refused(bad).as_deref(), Some(name), "{name} of {bad}");
            }
            let may_be_negative = name == "Cloth::gravity_scale";
            assert_eq!(refused(-1.0).as_deref(), (!may_be_negative).then_some(name), "{name} of -1");
            let may_be_zero = !["Cloth::max_strain", "Cloth::max_velocity"].contains(&name);
            assert_eq!(refused(0.0).as_deref(), (!may_be_zero).then_some(name), "{name} of 0");
        }
        assert_eq!(refused(1.0), None, "{name} of 1");
    }
}

#[test]
fn levels_are_checked_and_what_the_mesh_has_not_is_left_out() {
    let mut app = headless();
    let level = |stride, iterations| Cloth { levels: Some(vec![LevelPass { stride, iterations }]), ..default() };
    assert_eq!(refused_for(&mut app, level(4, 1001)).as_deref(), Some("Cloth::levels"));
    for cloth in [level(4, 0), level(4, 1000), level(0, 8), level(7, 8), level(u32::MAX, 8)] {
        assert_eq!(refused_for(&mut app, cloth.clone()), None, "{:?}", cloth.levels);
    }
    assert_eq!(refused_for(&mut app, Cloth { levels: Some(Vec::new()), ..default() }), None);
}

#[test]
fn the_error_carries_the_value_and_the_rule() {
    let error = Fabric { density: 0.0, ..default() }.material().unwrap_err();
    let rule = "greater than 0 kg/m²".into();
    assert_eq!(error, ClothError::InvalidParameter { name: "Fabric::density".into(), value: 0.0, rule });
}

#[test]
fn extreme_values_stay_finite() {
    let mut app = headless();
    for (name, set) in FABRIC {
        for value in [1e-30, 1e10, 1e30] {
            let mut fabric = Fabric::default();
            set(&mut fabric, value);
            assert_eq!(refused_for(&mut app, (fabric, Pins::corners())), None, "{name} of {value}");
        }
    }
    for solver in [ClothSolver::Strands, ClothSolver::Xpbd] {
        for gravity_scale in [1e10, -1e30, f32::MAX] {
            let cloth = Cloth { solver, gravity_scale, ..default() };
            assert_eq!(refused_for(&mut app, cloth), None, "gravity scale of {gravity_scale}");
        }
        for value in [1e-30, 1e30, f32::MAX] {
            let cloth = Cloth { solver, max_strain: value, max_velocity: value, ..default() };
            assert_eq!(refused_for(&mut app, (cloth, Pins::corners())), None, "strain and speed of {value}");
        }
    }
}

#[test]
fn a_value_that_turns_bad_is_ignored_and_the_cloth_goes_on() {
    let good = || {
        let mut app = headless();
        let cloth = spawn_cloth(&mut app, GRID, Pins::corners());
        run(&mut app, 10);
        (app, cloth)
    };
    let (mut app, cloth) = good();
    run(&mut app, 20);
    let expected = positions(&app, cloth);
    let breaks: [fn(&mut App, Entity); 5] = [
        |app, cloth| get_mut::<Fabric>(app, cloth).density = 0.0,
        |app, cloth| get_mut::<Fabric>(app, cloth).structural_stiffness = f32::NAN,
        |app, cloth| get_mut::<Cloth>(app, cloth).substeps = Some(0),
        |app, cloth| get_mut::<Cloth>(app, cloth).gravity_scale = f32::INFINITY,
        |app, cloth| *get_mut::<Pins>(app, cloth) = Pins::indices([99]),
    ];
    for break_it in breaks {
        let (mut app, cloth) = good();
        break_it(&mut app, cloth);
        run(&mut app, 20);
        assert_eq!(positions(&app, cloth), expected);
        assert_eq!(*app.world().resource::<Heard>(), Heard { ready: vec![cloth], ..default() });
    }
}

#[test]
fn a_good_value_acts_at_once() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, undamped());
    run(&mut app, 30);
    get_mut::<Cloth>(&mut app, cloth).gravity_scale = 0.0;
    run(&mut app, 1);
    let velocity = state(&app, cloth).velocity(5).unwrap();
    run(&mut app, 30);
    assert_close(state(&app, cloth).velocity(5).unwrap(), velocity, 1e-2);

    get_mut::<Fabric>(&mut app, cloth).damping = 50.0;
    run(&mut app, 30);
    assert!(state(&app, cloth).velocity(5).unwrap().length() < 1e-3);
}
