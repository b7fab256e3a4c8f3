//! Clothes are tuned by what they have beside them: skin, inertia and teleport.

use bevy::prelude::*;
use bevy_drape::{
    panel::{ClothChoice, ClothPanel},
    prelude::*,
};
use bevy_egui::egui::accesskit::Role;

use crate::common::*;

const BACKSTOP: ClothSkin = ClothSkin {
    max_distance: ClothMap::Painted { scale: 1.0, missing: f32::INFINITY },
    backstop: Some(0.01),
    backstop_radius: 0.1,
    pull: 0.0,
    pull_damping: 1.0,
    meets_others: false,
};

/// A knob of each section.
const KNOBS: [&str; 3] = ["Pull", "Linear", "Distance"];

fn shown(desk: &Desk) -> Vec<&'static str> {
    KNOBS.into_iter().filter(|name| desk.controls(Role::Slider, name).next().is_some()).collect()
}

/// A desk with one cloth that has all of it, or this skin.
fn desk(skin: ClothSkin) -> (Desk, Entity) {
    let mut app = app();
    let cloth = spawn_cloth(&mut app, "Cape", (skin, ClothInertia::default(), ClothTeleport::default()));
    (Desk::new(app), cloth)
}

#[test]
fn only_what_a_cloth_has_is_shown() {
    let mut app = app();
    let cape = spawn_cloth(&mut app, "Cape", (ClothSkin::default(), ClothInertia::default(), ClothTeleport::default()));
    spawn_cloth(&mut app, "Flag", ());
    let mut desk = Desk::new(app);
    assert_eq!(shown(&desk), KNOBS);
    for removed in 1..=3 {
        let mut cloth = desk.app().world_mut().entity_mut(cape);
        match removed {
            1 => drop(cloth.remove::<ClothSkin>()),
            2 => drop(cloth.remove::<ClothInertia>()),
            _ => drop(cloth.remove::<ClothTeleport>()),
        }
        desk.frames(2);
        assert_eq!(shown(&desk), KNOBS[removed..]);
    }
    desk.choose(Role::ComboBox, "Cloth", "Flag");
    assert!(shown(&desk).is_empty());
}

#[test]
fn every_value_can_be_typed() {
    let (mut desk, cloth) = desk(BACKSTOP);
    for (name, text) in [
        ("Paint scale", "1.5"),
        ("Backstop depth", "20 mm"),
        ("Backstop radius", "0.3 m"),
        ("Pull", "2 Hz"),
        ("Pull damping", "0.5"),
        ("Linear", "0.4"),
        ("Angular", "0.6"),
        ("Max speed", "5 m/s"),
        ("Max angular speed", "7"),
        ("Distance", "1 m"),
        ("Speed", "30"),
        ("Angle", "2"),
        ("Angular speed", "20 rad/s"),
    ] {
        desk.type_value(name, text);
    }
    desk.click(Role::CheckBox, "Meets others");
    desk.choose(Role::ComboBox, "Mode", "Reset");
    let skin = ClothSkin {
        max_distance: ClothMap::Painted { scale: 1.5, missing: f32::INFINITY },
        backstop: Some(0.02),
        backstop_radius: 0.3,
        pull: 2.0,
        pull_damping: 0.5,
        meets_others: true,
    };
    assert_eq!(desk.get::<ClothSkin>(cloth), &skin);
    let inertia = ClothInertia { linear: 0.4, angular: 0.6, max_speed: 5.0, max_angular_speed: 7.0 };
    assert_eq!(desk.get::<ClothInertia>(cloth), &inertia);
    let mode = TeleportMode::Reset;
    let teleport = ClothTeleport { mode, distance: 1.0, speed: 30.0, angle: 2.0, angular_speed: 20.0 };
    assert_eq!(desk.get::<ClothTeleport>(cloth), &teleport);
    assert_eq!((desk.get::<Cloth>(cloth), desk.get::<Fabric>(cloth)), (&Cloth::default(), &Fabric::default()));
}

#[test]
fn the_largest_distance_is_painted_or_the_same_for_all() {
    let (mut desk, cloth) = desk(ClothSkin::default());
    let map = |desk: &Desk| desk.get::<ClothSkin>(cloth).max_distance;
    desk.click(Role::CheckBox, "Free if unpainted");
    desk.type_value("Without paint", "0.25");
    assert_eq!(map(&desk), ClothMap::Painted { scale: 1.0, missing: 0.25 });
    desk.click(Role::CheckBox, "Free if unpainted");
    assert_eq!(map(&desk), ClothMap::default());
    assert!(desk.controls(Role::Slider, "Without paint").next().is_none());
    desk.choose(Role::ComboBox, "Max distance", "the same for all");
    desk.type_value("Everywhere", "0.4 m");
    assert_eq!(map(&desk), ClothMap::Uniform(0.4));
    assert!(desk.controls(Role::Slider, "Paint scale").next().is_none());
    desk.choose(Role::ComboBox, "Max distance", "as painted");
    assert_eq!(map(&desk), ClothMap::default());
}

#[test]
fn the_backstop_comes_and_goes() {
    let (mut desk, cloth) = desk(ClothSkin::default());
    assert!(desk.controls(Role::Slider, "Backstop radius").next().is_none());
    desk.click(Role::CheckBox, "Backstop");
    let depth = desk.get::<ClothSkin>(cloth).backstop;
    assert!(depth.is_some_and(|depth| depth > 0.0));
    assert!(desk.controls(Role::Slider, "Backstop radius").next().is_some());
    desk.click(Role::CheckBox, "Backstop");
    assert_eq!(desk.get::<ClothSkin>(cloth), &ClothSkin::default());
}

