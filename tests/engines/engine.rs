//! Both engines, as far as the tests need them, behind one face.

use avian3d::prelude as avian;
use bevy::prelude::*;
use bevy_drape::prelude::*;
use bevy_rapier3d::prelude as rapier;

use crate::common::{STEP, headless_with};

/// A physics engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Engine {
    Avian,
    Rapier,
}

/// Shapes that both engines have.
#[derive(Clone, Debug)]
pub enum Form {
    Ball(f32),
    /// By its half sizes.
    Cuboid(Vec3),
    /// Between two places.
    Capsule(Vec3, Vec3, f32),
    /// By its height and radius.
    Cylinder(f32, f32),
    /// By its height and radius.
    Cone(f32, f32),
    /// By its half sizes and the radius around.
    RoundCuboid(Vec3, f32),
    /// By its outward normal.
    HalfSpace(Vec3),
    /// By its corners.
    Hull(Vec<Vec3>),
    /// By its corners and triangles.
    Mesh(Vec<Vec3>, Vec<[u32; 3]>),
    Compound(Vec<(Vec3, Form)>),
}

pub const BOTH: [Engine; 2] = [Engine::Avian, Engine::Rapier];

impl Engine {
    /// An app with cloth and this engine, at 60 Hz: each update runs one step of both.
    pub fn app(self) -> App {
        let mut app = match self {
            Self::Avian => headless_with((avian_plugins(), ClothPlugin::default())),
            Self::Rapier => headless_with((rapier_plugins(), ClothPlugin::default())),
        };
        app.update();
        app
    }

    /// A body that nothing moves, with a collider.
    pub fn fixed(self, app: &mut App, form: &Form, at: Transform) -> Entity {
        let entity = app.world_mut().spawn(at).id();
        self.insert(app, entity, form);
        let mut entity = app.world_mut().entity_mut(entity);
        match self {
            Self::Avian => entity.insert(avian::RigidBody::Static),
            Self::Rapier => entity.insert(rapier::RigidBody::Fixed),
        };
        entity.id()
    }

    /// A body that forces move, with a collider and a mass in kg.
    pub fn dynamic(self, app: &mut App, form: &Form, mass: f32, at: Transform) -> Entity {
        let entity = app.world_mut().spawn(at).id();
        self.insert(app, entity, form);
        let mut entity = app.world_mut().entity_mut(entity);
        match self {
            Self::Avian => entity.insert((avian::RigidBody::Dynamic, avian::Mass(mass))),
            Self::Rapier => entity.insert((
                rapier::RigidBody::Dynamic,
                rapier::ColliderMassProperties::Mass(mass),
                rapier::Velocity::default(),
            )),
        };
        entity.id()
    }

    /// Gives an entity a collider, and nothing else.
    pub fn insert(self, app: &mut App, entity: Entity, form: &Form) {
        let mut entity = app.world_mut().entity_mut(entity);
        match self {
            Self::Avian => entity.insert(form.for_avian()),
            Self::Rapier => entity.insert(form.for_rapier()),
        };
    }

    pub fn set_gravity(self, app: &mut App, gravity: Vec3) {
        match self {
            Self::Avian => app.insert_resource(avian::Gravity(gravity)),
            Self::Rapier => {
                let world = app.world_mut();
                world.query::<&mut rapier::RapierConfiguration>().single_mut(world).unwrap().gravity = gravity;
                app
            }
        };
    }

    pub fn velocity(self, app: &App, entity: Entity) -> Vec3 {
        match self {
            Self::Avian => app.world().get::<avian::LinearVelocity>(entity).unwrap().0,
            Self::Rapier => app.world().get::<rapier::Velocity>(entity).unwrap().linear,
        }
    }

    pub fn set_velocity(self, app: &mut App, entity: Entity, velocity: Vec3) {
        let mut entity = app.world_mut().entity_mut(entity);
        match self {
            Self::Avian => entity.get_mut::<avian::LinearVelocity>().unwrap().0 = velocity,
            Self::Rapier => entity.get_mut::<rapier::Velocity>().unwrap().linear = velocity,
        }
    }
}

pub fn avian_plugins() -> impl Plugin {
    |app: &mut App| {
        app.add_plugins((avian::PhysicsPlugins::default(), ClothAvianPlugin));
    }
}

pub fn rapier_plugins() -> impl Plugin {
    |app: &mut App| {
        app.insert_resource(rapier::TimestepMode::Fixed { dt: STEP, substeps: 1 }).add_plugins((
            rapier::RapierPhysicsPlugin::<rapier::NoUserData>::default().in_fixed_schedule(),
            ClothRapierPlugin,
        ));
    }
}

impl Form {
    pub fn for_avian(&self) -> avian::Collider {
        use avian3d::parry::shape::SharedShape;
        match self {
            &Self::Ball(radius) => avian::Collider::sphere(radius),
            &Self::Cuboid(half) => avian::Collider::cuboid(2.0 * half.x, 2.0 * half.y, 2.0 * half.z),
            &Self::Capsule(a, b, radius) => avian::Collider::capsule_endpoints(radius, a, b),
            &Self::Cylinder(height, radius) => avian::Collider::cylinder(radius, height),
            &Self::Cone(height, radius) => avian::Collider::cone(radius, height),
            &Self::RoundCuboid(half, radius) => SharedShape::round_cuboid(half.x, half.y, half.z, radius).into(),
            &Self::HalfSpace(normal) => avian::Collider::half_space(normal),
            Self::Hull(corners) => avian::Collider::convex_hull(corners.clone()).unwrap(),
            Self::Mesh(corners, triangles) => avian::Collider::trimesh(corners.clone(), triangles.clone()),
            Self::Compound(forms) => {
                let forms = forms.iter().map(|(at, form)| (*at, Quat::IDENTITY, form.for_avian()));
                avian::Collider::compound(forms.collect())
            }
        }
    }

    pub fn for_rapier(&self) -> rapier::Collider {
        match self {
            &Self::Ball(radius) => rapier::Collider::ball(radius),
            &Self::Cuboid(half) => rapier::Collider::cuboid(half.x, half.y, half.z),
            &Self::Capsule(a, b, radius) => rapier::Collider::capsule(a, b, radius),
            &Self::Cylinder(height, radius) => rapier::Collider::cylinder(height / 2.0, radius),
            &Self::Cone(height, radius) => rapier::Collider::cone(height / 2.0, radius),
            &Self::RoundCuboid(half, radius) => rapier::Collider::round_cuboid(half.x, half.y, half.z, radius),
            &Self::HalfSpace(normal) => rapier::Collider::halfspace(normal).unwrap(),
            Self::Hull(corners) => rapier::Collider::convex_hull(corners).unwrap(),
            Self::Mesh(corners, triangles) => rapier::Collider::trimesh(corners.clone(), triangles.clone()).unwrap(),
            Self::Compound(forms) => {
                let forms = forms.iter().map(|(at, form)| (*at, Quat::IDENTITY, form.for_rapier()));
                rapier::Collider::compound(forms.collect())
            }
        }
    }
}
