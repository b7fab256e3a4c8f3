//! Obstacles: entities that cloth drapes over.

use bevy::{
    math::{Affine3A, Isometry3d, Vec3A, primitives::InfinitePlane3d},
    prelude::*,
};

use crate::{
    anchor::Poses,
    solver::{Body, Obstacle, Shape, Solid, TaperedCapsule},
};

/// An obstacle for cloth, moved by its `Transform`.
///
/// Move it in `FixedUpdate` or any schedule that runs once a step: its way since the latest step is what pushes the
/// cloth, and one that moves once a frame comes in jolts where a frame has several steps or none. Removing the component
/// and inserting it again lets it jump without pushing.
///
/// Made from one of Bevy's primitives: `ClothCollider::from(Sphere::new(0.3))`; also from a `Cuboid`, a `Capsule3d`, a [`TaperedCapsule`], a
/// `Cylinder`, a `Cone` and, for a ground, an `InfinitePlane3d`, behind which all is solid. The transform's scale applies; where
/// it isn't uniform, round shapes take its largest factor.
///
/// A collider of no size, or with a transform that isn't finite, is left out, with one warning.
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
#[require(Transform, ColliderMemory)]
pub struct ClothCollider {
    /// Its shape, m, in the entity's own space.
    pub shape: ColliderShape,
    /// Factor on the friction of the cloth that touches it, no unit. 1 by default, 0 for ice.
    pub friction: f32,
    /// Layers that it is in, one a bit. Cloth meets it where this has a bit in common with the cloth's mask.
    pub layers: u32,
}

/// What a collider is like.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Debug, Clone, PartialEq)]
pub enum ColliderShape {
    /// A primitive.
    Solid(Solid),
}

impl Default for ClothCollider {
    /// A ball of half a metre radius.
    fn default() -> Self {
        Sphere::default().into()
    }
}

impl From<ColliderShape> for ClothCollider {
    fn from(shape: ColliderShape) -> Self {
        Self { shape, friction: 1.0, layers: 1 }
    }
}

impl From<Solid> for ClothCollider {
    fn from(solid: Solid) -> Self {
        ColliderShape::Solid(solid).into()
    }
}

impl From<Sphere> for ClothCollider {
    fn from(sphere: Sphere) -> Self {
        Solid::Sphere(sphere).into()
    }
}

impl From<Cuboid> for ClothCollider {
    fn from(cuboid: Cuboid) -> Self {
        Solid::Cuboid(cuboid).into()
    }
}

impl From<Capsule3d> for ClothCollider {
    fn from(capsule: Capsule3d) -> Self {
        Solid::Capsule(capsule).into()
    }
}

impl From<Cylinder> for ClothCollider {
    fn from(cylinder: Cylinder) -> Self {
        Solid::Cylinder(cylinder).into()
    }
}

impl From<TaperedCapsule> for ClothCollider {
    fn from(capsule: TaperedCapsule) -> Self {
        Solid::TaperedCapsule(capsule).into()
    }
}

impl From<Cone> for ClothCollider {
    fn from(cone: Cone) -> Self {
        Solid::Cone(cone).into()
    }
}

impl From<InfinitePlane3d> for ClothCollider {
    fn from(plane: InfinitePlane3d) -> Self {
        Solid::HalfSpace(plane).into()
    }
}

impl ClothCollider {
    /// The same, in other layers.
    pub fn in_layers(mut self, layers: u32) -> Self {
        self.layers = layers;
        self
    }

    /// Shape and world pose under a transform. None where nothing solid is left.
    fn placed(&self, pose: Affine3A) -> Option<(Solid, Isometry3d)> {
        let (scale, rotation, translation) = pose.to_scale_rotation_translation();
        let ColliderShape::Solid(solid) = self.shape;
        let mut solid = scaled(solid, scale.abs())?;
        if let Solid::HalfSpace(plane) = &mut solid {
            // A plane's normal goes by the inverse transpose: exact under any scale, mirrored or not.
            let world = pose.matrix3.inverse().transpose() * Vec3A::from(Vec3::from(plane.normal));
            plane.normal = Dir3::new(rotation.inverse() * Vec3::from(world)).ok()?;
        }
        let pose = Isometry3d::new(translation, rotation);
        let is_finite = pose.translation.is_finite() && pose.rotation.is_finite() && self.friction.is_finite();
        (is_finite && self.friction >= 0.0).then_some((solid, pose))
    }
}

