//! Settings out of their range: refused at first, and ignored while the cloth runs.

use bevy::prelude::*;
use bevy_drape::{prelude::*, solver::LevelPass};

use crate::common::*;

const GRID: ClothGrid = ClothGrid { size: Vec2::ONE, particles: UVec2::new(4, 4), lying: false };
const NOT_FINITE: [f32; 3] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];

type Field<C> = (&'static str, fn(&mut C, f32));

const FABRIC: [Field<Fabric>; 15] = [
    ("Fabric::density", |fabric, value| fabric.density = value),
    ("Fabric::thickness", |fabric, value| fabric.thickness = value),
    ("Fabric::warp_stiffness", |fabric, value| fabric.warp_stiffness = value),
    ("Fabric::weft_stiffness", |fabric, value| fabric.weft_stiffness = value),
    ("Fabric::warp_stiffening", |fabric, value| fabric.warp_stiffening = value),
    ("Fabric::weft_stiffening", |fabric, value| fabric.weft_stiffening = value),
    ("Fabric::compression", |fabric, value| fabric.compression = value),
    ("Fabric::shear_stiffness", |fabric, value| fabric.shear_stiffness = value),
    ("Fabric::bending_rigidity", |fabric, value| fabric.bending_rigidity = value),
    ("Fabric::stretch_damping", |fabric, value| fabric.stretch_damping = value),
    ("Fabric::bend_damping", |fabric, value| fabric.bend_damping = value),
    ("Fabric::damping", |fabric, value| fabric.damping = value),
    ("Fabric::friction", |fabric, value| fabric.friction = value),
    ("Fabric::drag", |fabric, value| fabric.drag = value),
    ("Fabric::lift", |fabric, value| fabric.lift = value),
];

const SPRINGS: [Field<ClothSprings>; 6] = [
    ("ClothSprings::structural_stiffness", |springs, value| springs.structural_stiffness = value),
    ("ClothSprings::shear_stiffness", |springs, value| springs.shear_stiffness = value),
    ("ClothSprings::bend_stiffness", |springs, value| springs.bend_stiffness = value),
    ("ClothSprings::structural_damping", |springs, value| springs.structural_damping = value),
    ("ClothSprings::shear_damping", |springs, value| springs.shear_damping = value),
    ("ClothSprings::bend_damping", |springs, value| springs.bend_damping = value),
];

const CLOTH: [Field<Cloth>; 12] = [
    ("Cloth::max_strain", |cloth, value| cloth.max_strain = value),
    ("Cloth::substeps", |cloth, value| cloth.substeps = Some(value as u32)),
    ("Cloth::max_substeps", |cloth, value| cloth.max_substeps = value as u32),
    ("Cloth::max_work", |cloth, value| cloth.max_work = Some(value as u32)),
    ("Cloth::gravity_scale", |cloth, value| cloth.gravity_scale = value),
    ("Cloth::max_velocity", |cloth, value| cloth.max_velocity = value),
    ("Cloth::tether_slack", |cloth, value| cloth.tether_slack = Some(value)),
    ("Cloth::fluid_density", |cloth, value| cloth.fluid_density = value),
    ("Cloth::collision_margin", |cloth, value| cloth.collision_margin = value),
    ("Cloth::max_depenetration_velocity", |cloth, value| cloth.max_depenetration_velocity = value),
    ("Cloth::self_distance", |cloth, value| cloth.self_distance = value),
    ("Cloth::self_friction", |cloth, value| cloth.self_friction = value),
];

/// The component with one field of it changed.
fn with<C: Default>(set: fn(&mut C, f32), value: f32) -> C {
    let mut component = C::default();
    set(&mut component, value);
    component
}

/// A fabric with one field changed, whose shear fits whatever warp and weft.
fn fabric_with(set: fn(&mut Fabric, f32), value: f32) -> Fabric {
    let mut fabric = Fabric { shear_stiffness: 0.0, ..default() };
    set(&mut fabric, value);
    fabric
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
        let mut refused = |value| refused_for(&mut app, fabric_with(set, value));
        for bad in NOT_FINITE.into_iter().chain([-1.0]) {
            assert_eq!(refused(bad).as_deref(), Some(name), "{name} of {bad}");
        }
        let field = name.trim_start_matches("Fabric::");
        let may_be_zero = !["density", "thickness", "warp_stiffness", "weft_stiffness"].contains(&field);
        assert_eq!(refused(0.0).as_deref(), (!may_be_zero).then_some(name), "{name} of 0");
        assert_eq!(refused(1.0), None, "{name} of 1");
        let is_share = field == "compression";
        assert_eq!(refused(1.01).as_deref(), is_share.then_some(name), "{name} of 1.01");
    }
}

