//! What Bevy's loader shows us of a file, stage by stage.

use std::collections::BTreeMap;

use bevy::{
    asset::LoadContext,
    gltf::{
        GltfAssetLabel, GltfLoaderSettings, GltfMesh,
        extensions::{ErasedGltfExtensionHandler, GltfExtensionHandler},
    },
    mesh::MeshVertexAttribute,
    platform::collections::HashMap,
    prelude::*,
};

use super::{
    paint::{Paint, Painted},
    report::Report,
    scene::Scenery,
};

/// Reads one file; Bevy takes a fresh copy for each.
#[derive(Clone, Debug, Default)]
pub(super) struct ClothHandler {
    /// What is painted on the primitives of the mesh that is being read, by their numbers.
    paint: BTreeMap<usize, Paint>,
    /// The same of all meshes so far, by the labels of their assets.
    painted: HashMap<String, Painted>,
    report: Report,
}

impl GltfExtensionHandler for ClothHandler {
    fn dyn_clone(&self) -> Box<dyn ErasedGltfExtensionHandler> {
        Box::new(self.clone())
    }

    fn on_root(&mut self, context: &mut LoadContext<'_>, _file: &gltf::Gltf, _settings: &GltfLoaderSettings) {
        self.report.file = context.path().to_string();
    }

    async fn on_gltf_primitive(
        &mut self,
        _context: &mut LoadContext<'_>,
        _file: &gltf::Gltf,
        mesh: &gltf::Mesh<'_>,
        primitive: &gltf::Primitive<'_>,
        buffers: &[Vec<u8>],
        _custom_vertex_attributes: &HashMap<Box<str>, MeshVertexAttribute>,
        _is_on_skinned_nodes: bool,
        _is_on_other_nodes: bool,
        _own_mesh: &mut Option<Mesh>,
    ) {
        let paint = Paint::read(primitive, &subject(mesh), buffers, &mut self.report);
        if !paint.is_empty() {
            self.paint.insert(primitive.index(), paint);
        }
    }

    fn on_gltf_mesh(&mut self, context: &mut LoadContext<'_>, mesh: &gltf::Mesh, _handle: Handle<GltfMesh>) {
        for (number, paint) in core::mem::take(&mut self.paint) {
            let label = GltfAssetLabel::Primitive { mesh: mesh.index(), primitive: number }.to_string();
            let made = context.get_labeled(&label).and_then(|asset| asset.get::<Mesh>());
            let Some(mut painted_mesh) = made.cloned() else { continue };
            match paint.put_on(&mut painted_mesh) {
                Some(painted) => {
                    // It takes the place of the one that Bevy has made.
                    context.add_labeled_asset(label.clone(), painted_mesh);
                    self.painted.insert(label, painted);
                }
                None => self.report.warn(
                    &subject(mesh),
                    "what is painted on it is left out: the mesh that was loaded has other vertices; export it without compression",
                ),
            }
        }
    }

    fn on_scene_completed(
        &mut self,
        context: &mut LoadContext<'_>,
        _scene: &gltf::Scene,
        root: Entity,
        world: &mut World,
    ) {
        Scenery { world, context, painted: &self.painted, report: &mut self.report }.furnish(root);
    }
}

fn subject(mesh: &gltf::Mesh) -> String {
    mesh.name().map_or_else(|| format!("mesh {}", mesh.index()), |name| format!("mesh \"{name}\""))
}
