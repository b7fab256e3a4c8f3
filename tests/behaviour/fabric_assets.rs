//! Fabrics as assets: read from files, followed by cloths, and refused with file, line and field.

use core::any::TypeId;
use std::{path::Path, thread, time::Duration};

use bevy::{
    asset::{
        AssetLoadError, AssetLoadFailedEvent, LoadState, ReflectAsset,
        io::{
            AssetSourceBuilder, AssetSourceId,
            memory::{Dir, MemoryAssetReader},
        },
    },
    ecs::reflect::ReflectComponent,
    mesh::MeshPlugin,
    prelude::*,
    time::TimeUpdateStrategy,
};
use bevy_drape::{prelude::*, solver::Moduli};
use proptest::prelude::*;

use crate::common::*;

const GRID: ClothGrid = ClothGrid { size: Vec2::ONE, particles: UVec2::new(4, 4), lying: false };
const FILE: &str = "fabrics/test.fabric.ron";

/// What the asset server has logged of fabrics.
#[derive(Resource, Default)]
struct Failures(Vec<String>);

/// An app whose only asset is [`FILE`], in memory.
struct Shop {
    app: App,
    files: Dir,
}

impl Shop {
    fn new(text: &str) -> Self {
        let files = Dir::default();
        let root = files.clone();
        let mut app = App::new();
        app.register_asset_source(
            AssetSourceId::Default,
            AssetSourceBuilder::new(move || Box::new(MemoryAssetReader { root: root.clone() })),
        )
        .add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), MeshPlugin, ClothPlugin::default()))
        .init_resource::<Failures>()
        .add_systems(
            PreUpdate,
            |mut failed: MessageReader<AssetLoadFailedEvent<Fabric>>, mut failures: ResMut<Failures>| {
                failures.0.extend(failed.read().map(|event| event.error.to_string()));
            },
        );
        let step = Time::<Fixed>::from_hz(60.0);
        app.insert_resource(TimeUpdateStrategy::ManualDuration(step.timestep())).insert_resource(step);
        app.finish();
        app.cleanup();
        app.update();
        let mut shop = Self { app, files };
        shop.write(text);
        shop
    }

    fn write(&mut self, text: &str) {
        self.files.insert_asset_text(Path::new(FILE), text);
    }

    fn load(&self) -> Handle<Fabric> {
        self.app.world().resource::<AssetServer>().load(FILE)
    }

    /// What Bevy does where it watches a file that has been written.
    fn reload(&mut self, text: &str) {
        self.write(text);
        self.app.world().resource::<AssetServer>().reload(FILE);
    }

    fn failures(&self) -> &[String] {
        &self.app.world().resource::<Failures>().0
    }

    /// A cloth that follows [`FILE`], as soon as it does.
    fn following(fabric: &Fabric) -> (Self, Entity) {
        let mut shop = Self::new(&fabric.to_ron());
        let handle = shop.load();
        let cloth = spawn_cloth(&mut shop.app, GRID, (FabricHandle::new(handle), Pins::corners()));
        wait_for(&mut shop.app, |app| get::<Fabric>(app, cloth) == fabric);
        (shop, cloth)
    }
}

/// Updates until the asset server has done what is waited for.
#[track_caller]
pub fn wait_for(app: &mut App, done: impl Fn(&App) -> bool) {
    for _ in 0..2000 {
        if done(app) {
            return;
        }
        app.update();
        thread::sleep(Duration::from_millis(1));
    }
    panic!("it hasn't come");
}

fn fabrics(app: &mut App) -> Mut<'_, Assets<Fabric>> {
    app.world_mut().resource_mut()
}

/// Another fabric for every number.
fn fabric(density: f32) -> Fabric {
    Fabric { density, ..default() }
}

/// The default's text with one line of it replaced by another.
fn text_with(line: &str, other: &str) -> String {
    let text = Fabric::default().to_ron();
    assert!(text.contains(line));
    text.replacen(line, other, 1)
}

fn refused(text: &str) -> FabricFileError {
    Fabric::from_ron(text).expect_err(text)
}

