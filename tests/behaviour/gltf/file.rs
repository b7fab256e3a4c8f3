//! Writes glTF files as Blender's exporter does, and wrong ones.

use serde_json::{Value, json};

/// Vertices along each side of a [`sheet`].
pub const SIDE: usize = 5;

pub const BYTE: u32 = 5120;
pub const UNSIGNED_BYTE: u32 = 5121;
pub const SHORT: u32 = 5122;
pub const UNSIGNED_SHORT: u32 = 5123;
pub const FLOAT: u32 = 5126;

/// A file that is being written.
#[derive(Clone)]
pub struct File {
    pub json: Value,
    bytes: Vec<u8>,
}

/// A sheet of 1 x 1 m that hangs from the x axis, row by row from the top left, as the object, the mesh and the material
/// `Sheet`.
pub fn sheet() -> File {
    let mut file = File {
        json: json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "name": "Scene", "nodes": [0] }],
            "nodes": [{ "name": "Sheet", "mesh": 0 }],
            "meshes": [{ "name": "Sheet", "primitives": [{ "attributes": {}, "material": 0 }] }],
            "materials": [{ "name": "Sheet" }],
            "accessors": [], "bufferViews": [], "buffers": [],
        }),
        bytes: Vec::new(),
    };
    let share = |i: usize| i as f32 / (SIDE - 1) as f32;
    let vertices = || (0..SIDE * SIDE).map(|i| (share(i % SIDE), share(i / SIDE)));
    let places: Vec<f32> = vertices().flat_map(|(right, down)| [right - 0.5, -down, 0.0]).collect();
    file.attribute("POSITION", "VEC3", FLOAT, false, &floats(&places));
    file.json["accessors"][0]["min"] = json!([-0.5, -1.0, 0.0]);
    file.json["accessors"][0]["max"] = json!([0.5, 0.0, 0.0]);
    file.attribute("NORMAL", "VEC3", FLOAT, false, &floats(&[0.0, 0.0, 1.0].repeat(SIDE * SIDE)));
    let uvs: Vec<f32> = vertices().flat_map(|(right, down)| [right, down]).collect();
    file.attribute("TEXCOORD_0", "VEC2", FLOAT, false, &floats(&uvs));
    let corners = (0..(SIDE - 1) * (SIDE - 1)).flat_map(|cell| {
        let first = (cell / (SIDE - 1) * SIDE + cell % (SIDE - 1)) as u16;
        let below = first + SIDE as u16;
        [first, below, first + 1, first + 1, below, below + 1]
    });
    let indices: Vec<u8> = corners.flat_map(u16::to_le_bytes).collect();
    let accessor = file.accessor("SCALAR", UNSIGNED_SHORT, false, &indices);
    file.primitive()["indices"] = accessor.into();
    file
}

/// The same with an armature of two bones, one at the top edge and its child at the bottom edge; the rows between follow both.
pub fn worn_sheet() -> File {
    let mut file = sheet();
    let lower = |i: usize| (i / SIDE) as f32 / (SIDE - 1) as f32;
    let joints: Vec<u8> = [0_u8, 1, 0, 0].repeat(SIDE * SIDE);
    let weights: Vec<f32> = (0..SIDE * SIDE).flat_map(|i| [1.0 - lower(i), lower(i), 0.0, 0.0]).collect();
    file.attribute("JOINTS_0", "VEC4", UNSIGNED_BYTE, false, &joints);
    file.attribute("WEIGHTS_0", "VEC4", FLOAT, false, &floats(&weights));
    let matrix = |up: f32| [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, up, 0.0, 1.0];
    let bind = file.accessor("MAT4", FLOAT, false, &floats(&[matrix(0.0), matrix(1.0)].concat()));
    file.json["nodes"] = json!([
        { "name": "Sheet", "mesh": 0, "skin": 0 },
        { "name": "upper", "children": [2] },
        { "name": "lower", "translation": [0.0, -1.0, 0.0] },
        { "name": "Armature", "children": [0, 1] },
    ]);
    file.json["scenes"][0]["nodes"] = json!([3]);
    file.json["skins"] = json!([{ "joints": [1, 2], "inverseBindMatrices": bind }]);
    file
}

/// A float of each vertex, as Blender writes the attribute types Float, Integer and Boolean.
pub fn by_row(value: impl Fn(f32) -> f32) -> Vec<f32> {
    (0..SIDE * SIDE).map(|i| value((i / SIDE) as f32 / (SIDE - 1) as f32)).collect()
}

pub fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// As Blender writes what is painted: the attribute type Byte Color.
pub fn colours(red: &[f32]) -> Vec<u8> {
    let channels = red.iter().flat_map(|red| [*red, 0.3, 0.9, 1.0]);
    channels.flat_map(|channel| ((channel * 65_535.0 + 0.5) as u16).to_le_bytes()).collect()
}

impl File {
    pub fn primitive(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    /// Paints a float on each vertex.
    pub fn paint(mut self, name: &str, values: &[f32]) -> Self {
        self.attribute(name, "SCALAR", FLOAT, false, &floats(values));
        self
    }

    /// Writes a custom property: on `/nodes/0`, say.
    pub fn property(mut self, on: &str, name: &str, value: impl Into<Value>) -> Self {
        self.json.pointer_mut(on).expect("a place in the file")["extras"][name] = value.into();
        self
    }

    pub fn without_normals(mut self) -> Self {
        self.primitive()["attributes"].as_object_mut().expect("attributes").remove("NORMAL");
        self
    }

    /// Adds an attribute of the mesh; its count follows from the bytes.
    pub fn attribute(&mut self, name: &str, kind: &str, component: u32, normalized: bool, bytes: &[u8]) {
        let accessor = self.accessor(kind, component, normalized, bytes);
        self.primitive()["attributes"][name] = accessor.into();
    }

    pub fn accessor(&mut self, kind: &str, component: u32, normalized: bool, bytes: &[u8]) -> usize {
        let width = match kind {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "MAT4" => 16,
            _ => 4,
        };
        let size = match component {
            BYTE | UNSIGNED_BYTE => 1,
            SHORT | UNSIGNED_SHORT => 2,
            _ => 4,
        };
        let view = self.view(bytes);
        let mut accessor = json!({
            "bufferView": view, "componentType": component, "count": bytes.len() / (width * size), "type": kind,
        });
        if normalized {
            accessor["normalized"] = true.into();
        }
        self.add("accessors", accessor)
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.add("bufferViews", view)
    }

    pub fn add(&mut self, list: &str, value: Value) -> usize {
        let list = self.json[list].as_array_mut().expect("a list");
        list.push(value);
        list.len() - 1
    }

    /// The whole file.
    pub fn bytes(mut self) -> Vec<u8> {
        self.json["buffers"] = json!([{ "byteLength": self.bytes.len() }]);
        let mut json = serde_json::to_vec(&self.json).expect("JSON");
        json.resize(json.len().next_multiple_of(4), b' ');
        let length = |bytes: &[u8]| (bytes.len() as u32).to_le_bytes();
        let whole = (12 + 8 + json.len() + 8 + self.bytes.len()) as u32;
        let head = [&b"glTF"[..], &2_u32.to_le_bytes(), &whole.to_le_bytes()].concat();
        [&head[..], &length(&json), b"JSON", &json, &length(&self.bytes), b"BIN\0", &self.bytes].concat()
    }
}
