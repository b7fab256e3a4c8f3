//! Custom properties: what an artist may write on objects, bones, meshes, materials and scenes.

use bevy::prelude::*;
use serde_json::Value;

use super::report::{Report, nearest};
use crate::{fabric::Fabric, pins::PinSelector};

mod value;

/// What a property is written on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    Scene,
    /// An object, a bone, an armature or an empty.
    Node,
    Mesh,
    Material,
}

/// The properties of one of these, by what they mean.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Properties {
    pub cloth: Option<WhatCloth>,
    pub max_distance: Option<f32>,
    pub backstop: Option<f32>,
    pub backstop_radius: Option<f32>,
    pub pull: Option<f32>,
    pub self_collision: Option<bool>,
    pub layers: Option<u32>,
    pub mask: Option<u32>,
    pub pin: Option<PinSelector>,
    pub proxy: Option<String>,
    pub body: Option<bool>,
    pub collider: Option<WhatCollider>,
    pub radius: Option<f32>,
    pub wind: Option<f32>,
}

/// Whether something is cloth, and of what.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum WhatCloth {
    No,
    /// Of the default fabric, unless a mesh, a material or the scene names one.
    Yes,
    Preset(Box<Fabric>),
    /// A file, from the folder of the glTF file, or from that of all assets if it begins with a slash.
    File(String),
}

/// What an obstacle is like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WhatCollider {
    /// None, and no part of a body either.
    None,
    Capsule,
    Box,
    Sphere,
    Hull,
    Mesh,
}

/// A property.
struct Key {
    name: &'static str,
    places: &'static [Place],
    /// Reads it, or says what it has to be.
    read: fn(&mut Properties, &Value) -> Result<(), String>,
}

const CLOTH: &[Place] = &[Place::Node, Place::Mesh, Place::Material, Place::Scene];
const NODE: &[Place] = &[Place::Node];

/// All of them. `docs/blender.md` has them as a table.
const KEYS: [Key; 14] = [
    Key { name: "cloth", places: CLOTH, read: |it, v| set(&mut it.cloth, value::what_cloth(v)) },
    Key { name: "cloth_max_distance", places: CLOTH, read: |it, v| set(&mut it.max_distance, value::length(v)) },
    Key { name: "cloth_backstop", places: CLOTH, read: |it, v| set(&mut it.backstop, value::length(v)) },
    Key { name: "cloth_backstop_radius", places: CLOTH, read: |it, v| set(&mut it.backstop_radius, value::radius(v)) },
    Key { name: "cloth_pull", places: CLOTH, read: |it, v| set(&mut it.pull, value::frequency(v)) },
    Key { name: "cloth_self", places: CLOTH, read: |it, v| set(&mut it.self_collision, value::switch(v)) },
    Key { name: "cloth_layers", places: CLOTH, read: |it, v| set(&mut it.layers, value::bits(v)) },
    Key { name: "cloth_mask", places: CLOTH, read: |it, v| set(&mut it.mask, value::bits(v)) },
    Key { name: "cloth_pin", places: CLOTH, read: |it, v| set(&mut it.pin, value::pin(v)) },
    Key { name: "cloth_proxy", places: NODE, read: |it, v| set(&mut it.proxy, value::name(v)) },
    Key { name: "cloth_body", places: NODE, read: |it, v| set(&mut it.body, value::switch(v)) },
    Key { name: "cloth_collider", places: NODE, read: |it, v| set(&mut it.collider, value::what_collider(v)) },
    Key { name: "cloth_radius", places: NODE, read: |it, v| set(&mut it.radius, value::radius(v)) },
    Key { name: "cloth_wind", places: NODE, read: |it, v| set(&mut it.wind, value::speed(v)) },
];

impl Properties {
    /// Reads the properties of something out of its extras. What can't be used is left out, with one warning each.
    pub fn read(extras: &str, place: Place, subject: &str, report: &mut Report) -> Self {
        let mut properties = Self::default();
        // Extras may be any JSON, and most aren't ours.
        let Ok(Value::Object(entries)) = serde_json::from_str(extras) else { return properties };
        for (written, value) in &entries {
            let Some(key) = KEYS.iter().find(|key| key.name == written) else {
                if written.to_lowercase().starts_with("cloth") {
                    let guess = nearest(written, KEYS.iter().map(|key| key.name)).unwrap_or("cloth");
                    report.warn(subject, format_args!("no property is called {written}; did you mean {guess}?"));
                }
                continue;
            };
            if !key.places.contains(&place) {
                let belongs = place_names(key.places);
                report.warn(subject, format_args!("{written} does nothing here; write it on {belongs}"));
            } else if let Err(rule) = (key.read)(&mut properties, value) {
                report.warn(subject, format_args!("{written} is {value}, and it has to be {rule}"));
            }
        }
        properties
    }

