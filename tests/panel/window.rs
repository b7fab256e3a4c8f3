//! The panel's own window and its key.

use bevy::{
    camera::{RenderTarget, Viewport},
    input::{
        ButtonState, InputPlugin,
        keyboard::{Key, KeyCode, KeyboardInput, NativeKey},
    },
    mesh::MeshPlugin,
    prelude::*,
    window::WindowPlugin,
};
use bevy_drape::{
    panel::{ClothPanel, ClothPanelPlugin},
    prelude::*,
};
use bevy_egui::{
    EguiContext, EguiFullOutput, EguiPlugin, EguiPostUpdateSet, PrimaryEguiContext,
    egui::{self, Event, MouseWheelUnit, Pos2, Rect, Shape, TouchPhase},
    input::{EguiInputEvent, EguiWantsInput},
};

/// An app with all that egui needs, and no display.
fn app(panel: ClothPanelPlugin) -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), MeshPlugin, InputPlugin))
        .add_plugins((WindowPlugin::default(), ImagePlugin::default()))
        .init_asset::<Shader>()
        .add_plugins((ClothPlugin::default(), panel));
    app.finish();
    app.cleanup();
    app.world_mut().spawn((Camera::default(), RenderTarget::default(), PrimaryEguiContext));
    app
}

/// Presses and releases a key.
fn press(app: &mut App, key_code: KeyCode) {
    for state in [ButtonState::Pressed, ButtonState::Released] {
        app.world_mut().write_message(KeyboardInput {
            key_code,
            logical_key: Key::Unidentified(NativeKey::Unidentified),
            state,
            text: None,
            repeat: false,
            window: Entity::PLACEHOLDER,
        });
        app.update();
    }
}

fn is_shown(app: &mut App) -> bool {
    let mut contexts = app.world_mut().query::<&mut EguiContext>();
    let mut context = contexts.single_mut(app.world_mut()).expect("one context");
    context.get_mut().memory(|memory| {
        memory.areas().visible_layer_ids().iter().any(|layer| layer.id == egui::Id::new("bevy_drape panel"))
    })
}

#[test]
fn the_key_shows_and_hides_the_window() {
    let mut app = app(ClothPanelPlugin::default());
    app.update();
    assert!(!app.world().resource::<ClothPanel>().open && !is_shown(&mut app));
    press(&mut app, KeyCode::F1);
    assert!(app.world().resource::<ClothPanel>().open && is_shown(&mut app));
    press(&mut app, KeyCode::F2);
    assert!(is_shown(&mut app));
    press(&mut app, KeyCode::F1);
    assert!(!app.world().resource::<ClothPanel>().open && !is_shown(&mut app));
}

#[test]
fn the_window_may_be_open_at_once_and_without_a_key() {
    let mut app = app(ClothPanelPlugin { key: None, open: true, ..default() });
    app.update();
    press(&mut app, KeyCode::F1);
    assert!(app.world().resource::<ClothPanel>().open && is_shown(&mut app));
    app.world_mut().resource_mut::<ClothPanel>().open = false;
    app.update();
    assert!(!is_shown(&mut app));
}

#[test]
fn the_key_is_a_letter_like_any_other_while_somebody_types() {
    let mut app = app(ClothPanelPlugin { key: Some(KeyCode::KeyC), open: true, ..default() });
    app.update();
    app.add_systems(bevy_egui::EguiPrimaryContextPass, |mut contexts: bevy_egui::EguiContexts| {
        let context = contexts.ctx_mut().expect("a context");
        egui::Area::new("area".into()).show(context, |ui| {
            ui.text_edit_singleline(&mut String::new()).request_focus();
        });
    });
    app.update();
    app.update();
    assert!(app.world().resource::<EguiWantsInput>().wants_keyboard_input(), "somebody types");
    press(&mut app, KeyCode::KeyC);
    assert!(app.world().resource::<ClothPanel>().open);
}

#[test]
fn the_plugin_brings_egui_unless_it_is_there() {
    let with = app(ClothPanelPlugin::default());
    assert!(with.is_plugin_added::<EguiPlugin>());
    let without = app(ClothPanelPlugin { window: false, ..default() });
    assert!(!without.is_plugin_added::<EguiPlugin>());
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), MeshPlugin, InputPlugin))
        .add_plugins((WindowPlugin::default(), ImagePlugin::default()))
        .init_asset::<Shader>()
        .add_plugins((EguiPlugin::default(), ClothPlugin::default(), ClothPanelPlugin::default()));
    app.finish();
    app.update();
}

#[test]
fn an_app_without_keyboard_or_clock_or_cloth_is_left_in_peace() {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), ClothPanelPlugin { window: false, open: true, ..default() }));
    app.finish();
    app.update();
    app.update();
    let context = egui::Context::default();
    for _ in 0..3 {
        let _ = context.run_ui(default(), |ui| bevy_drape::panel::cloth_panel(ui, app.world_mut()));
        app.update();
    }
}

