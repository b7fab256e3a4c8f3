//! An app with cloth, its panel, and hands for the panel.

use std::time::Duration;

use bevy::{ecs::component::Mutable, mesh::MeshPlugin, prelude::*, time::TimeUpdateStrategy};
use bevy_drape::{
    panel::{ClothPanelPlugin, cloth_panel},
    prelude::*,
};
use bevy_egui::egui::{self, Event, Key, PointerButton, Pos2, accesskit::Role};
use egui_kittest::{
    Harness, Node,
    kittest::{NodeT, Queryable},
};

/// Which component of which cloths has been changed, and which cloths have been reset.
#[derive(Resource, Default, Debug, PartialEq)]
pub struct Heard {
    pub changed: Vec<&'static str>,
    pub resets: usize,
}

/// An app with cloth at 60 Hz and the panel without its window: each update runs one step.
pub fn app() -> App {
    app_with(|_: &mut App| {})
}

/// The same with another plugin.
pub fn app_with(plugin: impl Plugin) -> App {
    let mut app = App::new();
    let panel = ClothPanelPlugin { window: false, ..default() };
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), MeshPlugin))
        .add_plugins((ClothPlugin::default(), panel, plugin))
        .init_resource::<Heard>()
        .add_observer(|_: On<ClothReset>, mut heard: ResMut<Heard>| heard.resets += 1)
        .add_systems(
            Last,
            (
                hear::<Cloth>,
                hear::<Fabric>,
                hear::<ClothSprings>,
                hear::<Pins>,
                hear::<Wind>,
                hear::<ClothSkin>,
                hear::<ClothInertia>,
                hear::<ClothTeleport>,
                hear_resource::<ClothGravity>,
                hear_resource::<ClothBudget>,
            )
                .chain(),
        );
    #[cfg(feature = "debug")]
    app.add_plugins(bevy_drape::debug::ClothDebugPlugin);
    let step = Time::<Fixed>::from_hz(60.0);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(step.timestep())).insert_resource(step);
    app.finish();
    app.cleanup();
    app.update();
    app
}

fn hear<C: Component + TypePath>(changed: Query<(), Changed<C>>, mut heard: ResMut<Heard>) {
    heard.changed.extend(changed.iter().map(|()| C::short_type_path()));
}

fn hear_resource<R: Resource + TypePath>(resource: Res<R>, mut heard: ResMut<Heard>) {
    if resource.is_changed() {
        heard.changed.push(R::short_type_path());
    }
}

/// Spawns a named cloth that hangs from its top edge, with other components over it.
pub fn spawn_cloth(app: &mut App, name: &'static str, more: impl Bundle) -> Entity {
    let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(Mesh::from(ClothGrid::new(1.0, 1.0, 8, 8)));
    let cloth = (Mesh3d(mesh), Cloth::default(), Pins::edge(ClothEdge::Top), Name::new(name));
    app.world_mut().spawn(cloth).insert(more).id()
}

/// The panel over an app.
pub struct Desk {
    pub harness: Harness<'static, App>,
}

impl Desk {
    /// The panel, all sections open, after a few frames.
    pub fn new(mut app: App) -> Self {
        for _ in 0..3 {
            app.update();
        }
        let harness = Harness::builder()
            .with_size(egui::vec2(340.0, 2400.0))
            .with_max_steps(30)
            .build_ui_state(|ui, app: &mut App| cloth_panel(ui, app.world_mut()), app);
        let mut desk = Self { harness };
        for section in ["Inertia", "Teleport", "Gravity and air", "Wind", "Budget", "Mesh", "Drawing"] {
            if desk.harness.query_by_label(section).is_some() {
                desk.press(section);
            }
        }
        desk.frame();
        desk.heard();
        desk
    }

    /// One frame of the app and of the panel.
    pub fn frame(&mut self) {
        self.harness.state_mut().update();
        self.harness.step();
    }

    pub fn frames(&mut self, count: usize) {
        for _ in 0..count {
            self.frame();
        }
    }

    pub fn app(&mut self) -> &mut App {
        self.harness.state_mut()
    }

    pub fn get<C: Component>(&self, entity: Entity) -> &C {
        self.harness.state().world().get(entity).expect("the component")
    }

