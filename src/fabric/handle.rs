//! A fabric that several cloths share: its values are copied to each of them.

use bevy::{
    asset::{AsAssetId, prelude::AssetChanged},
    ecs::template::FromTemplate,
    prelude::*,
};

use super::Fabric;

/// Gives a cloth the [`Fabric`] of an asset, be it from a `*.fabric.ron` file or added by code.
///
/// The asset's values are copied to the entity's [`Fabric`] in [`ClothSystems::Prepare`](crate::prelude::ClothSystems)
/// once it has loaded, and again whenever the asset or this component changes, as when its file is edited and Bevy
/// watches it. Until then, and where loading fails, the cloth runs with the [`Fabric`] that it has.
///
/// Between two such changes the entity's [`Fabric`] may be changed directly; the next one overwrites that, unless the
/// cloth is [`detached`](Self::detached).
///
/// ```no_run
/// # use bevy::prelude::*;
/// # use bevy_drape::prelude::*;
/// fn setup(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, assets: Res<AssetServer>) {
///     commands.spawn((
///         Mesh3d(meshes.add(ClothGrid::new(1.0, 1.0, 48, 48))),
///         Cloth::default(),
///         FabricHandle::new(assets.load("fabrics/silk.fabric.ron")),
///     ));
/// }
/// ```
#[derive(Component, FromTemplate, Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
#[require(Fabric)]
pub struct FabricHandle {
    /// The asset.
    pub handle: Handle<Fabric>,
    /// Keeps the entity's [`Fabric`] as it is, as for one cloth that is tuned apart from the others. Set back to
    /// `false`, the asset's values are copied again.
    pub detached: bool,
}

impl FabricHandle {
    /// Follows the asset.
    pub fn new(handle: Handle<Fabric>) -> Self {
        Self { handle, detached: false }
    }
}

impl From<Handle<Fabric>> for FabricHandle {
    fn from(handle: Handle<Fabric>) -> Self {
        Self::new(handle)
    }
}

impl AsAssetId for FabricHandle {
    type Asset = Fabric;

    fn as_asset_id(&self) -> AssetId<Fabric> {
        self.handle.id()
    }
}

/// Copies assets that have come or changed to the cloths that follow them.
pub(crate) fn copy_fabrics(
    fabrics: Res<Assets<Fabric>>,
    mut cloths: Query<(&FabricHandle, &mut Fabric), Or<(Changed<FabricHandle>, AssetChanged<FabricHandle>)>>,
) {
    for (follower, mut fabric) in &mut cloths {
        if !follower.detached
            && let Some(asset) = fabrics.get(&follower.handle)
        {
            fabric.set_if_neq(asset.clone());
        }
    }
}