#[test]
fn plain_springs_are_checked_field_by_field() {
    let mut app = headless();
    for (name, set) in SPRINGS {
        let mut refused = |value| refused_for(&mut app, with(set, value));
        for bad in NOT_FINITE.into_iter().chain([-1.0]) {
            assert_eq!(refused(bad).as_deref(), Some(name), "{name} of {bad}");
        }
        for good in [0.0, 1.0] {
            assert_eq!(refused(good), None, "{name} of {good}");
        }
    }
}

#[test]
fn what_springs_take_the_place_of_is_not_checked() {
    let mut app = headless();
    let fabric = Fabric { warp_stiffness: f32::NAN, bending_rigidity: -1.0, compression: 7.0, ..default() };
    assert_eq!(refused_for(&mut app, fabric.clone()).as_deref(), Some("Fabric::warp_stiffness"));
    assert_eq!(refused_for(&mut app, (fabric.clone(), ClothSprings::default())), None);
    let fabric = Fabric { thickness: 0.0, ..fabric };
    let springs = ClothSprings { shear_damping: -1.0, ..default() };
    assert_eq!(refused_for(&mut app, (fabric, springs)).as_deref(), Some("Fabric::thickness"));
}

#[test]
fn cloths_are_checked_field_by_field() {
    let mut app = headless();
    for (name, set) in CLOTH {
        let mut refused = |value| refused_for(&mut app, with(set, value));
        let is_count = name.ends_with("substeps") || name.ends_with("max_work");
        if is_count {
            assert_eq!(refused(0.0).as_deref(), Some(name));
        } else {
            for bad in NOT_FINITE {
                assert_eq!(refused(bad).as_deref(), Some(name), "{name} of {bad}");
            }
            let may_be_negative = name == "Cloth::gravity_scale";
            assert_eq!(refused(-1.0).as_deref(), (!may_be_negative).then_some(name), "{name} of -1");
            let must_be_positive = ["max_strain", "max_velocity", "max_depenetration_velocity", "self_distance"]
                .map(|field| format!("Cloth::{field}"));
            let may_be_zero = !must_be_positive.contains(&name.to_string());
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
fn the_message_names_the_field_and_the_rule() {
    for (fabric, expected) in [
        (Fabric { thickness: 0.0, ..default() }, "Fabric::thickness is 0, and it has to be greater than 0 m; set"),
        (
            Fabric { weft_stiffness: 0.0, ..default() },
            "Fabric::weft_stiffness is 0, and it has to be greater than 0 N/m;",
        ),
        (
            Fabric { bending_rigidity: -0.5, ..default() },
            "Fabric::bending_rigidity is -0.5, and it has to be 0 N·m or greater;",
        ),
        (Fabric { compression: 1.5, ..default() }, "Fabric::compression is 1.5, and it has to be 0 to 1;"),
        (
            Fabric { warp_stiffness: 300.0, weft_stiffness: 100.0, shear_stiffness: 151.0, ..default() },
            "Fabric::shear_stiffness is 151, and it has to be at most 150 N/m, the product of warp and weft stiffness over \
             their difference",
        ),
    ] {
        let message = fabric.material().unwrap_err().to_string();
        assert!(message.starts_with(expected), "{message}");
    }
    let fitting = Fabric { warp_stiffness: 300.0, weft_stiffness: 100.0, shear_stiffness: 149.0, ..default() };
    assert!(fitting.material().is_ok());
    assert!(Fabric { shear_stiffness: 1e6, ..default() }.material().is_ok(), "warp and weft are alike");
}

#[test]
fn extreme_values_stay_finite() {
    let mut app = headless();
    for (name, set) in FABRIC {
        let is_share = name == "Fabric::compression";
        for value in [1e-30, 1e10, 1e30].into_iter().filter(|&value| !is_share || value <= 1.0) {
            let fabric = fabric_with(set, value);
            assert_eq!(refused_for(&mut app, (fabric, Pins::corners())), None, "{name} of {value}");
        }
    }
    for (name, set) in SPRINGS {
        for value in [1e-30, 1e10, 1e30] {
            let springs = with(set, value);
            assert_eq!(refused_for(&mut app, (springs, Pins::corners())), None, "{name} of {value}");
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
    let breaks: [fn(&mut App, Entity); 6] = [
        |app, cloth| get_mut::<Fabric>(app, cloth).density = 0.0,
        |app, cloth| get_mut::<Fabric>(app, cloth).bending_rigidity = f32::NAN,
        |app, cloth| {
            let springs = ClothSprings { bend_stiffness: -1.0, ..default() };
            app.world_mut().entity_mut(cloth).insert(springs);
        },
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