    pub fn get_mut<C: Component<Mutability = Mutable>>(&mut self, entity: Entity) -> Mut<'_, C> {
        self.app().world_mut().get_mut(entity).expect("the component")
    }

    pub fn resource<R: Resource>(&self) -> &R {
        self.harness.state().world().resource()
    }

    /// What has happened since this was last asked.
    pub fn heard(&mut self) -> Heard {
        core::mem::take(&mut *self.app().world_mut().resource_mut::<Heard>())
    }

    /// All that is written.
    pub fn texts(&self) -> Vec<String> {
        self.harness.root().children_recursive().filter_map(|node| node.accesskit_node().value()).collect()
    }

    /// A control by what it is and what it is called.
    #[track_caller]
    pub fn control<'a>(&'a self, role: Role, name: &'a str) -> Node<'a> {
        let found: Vec<_> = self.controls(role, name).collect();
        assert_eq!(found.len(), 1, "controls of role {role:?} called {name:?}");
        found[0]
    }

    pub fn controls<'a>(&'a self, role: Role, name: &'a str) -> impl Iterator<Item = Node<'a>> {
        self.harness.root().children_recursive().filter(move |node| {
            let node = node.accesskit_node();
            let is_labelled = || node.labelled_by().any(|label| label.value().as_deref() == Some(name));
            node.role() == role && (node.label().as_deref() == Some(name) || is_labelled())
        })
    }

    /// Presses and releases the pointer.
    pub fn click_at(&mut self, at: Pos2) {
        self.harness.hover_at(at);
        for pressed in [true, false] {
            let button = PointerButton::Primary;
            self.harness.event(Event::PointerButton { pos: at, button, pressed, modifiers: default() });
        }
        self.harness.run();
        self.harness.remove_cursor();
        self.harness.run();
    }

    /// Presses what is called `name`.
    #[track_caller]
    pub fn press(&mut self, name: &str) {
        let at = self.harness.get_by_label(name).rect().center();
        self.click_at(at);
    }

    /// Presses a button or a box, the first of that name, and lets a frame pass.
    #[track_caller]
    pub fn click(&mut self, role: Role, name: &str) {
        let at = self.controls(role, name).next().expect("the control").rect().center();
        self.click_at(at);
        self.frame();
    }

    /// Opens a list or a menu and presses one of its entries.
    #[track_caller]
    pub fn choose(&mut self, role: Role, list: &str, entry: &str) {
        let at = self.control(role, list).rect().center();
        self.click_at(at);
        let found = self.harness.get_all_by_label(entry).last().map(|node| node.rect().center());
        self.click_at(found.expect("the entry"));
        self.frame();
    }

    /// Presses a slider at a share of its length.
    #[track_caller]
    pub fn slide(&mut self, name: &str, share: f32) {
        let rect = self.control(Role::Slider, name).rect();
        self.click_at(Pos2::new(rect.left() + share * rect.width(), rect.center().y));
        self.frame();
    }

    /// Types a value and ends with the enter key.
    #[track_caller]
    pub fn type_value(&mut self, name: &str, text: &str) {
        self.type_nth_value(name, 0, text);
    }

    #[track_caller]
    pub fn type_nth_value(&mut self, name: &str, nth: usize, text: &str) {
        let at = self.controls(Role::SpinButton, name).nth(nth).expect("a field").rect().center();
        self.click_at(at);
        self.harness.event(Event::Text(text.into()));
        self.harness.run();
        self.harness.key_press(Key::Enter);
        self.harness.run();
        self.frame();
    }

    /// Presses an entry of the menu and gives what is on the clipboard right then.
    #[track_caller]
    pub fn copy(&mut self, entry: &str) -> Option<String> {
        let at = self.control(Role::Button, "Copy ⏷").rect().center();
        self.click_at(at);
        let at = self.control(Role::Button, entry).rect().center();
        self.copy_at(at)
    }

    /// Presses a button and gives what is on the clipboard right then.
    pub fn copy_at(&mut self, at: Pos2) -> Option<String> {
        self.harness.hover_at(at);
        self.harness.step();
        self.harness.drag_at(at);
        self.harness.step();
        let button = PointerButton::Primary;
        self.harness.event(Event::PointerButton { pos: at, button, pressed: false, modifiers: default() });
        self.harness.step();
        self.copied()
    }

    /// What has been put on the clipboard by the latest frame.
    fn copied(&self) -> Option<String> {
        self.harness.output().platform_output.commands.iter().find_map(|command| match command {
            egui::OutputCommand::CopyText(text) => Some(text.clone()),
            _ => None,
        })
    }
}

/// A step's duration.
pub fn step() -> Duration {
    Time::<Fixed>::from_hz(60.0).timestep()
}
