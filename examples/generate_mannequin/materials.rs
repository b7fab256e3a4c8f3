//! The materials, plain colours.

use serde_json::{Value, json};

pub const BODY: usize = 0;
pub const CAPE: usize = 1;
pub const SKIRT: usize = 2;
pub const TUNIC: usize = 3;
pub const TRIM: usize = 4;

pub fn materials() -> Value {
    json!([
        {
            "name": "Body",
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.62, 0.47, 0.33, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.55,
            },
        },
        cloth("Cape", [0.33, 0.03, 0.05]),
        cloth("Skirt", [0.05, 0.11, 0.25]),
        cloth("Tunic", [0.72, 0.66, 0.52]),
        cloth("Trim", [0.55, 0.30, 0.05]),
    ])
}

fn cloth(name: &str, [red, green, blue]: [f32; 3]) -> Value {
    json!({
        "name": name,
        "doubleSided": true,
        "pbrMetallicRoughness": {
            "baseColorFactor": [red, green, blue, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9,
        },
    })
}
