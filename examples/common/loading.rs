//! Tells when everything that the scene shows has arrived.

use bevy::{
    asset::{LoadState, RecursiveDependencyLoadState, UntypedAssetId, VisitAssetDependencies},
    ecs::system::SystemParam,
    prelude::*,
    render::{Extract, ExtractSchedule, MainWorld, RenderApp, render_resource::PipelineCache},
    world_serialization::{WorldInstance, WorldInstanceSpawner},
};

/// Frames in a row without anything to wait for: what one frame brings (a spawned scene, a prepared texture) may ask
/// for something more in the next.
const QUIET_FRAMES: u32 = 3;

/// Looks at the renderer's pipelines for [`Loading`].
pub struct LoadingPlugin;

impl Plugin for LoadingPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<PipelinesReady>();
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            render_app.add_systems(ExtractSchedule, report_pipelines);
        }
    }
}

#[derive(Resource, Default)]
struct PipelinesReady(bool);

fn report_pipelines(mut main_world: ResMut<MainWorld>, pipelines: Res<PipelineCache>) {
    let is_ready = pipelines.waiting_pipelines().count() == 0;
    if let Some(mut ready) = main_world.get_resource_mut::<PipelinesReady>() {
        ready.0 = is_ready;
    }
}

/// The assets that entities refer to, and the pipelines that draw them.
#[derive(SystemParam)]
pub struct Loading<'w, 's> {
    server: Res<'w, AssetServer>,
    pipelines: Res<'w, PipelinesReady>,
    scene_spawner: Res<'w, WorldInstanceSpawner>,
    scenes: Query<'w, 's, (&'static WorldAssetRoot, Option<&'static WorldInstance>)>,
    meshes: Query<'w, 's, &'static Mesh3d>,
    surfaces: Query<'w, 's, &'static MeshMaterial3d<StandardMaterial>>,
    materials: Res<'w, Assets<StandardMaterial>>,
    quiet_frames: Local<'s, u32>,
}

impl Loading<'_, '_> {
    /// Call it once a frame. An asset that can't be loaded is an error.
    pub fn is_done(&mut self) -> Result<bool, String> {
        if self.assets_are_loaded()? && self.pipelines.0 {
            *self.quiet_frames += 1;
        } else {
            *self.quiet_frames = 0;
        }
        Ok(*self.quiet_frames >= QUIET_FRAMES)
    }

    fn assets_are_loaded(&self) -> Result<bool, String> {
        let mut all_loaded = true;
        for (root, instance) in &self.scenes {
            let is_spawned = instance.is_some_and(|instance| self.scene_spawner.instance_is_ready(**instance));
            all_loaded &= self.is_loaded(root.0.id().untyped())? && is_spawned;
        }
        for mesh in &self.meshes {
            all_loaded &= self.is_loaded(mesh.id().untyped())?;
        }
        for surface in &self.surfaces {
            all_loaded &= self.is_loaded(surface.id().untyped())?;
            all_loaded &= self.textures_are_loaded(surface.id())?;
        }
        Ok(all_loaded)
    }

    /// A material made in code is no asset of the server, but its textures may be.
    fn textures_are_loaded(&self, material: AssetId<StandardMaterial>) -> Result<bool, String> {
        let Some(material) = self.materials.get(material) else {
            return Ok(false);
        };
        let mut textures = Vec::new();
        material.visit_dependencies(&mut |id| textures.push(id));
        let mut all_loaded = true;
        for texture in textures {
            all_loaded &= self.is_loaded(texture)?;
        }
        Ok(all_loaded)
    }

    fn is_loaded(&self, id: UntypedAssetId) -> Result<bool, String> {
        use RecursiveDependencyLoadState::{Failed, Loaded};
        match self.server.get_recursive_dependency_load_state(id) {
            // The server doesn't know what was made in code.
            None | Some(Loaded) => Ok(true),
            Some(Failed(error)) => Err(format!("An asset can't be loaded: {error}")),
            Some(_) => Ok(false),
        }
    }
}
