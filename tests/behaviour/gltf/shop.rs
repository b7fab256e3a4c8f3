//! An app whose assets are in memory, and what it warns of.

use std::{
    io::{self, Write},
    path::Path,
    sync::{Arc, Mutex, OnceLock},
};

use bevy::{
    asset::{
        LoadState,
        io::{
            AssetSourceBuilder, AssetSourceId,
            memory::{Dir, MemoryAssetReader},
        },
    },
    gltf::GltfPlugin,
    log::{tracing::subscriber, tracing_subscriber::fmt},
    mesh::MeshPlugin,
    prelude::*,
    time::TimeUpdateStrategy,
    world_serialization::{WorldInstanceReady, WorldSerializationPlugin},
};
use bevy_drape::prelude::*;

use super::file::File;
use crate::{common::run, fabric_assets::wait_for};

/// What all tests here log, on whatever thread: files are read on others than the test's own.
#[derive(Clone, Default)]
struct Log(Arc<Mutex<Vec<u8>>>);

static LOG: OnceLock<Log> = OnceLock::new();

impl Write for Log {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().expect("no test fails while it writes").write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn log() -> &'static Log {
    LOG.get_or_init(|| {
        let log = Log::default();
        let written = log.clone();
        let listener = fmt().with_ansi(false).with_writer(move || written.clone()).finish();
        subscriber::set_global_default(listener).expect("nobody else listens");
        log
    })
}

/// What has been warned of a file; its name has to be its test's alone.
pub fn warnings(file: &str) -> Vec<String> {
    let text = log().0.lock().expect("no test fails while it writes").clone();
    let text = String::from_utf8(text).expect("text");
    let name = format!(": {file}, ");
    let warnings = text.lines().filter(|line| line.contains("WARN"));
    warnings.filter_map(|line| Some(line.split_once(&name)?.1.to_owned())).collect()
}

/// How many scenes are there.
#[derive(Resource, Default)]
struct Spawned(usize);

/// An app with Bevy's loader and [`ClothPlugin`], and files in memory.
pub struct Shop {
    pub app: App,
    files: Dir,
}

impl Shop {
    pub fn new() -> Self {
        Self::with(GltfPlugin::default())
    }

    /// The same with another glTF plugin.
    pub fn with(loader: GltfPlugin) -> Self {
        Self::with_plugins(|app| {
            app.add_plugins((loader, ClothPlugin::default()));
        })
    }

    /// The same with plugins in another order: the glTF plugin has to be among them.
    pub fn with_plugins(add: impl FnOnce(&mut App)) -> Self {
        log();
        let files = Dir::default();
        let root = files.clone();
        let mut app = App::new();
        app.register_asset_source(
            AssetSourceId::Default,
            AssetSourceBuilder::new(move || Box::new(MemoryAssetReader { root: root.clone() })),
        )
        .add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), MeshPlugin, ImagePlugin::default()))
        .add_plugins(WorldSerializationPlugin)
        .init_resource::<Spawned>()
        .add_observer(|_: On<WorldInstanceReady>, mut spawned: ResMut<Spawned>| spawned.0 += 1);
        add(&mut app);
        let step = Time::<Fixed>::from_hz(60.0);
        app.insert_resource(TimeUpdateStrategy::ManualDuration(step.timestep())).insert_resource(step);
        app.finish();
        app.cleanup();
        app.update();
        Self { app, files }
    }

    pub fn write(&mut self, path: &str, file: File) {
        self.files.insert_asset(Path::new(path), file.bytes());
    }

    pub fn write_text(&mut self, path: &str, text: &str) {
        self.files.insert_asset_text(Path::new(path), text);
    }

    /// Spawns the scene of a file, and waits until it is there.
    pub fn spawn(&mut self, path: &str, at: Transform) -> Entity {
        let server = self.app.world().resource::<AssetServer>().clone();
        let scene: Handle<WorldAsset> = server.load(GltfAssetLabel::Scene(0).from_asset(path.to_owned()));
        let before = self.app.world().resource::<Spawned>().0;
        let root = self.app.world_mut().spawn((WorldAssetRoot(scene.clone()), at)).id();
        wait_for(&mut self.app, |app| {
            if let LoadState::Failed(error) = server.load_state(&scene) {
                panic!("{error}");
            }
            app.world().resource::<Spawned>().0 > before
        });
        run(&mut self.app, 2);
        root
    }

    /// Writes a file, spawns its scene and waits until it is there.
    pub fn show(path: &str, file: File) -> (Self, Entity) {
        let mut shop = Self::new();
        shop.write(path, file);
        let root = shop.spawn(path, Transform::default());
        (shop, root)
    }

    /// Loads a file, and waits until it is there.
    pub fn load(&mut self, path: &str) -> Handle<Gltf> {
        let server = self.app.world().resource::<AssetServer>().clone();
        let file = server.load(path.to_owned());
        wait_for(&mut self.app, |_| server.is_loaded(&file));
        run(&mut self.app, 5);
        file
    }

    /// Waits for another scene: one that is reloaded.
    pub fn reload(&mut self, path: &str) {
        let before = self.app.world().resource::<Spawned>().0;
        self.app.world().resource::<AssetServer>().reload(path.to_owned());
        wait_for(&mut self.app, |app| app.world().resource::<Spawned>().0 > before);
        run(&mut self.app, 2);
    }

    /// All entities below one.
    fn below(&self, root: Entity) -> Vec<Entity> {
        let mut below = vec![root];
        let mut i = 0;
        while let Some(&entity) = below.get(i) {
            below.extend(self.app.world().get::<Children>(entity).into_iter().flatten());
            i += 1;
        }
        below
    }

    /// The entity of this name.
    #[track_caller]
    pub fn named(&self, root: Entity, name: &str) -> Entity {
        let is_named = |&entity: &Entity| {
            self.app.world().get::<Name>(entity).is_some_and(|it| it.as_str() == name)
                && self.app.world().get::<Mesh3d>(entity).is_none()
        };
        self.below(root).into_iter().find(is_named).unwrap_or_else(|| panic!("nothing is called {name}"))
    }

    /// All that have a component, below an entity.
    pub fn all<C: Component>(&self, root: Entity) -> Vec<Entity> {
        self.below(root).into_iter().filter(|&entity| self.app.world().get::<C>(entity).is_some()).collect()
    }

    /// The only cloth below an entity.
    #[track_caller]
    pub fn cloth(&self, root: Entity) -> Entity {
        let cloths = self.all::<Cloth>(root);
        assert_eq!(cloths.len(), 1, "one cloth");
        cloths[0]
    }

    #[track_caller]
    pub fn get<C: Component>(&self, entity: Entity) -> &C {
        crate::common::get(&self.app, entity)
    }

    /// The mesh that an entity was loaded with, or that its cloth draws.
    pub fn mesh(&self, entity: Entity) -> &Mesh {
        crate::common::drawn(&self.app, entity)
    }

    /// The mesh of a scene's only part.
    pub fn only_mesh(&self, root: Entity) -> &Mesh {
        self.mesh(self.all::<Mesh3d>(root)[0])
    }
}