    /// These, and those of something `weaker` where there are none.
    pub fn or(self, weaker: &Self) -> Self {
        let cloth = match (self.cloth, &weaker.cloth) {
            // It is left open of which fabric.
            (Some(WhatCloth::Yes), Some(of @ (WhatCloth::Preset(_) | WhatCloth::File(_)))) => Some(of.clone()),
            (None, weaker) => weaker.clone(),
            (stronger, _) => stronger,
        };
        let Self { max_distance, backstop, backstop_radius, pull, self_collision, layers, mask, .. } = self;
        Self {
            cloth,
            max_distance: max_distance.or(weaker.max_distance),
            backstop: backstop.or(weaker.backstop),
            backstop_radius: backstop_radius.or(weaker.backstop_radius),
            pull: pull.or(weaker.pull),
            self_collision: self_collision.or(weaker.self_collision),
            layers: layers.or(weaker.layers),
            mask: mask.or(weaker.mask),
            pin: self.pin.or_else(|| weaker.pin.clone()),
            proxy: self.proxy.or_else(|| weaker.proxy.clone()),
            body: self.body.or(weaker.body),
            collider: self.collider.or(weaker.collider),
            radius: self.radius.or(weaker.radius),
            wind: self.wind.or(weaker.wind),
        }
    }

    /// Whether they make something cloth.
    pub fn is_cloth(&self) -> bool {
        self.cloth.as_ref().is_some_and(|cloth| *cloth != WhatCloth::No)
    }

    /// The name of a property that means something only for cloth on an armature, if there is one.
    pub fn of_skin(&self) -> Option<&'static str> {
        [
            ("cloth_max_distance", self.max_distance.is_some()),
            ("cloth_backstop", self.backstop.is_some()),
            ("cloth_backstop_radius", self.backstop_radius.is_some()),
            ("cloth_pull", self.pull.is_some()),
        ]
        .into_iter()
        .find_map(|(name, is_there)| is_there.then_some(name))
    }

    /// The name of a property that means something only for cloth, if there is one.
    pub fn of_cloth(&self) -> Option<&'static str> {
        let others = [
            ("cloth_self", self.self_collision.is_some()),
            ("cloth_layers", self.layers.is_some() && self.collider.is_none()),
            ("cloth_mask", self.mask.is_some()),
            ("cloth_pin", self.pin.is_some()),
        ];
        self.of_skin().or_else(|| others.into_iter().find_map(|(name, is_there)| is_there.then_some(name)))
    }
}

fn place_names(places: &[Place]) -> String {
    let names = places.iter().map(|place| match place {
        Place::Scene => "the scene",
        Place::Node => "an object or a bone",
        Place::Mesh => "a mesh",
        Place::Material => "a material",
    });
    names.collect::<Vec<_>>().join(", ")
}

fn set<T>(field: &mut Option<T>, value: Result<T, String>) -> Result<(), String> {
    *field = Some(value?);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(extras: &str) -> Properties {
        Properties::read(extras, Place::Node, "object", &mut Report::default())
    }

    #[test]
    fn the_page_for_artists_has_every_property() {
        let page = include_str!("../../docs/blender.md");
        for key in KEYS {
            assert!(page.contains(&format!("\n| `{}` |", key.name)), "{}", key.name);
        }
        assert!(Fabric::PRESETS.iter().all(|preset| page.contains(&format!("`{}`", preset.name))));
    }

    #[test]
    fn the_stronger_counts_but_a_fabric_before_none() {
        let (silk, denim) = (read(r#"{"cloth": "silk"}"#), read(r#"{"cloth": "denim", "cloth_pull": 2}"#));
        assert_eq!(read(r#"{"cloth": true}"#).or(&silk).cloth, silk.cloth);
        assert_eq!(silk.clone().or(&denim), Properties { pull: Some(2.0), ..silk.clone() });
        assert!(!read(r#"{"cloth": false}"#).or(&silk).is_cloth());
        assert_eq!(read(r#"{"cloth": true}"#).or(&Properties::default()).cloth, Some(WhatCloth::Yes));
        assert_eq!(read(r#"{"cloth": 1}"#).or(&read(r#"{"cloth": false}"#)).cloth, Some(WhatCloth::Yes));
    }
}