#[test]
fn a_cloth_takes_the_values_of_a_file() {
    let (shop, cloth) = Shop::following(&fabric(0.7));
    assert_eq!(*get::<ClothStatus>(&shop.app, cloth), ClothStatus::Ready);
    assert_eq!(shop.failures(), [""; 0]);
}

#[test]
fn until_its_asset_is_there_a_cloth_runs_with_what_it_has() {
    let mut app = headless();
    let handle = fabrics(&mut app).reserve_handle();
    let cloth = spawn_cloth(&mut app, GRID, (fabric(0.3), FabricHandle::from(handle.clone())));
    run(&mut app, 10);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready);
    assert_eq!(*get::<Fabric>(&app, cloth), fabric(0.3));
    fabrics(&mut app).insert(&handle, fabric(0.7)).unwrap();
    run(&mut app, 2);
    assert_eq!(*get::<Fabric>(&app, cloth), fabric(0.7));
}

#[test]
fn a_cloth_is_built_with_the_values_of_an_asset_that_is_there() {
    let mut app = headless();
    let handle = fabrics(&mut app).add(fabric(0.7));
    // Refused, had it been used.
    let cloth = spawn_cloth(&mut app, GRID, (fabric(-1.0), FabricHandle::new(handle)));
    app.update();
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready);
    assert_eq!(*get::<Fabric>(&app, cloth), fabric(0.7));
    assert_eq!(app.world().resource::<Heard>().failed, []);
}

#[test]
fn the_handle_may_come_before_the_cloth_or_after() {
    let mut app = headless();
    let handle = fabrics(&mut app).add(fabric(0.7));
    let early = app.world_mut().spawn(FabricHandle::new(handle.clone())).id();
    run(&mut app, 3);
    let mesh = add_mesh(&mut app, GRID);
    app.world_mut().entity_mut(early).insert((Mesh3d(mesh), Cloth::default()));
    let late = spawn_cloth(&mut app, GRID, ());
    run(&mut app, 3);
    assert_eq!(*get::<Fabric>(&app, late), Fabric::default());
    app.world_mut().entity_mut(late).insert(FabricHandle::new(handle));
    app.update();
    for cloth in [early, late] {
        assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready);
        assert_eq!(*get::<Fabric>(&app, cloth), fabric(0.7));
    }
}

#[test]
fn all_cloths_follow_a_changed_asset() {
    let mut app = headless();
    let handle = fabrics(&mut app).add(fabric(0.7));
    let cloths = [0, 1].map(|_| spawn_cloth(&mut app, GRID, FabricHandle::new(handle.clone())));
    let other = spawn_cloth(&mut app, GRID, ());
    run(&mut app, 3);
    fabrics(&mut app).get_mut(&handle).unwrap().density = 0.8;
    run(&mut app, 2);
    for cloth in cloths {
        assert_eq!(*get::<Fabric>(&app, cloth), fabric(0.8));
    }
    assert_eq!(*get::<Fabric>(&app, other), Fabric::default());
}

#[test]
fn a_cloth_follows_a_file_that_is_edited() {
    let (mut shop, cloth) = Shop::following(&fabric(0.7));
    shop.reload(&fabric(0.8).to_ron());
    wait_for(&mut shop.app, |app| *get::<Fabric>(app, cloth) == fabric(0.8));
}

#[test]
fn a_cloth_follows_another_handle() {
    let mut app = headless();
    let [one, other] = [0.7, 0.8].map(|density| fabrics(&mut app).add(fabric(density)));
    let cloth = spawn_cloth(&mut app, GRID, FabricHandle::new(one));
    run(&mut app, 3);
    get_mut::<FabricHandle>(&mut app, cloth).handle = other;
    app.update();
    assert_eq!(*get::<Fabric>(&app, cloth), fabric(0.8));
}

