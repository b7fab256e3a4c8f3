//! A cloth falls on a ball, or a table, over a ground.

use std::{io, sync::Arc};

use bevy::{
    math::{Isometry3d, Mat3A, Vec3A, primitives::InfinitePlane3d},
    prelude::*,
};
use bevy_drape::{
    build,
    solver::{MeshShape, Shape, Solid, Topology, TriangleMesh},
};

use super::{Cloth, Scene, Settings};

/// The ground, at 0.
pub const GROUND: Solid = Solid::HalfSpace(InfinitePlane3d { normal: Dir3::Y });

/// The ball.
const RADIUS: f32 = 0.3;
pub const CENTRE: Vec3 = Vec3::new(0.0, 0.15, 0.0);

/// How high the top of what is below the cloth is, m.
const TOP: f32 = CENTRE.y + RADIUS;

/// How high the lowest of the cloth is at first, m.
const HEIGHT: f32 = 0.75;

/// The cloth with its lowest point at 0.75 m.
pub fn raised(cloth: Cloth) -> Cloth {
    let lowest = cloth.topology.rest.iter().map(|p| p.y).fold(f32::INFINITY, f32::min);
    let mut cloth = cloth;
    for place in &mut cloth.particles.position {
        place.y += HEIGHT - lowest;
    }
    cloth
}

/// On a ball of 0.3 m radius at (0, 0.15, 0).
pub fn on_ball(settings: &Settings, cloths: impl IntoIterator<Item = Cloth>) -> Scene {
    Scene::new(settings, cloths).with(Solid::Sphere(Sphere::new(RADIUS)), CENTRE).with(GROUND, Vec3::ZERO)
}

/// On a table of 0.5 m x 0.5 m whose top is as high as that of the ball.
pub fn on_table(settings: &Settings, cloth: Cloth) -> Scene {
    let table = Cuboid::new(0.5, TOP, 0.5);
    Scene::new(settings, [cloth]).with(Solid::Cuboid(table), Vec3::Y * (0.5 * TOP)).with(GROUND, Vec3::ZERO)
}

/// With so many more such balls around it, which are too far away for the cloth to reach.
pub fn among(scene: Scene, others: u32) -> Scene {
    // m, rad
    const NEAREST: f32 = 2.0;
    const GOLDEN_ANGLE: f32 = 2.399_963;
    (0..others).map(|i| i as f32).fold(scene, |scene, i| {
        let place = Quat::from_rotation_y(i * GOLDEN_ANGLE) * Vec3::X * (NEAREST + RADIUS * i.sqrt());
        scene.with(Solid::Sphere(Sphere::new(RADIUS)), place + CENTRE)
    })
}

/// The same ball of 20,480 triangles.
pub fn on_mesh(settings: &Settings, cloth: Cloth, is_closed: bool) -> io::Result<Scene> {
    const SUBDIVISIONS: u32 = 31;
    let ball = Sphere::new(RADIUS).mesh().ico(SUBDIVISIONS).map_err(io::Error::other)?;
    // Welds it, as the vertices of a mesh may stand at one place.
    let Topology { rest, triangles, .. } = build::topology_of(&ball, Mat3A::IDENTITY).map_err(io::Error::other)?;
    let points: Vec<Vec3A> = rest.into_iter().map(Vec3A::from).collect();
    let height = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(|i| points[i as usize]);
        (b - a).cross(c - a).normalize_or_zero().dot(a)
    };
    // What all of its faces have inside.
    let inner = Sphere::new(triangles.iter().map(height).fold(RADIUS, f32::min));
    let mesh = Arc::new(TriangleMesh::new(points, &triangles, is_closed));
    let shape = Shape::Mesh(MeshShape { mesh, deformed: None });
    let pose = Isometry3d::from_translation(CENTRE);
    let scene = Scene::new(settings, [cloth]).with_shape(shape, Solid::Sphere(inner), pose);
    Ok(scene.with(GROUND, Vec3::ZERO))
}