/// A solid under a scale of no negative factors; none where it has no size or none that is finite.
fn scaled(solid: Solid, scale: Vec3) -> Option<Solid> {
    let around = scale.max_element();
    let across = scale.x.max(scale.z);
    let all_positive = |sizes: &[f32]| sizes.iter().all(|&size| size.is_finite() && size > 0.0);
    let (solid, has_size) = match solid {
        Solid::Sphere(Sphere { radius }) => {
            let radius = radius * around;
            (Solid::Sphere(Sphere { radius }), all_positive(&[radius]))
        }
        Solid::Cuboid(Cuboid { half_size }) => {
            let half_size = half_size * scale;
            (Solid::Cuboid(Cuboid { half_size }), all_positive(&half_size.to_array()))
        }
        Solid::Capsule(Capsule3d { radius, half_length }) => {
            let (radius, half_length) = (radius * across, half_length * scale.y);
            let has_size = all_positive(&[radius]) && half_length.is_finite() && half_length >= 0.0;
            (Solid::Capsule(Capsule3d { radius, half_length }), has_size)
        }
        Solid::TaperedCapsule(TaperedCapsule { radius_top, radius_bottom, half_length }) => {
            let (radius_top, radius_bottom) = (radius_top * across, radius_bottom * across);
            let half_length = half_length * scale.y;
            let has_size = all_positive(&[radius_top, radius_bottom]) && half_length.is_finite() && half_length >= 0.0;
            (Solid::TaperedCapsule(TaperedCapsule { radius_top, radius_bottom, half_length }), has_size)
        }
        Solid::Cone(Cone { radius, height }) => {
            let (radius, height) = (radius * across, height * scale.y);
            (Solid::Cone(Cone { radius, height }), all_positive(&[radius, height]))
        }
        Solid::Cylinder(Cylinder { radius, half_height }) => {
            let (radius, half_height) = (radius * across, half_height * scale.y);
            (Solid::Cylinder(Cylinder { radius, half_height }), all_positive(&[radius, half_height]))
        }
        Solid::HalfSpace(_) => (solid, all_positive(&[around])),
    };
    has_size.then_some(solid)
}

/// What is remembered of a collider from step to step.
#[derive(Component, Clone, Copy, Debug, Default)]
pub(crate) struct ColliderMemory {
    /// World pose at the end of the latest step.
    pose: Option<Isometry3d>,
    /// The collider was left out and a warning said so.
    warned: bool,
}

/// Forgets where a collider was: if it comes back, it comes out of nowhere and not from there.
pub(crate) fn on_collider_removed(removed: On<Remove, ClothCollider>, mut commands: Commands) {
    commands.entity(removed.entity).try_remove::<ColliderMemory>();
}

/// All obstacles of the coming step, in world space.
#[derive(Resource, Debug, Default)]
pub(crate) struct Obstacles {
    /// With their entity and layers, in the order of their entities.
    pub list: Vec<(Entity, u32, Obstacle)>,
}

impl Obstacles {
    /// Writes the obstacles that `mask` selects into `near`, relative to `origin`, and whose they are into `owners`.
    pub fn around(&self, origin: Vec3, mask: u32, near: &mut Vec<Obstacle>, owners: &mut Vec<Entity>) {
        let origin = Vec3A::from(origin);
        let relative = |pose: Isometry3d| Isometry3d::new(pose.translation - origin, pose.rotation);
        let selected = || self.list.iter().filter(|(_, layers, _)| layers & mask != 0);
        near.clear();
        near.extend(selected().map(|(_, _, obstacle)| Obstacle {
            start: relative(obstacle.start),
            end: relative(obstacle.end),
            body: obstacle.body.map(|body| Body { centre: body.centre - origin, ..body }),
            ..obstacle.clone()
        }));
        owners.clear();
        owners.extend(selected().map(|&(entity, ..)| entity));
    }
}

/// Reads all colliders and how they have moved since the latest step.
pub(crate) fn gather_obstacles(
    mut colliders: Query<(Entity, &ClothCollider, &mut ColliderMemory)>,
    mut obstacles: ResMut<Obstacles>,
    poses: Poses,
) {
    obstacles.list.clear();
    for (entity, collider, mut memory) in &mut colliders {
        let pose = poses.compute_global_transform(entity);
        let placed = pose.ok().and_then(|pose| collider.placed(pose.affine()));
        let Some((solid, end)) = placed else {
            if !memory.warned {
                warn!(
                    "collider {entity} is left out: give its shape, friction and transform finite values, and its \
                     shape a size greater than zero"
                );
            }
            *memory = ColliderMemory { pose: None, warned: true };
            continue;
        };
        let start = memory.pose.unwrap_or(end);
        *memory = ColliderMemory { pose: Some(end), warned: false };
        let friction = collider.friction;
        let obstacle = Obstacle { shape: Shape::Solid(solid), start, end, friction, body: None };
        obstacles.list.push((entity, collider.layers, obstacle));
    }
    // Contact comes out the same whatever order the world keeps its entities in.
    obstacles.list.sort_unstable_by_key(|&(entity, ..)| entity);
}
