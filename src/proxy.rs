//! Fine meshes that follow a coarse cloth.

use std::sync::Arc;

use bevy::prelude::*;

use crate::{
    error::ClothError,
    parameter::{Parameter, check_parameters},
    solver::{
        Topology,
        embedding::{Embedding, EmbeddingScratch},
    },
};

/// Has a mesh follow a coarse cloth, its driver: that is simulated, and this one is seen. A wrap deformer, in other words.
///
/// Each vertex goes with the closest triangle of the driver, as both were modelled, one beside the other: it is exactly where it was modelled
/// while the driver is at rest, and the fine mesh stays round where the coarse one has corners. Both are on the same skeleton, or neither
/// is. Vertices between those that the driver has pinned to the skeleton are drawn by it alone, bit for bit as the body beside them.
///
/// On an entity without a `Mesh3d` all meshes below it follow, as those of a [garment](crate::prelude::ClothPartOf). It isn't cloth itself:
/// fabric, pins and obstacles are those of the driver, which is best hidden (`Visibility::Hidden`). A press on the fine mesh takes hold of
/// the driver. Normals and tangents are its own.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_drape::prelude::*;
/// fn spawn_cape(mut commands: Commands, coarse: Handle<Mesh>, fine: Handle<Mesh>) {
///     let driver = commands.spawn((Mesh3d(coarse), Cloth::default(), Visibility::Hidden)).id();
///     commands.spawn((Mesh3d(fine), ClothProxy::new(driver)));
/// }
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Debug, Clone, PartialEq)]
#[require(ProxyWait, Transform)]
pub struct ClothProxy {
    /// The coarse cloth, on an entity with a [`Cloth`](crate::prelude::Cloth).
    #[entities]
    pub driver: Entity,
    /// How far from the driver vertices may be without a warning, m, greater than 0, 0.05 by default: what is farther follows all the same,
    /// and is likely to belong to something else.
    #[reflect(@Parameter::positive("m", (0.01, 0.2)).entered((0.0001, 100.0)))]
    pub reach: f32,
}

impl ClothProxy {
    /// Follows `driver`, with the default reach.
    pub fn new(driver: Entity) -> Self {
        Self { driver, reach: 0.05 }
    }

    /// Checks the ranges of all settings.
    ///
    /// # Errors
    ///
    /// [`ClothError::InvalidParameter`] with the first field that is out of its range.
    pub fn validate(&self) -> Result<(), ClothError> {
        check_parameters(self, |_| true)
    }
}

/// How a mesh follows its driver.
#[derive(Component, Clone, Debug)]
#[component(clone_behavior = Ignore)]
pub(crate) struct Embedded {
    pub driver: Entity,
    /// What the driver was made of when the mesh was embedded in it.
    pub topology: Arc<Topology>,
    pub embedding: Arc<Embedding>,
    pub scratch: EmbeddingScratch,
}

/// How long a mesh has waited for its driver, s, and what was said of it.
#[derive(Component, Clone, Debug, Default)]
#[component(clone_behavior = Ignore)]
pub(crate) struct ProxyWait {
    pub waited: f32,
    pub told: Option<String>,
}