#[test]
fn a_detached_cloth_keeps_its_own_until_it_is_attached_again() {
    let mut app = headless();
    let handle = fabrics(&mut app).add(fabric(0.7));
    let detached = FabricHandle { handle: handle.clone(), detached: true };
    let never = spawn_cloth(&mut app, GRID, (fabric(0.2), detached));
    let later = spawn_cloth(&mut app, GRID, FabricHandle::new(handle.clone()));
    run(&mut app, 3);
    get_mut::<FabricHandle>(&mut app, later).detached = true;
    *get_mut::<Fabric>(&mut app, later) = fabric(0.3);
    fabrics(&mut app).get_mut(&handle).unwrap().density = 0.8;
    run(&mut app, 3);
    assert_eq!(*get::<Fabric>(&app, never), fabric(0.2));
    assert_eq!(*get::<Fabric>(&app, later), fabric(0.3));
    for cloth in [never, later] {
        get_mut::<FabricHandle>(&mut app, cloth).detached = false;
        app.update();
        assert_eq!(*get::<Fabric>(&app, cloth), fabric(0.8));
    }
}

#[test]
fn a_direct_change_holds_until_the_asset_changes() {
    let mut app = headless();
    let handle = fabrics(&mut app).add(fabric(0.7));
    let cloth = spawn_cloth(&mut app, GRID, FabricHandle::new(handle.clone()));
    run(&mut app, 3);
    *get_mut::<Fabric>(&mut app, cloth) = fabric(0.3);
    run(&mut app, 3);
    assert_eq!(*get::<Fabric>(&app, cloth), fabric(0.3));
    fabrics(&mut app).get_mut(&handle).unwrap().density = 0.8;
    run(&mut app, 3);
    assert_eq!(*get::<Fabric>(&app, cloth), fabric(0.8));
}

#[test]
fn equal_values_change_nothing() {
    let mut app = headless();
    let handle = fabrics(&mut app).add(fabric(0.7));
    let cloth = spawn_cloth(&mut app, GRID, FabricHandle::new(handle.clone()));
    run(&mut app, 3);
    let changed = |app: &App| app.world().entity(cloth).get_ref::<Fabric>().unwrap().last_changed();
    let before = changed(&app);
    fabrics(&mut app).get_mut(&handle).unwrap().density = 0.7;
    get_mut::<FabricHandle>(&mut app, cloth).set_changed();
    run(&mut app, 3);
    assert_eq!(changed(&app), before);
}

#[test]
fn bad_values_from_code_are_refused_and_the_cloth_goes_on() {
    let mut app = headless();
    let handle = fabrics(&mut app).add(fabric(0.7));
    let cloth = spawn_cloth(&mut app, GRID, FabricHandle::new(handle.clone()));
    run(&mut app, 3);
    fabrics(&mut app).get_mut(&handle).unwrap().density = f32::NAN;
    run(&mut app, 10);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready);
    assert!(positions(&app, cloth).into_iter().all(Vec3::is_finite));
}

#[test]
fn a_file_that_turns_bad_keeps_the_values_and_says_so() {
    let (mut shop, cloth) = Shop::following(&fabric(0.7));
    shop.reload(&text_with("drag: 1.2", "drag: -1.2"));
    wait_for(&mut shop.app, |app| !app.world().resource::<Failures>().0.is_empty());
    let place_then = place(&shop.app, cloth, 5);
    run(&mut shop.app, 10);
    assert_eq!(*get::<Fabric>(&shop.app, cloth), fabric(0.7));
    assert_eq!(*get::<ClothStatus>(&shop.app, cloth), ClothStatus::Ready);
    assert_ne!(place(&shop.app, cloth, 5), place_then);
    // Bevy tries a file a second time when it fails to be loaded again.
    assert!(shop.failures().len() <= 2, "{:?}", shop.failures());
    assert!(shop.failures()[0].contains("fabrics/test.fabric.ron, line 15: drag is -1.2"));

    shop.reload(&fabric(0.8).to_ron());
    wait_for(&mut shop.app, |app| *get::<Fabric>(app, cloth) == fabric(0.8));
}

