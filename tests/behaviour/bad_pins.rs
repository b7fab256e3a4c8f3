//! Pins that can't be chosen are refused with the reason.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

const GRID: ClothGrid = ClothGrid { size: Vec2::ONE, particles: UVec2::new(4, 4), lying: false };

#[test]
fn pins_that_cannot_be_chosen_are_refused() {
    let refused = |pins: Pins, mesh: Mesh| {
        let mut app = headless();
        let cloth = spawn_cloth(&mut app, mesh, pins);
        run(&mut app, 2);
        match get::<ClothStatus>(&app, cloth) {
            ClothStatus::Failed(error) => error.clone(),
            status => panic!("{status:?}"),
        }
    };
    assert_eq!(refused(Pins::indices([3, 16]), GRID.into()), ClothError::PinOutOfRange { vertex: 16, count: 16 });
    let lacking = |attribute: &str| ClothError::PinsNeedAttribute { attribute: attribute.into() };
    assert_eq!(refused(Pins::vertex_color(LinearRgba::RED), GRID.into()), lacking("vertex colours"));
    let pin = Pins::attribute(ATTRIBUTE_PIN);
    assert_eq!(refused(pin, GRID.into()), lacking("the attribute \"Pin\" of format Float32"));
    let mut no_uvs: Mesh = GRID.into();
    no_uvs.remove_attribute(Mesh::ATTRIBUTE_UV_0);
    assert_eq!(refused(Pins::edge(ClothEdge::Top), no_uvs), lacking("UV coordinates"));

    let nothing = [
        Pins::region(Vec3::splat(5.0), Vec3::splat(6.0)),
        Pins::predicate(|_| false),
        PinSelector::Predicate(PinPredicate::default()).into(),
    ];
    for pins in nothing {
        let error = refused(pins, GRID.into());
        assert!(matches!(error, ClothError::NothingPinned { .. }), "{error:?}");
    }
    assert!(matches!(refused(Pins::corners(), Sphere::new(1.0).into()), ClothError::NothingPinned { .. }));
}

#[test]
fn no_indices_are_no_pins() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, GRID, Pins::indices([]));
    run(&mut app, 1);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready);
}

#[test]
fn pins_that_a_command_cannot_add_do_not_stand_in_the_way_of_others() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 4, 4), Pins::edge(ClothEdge::Top));
    run(&mut app, 2);
    command(&mut app, cloth, |cloth| cloth.pin_cloth(Pins::indices([99])));
    command(&mut app, cloth, |cloth| cloth.pin_cloth(Pins::indices([12])));
    command(&mut app, cloth, |cloth| cloth.unpin_cloth(Pins::indices([0])));
    run(&mut app, 2);
    assert_eq!(pinned(&app, cloth), [1, 2, 3, 12]);
    command(&mut app, cloth, |cloth| cloth.reset_cloth());
    run(&mut app, 2);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready);
    assert_eq!(pinned(&app, cloth), [1, 2, 3, 12]);
}

#[test]
fn pins_that_come_and_go_do_not_pile_up() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 4, 4), Pins::edge(ClothEdge::Top));
    for _ in 0..20 {
        command(&mut app, cloth, |cloth| cloth.pin_cloth(Pins::indices([12])));
        command(&mut app, cloth, |cloth| cloth.unpin_cloth(Pins::indices([12])));
    }
    assert_eq!(get::<Pins>(&app, cloth).groups.len(), 2);
}
