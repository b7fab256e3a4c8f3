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

/// What is to be one cloth: a primitive of an object, or all of them, as a garment.
struct Piece<'a> {
    /// The primitive's entity, or that of the object.
    entity: Entity,
    parts: &'a [Part],
    properties: Properties,
}

impl Scenery<'_, '_> {
    /// Makes cloth of an object's mesh, where it, its mesh, or a material says so. What it leaves open the whole scene may say. Returns the
    /// entities that are cloth.
    pub(super) fn make_garment(&mut self, node: &Node, of_all: &Properties, bones: &HashSet<Entity>) -> Vec<Entity> {
        let pieces = self.pieces(node);
        for piece in &pieces {
            self.make_cloth(node, piece, &piece.properties.clone().or(of_all), bones);
        }
        for part in &node.parts {
            let properties = node.properties.clone().or(&part.properties);
            if properties.cloth.is_none()
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
        pieces.into_iter().map(|piece| piece.entity).collect()
    }

    /// What becomes cloth of an object. Its materials make one garment, if all of them are the same cloth; else each is cloth for itself.
    fn pieces<'a>(&mut self, node: &'a Node) -> Vec<Piece<'a>> {
        let piece = |part: &'a Part| {
            let properties = node.properties.clone().or(&part.properties);
            let is_cloth = properties.is_cloth();
            is_cloth.then(|| Piece { entity: part.entity, parts: core::slice::from_ref(part), properties })
        };
        let mut pieces: Vec<Piece> = node.parts.iter().filter_map(piece).collect();
        let is_one = pieces.len() > 1
            && pieces.len() == node.parts.len()
            && pieces.iter().all(|piece| piece.properties == pieces[0].properties);
        if is_one && self.has_other_meshes(node) {
            self.report.warn(
                &node.subject,
                "its materials are a cloth each, as it has objects with meshes below it, which would be sewn to it; move them elsewhere",
            );
        } else if is_one {
            let properties = pieces.swap_remove(0).properties;
            pieces = vec![Piece { entity: node.entity, parts: &node.parts, properties }];
        }
        pieces
    }

    /// Whether there are meshes below an object that aren't its own.
    fn has_other_meshes(&self, node: &Node) -> bool {
        let below = |entity: Entity| self.world.get::<Children>(entity).into_iter().flatten().copied();
        let mut next: Vec<Entity> = below(node.entity).collect();
        while let Some(entity) = next.pop() {
            let is_own = node.parts.iter().any(|part| part.entity == entity);
            if self.world.get::<Mesh3d>(entity).is_some() && !is_own {
                return true;
            }
            next.extend(below(entity));
        }
        false
    }

    fn make_cloth(&mut self, node: &Node, piece: &Piece, properties: &Properties, bones: &HashSet<Entity>) {
        let painted = Painted::joined(piece.parts.iter().map(|part| self.painted_on(part.entity)));
        let is_skinned = piece.parts.iter().all(|part| part.is_skinned);
        let timing = if !is_skinned && self.hangs_on(node.entity, bones) {
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
        let pins = self.pins(node, is_skinned, properties, &painted);
        self.world.entity_mut(piece.entity).insert((cloth, pins));
        if is_skinned {
            self.world.entity_mut(piece.entity).insert(skin(properties));
        } else if let Some(name) = properties.of_skin().filter(|_| node.properties.of_skin().is_some()) {
            self.report.warn(&node.subject, format_args!("{name} does nothing: its mesh follows no armature"));
        }
        self.give_fabric(node, piece.entity, properties);
    }

    /// What is painted on the mesh of a part.
    fn painted_on(&self, part: Entity) -> Painted {
        let path = self.world.get::<Mesh3d>(part).and_then(|mesh| mesh.0.path());
        let label = path.and_then(|path| path.label());
        label.and_then(|label| self.painted.get(label)).cloned().unwrap_or_default()
    }

    /// The pins that cloth has by its properties and by what is painted on it. Says so where that can't be meant.
    fn pins(&mut self, node: &Node, is_skinned: bool, properties: &Properties, painted: &Painted) -> Pins {
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
            let what = if is_skinned { held } else { falls };
            self.report.warn(
                &node.subject,
                format_args!("nothing holds it: _CLOTH is nowhere 0, so {what}; paint 0 on what is to be held"),
            );
        }
        // On a skeleton `ClothSkin` does that.
        if !is_skinned && !fixed.is_empty() { pins.and(Pins::indices(fixed)) } else { pins }
    }

    fn give_fabric(&mut self, node: &Node, cloth: Entity, properties: &Properties) {
        match &properties.cloth {
            Some(WhatCloth::Preset(fabric)) => {
                self.world.entity_mut(cloth).insert(Fabric::clone(fabric));
            }
            Some(WhatCloth::File(file)) => match self.context.path().resolve_embed_str(file) {
                Ok(path) => {
                    let fabric = FabricHandle::new(self.context.load(path));
                    self.world.entity_mut(cloth).insert(fabric);
                }
                Err(error) => {
                    self.report.warn(&node.subject, format_args!("cloth is {file}, which is no path: {error}"));
                }
            },
            _ => {}
        }
    }
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
