//! Reads what is cloth out of glTF files: what is painted becomes attributes of their meshes, and custom properties become
//! components in their scenes, so that instances, respawned and reloaded scenes have them too.

mod accessor;
mod collider;
mod garment;
mod handler;
mod node;
mod paint;
mod property;
mod proxy;
mod report;
mod scene;

use bevy::{gltf::extensions::GltfExtensionHandlers, prelude::*};

use crate::{
    cloth::Cloth,
    fabric::{Fabric, handle::FabricHandle},
    pins::Pins,
    proxy::ClothProxy,
    skin::ClothSkin,
    surroundings::{body::ClothBody, collider::ClothCollider, wind::Wind},
};
use handler::ClothHandler;

/// Has Bevy's loader show us every file, whether its plugin has come already or comes later.
pub(crate) fn register(app: &mut App) {
    app.init_resource::<GltfExtensionHandlers>();
    let handlers = app.world().resource::<GltfExtensionHandlers>().0.clone();
    match handlers.try_write() {
        Some(mut handlers) => handlers.push(Box::new(ClothHandler::default())),
        // Files are loaded once all plugins are there.
        None => warn!("glTF files bring no cloth: one is being loaded already; add ClothPlugin before the app runs"),
    }
    // A scene with a component of an unknown type ends the app, also where types don't register themselves.
    app.register_type::<Cloth>()
        .register_type::<Fabric>()
        .register_type::<FabricHandle>()
        .register_type::<Pins>()
        .register_type::<ClothSkin>()
        .register_type::<ClothProxy>()
        .register_type::<ClothBody>()
        .register_type::<ClothCollider>()
        .register_type::<Wind>();
}