#[test]
fn a_file_that_was_never_good_leaves_the_cloth_what_it_has() {
    let mut shop = Shop::new("()");
    let handle = shop.load();
    let cloth = spawn_cloth(&mut shop.app, GRID, (fabric(0.3), FabricHandle::new(handle)));
    wait_for(&mut shop.app, |app| !app.world().resource::<Failures>().0.is_empty());
    run(&mut shop.app, 3);
    assert_eq!(*get::<Fabric>(&shop.app, cloth), fabric(0.3));
    assert_eq!(*get::<ClothStatus>(&shop.app, cloth), ClothStatus::Ready);
    shop.reload(&fabric(0.8).to_ron());
    wait_for(&mut shop.app, |app| *get::<Fabric>(app, cloth) == fabric(0.8));
}

/// What is wrong, the line and field that are told, and how the message goes on.
#[rustfmt::skip]
fn bad_texts() -> Vec<(String, usize, Option<&'static str>, &'static str)> {
    let density = |other: &str| text_with("density: 0.15,", other);
    let drag = |other: &str| text_with("drag: 1.2,", other);
    vec![
        (density("density: -1,"), 2, Some("density"), "density is -1, and it has to be greater than 0 kg/m²; set it"),
        (density("density: 0.0,"), 2, Some("density"), "density is 0, and it has to be greater than 0 kg/m²; set it"),
        (drag("drag: -0.5,"), 15, Some("drag"), "drag is -0.5, and it has to be 0 or greater; set it"),
        (drag("drag: NaN,"), 15, Some("drag"), "drag is NaN, and it has to be 0 or greater; set it"),
        (drag("drag: inf,"), 15, Some("drag"), "drag is inf, and"),
        (drag("drag: 1e99,"), 15, Some("drag"), "drag is inf, and"),
        (drag(""), 17, Some("drag"), "drag is missing, and a fabric has every field; add it"),
        ("()".into(), 1, Some("density"), "density is missing, and"),
        (drag("drag: 1.2,\n    weight: 3,"), 16, Some("weight"), "a fabric has no weight; use one of density, "),
        (drag("drag: 1.2, weight: \"3\","), 15, Some("weight"), "a fabric has no weight; use one of density, "),
        (drag("drag: 1.2,\n\n    density: 3,"), 17, Some("density"), "density is there twice, and"),
        (drag("drag: \"1.2\","), 15, Some("drag"), "drag has to be a number; write one, as in `drag: 0.5`"),
        (drag("drag: true,"), 15, Some("drag"), "drag has to be a number"),
        (drag("drag: Some(1.2),"), 15, Some("drag"), "drag has to be a number"),
        (drag("drag: (1.2),"), 15, Some("drag"), "drag has to be a number"),
        (drag("drag: ,"), 15, Some("drag"), "drag has to be a number"),
        // Syntax.
        (drag("drag: 1.2"), 15, Some("drag"), "the text from drag on can't be read (Expected comma); mend it there"),
        (drag("drag: 1.2 kg,"), 15, Some("drag"), "the text from drag on can't be read (Expected comma)"),
        (drag("drag = 1.2,"), 15, Some("drag"), "the text from drag on can't be read (Expected colon)"),
        (drag("drag: 1,2,"), 15, Some("drag"), "the text from drag on can't be read ("),
        (drag("drag: 1.2, /*"), 15, Some("drag"), "the text from drag on can't be read (Unclosed block comment)"),
        (drag("\"drag\": 1.2,"), 15, Some("friction"), "the text from friction on can't be read ("),
        (text_with(")", ""), 16, Some("lift"), "the text from lift on can't be read ("),
        (text_with(")", ")\n)"), 18, None, "there is text behind the fabric; remove it"),
        ("\n// Nothing.\n".into(), 3, None, "this isn't a fabric ("),
        ("// A list.\n[0.2]".into(), 2, None, "this isn't a fabric ("),
        ("Cloth()".into(), 1, None, "this isn't a fabric (Expected struct `Fabric` but found `Cloth`); write all"),
        // Layout: comments that look like fields, several fields a line, Windows' line ends, values on their own line.
        (drag("// drag: 1,\n  /* drag: 2,\n */ drag: -3,"), 17, Some("drag"), "drag is -3, and"),
        (drag("drag:\n  // After the colon.\n  -3,"), 15, Some("drag"), "drag is -3, and"),
        (drag("lift: 1, drag: -7,").replacen("    lift: 0.4,", "", 1), 15, Some("drag"), "drag is -7, and"),
        (drag("drag: -7,").replace('\n', "\r\n"), 15, Some("drag"), "drag is -7, and"),
        (Fabric { lift: -1.0, ..default() }.to_ron().replace('\n', " "), 1, Some("lift"), "lift is -1, and"),
        (Fabric { shear_stiffness: 1e6, ..Fabric::DENIM }.to_ron(), 9, Some("shear_stiffness"), "shear_stiffness is 1000000, and it has to be at most 515"),
        (drag("r#drag: -1,"), 15, Some("drag"), "drag is -1, and"),
    ]
}

