//! The file: a glTF document of armature, meshes, skin and animations.

use std::error::Error;

use serde_json::{Value, json};

use super::{
    anatomy::Anatomy,
    body::body,
    cape::{cape, cape_fine},
    clips::{Clip, clips},
    glb::{self, Binary, Purpose},
    materials::materials,
    mesh::{Model, Primitive},
    skeleton::{COUNT, JOINTS, PELVIS},
    skirt::skirt,
    tunic::tunic,
};

pub fn file() -> Result<Vec<u8>, Box<dyn Error>> {
    let anatomy = Anatomy::new();
    let models = [body(&anatomy), cape(&anatomy), skirt(&anatomy), tunic(&anatomy), cape_fine(&anatomy)];
    let mut binary = Binary::default();
    let meshes: Vec<Value> = models.iter().map(|model| mesh(model, &mut binary)).collect();
    let inverse_binds: Vec<_> = JOINTS.iter().map(|joint| joint.inverse_bind()).collect();
    let inverse_binds = binary.floats(&inverse_binds, Purpose::Other);
    let animations: Vec<Value> = clips().iter().map(|clip| animation(clip, &mut binary)).collect();
    let document = json!({
        "asset": { "version": "2.0", "generator": "bevy_drape, examples/generate_mannequin" },
        "scene": 0,
        "scenes": [{ "nodes": [COUNT] }],
        "nodes": nodes(&models),
        "meshes": meshes,
        "skins": [{
            "name": "Mannequin", "skeleton": PELVIS, "inverseBindMatrices": inverse_binds,
            "joints": (0..COUNT).collect::<Vec<_>>(),
        }],
        "materials": materials(),
        "animations": animations,
    });
    glb::file(document, binary)
}

/// The joints by their numbers, then the armature, which has skeleton and meshes below it.
fn nodes(models: &[Model]) -> Vec<Value> {
    let mut nodes: Vec<Value> = (0..COUNT).map(joint).collect();
    let meshes = COUNT + 1..=COUNT + models.len();
    nodes.push(json!({
        "name": "Mannequin",
        "children": core::iter::once(PELVIS).chain(meshes).collect::<Vec<_>>(),
        "extras": { "cloth_body": true },
    }));
    for (index, model) in models.iter().enumerate() {
        let mut node = json!({ "name": model.name, "mesh": index, "skin": 0 });
        if !model.extras.is_null() {
            node["extras"] = model.extras.clone();
        }
        nodes.push(node);
    }
    nodes
}

fn joint(index: usize) -> Value {
    let joint = &JOINTS[index];
    let (place, turn) = joint.local();
    let mut node = json!({ "name": joint.name, "translation": place.to_array(), "rotation": turn.to_array() });
    let children: Vec<usize> = (0..COUNT).filter(|&child| JOINTS[child].parent == Some(index)).collect();
    if !children.is_empty() {
        node["children"] = children.into();
    }
    // Arms that swing through a cape would hook on it.
    if ["lower_arm", "hand"].iter().any(|limb| joint.name.starts_with(limb)) {
        node["extras"] = json!({ "cloth_collider": "none" });
    }
    node
}

fn mesh(model: &Model, binary: &mut Binary) -> Value {
    let primitives: Vec<Value> = model.primitives.iter().map(|part| primitive(part, binary)).collect();
    json!({ "name": model.name, "primitives": primitives })
}

fn primitive(primitive: &Primitive, binary: &mut Binary) -> Value {
    let mut attributes = json!({
        "POSITION": binary.floats(&primitive.positions, Purpose::Vertices),
        "NORMAL": binary.floats(&primitive.normals, Purpose::Vertices),
        "JOINTS_0": binary.joints(&primitive.joints),
        "WEIGHTS_0": binary.weights(&primitive.weights),
    });
    if !primitive.uvs.is_empty() {
        attributes["TEXCOORD_0"] = binary.floats(&primitive.uvs, Purpose::Vertices).into();
        attributes["_CLOTH"] = binary.floats(&primitive.looseness, Purpose::Vertices).into();
    }
    json!({
        "attributes": attributes,
        "indices": binary.indices(&primitive.indices),
        "material": primitive.material,
    })
}

/// A sampler for the pelvis' place, and one for each joint's turn.
fn animation(clip: &Clip, binary: &mut Binary) -> Value {
    let times = binary.floats(&clip.times, Purpose::Other);
    let sampler = |output: usize| json!({ "input": times, "interpolation": "LINEAR", "output": output });
    let mut samplers = vec![sampler(binary.floats(&clip.places, Purpose::Other))];
    let mut channels = vec![json!({ "sampler": 0, "target": { "node": PELVIS, "path": "translation" } })];
    for (joint, turns) in clip.turns.iter().enumerate() {
        channels.push(json!({ "sampler": samplers.len(), "target": { "node": joint, "path": "rotation" } }));
        samplers.push(sampler(binary.floats(turns, Purpose::Other)));
    }
    json!({ "name": clip.name, "samplers": samplers, "channels": channels })
}
