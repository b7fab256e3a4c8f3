//! The file: a glTF document, the mesh and its picture.

use std::error::Error;

use serde_json::{Value, json};

use super::{
    glb::{self, Binary, Purpose},
    mesh::FlagMesh,
};

const LINEAR: u32 = 9729;
const LINEAR_MIPMAP_LINEAR: u32 = 9987;
const CLAMP_TO_EDGE: u32 = 33071;

pub fn file(mesh: &FlagMesh, png: &[u8]) -> Result<Vec<u8>, Box<dyn Error>> {
    let normals = vec![[0.0, 0.0, 1.0]; mesh.positions.len()];
    let mut binary = Binary::default();
    let primitive = json!({
        "attributes": {
            "POSITION": binary.floats(&mesh.positions, Purpose::Vertices),
            "NORMAL": binary.floats(&normals, Purpose::Vertices),
            "TEXCOORD_0": binary.floats(&mesh.uvs, Purpose::Vertices),
            "_PIN": binary.floats(&mesh.pins, Purpose::Vertices),
        },
        "indices": binary.indices(&mesh.indices),
        "material": 0,
    });
    let picture = binary.bytes(png.iter().copied(), Purpose::Other);
    glb::file(document(&primitive, picture), binary)
}

fn document(primitive: &Value, picture: usize) -> Value {
    json!({
        "asset": { "version": "2.0", "generator": "bevy_drape, examples/generate_flag" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        // The fabric is a file beside this one.
        "nodes": [{ "name": "Flag", "mesh": 0, "extras": { "cloth": super::FABRIC } }],
        "meshes": [{ "name": "Flag", "primitives": [primitive] }],
        "materials": [{
            "name": "Bunting",
            "doubleSided": true,
            "pbrMetallicRoughness": {
                "baseColorTexture": { "index": 0 }, "metallicFactor": 0.0, "roughnessFactor": 0.85,
            },
        }],
        "textures": [{ "source": 0, "sampler": 0 }],
        "samplers": [{
            "magFilter": LINEAR, "minFilter": LINEAR_MIPMAP_LINEAR,
            "wrapS": CLAMP_TO_EDGE, "wrapT": CLAMP_TO_EDGE,
        }],
        "images": [{ "name": "Flag", "bufferView": picture, "mimeType": "image/png" }],
    })
}
