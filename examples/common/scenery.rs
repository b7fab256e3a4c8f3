//! A calm outdoor studio to show cloth in: soft ground that fades into the horizon, a gradient sky, a warm sun.

use bevy::{
    core_pipeline::tonemapping::Tonemapping,
    light::{
        CascadeShadowConfigBuilder, DirectionalLightShadowMap, EnvironmentMapLight, NotShadowCaster, NotShadowReceiver,
    },
    math::{Affine2, ops::powf},
    mesh::VertexAttributeValues,
    pbr::{DistanceFog, FogFalloff},
    prelude::*,
    render::render_resource::Face,
};
use bevy_panorbit_camera::PanOrbitCamera;

use super::{
    mipmaps::{Texels, tile},
    weave::noise,
};

/// Where the sun's light comes from.
const SUN: Vec3 = Vec3::new(-4.0, 7.0, 5.0);

const HORIZON: LinearRgba = LinearRgba::rgb(0.72, 0.70, 0.66);
const ZENITH: LinearRgba = LinearRgba::rgb(0.10, 0.27, 0.56);
const GROUND: Color = Color::srgb(0.64, 0.62, 0.595);
const SUN_COLOUR: Color = Color::srgb(1.0, 0.95, 0.87);

/// Light that comes from the sky in all directions, in cd/m².
const SKY_LUMINANCE: f32 = 800.0;

/// Half the side of the ground in metres; the fog has swallowed it before its edge.
const GROUND_HALF_SIZE: f32 = 120.0;

/// Side of one tile of the ground's texture in metres.
const GROUND_TILE: f32 = 3.0;

/// Radius of the sky in metres, within the camera's far plane.
const SKY_RADIUS: f32 = 500.0;

/// Ground, sky and sun as one system for `Startup`. The camera is up to the example.
pub fn spawn_scenery(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut images: ResMut<Assets<Image>>,
) {
    spawn_ground(&mut commands, &mut meshes, &mut materials, &mut images);
    spawn_sky(&mut commands, &mut meshes, &mut materials);
    spawn_sun(&mut commands);
}

/// A camera at `eye` that looks at `look_at`. In a window the mouse moves it: left drag turns, right drag shifts, the
/// wheel zooms.
pub fn spawn_camera(commands: &mut Commands, eye: Vec3, look_at: Vec3) -> Entity {
    commands
        .spawn((
            Camera3d::default(),
            Transform::from_translation(eye).looking_at(look_at, Vec3::Y),
            Msaa::Sample4,
            // The only one that keeps the colours of cloth as its material gives them.
            Tonemapping::KhronosPbrNeutral,
            DistanceFog { color: HORIZON.into(), falloff: FogFalloff::Linear { start: 12.0, end: 90.0 }, ..default() },
            PanOrbitCamera {
                focus: look_at,
                target_focus: look_at,
                // Nothing is to be seen from under the ground.
                pitch_lower_limit: Some(-0.15),
                zoom_upper_limit: Some(60.0),
                ..default()
            },
        ))
        .queue(light_by_sky)
        .id()
}

/// The camera turns with the same button that drags cloth: it rests while any is held.
#[cfg(feature = "picking")]
pub fn rest_camera_while_dragging(
    grabs: Res<bevy_drape::prelude::PointerGrabs>,
    mut cameras: Query<&mut PanOrbitCamera>,
) {
    for mut camera in &mut cameras {
        camera.enabled = grabs.is_empty();
    }
}

/// Without the light of sky and ground, the sides away from the sun would be black.
fn light_by_sky(mut camera: EntityWorldMut) {
    let sky = camera.world_scope(|world| EnvironmentMapLight {
        intensity: SKY_LUMINANCE,
        ..EnvironmentMapLight::hemispherical_gradient(
            &mut world.resource_mut::<Assets<Image>>(),
            ZENITH.mix(&HORIZON, 0.5),
            HORIZON,
            GROUND,
        )
    });
    camera.insert(sky);
}

