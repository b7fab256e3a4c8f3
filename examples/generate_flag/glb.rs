//! The file: a glTF document and its numbers in one binary container.

use std::error::Error;

use gltf_json::validation::Validate;
use serde_json::{Value, json};

use super::{
    SIZE,
    mesh::{FLY_U, FlagMesh, HOIST_U},
};

const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const LINEAR: u32 = 9729;
const LINEAR_MIPMAP_LINEAR: u32 = 9987;
const CLAMP_TO_EDGE: u32 = 33071;
const ARRAY_BUFFER: Option<u32> = Some(34962);
const ELEMENT_ARRAY_BUFFER: Option<u32> = Some(34963);

pub fn file(mesh: &FlagMesh, png: &[u8]) -> Result<Vec<u8>, Box<dyn Error>> {
    let normals = vec![[0.0, 0.0, 1.0]; mesh.positions.len()];
    let mut binary = Binary::default();
    binary.add_floats(mesh.positions.as_flattened());
    binary.add_floats(normals.as_flattened());
    binary.add_floats(mesh.uvs.as_flattened());
    binary.add_floats(&mesh.pins);
    binary.add(mesh.indices.iter().flat_map(|index| index.to_le_bytes()), ELEMENT_ARRAY_BUFFER);
    binary.add(png.iter().copied(), None);

    let document = document(mesh, &binary);
    check(&document)?;
    Ok(container(serde_json::to_vec(&document)?, binary.bytes))
}

/// The binary chunk of the file and the views into it.
#[derive(Default)]
struct Binary {
    bytes: Vec<u8>,
    views: Vec<Value>,
}

impl Binary {
    fn add(&mut self, bytes: impl IntoIterator<Item = u8>, target: Option<u32>) {
        let offset = self.bytes.len();
        self.bytes.extend(bytes);
        let mut view = json!({ "buffer": 0, "byteOffset": offset, "byteLength": self.bytes.len() - offset });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        self.views.push(view);
        // Each view begins at a multiple of four, as its numbers must.
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
    }

    fn add_floats(&mut self, floats: &[f32]) {
        self.add(floats.iter().flat_map(|float| float.to_le_bytes()), ARRAY_BUFFER);
    }
}

fn document(mesh: &FlagMesh, binary: &Binary) -> Value {
    json!({
        "asset": { "version": "2.0", "generator": "bevy_drape, examples/generate_flag" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "name": "Flag", "mesh": 0 }],
        "meshes": [{
            "name": "Flag",
            "primitives": [{
                "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "_PIN": 3 },
                "indices": 4,
                "material": 0,
            }],
        }],
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
        "images": [{ "name": "Flag", "bufferView": 5, "mimeType": "image/png" }],
        "accessors": accessors(mesh),
        "bufferViews": binary.views,
        "buffers": [{ "byteLength": binary.bytes.len() }],
    })
}

/// Each accessor reads the view of the same number.
fn accessors(mesh: &FlagMesh) -> Value {
    let count = mesh.positions.len();
    let floats = |view: usize, kind: &str, min: Value, max: Value| {
        json!({
            "bufferView": view, "componentType": FLOAT, "count": count, "type": kind, "min": min, "max": max,
        })
    };
    json!([
        floats(0, "VEC3", json!([0.0, -SIZE[1], 0.0]), json!([SIZE[0], 0.0, 0.0])),
        floats(1, "VEC3", json!([0.0, 0.0, 1.0]), json!([0.0, 0.0, 1.0])),
        floats(2, "VEC2", json!([HOIST_U[0], 0.0]), json!([FLY_U[0], 1.0])),
        floats(3, "SCALAR", json!([0.0]), json!([1.0])),
        {
            "bufferView": 4, "componentType": UNSIGNED_SHORT, "count": mesh.indices.len(), "type": "SCALAR",
            "min": [0], "max": [count - 1],
        },
    ])
}

/// Refuses to write what a strict reader would refuse to read.
fn check(document: &Value) -> Result<(), Box<dyn Error>> {
    let root: gltf_json::Root = serde_json::from_value(document.clone())?;
    let mut faults = Vec::new();
    root.validate(&root, gltf_json::Path::new, &mut |path, fault| faults.push(format!("{}: {fault}", path())));
    if faults.is_empty() { Ok(()) } else { Err(faults.join("\n").into()) }
}

/// A header and two chunks, each padded to a multiple of four bytes.
fn container(mut json: Vec<u8>, mut binary: Vec<u8>) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let length = |bytes: &[u8]| (bytes.len() as u32).to_le_bytes();
    let total = (12 + 8 + json.len() + 8 + binary.len()) as u32;
    [
        b"glTF".as_slice(),
        &2_u32.to_le_bytes(),
        &total.to_le_bytes(),
        &length(&json),
        b"JSON",
        &json,
        &length(&binary),
        b"BIN\0",
        &binary,
    ]
    .concat()
}