#[test]
fn bad_texts_are_refused_with_line_and_field() {
    for (text, line, field, problem) in bad_texts() {
        let error = refused(&text);
        assert_eq!((error.line, error.field.as_deref()), (line, field), "{error}\n{text}");
        assert!(error.problem.starts_with(problem), "{error}\n{text}");
        assert_eq!(error.to_string(), format!("line {line}: {}", error.problem));
    }
}

#[test]
fn bad_files_are_refused_with_file_line_and_field() {
    for (text, line, _, problem) in bad_texts() {
        let mut shop = Shop::new(&text);
        let _handle = shop.load();
        wait_for(&mut shop.app, |app| !app.world().resource::<Failures>().0.is_empty());
        run(&mut shop.app, 3);
        let said = shop.failures();
        let expected = format!("{FILE}, line {line}: {problem}");
        assert!(said.len() == 1 && said[0].contains(&expected), "{said:?} and not {expected}");
    }
}

#[test]
fn the_error_of_a_file_can_be_taken_apart() {
    let mut shop = Shop::new(&text_with("drag: 1.2", "drag: -1.2"));
    let handle = shop.load();
    wait_for(&mut shop.app, |app| !app.world().resource::<Failures>().0.is_empty());
    let LoadState::Failed(error) = shop.app.world().resource::<AssetServer>().load_state(&handle) else {
        panic!("it has been loaded");
    };
    let AssetLoadError::AssetLoaderError(error) = &*error else { panic!("{error}") };
    let error: &FabricFileError = error.error().downcast_ref().unwrap();
    assert_eq!((error.file.as_deref(), error.line, error.field.as_deref()), (Some(FILE), 15, Some("drag")));
}

#[test]
fn a_file_that_is_no_text_is_refused_with_its_line() {
    let mut shop = Shop::new("");
    shop.files.insert_asset(Path::new(FILE), b"(\n    // \xff\n)".to_vec());
    let _handle = shop.load();
    wait_for(&mut shop.app, |app| !app.world().resource::<Failures>().0.is_empty());
    assert!(shop.failures()[0].contains("fabrics/test.fabric.ron, line 2: a character isn't UTF-8; save"));
}

#[test]
fn a_text_may_name_the_type_and_carry_comments() {
    let text = format!("// Heavy.\nFabric{}", text_with("0.15", "7 /* kg/m² */"));
    assert_eq!(Fabric::from_ron(&text), Ok(fabric(7.0)));
}

fn any_fabric() -> impl Strategy<Value = Fabric> {
    let value = prop_oneof![0.0f32..100.0, (0..f32::MAX.to_bits()).prop_map(f32::from_bits)];
    let positive = value.clone().prop_map(|value| value.max(f32::MIN_POSITIVE));
    (prop::array::uniform4(positive), prop::array::uniform10(value), 0.0f32..=1.0).prop_map(
        |([a, b, c, d], [e, f, g, h, i, j, k, l, m, n], compression)| Fabric {
            density: a,
            thickness: b,
            warp_stiffness: c,
            weft_stiffness: d,
            warp_stiffening: e,
            weft_stiffening: f,
            compression,
            shear_stiffness: g.min(Moduli::most_shear([c, d])),
            bending_rigidity: h,
            stretch_damping: i,
            bend_damping: j,
            damping: k,
            friction: l,
            drag: m,
            lift: n,
        },
    )
}

