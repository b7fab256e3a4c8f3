//! Makes obstacles of objects and bones.

use bevy::{camera::primitives::Aabb, math::bounding::Aabb3d, prelude::*};

use super::{
    node::{self, Node},
    property::WhatCollider,
    scene::Scenery,
};
use crate::surroundings::collider::ClothCollider;

/// Radius of a capsule on a bone that says none, in lengths of the bone.
const SLENDERNESS: f32 = 0.2;

impl Scenery<'_, '_> {
    /// Makes an obstacle of a node, where it asks for one.
    pub(super) fn make_collider(&mut self, node: &Node) {
        let Some(collider) = node.properties.collider else {
            if node.properties.radius.is_some() {
                let problem = "cloth_radius does nothing without the property `cloth_collider`; add that";
                self.report.warn(&node.subject, problem);
            }
            return;
        };
        match collider {
            WhatCollider::None => {}
            WhatCollider::Hull | WhatCollider::Mesh if node.parts.is_empty() => {
                let problem = "cloth_collider needs a mesh to be that; make it a capsule, a box or a sphere";
                self.report.warn(&node.subject, problem);
            }
            WhatCollider::Hull | WhatCollider::Mesh => self.collide_by_triangles(node, collider),
            _ if node.parts.iter().any(|part| part.is_skinned) => {
                let problem = "cloth_collider wouldn't follow the armature; make it a mesh, or write it on bones";
                self.report.warn(&node.subject, problem);
            }
            _ => match self.bounds(node) {
                Some(bounds) => self.collide_by_solid(node, around_box(collider, bounds, node.properties.radius)),
                None => self.collide_by_bone(node, collider),
            },
        }
    }

    #[cfg(feature = "mesh_colliders")]
    fn collide_by_triangles(&mut self, node: &Node, collider: WhatCollider) {
        for part in &node.parts {
            let shape =
                if collider == WhatCollider::Mesh { ClothCollider::mesh() } else { ClothCollider::convex_hull() };
            self.world.entity_mut(part.entity).insert(in_layers_of(node, shape));
        }
    }

    #[cfg(not(feature = "mesh_colliders"))]
    fn collide_by_triangles(&mut self, node: &Node, _collider: WhatCollider) {
        let problem = "cloth_collider needs the feature `mesh_colliders` of bevy_drape to be that; enable it";
        self.report.warn(&node.subject, problem);
    }

    /// A capsule from the bone's beginning to that of the next one; for an empty or the last bone, a ball.
    fn collide_by_bone(&mut self, node: &Node, collider: WhatCollider) {
        let end = self.end_of_bone(node.entity);
        let Some(radius) = node.properties.radius.or(end.map(|end| SLENDERNESS * end.length())) else {
            let problem = "cloth_collider has no size, since no bone follows this one; add cloth_radius";
            self.report.warn(&node.subject, problem);
            return;
        };
        self.collide_by_solid(node, along_bone(collider, end.unwrap_or(Vec3::ZERO), radius));
    }

    /// On an entity of its own, since a solid has its own middle and turn.
    fn collide_by_solid(&mut self, node: &Node, (shape, transform): (ClothCollider, Transform)) {
        let name = format!("{} collider", node::name(self.world, node.entity));
        let collider = in_layers_of(node, shape);
        self.world.spawn((Name::new(name), collider, transform, ChildOf(node.entity)));
    }

    /// The box around the parts of a node, in its own space. None for one without a mesh.
    fn bounds(&self, node: &Node) -> Option<Aabb3d> {
        let boxes = node.parts.iter().filter_map(|part| {
            let bounds = self.world.get::<Aabb>(part.entity)?;
            let turned = self.world.get::<Transform>(part.entity)?.compute_affine();
            let corner = |i: u32| {
                let side = Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 2.0 - 1.0;
                turned.transform_point3(Vec3::from(bounds.center) + side * Vec3::from(bounds.half_extents))
            };
            Some(Aabb3d::from_point_cloud(Isometry3d::IDENTITY, (0..8).map(corner)))
        });
        boxes.reduce(|one, other| Aabb3d { min: one.min.min(other.min), max: one.max.max(other.max) })
    }

    /// Where the next bone begins: of several, the one that is farthest along the Y axis, as a bone of Blender is.
    fn end_of_bone(&self, bone: Entity) -> Option<Vec3> {
        let children = self.world.get::<Children>(bone).into_iter().flatten();
        let places = children.filter(|&&child| self.world.get::<Mesh3d>(child).is_none());
        let places = places.filter_map(|&child| Some(self.world.get::<Transform>(child)?.translation));
        places.filter(|place| place.length() > 1e-4).max_by(|one, other| one.y.total_cmp(&other.y))
    }
}

fn in_layers_of(node: &Node, collider: ClothCollider) -> ClothCollider {
    match node.properties.layers {
        Some(layers) => collider.in_layers(layers),
        None => collider,
    }
}

/// A solid that fills a box, or has a radius of its own in the middle of it.
fn around_box(collider: WhatCollider, bounds: Aabb3d, radius: Option<f32>) -> (ClothCollider, Transform) {
    let half_size = Vec3::from(bounds.max - bounds.min) / 2.0;
    let middle = Transform::from_translation(Vec3::from(bounds.min + bounds.max) / 2.0);
    let (axis, turn) = match half_size {
        Vec3 { x, y, z } if x > y && x >= z => (half_size, Quat::from_rotation_arc(Vec3::Y, Vec3::X)),
        Vec3 { y, z, .. } if z > y => (half_size.zxy(), Quat::from_rotation_arc(Vec3::Y, Vec3::Z)),
        _ => (half_size.yzx(), Quat::IDENTITY),
    };
    match collider {
        WhatCollider::Box => (Cuboid { half_size }.into(), middle),
        WhatCollider::Sphere => (Sphere::new(radius.unwrap_or(half_size.max_element())).into(), middle),
        _ => {
            let radius = radius.unwrap_or(axis.y.max(axis.z)).min(axis.x);
            (Capsule3d::new(radius, 2.0 * (axis.x - radius)).into(), middle.with_rotation(turn))
        }
    }
}

/// A solid from a bone's beginning to its `end`.
fn along_bone(collider: WhatCollider, end: Vec3, radius: f32) -> (ClothCollider, Transform) {
    let length = end.length();
    let turn = Quat::from_rotation_arc(Vec3::Y, end.normalize_or(Vec3::Y));
    let middle = Transform::from_translation(end / 2.0).with_rotation(turn);
    match collider {
        WhatCollider::Box => {
            let half_size = Vec3::new(radius, (length / 2.0).max(radius), radius);
            (Cuboid { half_size }.into(), middle)
        }
        WhatCollider::Sphere => (Sphere::new(radius).into(), Transform::IDENTITY),
        _ => (Capsule3d::new(radius, length).into(), middle),
    }
}
