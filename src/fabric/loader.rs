//! Loads fabrics through Bevy's asset server.

use bevy::{
    asset::{AssetLoader, LoadContext, io::Reader},
    ecs::error::BevyError,
    prelude::*,
};

use super::{Fabric, file};

/// Loads `*.fabric.ron`. What is wrong with a file is a [`FabricFileError`](file::FabricFileError) that names it.
#[derive(TypePath)]
struct FabricLoader;

impl AssetLoader for FabricLoader {
    type Asset = Fabric;
    type Settings = ();
    type Error = BevyError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        _settings: &(),
        context: &mut LoadContext<'_>,
    ) -> Result<Fabric, BevyError> {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes).await?;
        let fabric = file::from_bytes(&bytes).map_err(|error| error.in_file(context.path()))?;
        Ok(fabric)
    }

    fn extensions(&self) -> &[&str] {
        &["fabric.ron"]
    }
}

/// Makes fabrics assets, as soon as there is an asset server. Asked again, it does nothing.
pub(crate) fn register(app: &mut App) {
    if app.world().contains_resource::<AssetServer>() && !app.world().contains_resource::<Assets<Fabric>>() {
        app.init_asset::<Fabric>().register_asset_reflect::<Fabric>().register_asset_loader(FabricLoader);
    }
}
