//! Draws what knows nothing of meshes and entities.

use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};
use bevy_drape::solver::{Ellipsoid, Solid};
use drape_lab::scene;

use super::{Stage, common};

/// How far scenes without a ground are off it, m.
const LIFT: f32 = 1.0;

/// How far what is drawn of obstacles and of the ground stays behind where they are, m: the cloth of these experiments has no
/// thickness, and would flicker with what it lies on.
const BEHIND: f32 = 0.003;

/// Number of a cloth in its scene.
#[derive(Component)]
pub struct DrawnCloth(usize);

/// Number of an obstacle in its scene.
#[derive(Component)]
pub struct DrawnObstacle(usize);

pub fn spawn(mut commands: Commands, mut studio: common::Studio, stage: Res<Stage>) {
    let scene = &stage.0;
    let has_ground = scene.solids.iter().any(|solid| matches!(solid, Solid::HalfSpace(_)));
    let lift = if has_ground { BEHIND } else { LIFT };
    let all = commands.spawn((Transform::from_xyz(0.0, lift, 0.0), Visibility::default())).id();
    let colors = [Color::srgb(0.20, 0.42, 0.58), Color::srgb(0.85, 0.62, 0.24), Color::srgb(0.70, 0.24, 0.20)];
    for (i, cloth) in scene.cloths.iter().enumerate() {
        let color = colors[i % colors.len()];
        let material = common::fabric_material(&mut studio.images, color, Vec2::splat(10.0));
        commands.spawn((
            Mesh3d(studio.meshes.add(mesh_of(cloth))),
            MeshMaterial3d(studio.materials.add(material)),
            DrawnCloth(i),
            ChildOf(all),
        ));
    }
    for (i, solid) in scene.solids.iter().enumerate() {
        if let Some(mesh) = shape_of(solid) {
            commands.spawn((studio.solid(mesh, Color::srgb(0.82, 0.80, 0.76)), DrawnObstacle(i), ChildOf(all)));
        }
    }
}

/// The mesh of a cloth, its UVs in metres.
fn mesh_of(cloth: &scene::Cloth) -> Mesh {
    let rest = &cloth.topology.rest;
    let uvs: Vec<[f32; 2]> = rest.iter().map(|place| [place.x, place.y + place.z]).collect();
    let indices = cloth.topology.triangles.as_flattened().to_vec();
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, rest.iter().map(Vec3::to_array).collect::<Vec<_>>())
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
        .with_inserted_indices(Indices::U32(indices))
        .with_computed_smooth_normals()
}

/// What is to be seen of an obstacle. The ground is there already.
fn shape_of(solid: &Solid) -> Option<Mesh> {
    Some(match *solid {
        // Not what is thin: it would be gone.
        Solid::Sphere(Sphere { radius }) if radius > 0.1 => Sphere::new(radius - BEHIND).mesh().uv(128, 72),
        Solid::Sphere(sphere) => sphere.mesh().uv(64, 36),
        Solid::Ellipsoid(Ellipsoid { half_size }) => Sphere::new(1.0).mesh().uv(64, 36).scaled_by(half_size),
        Solid::Cuboid(cuboid) => cuboid.into(),
        Solid::Capsule(capsule) => capsule.into(),
        Solid::Cylinder(cylinder) => cylinder.into(),
        Solid::Cone(cone) => cone.into(),
        Solid::TaperedCapsule(_) | Solid::HalfSpace(_) => return None,
    })
}

pub fn draw_cloths(stage: Res<Stage>, cloths: Query<(&DrawnCloth, &Mesh3d)>, mut meshes: ResMut<Assets<Mesh>>) {
    for (drawn, mesh) in &cloths {
        if let Some(mut mesh) = meshes.get_mut(&mesh.0) {
            let places = stage.0.cloths[drawn.0].particles.position.iter();
            let places: Vec<[f32; 3]> = places.map(|place| place.to_array()).collect();
            mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, places);
            mesh.compute_smooth_normals();
        }
    }
}

pub fn place_obstacles(stage: Res<Stage>, mut obstacles: Query<(&DrawnObstacle, &mut Transform)>) {
    for (drawn, mut transform) in &mut obstacles {
        let pose = stage.0.surroundings.obstacles[drawn.0].end;
        (transform.translation, transform.rotation) = (pose.translation.into(), pose.rotation);
    }
}