#[test]
fn no_text_makes_a_bad_value_of_clothes() {
    let (mut desk, cloth) = desk(BACKSTOP);
    let valid = |desk: &Desk| {
        desk.get::<ClothSkin>(cloth).validate().is_ok()
            && desk.get::<ClothInertia>(cloth).validate().is_ok()
            && desk.get::<ClothTeleport>(cloth).validate().is_ok()
    };
    let bad = ["-5", "NaN", "inf", "1e30", "-1e30", "1e-30", "", "abc"];
    let skin = ["Paint scale", "Backstop depth", "Backstop radius", "Pull", "Pull damping"];
    let motion = ["Linear", "Angular", "Max speed", "Max angular speed", "Distance", "Speed", "Angle", "Angular speed"];
    for name in skin.into_iter().chain(motion) {
        for text in bad {
            desk.type_value(name, text);
            assert!(valid(&desk), "{name}: {text:?}");
        }
    }
    desk.choose(Role::ComboBox, "Max distance", "the same for all");
    for text in bad {
        desk.type_value("Everywhere", text);
        assert!(valid(&desk), "{text:?}");
    }
}

#[test]
fn nothing_is_written_while_nothing_is_edited() {
    let bad = ClothMap::Uniform(f32::NAN);
    let (mut desk, cloth) = desk(ClothSkin { max_distance: bad, backstop: Some(f32::NAN), ..default() });
    desk.frames(10);
    assert_eq!(desk.heard(), Heard::default());
    assert!(desk.get::<ClothSkin>(cloth).backstop.is_some_and(f32::is_nan));
}

#[test]
fn an_edit_of_all_gives_no_cloth_what_it_hasnt() {
    let mut app = app();
    let cape = spawn_cloth(&mut app, "Cape", (ClothSkin::default(), ClothInertia::default()));
    let skirt = spawn_cloth(&mut app, "Skirt", (BACKSTOP, ClothTeleport::default()));
    let tie = spawn_cloth(&mut app, "Tie", ());
    let mut desk = Desk::new(app);
    desk.app().world_mut().resource_mut::<ClothPanel>().choice = ClothChoice::All;
    desk.frame();
    desk.type_value("Pull", "3");
    desk.type_value("Linear", "0.5");
    assert_eq!(desk.get::<ClothSkin>(cape), &ClothSkin { pull: 3.0, ..default() });
    assert_eq!(desk.get::<ClothSkin>(skirt), &ClothSkin { pull: 3.0, ..BACKSTOP });
    assert_eq!(desk.get::<ClothInertia>(cape).linear, 0.5);
    let world = desk.app().world();
    assert!(!world.entity(skirt).contains::<ClothInertia>());
    assert!(!world.entity(tie).contains::<ClothSkin>() && !world.entity(tie).contains::<ClothInertia>());
}

#[test]
fn clothes_are_copied_as_rust() {
    let (mut desk, _) = desk(BACKSTOP);
    desk.choose(Role::ComboBox, "Max distance", "the same for all");
    desk.type_value("Everywhere", "0.4");
    desk.type_value("Linear", "0.5");
    desk.choose(Role::ComboBox, "Mode", "Off");
    desk.choose(Role::ComboBox, "Timing", "Late");
    let expected = "Cloth { timing: ClothTiming::Late, ..default() },\nFabric::default(),\n\
                    ClothSkin { max_distance: ClothMap::Uniform(0.4), backstop: Some(0.01), ..default() },\n\
                    ClothInertia { linear: 0.5, ..default() },\n\
                    ClothTeleport { mode: TeleportMode::Off, ..default() },\n";
    assert_eq!(desk.copy("Copy as Rust").as_deref(), Some(expected));
    // What was copied, as code.
    let _: (Cloth, ClothSkin, ClothInertia, ClothTeleport) = (
        Cloth { timing: ClothTiming::Late, ..default() },
        ClothSkin { max_distance: ClothMap::Uniform(0.4), backstop: Some(0.01), ..default() },
        ClothInertia { linear: 0.5, ..default() },
        ClothTeleport { mode: TeleportMode::Off, ..default() },
    );
}

#[test]
fn clothes_go_back_to_what_they_were() {
    let (mut desk, cloth) = desk(BACKSTOP);
    let revert = |desk: &mut Desk| desk.choose(Role::Button, "Revert ⏷", "This cloth");
    desk.type_value("Pull", "3");
    desk.type_value("Linear", "0.5");
    desk.choose(Role::ComboBox, "Mode", "Off");
    desk.choose(Role::ComboBox, "Timing", "Late");
    desk.app().world_mut().entity_mut(cloth).remove::<ClothInertia>();
    revert(&mut desk);
    assert_eq!(desk.get::<ClothSkin>(cloth), &BACKSTOP);
    assert_eq!(desk.get::<ClothInertia>(cloth), &ClothInertia::default(), "also what is gone");
    assert_eq!(desk.get::<ClothTeleport>(cloth), &ClothTeleport::default());
    assert_eq!(desk.get::<Cloth>(cloth), &Cloth::default());
    desk.frame();
    desk.heard();
    revert(&mut desk);
    assert_eq!(desk.heard(), Heard::default(), "there is nothing left to revert");
}
