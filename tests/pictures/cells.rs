//! A picture in cells, each for something to hang in, before a wall in the sun.

use bevy::{
    camera::{RenderTarget, ScalingMode},
    core_pipeline::{
        prepass::{DepthPrepass, MotionVectorPrepass, NormalPrepass},
        tonemapping::Tonemapping,
    },
    light::{CascadeShadowConfigBuilder, DirectionalLightShadowMap},
    prelude::*,
};
use bevy_drape::prelude::*;

/// Side of a cell in m.
pub const CELL: f32 = 1.0;

/// Number of cells.
pub const CELLS: usize = COLUMNS * ROWS;

const COLUMNS: usize = 6;
const ROWS: usize = 3;

/// Size of the picture in pixels.
pub const SIZE: UVec2 = UVec2::new(640, 360);

/// Height of what the camera sees in m; the cells fill its width.
const VIEW: f32 = CELL * COLUMNS as f32 * SIZE.y as f32 / SIZE.x as f32;

/// Middle of a cell.
pub fn place(cell: usize) -> Vec3 {
    let (column, row) = (cell % COLUMNS, cell / COLUMNS);
    let middle = |count: usize, index: usize| index as f32 - (count as f32 - 1.0) / 2.0;
    Vec3::new(middle(COLUMNS, column), -middle(ROWS, row), 0.0) * CELL
}

/// What a cloth with its middle there fills of the picture whatever the wind does, as `share` takes it.
pub fn region(place: Vec3) -> [f32; 4] {
    let view = Vec2::new(CELL * COLUMNS as f32, VIEW);
    let middle = place.truncate() * Vec2::new(1.0, -1.0) / view + 0.5;
    let half = Vec2::splat(0.2 * CELL) / view;
    let (from, to) = (middle - half, middle + half);
    [from.x, from.y, to.x, to.y]
}

/// A camera with all prepasses, a sun that casts shadows, a grey wall that they fall on, and a wind that blows there.
pub fn spawn_surroundings(world: &mut World, target: Handle<Image>) {
    world.spawn((
        Camera3d::default(),
        RenderTarget::Image(target.into()),
        Projection::Orthographic(OrthographicProjection {
            scaling_mode: ScalingMode::FixedVertical { viewport_height: VIEW },
            ..OrthographicProjection::default_3d()
        }),
        Transform::from_xyz(0.0, 0.0, 5.0),
        // Colours stay as materials give them.
        Tonemapping::KhronosPbrNeutral,
        Msaa::Off,
        DepthPrepass,
        NormalPrepass,
        MotionVectorPrepass,
    ));
    world.insert_resource(DirectionalLightShadowMap { size: 1024 });
    world.insert_resource(GlobalAmbientLight { brightness: 600.0, ..default() });
    world.spawn((
        DirectionalLight { illuminance: 6000.0, shadow_maps_enabled: true, ..default() },
        CascadeShadowConfigBuilder { num_cascades: 1, maximum_distance: 10.0, ..default() }.build(),
        Transform::from_xyz(-2.0, 3.0, 4.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    let mesh = world.resource_mut::<Assets<Mesh>>().add(Rectangle::new(8.0, 5.0));
    let grey = StandardMaterial { base_color: Color::srgb(0.5, 0.5, 0.5), perceptual_roughness: 0.9, ..default() };
    let material = world.resource_mut::<Assets<StandardMaterial>>().add(grey);
    world.spawn((Mesh3d(mesh), MeshMaterial3d(material), Transform::from_xyz(0.0, 0.0, -0.6)));
    world.spawn(Wind { velocity: Vec3::new(0.3, 0.0, -0.9), ..default() });
}