proptest! {
    #[test]
    fn what_is_written_is_read_again(fabric in any_fabric()) {
        let text = fabric.to_ron();
        prop_assert_eq!(text.lines().count(), 17);
        prop_assert!(text.ends_with(")\n"));
        prop_assert_eq!(Fabric::from_ron(&text), Ok(fabric));
    }

    #[test]
    fn a_damaged_text_is_refused_within_its_lines(at in 0usize..300, with in "[ -~\\n\u{b7}]{0,3}") {
        let mut text = Fabric::default().to_ron();
        text.replace_range(at.min(text.len())..(at + 2).min(text.len()), &with);
        if let Err(error) = Fabric::from_ron(&text) {
            prop_assert!((1..=text.lines().count() + 1).contains(&error.line), "{}\n{}", error, text);
        }
    }
}

#[test]
fn plugins_may_come_in_any_order() {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, ClothPlugin::default(), TransformPlugin, AssetPlugin::default(), MeshPlugin));
    app.finish();
    app.cleanup();
    let handle = fabrics(&mut app).add(fabric(0.7));
    let cloth = spawn_cloth(&mut app, GRID, FabricHandle::new(handle));
    let file = app.world().resource::<AssetServer>().load("fabrics/silk.fabric.ron");
    let other = spawn_cloth(&mut app, GRID, FabricHandle::new(file));
    run(&mut app, 2);
    assert_eq!(*get::<Fabric>(&app, cloth), fabric(0.7));
    wait_for(&mut app, |app| *get::<Fabric>(app, other) == Fabric::SILK);
}

#[test]
fn fabrics_that_other_plugins_add_are_kept() {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), MeshPlugin, ClothPlugin::default()));
    let handle = fabrics(&mut app).add(fabric(0.7));
    app.finish();
    app.cleanup();
    let cloth = spawn_cloth(&mut app, GRID, FabricHandle::new(handle));
    app.update();
    assert_eq!(*get::<Fabric>(&app, cloth), fabric(0.7));
}

#[test]
fn without_assets_a_handle_does_nothing() {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, ClothPlugin::default()));
    app.finish();
    app.cleanup();
    // Meshes that something else than Bevy's plugin looks after: the cloth runs all the same.
    app.init_resource::<Assets<Mesh>>().add_message::<AssetEvent<Mesh>>();
    let cloth = spawn_cloth(&mut app, GRID, (fabric(0.3), FabricHandle::default()));
    run(&mut app, 3);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready);
    assert_eq!(*get::<Fabric>(&app, cloth), fabric(0.3));
}

#[test]
fn inspectors_see_handles_and_assets() {
    let mut app = headless();
    let handle = fabrics(&mut app).add(fabric(0.7));
    let cloth = spawn_cloth(&mut app, GRID, FabricHandle::new(handle.clone()));
    run(&mut app, 1);
    let registry = app.world().resource::<AppTypeRegistry>().clone();
    let registry = registry.read();
    let component = registry.get_type_data::<ReflectComponent>(TypeId::of::<FabricHandle>()).unwrap();
    assert!(registry.get_type_data::<ReflectAsset>(TypeId::of::<Fabric>()).is_some());
    let mut follower = component.reflect_mut(app.world_mut().entity_mut(cloth)).unwrap();
    assert_eq!(*follower.path::<Handle<Fabric>>("handle").unwrap(), handle);
    *follower.path_mut::<bool>("detached").unwrap() = true;
    fabrics(&mut app).get_mut(&handle).unwrap().density = 0.8;
    run(&mut app, 3);
    assert_eq!(*get::<Fabric>(&app, cloth), fabric(0.7));
}
