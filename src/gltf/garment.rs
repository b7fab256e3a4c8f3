//! Makes cloth of the meshes that are to be.

use bevy::{platform::collections::HashSet, prelude::*};

use super::{
    node::{Node, Part},
    paint::Painted,
    property::{Properties, WhatCloth},
    scene::Scenery,
};
use crate::{
    cloth::{Cloth, ClothTiming},
    fabric::{Fabric, handle::FabricHandle},
    pins::{ATTRIBUTE_PIN, Pins},
    skin::{ClothMap, ClothSkin, FIXED},
};

impl Scenery<'_, '_> {
    /// Makes cloth of a node's mesh, where it, its mesh, or a material says so. What it leaves open the whole scene may say. Whether
    /// any is.
    pub(super) fn make_garment(&mut self, node: &Node, of_all: &Properties, bones: &HashSet<Entity>) -> bool {
        let mut is_any = false;
        for part in cloth_parts(node) {
            let properties = node.properties.clone().or(&part.properties);
            if properties.is_cloth() {
                is_any = true;
                self.make_cloth(node, part, &properties.or(of_all), bones);
            } else if properties.cloth.is_none()
                && let Some(name) = properties.of_cloth()
            {
                self.report
                    .warn(&node.subject, format_args!("{name} does nothing without the property `cloth`; add that"));
            }
        }
        let misplaced = node.properties.is_cloth().then_some("cloth").or_else(|| node.properties.of_cloth());
        if let Some(name) = misplaced.filter(|_| node.parts.is_empty()) {
            self.report.warn(
                &node.subject,
                format_args!("{name} does nothing where there is no mesh; write it on an object that has one"),
            );
        }
        is_any
    }

    fn make_cloth(&mut self, node: &Node, part: &Part, properties: &Properties, bones: &HashSet<Entity>) {
        let painted = self.painted_on(part.entity);
        let timing = if !part.is_skinned && self.hangs_on(node.entity, bones) {
            ClothTiming::Late // with the animation that moves it
        } else {
            ClothTiming::Auto
        };
        let defaults = Cloth::default();
        let cloth = Cloth {
            timing,
            self_collision: properties.self_collision.unwrap_or(defaults.self_collision),
            collision_layers: properties.layers.unwrap_or(defaults.collision_layers),
            collision_mask: properties.mask.unwrap_or(defaults.collision_mask),
            ..defaults
        };
        let pins = self.pins(node, part, properties, &painted);
        self.world.entity_mut(part.entity).insert((cloth, pins));
        if part.is_skinned {
            self.world.entity_mut(part.entity).insert(skin(properties));
        } else if let Some(name) = properties.of_skin().filter(|_| node.properties.of_skin().is_some()) {
            self.report.warn(&node.subject, format_args!("{name} does nothing: its mesh follows no armature"));
        }
        self.give_fabric(node, part, properties);
    }

    /// What is painted on the mesh of a part.
    fn painted_on(&self, part: Entity) -> Painted {
        let path = self.world.get::<Mesh3d>(part).and_then(|mesh| mesh.0.path());
        let label = path.and_then(|path| path.label());
        label.and_then(|label| self.painted.get(label)).cloned().unwrap_or_default()
    }

    /// The pins that a part has by its properties and by what is painted on it. Says so where that can't be meant.
    fn pins(&mut self, node: &Node, part: &Part, properties: &Properties, painted: &Painted) -> Pins {
        let mut pins = properties.pin.clone().map_or_else(Pins::none, Pins::from);
        match painted.is_pinned {
            Some(true) => pins = pins.and(Pins::attribute(ATTRIBUTE_PIN)),
            Some(false) => {
                self.report.warn(&node.subject, "_PIN is painted and pins nothing; paint 1 on what is to be pinned");
            }
            None => {}
        }
        let Some(looseness) = &painted.looseness else { return pins };
        let scale = properties.max_distance.unwrap_or(1.0);
        let fixed: Vec<u32> = (0..).zip(looseness).filter(|(_, it)| *it * scale < FIXED).map(|(i, _)| i).collect();
        if fixed.len() == looseness.len() {
            self.report.warn(
                &node.subject,
                "there is nothing to simulate: _CLOTH, times cloth_max_distance, is 0 all over; paint more on what is to be loose",
            );
        } else if fixed.is_empty() && pins.groups.is_empty() {
            let (held, falls) = ("it may slide about on its body", "it falls");
            let what = if part.is_skinned { held } else { falls };
            self.report.warn(
                &node.subject,
                format_args!("nothing holds it: _CLOTH is nowhere 0, so {what}; paint 0 on what is to be held"),
            );
        }
        // On a skeleton `ClothSkin` does that.
        if !part.is_skinned && !fixed.is_empty() { pins.and(Pins::indices(fixed)) } else { pins }
    }

    fn give_fabric(&mut self, node: &Node, part: &Part, properties: &Properties) {
        match &properties.cloth {
            Some(WhatCloth::Preset(fabric)) => {
                self.world.entity_mut(part.entity).insert(Fabric::clone(fabric));
            }
            Some(WhatCloth::File(file)) => match self.context.path().resolve_embed_str(file) {
                Ok(path) => {
                    let fabric = FabricHandle::new(self.context.load(path));
                    self.world.entity_mut(part.entity).insert(fabric);
                }
                Err(error) => {
                    self.report.warn(&node.subject, format_args!("cloth is {file}, which is no path: {error}"));
                }
            },
            _ => {}
        }
    }
}

/// The parts of a node that become cloth, each for itself. A garment of several materials is several cloths.
fn cloth_parts(node: &Node) -> &[Part] {
    &node.parts
}

/// How closely cloth follows its skeleton.
fn skin(properties: &Properties) -> ClothSkin {
    let defaults = ClothSkin::default();
    ClothSkin {
        max_distance: ClothMap::Painted {
            scale: properties.max_distance.unwrap_or(1.0),
            missing: properties.max_distance.unwrap_or(f32::INFINITY),
        },
        backstop: properties.backstop,
        backstop_radius: properties.backstop_radius.unwrap_or(defaults.backstop_radius),
        pull: properties.pull.unwrap_or(defaults.pull),
        ..defaults
    }
}
