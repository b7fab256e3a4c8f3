//! The panel's own window and its key.

use bevy::{
    camera::RenderTarget,
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
use bevy_egui::{EguiContext, EguiPlugin, PrimaryEguiContext, egui, input::EguiWantsInput};

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