pub fn spawn_ground(
    commands: &mut Commands,
    meshes: &mut Assets<Mesh>,
    materials: &mut Assets<StandardMaterial>,
    images: &mut Assets<Image>,
) {
    let colour = GROUND.to_linear().to_vec3();
    let texture = tile(256, Texels::Colours, |u, v| colour * (0.93 + 0.14 * grain(u, v)));
    commands.spawn((
        Mesh3d(meshes.add(Plane3d::new(Vec3::Y, Vec2::splat(GROUND_HALF_SIZE)))),
        MeshMaterial3d(materials.add(StandardMaterial {
            base_color_texture: Some(images.add(texture)),
            perceptual_roughness: 1.0,
            reflectance: 0.1,
            uv_transform: Affine2::from_scale(Vec2::splat(2.0 * GROUND_HALF_SIZE / GROUND_TILE)),
            ..default()
        })),
        NotShadowCaster,
    ));
}

/// Soft blotches that repeat without a seam: noise on ever finer grids.
fn grain(u: f32, v: f32) -> f32 {
    [4, 8, 16, 64, 128].into_iter().map(|cells| smooth_noise(u * cells as f32, v * cells as f32, cells)).sum::<f32>()
        / 5.0
}

fn smooth_noise(x: f32, y: f32, cells: u32) -> f32 {
    let corner = |right: u32, down: u32| {
        let column = (x as u32 + right) % cells;
        let row = (y as u32 + down) % cells;
        noise(column + cells * row, cells)
    };
    let ease = |t: f32| t * t * (3.0 - 2.0 * t);
    let (right, down) = (ease(x.fract()), ease(y.fract()));
    let top = corner(0, 0).lerp(corner(1, 0), right);
    let bottom = corner(0, 1).lerp(corner(1, 1), right);
    top.lerp(bottom, down)
}

/// A dome coloured from horizon to zenith. Unlit, so that it meets the ground in exactly the colour of the fog.
pub fn spawn_sky(commands: &mut Commands, meshes: &mut Assets<Mesh>, materials: &mut Assets<StandardMaterial>) {
    let mut dome = Sphere::new(SKY_RADIUS).mesh().uv(96, 64);
    if let Some(VertexAttributeValues::Float32x3(positions)) = dome.attribute(Mesh::ATTRIBUTE_POSITION) {
        let colours: Vec<_> =
            positions.iter().map(|position| sky_colour(Vec3::from(*position) / SKY_RADIUS).to_f32_array()).collect();
        dome.insert_attribute(Mesh::ATTRIBUTE_COLOR, colours);
    }
    commands.spawn((
        Mesh3d(meshes.add(dome)),
        MeshMaterial3d(materials.add(StandardMaterial {
            unlit: true,
            fog_enabled: false,
            cull_mode: Some(Face::Front),
            ..default()
        })),
        NotShadowCaster,
        NotShadowReceiver,
    ));
}

fn sky_colour(direction: Vec3) -> LinearRgba {
    // Most of the change happens low, where cameras that look at cloth see the sky.
    let height = powf(direction.y.max(0.0), 0.6);
    let towards_sun = direction.dot(SUN.normalize()).max(0.0).powi(6);
    HORIZON.mix(&ZENITH, height) + SUN_COLOUR.to_linear() * (0.25 * towards_sun * height)
}

pub fn spawn_sun(commands: &mut Commands) {
    commands.insert_resource(DirectionalLightShadowMap { size: 4096 });
    commands.spawn((
        DirectionalLight { color: SUN_COLOUR, illuminance: 3_600.0, shadow_maps_enabled: true, ..default() },
        // Scenes are about 10 m across; further away the fog hides that shadows are missing.
        CascadeShadowConfigBuilder {
            num_cascades: 2,
            first_cascade_far_bound: 9.0,
            maximum_distance: 25.0,
            ..default()
        }
        .build(),
        Transform::from_translation(SUN).looking_at(Vec3::ZERO, Vec3::Y),
    ));
}
