//! Writes glTF files of one binary container: a document, and the numbers that it refers to.

#![allow(dead_code, reason = "each generator is its own crate and uses only a part of this module")]

use std::error::Error;

use gltf_json::validation::Validate;
use serde_json::{Value, json};

const UNSIGNED_BYTE: u32 = 5121;
const UNSIGNED_SHORT: u32 = 5123;
const FLOAT: u32 = 5126;

/// What a view into the binary chunk is for.
#[derive(Clone, Copy)]
pub enum Purpose {
    Vertices = 34962,
    Indices = 34963,
    /// Neither: pictures, animations, bind poses.
    Other = 0,
}

/// The binary chunk of a file, the views into it, and what the numbers in them mean.
///
/// What adds something returns the number by which the document refers to it.
#[derive(Default)]
pub struct Binary {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Binary {
    /// Adds a view.
    pub fn bytes(&mut self, bytes: impl IntoIterator<Item = u8>, purpose: Purpose) -> usize {
        let offset = self.bytes.len();
        self.bytes.extend(bytes);
        let mut view = json!({ "buffer": 0, "byteOffset": offset, "byteLength": self.bytes.len() - offset });
        if !matches!(purpose, Purpose::Other) {
            view["target"] = (purpose as u32).into();
        }
        self.views.push(view);
        // Each view begins at a multiple of four, as its numbers must.
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.len() - 1
    }

    /// Adds numbers, vectors or matrices as an accessor with a view of its own.
    pub fn floats<const N: usize>(&mut self, values: &[[f32; N]], purpose: Purpose) -> usize {
        let view = self.bytes(values.as_flattened().iter().flat_map(|float| float.to_le_bytes()), purpose);
        let mut accessor = accessor(view, FLOAT, values.len(), N);
        // Readers want the bounds of positions and of an animation's times; of matrices they are of no use.
        if N < 4 {
            accessor["min"] = json!(bounds(values, f32::min).to_vec());
            accessor["max"] = json!(bounds(values, f32::max).to_vec());
        }
        self.add(accessor)
    }

    /// Adds the joints of each vertex.
    pub fn joints(&mut self, joints: &[[u8; 4]]) -> usize {
        let view = self.bytes(joints.as_flattened().iter().copied(), Purpose::Vertices);
        self.add(accessor(view, UNSIGNED_BYTE, joints.len(), 4))
    }

    /// Adds the weights of each vertex, in parts of 65,535.
    pub fn weights(&mut self, weights: &[[u16; 4]]) -> usize {
        let view = self.bytes(weights.as_flattened().iter().flat_map(|weight| weight.to_le_bytes()), Purpose::Vertices);
        let mut accessor = accessor(view, UNSIGNED_SHORT, weights.len(), 4);
        accessor["normalized"] = true.into();
        self.add(accessor)
    }

    /// Adds the vertices of each triangle.
    pub fn indices(&mut self, indices: &[u16]) -> usize {
        let view = self.bytes(indices.iter().flat_map(|index| index.to_le_bytes()), Purpose::Indices);
        let mut accessor = accessor(view, UNSIGNED_SHORT, indices.len(), 1);
        accessor["min"] = json!([indices.iter().min()]);
        accessor["max"] = json!([indices.iter().max()]);
        self.add(accessor)
    }

    fn add(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}

fn accessor(view: usize, component: u32, count: usize, components: usize) -> Value {
    let kind = match components {
        1 => "SCALAR",
        2 => "VEC2",
        3 => "VEC3",
        16 => "MAT4",
        _ => "VEC4",
    };
    json!({ "bufferView": view, "componentType": component, "count": count, "type": kind })
}

fn bounds<const N: usize>(values: &[[f32; N]], pick: impl Fn(f32, f32) -> f32) -> [f32; N] {
    let bounds = values.iter().copied().reduce(|a, b| std::array::from_fn(|axis| pick(a[axis], b[axis])));
    // Zero has one sign only.
    bounds.unwrap_or([0.0; N]).map(|bound| bound + 0.0)
}

/// The file. `document` is all of it but what `binary` adds.
pub fn file(mut document: Value, binary: Binary) -> Result<Vec<u8>, Box<dyn Error>> {
    document["accessors"] = binary.accessors.into();
    document["bufferViews"] = binary.views.into();
    document["buffers"] = json!([{ "byteLength": binary.bytes.len() }]);
    check(&document)?;
    Ok(container(serde_json::to_vec(&document)?, binary.bytes))
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