/// Texts of which all can be seen, and where.
#[derive(Resource, Default)]
struct Seen(Vec<(String, Rect)>);

impl Seen {
    #[track_caller]
    fn place(&self, text: &str) -> Rect {
        self.0.iter().find(|(seen, _)| seen == text).unwrap_or_else(|| panic!("{text:?} isn't seen")).1
    }

    fn has(&self, text: &str) -> bool {
        self.0.iter().any(|(seen, _)| seen == text)
    }
}

fn note_texts(outputs: Query<&EguiFullOutput>, mut seen: ResMut<Seen>) {
    seen.0.clear();
    for shape in outputs.iter().filter_map(|output| output.as_ref()).flat_map(|output| &output.shapes) {
        note_text(&shape.shape, shape.clip_rect, &mut seen.0);
    }
}

fn note_text(shape: &Shape, clip: Rect, seen: &mut Vec<(String, Rect)>) {
    match shape {
        Shape::Vec(shapes) => shapes.iter().for_each(|shape| note_text(shape, clip, seen)),
        Shape::Text(text) if clip.contains_rect(text.visual_bounding_rect()) => {
            seen.push((text.galley.text().to_owned(), text.visual_bounding_rect()));
        }
        _ => {}
    }
}

/// An app with a cloth and an open window on a screen of this size, after some frames.
fn screen(size: UVec2, cloth: Cloth) -> App {
    let mut app = app(ClothPanelPlugin { open: true, ..default() });
    app.init_resource::<Seen>()
        .add_systems(PostUpdate, note_texts.after(EguiPostUpdateSet::EndPass).before(EguiPostUpdateSet::ProcessOutput));
    let mut cameras = app.world_mut().query::<&mut Camera>();
    let mut camera = cameras.single_mut(app.world_mut()).expect("one camera");
    camera.viewport = Some(Viewport { physical_size: size, ..default() });
    let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(Mesh::from(ClothGrid::new(1.0, 1.0, 8, 8)));
    app.world_mut().spawn((Mesh3d(mesh), cloth, Pins::edge(ClothEdge::Top), Name::new("Curtain")));
    for _ in 0..20 {
        app.update();
    }
    app
}

/// Turns the wheel with the pointer at a place.
fn scroll(app: &mut App, at: Pos2) {
    let context = app.world_mut().query_filtered::<Entity, With<EguiContext>>().single(app.world()).expect("one");
    let (unit, delta, phase) = (MouseWheelUnit::Point, egui::vec2(0.0, -2000.0), TouchPhase::Move);
    let wheel = Event::MouseWheel { unit, delta, phase, modifiers: default() };
    for event in [Event::PointerMoved(at), wheel] {
        app.world_mut().write_message(EguiInputEvent { context, event });
        app.update();
    }
    for _ in 0..60 {
        app.update();
    }
}

const READINGS: [&str; 5] = ["Step time, ms", "Substeps taken", "Stretch, %", "Energy, J", "Contacts"];

#[test]
fn readings_and_advice_are_seen_on_a_small_screen_without_scrolling() {
    let ill = Cloth { solver: ClothSolver::Explicit, max_substeps: 1, ..default() };
    let app = screen(UVec2::new(1280, 720), ill);
    let seen = app.world().resource::<Seen>();
    for text in READINGS.into_iter().chain(["Cloth", "Status", "Pause", "Reset", "Fabric", "Preset"]) {
        assert!(seen.place(text).bottom() <= 720.0, "{text}");
    }
    let advice = seen.0.iter().find(|(text, _)| text.contains("substeps carry only")).expect("the advice");
    assert!(advice.1.top() > seen.place("Contacts").bottom());
    assert!(seen.0.iter().any(|(text, _)| text.ends_with("for the explicit solver's stability")), "why so many");
}

#[test]
fn readings_stay_in_sight_while_settings_scroll() {
    let mut app = screen(UVec2::new(1280, 720), Cloth::default());
    let before = app.world().resource::<Seen>().place("Energy, J");
    let at = app.world().resource::<Seen>().place("Preset").center();
    assert!(!app.world().resource::<Seen>().has("Drawing"));
    scroll(&mut app, at);
    let seen = app.world().resource::<Seen>();
    assert_eq!(seen.place("Energy, J"), before);
    assert!(!seen.has("Preset") && seen.has("Mesh"), "the settings have scrolled: {:?}", seen.0);
}

#[test]
fn on_a_very_small_screen_all_of_it_scrolls() {
    let mut app = screen(UVec2::new(640, 360), Cloth::default());
    let at = app.world().resource::<Seen>().place("Substeps taken").center();
    assert!(!app.world().resource::<Seen>().has("Preset"));
    scroll(&mut app, at);
    let seen = app.world().resource::<Seen>();
    assert!(!seen.has("Substeps taken") && seen.has("Mesh"), "{:?}", seen.0);
}
