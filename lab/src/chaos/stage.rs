//! The app of a scene, and who is on in it.

use bevy::{
    ecs::{component::Mutable, schedule::SingleThreadedExecutor},
    mesh::MeshPlugin,
    prelude::*,
};
use bevy_drape::prelude::*;

use super::{diary::Diary, dice::Dice, movement::Mover};

/// A scene.
pub struct Stage {
    pub app: App,
    pub dice: Dice,
    pub diary: Diary,
    pub cloths: Vec<Entity>,
    pub obstacles: Vec<Entity>,
    pub winds: Vec<Entity>,
    /// All that moves, of whatever kind.
    pub movers: Vec<Mover>,
    /// Hands, and which cloth they hold.
    pub grabs: Vec<(Entity, GrabId)>,
}

/// What cloths have announced since the latest frame.
#[derive(Resource, Default)]
pub struct Heard {
    pub reset: Vec<(Entity, ResetCause)>,
    pub failed: Vec<(Entity, ClothError)>,
}

impl Stage {
    pub fn new(mut dice: Dice, diary: Diary) -> Self {
        let app = app(&mut dice);
        let (cloths, obstacles, winds, movers, grabs) = default();
        Self { app, dice, diary, cloths, obstacles, winds, movers, grabs }
    }

    /// One of all cloths that are there.
    pub fn some_cloth(&mut self) -> Option<Entity> {
        let there: Vec<Entity> = self.cloths.iter().copied().filter(|&cloth| self.is_there(cloth)).collect();
        self.dice.any(&there)
    }

    pub fn is_there(&self, entity: Entity) -> bool {
        self.app.world().get_entity(entity).is_ok()
    }

    /// A component of an entity, to be changed, if it has it.
    pub fn change<C: Component<Mutability = Mutable>>(&mut self, entity: Entity, change: impl FnOnce(&mut C)) {
        if let Some(mut component) = self.app.world_mut().get_mut::<C>(entity) {
            change(&mut component);
        }
    }

    /// Does something with an entity that is there.
    pub fn with(&mut self, entity: Entity, act: impl FnOnce(&mut EntityWorldMut)) {
        if let Ok(mut entity) = self.app.world_mut().get_entity_mut(entity) {
            act(&mut entity);
        }
    }

    /// Gives commands to an entity that is there.
    pub fn command(&mut self, entity: Entity, ask: impl FnOnce(&mut EntityCommands)) {
        if let Ok(mut commands) = self.app.world_mut().commands().get_entity(entity) {
            ask(&mut commands);
        }
        self.app.world_mut().flush();
    }
}

/// A headless app on one thread: scenes run side by side, and each has to come out the same.
fn app(dice: &mut Dice) -> App {
    let plugin = match dice.count(0..=5) {
        0 => ClothPlugin::new(FixedUpdate),
        1 => ClothPlugin::new(Update),
        _ => ClothPlugin::default(),
    };
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), MeshPlugin, plugin.single_threaded()))
        .init_resource::<Heard>()
        .add_observer(|event: On<ClothReset>, mut heard: ResMut<Heard>| heard.reset.push((event.entity, event.cause)))
        .add_observer(|event: On<ClothFailed>, mut heard: ResMut<Heard>| {
            heard.failed.push((event.entity, event.error.clone()));
        });
    app.finish();
    app.cleanup();
    for (_, schedule) in app.world_mut().resource_mut::<Schedules>().iter_mut() {
        schedule.set_executor(SingleThreadedExecutor::new());
    }
    app
}
