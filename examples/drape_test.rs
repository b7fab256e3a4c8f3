//! Cusick's drape test: a disc of cloth on a smaller support, and the share of the overhanging ring that its shadow in
//! light from above still covers. Space takes the next fabric.

mod common;

use bevy::{mesh::VertexAttributeValues, prelude::*};
use bevy_drape::prelude::*;
use drape_lab::laboratory::{mesh, shadow};

/// Radii of the cloth and of its support, m.
const RADIUS: f64 = 0.15;
const SUPPORT: f64 = 0.09;

/// Length of the mesh's edges, m.
const EDGE: f64 = 0.0075;

/// How high the support is, m.
const HEIGHT: f32 = 0.8;

/// Seconds that each fabric is shown for where nobody presses a key.
const TURN: f32 = 8.0;

fn main() -> AppExit {
    common::app("Drape test", "Cusick's drape test. Space: next fabric")
        .add_plugins(ClothPlugin::default())
        .add_systems(Startup, (common::spawn_scenery, setup))
        .add_systems(Update, (change_fabric, measure).chain())
        .run()
}

/// Which preset is on the support.
#[derive(Component, Default)]
struct Specimen {
    preset: usize,
    since: f32,
}

fn setup(mut commands: Commands, mut studio: common::Studio) {
    common::spawn_camera(&mut commands, Vec3::new(0.0, 1.08, 0.48), Vec3::new(0.0, 0.77, 0.0));
    let support = Cylinder::new(SUPPORT as f32, HEIGHT);
    let wood = Color::srgb(0.45, 0.30, 0.19);
    commands.spawn((studio.solid(support, wood), Transform::from_xyz(0.0, HEIGHT / 2.0 - 0.001, 0.0)));
    let disc = dressed(mesh::disc(mesh::Kind::Grid, RADIUS, SUPPORT, EDGE));
    // In the apparatus a second disc holds it down.
    let held = Pins::predicate(|vertex| f64::from(vertex.position.length()) < SUPPORT + 0.6 * EDGE);
    commands.spawn((
        studio.cloth(disc, Color::srgb(0.80, 0.78, 0.72)),
        Cloth { fluid_density: 0.0, ..default() },
        Fabric::PRESETS[0].fabric.clone(),
        held,
        Transform::from_xyz(0.0, HEIGHT, 0.0),
        Specimen::default(),
    ));
}

/// The mesh with what drawing asks for: the laboratory's has none of it.
fn dressed(mesh: Mesh) -> Mesh {
    let places =
        mesh.attribute(Mesh::ATTRIBUTE_POSITION).and_then(VertexAttributeValues::as_float3).unwrap_or_default();
    let uvs: Vec<[f32; 2]> = places.iter().map(|&[x, _, z]| [x, z]).collect();
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs).with_computed_smooth_normals()
}

fn change_fabric(
    time: Res<Time>,
    keys: Option<Res<ButtonInput<KeyCode>>>,
    specimen: Single<(Entity, &mut Specimen, &mut Fabric)>,
    mut commands: Commands,
) {
    let (entity, mut specimen, mut fabric) = specimen.into_inner();
    let now = time.elapsed_secs();
    let is_asked = keys.is_some_and(|keys| keys.just_pressed(KeyCode::Space));
    if is_asked || now - specimen.since > TURN {
        *specimen = Specimen { preset: (specimen.preset + 1) % Fabric::PRESETS.len(), since: now };
        commands.entity(entity).reset_cloth();
    }
    // So much damping brings it to rest soon, and changes no place of rest.
    fabric.set_if_neq(Fabric { damping: 4.0, ..Fabric::PRESETS[specimen.preset].fabric.clone() });
}

fn measure(specimen: Single<(&Specimen, &ClothState)>, mut overlay: ResMut<common::Overlay>) {
    let (specimen, state) = *specimen;
    let positions: Vec<_> = state.positions_from_origin().map(Into::into).collect();
    if positions.is_empty() {
        return;
    }
    let disc = |radius: f64| core::f64::consts::PI * radius * radius;
    let shadow = shadow::area(&positions, state.triangles());
    let coefficient = (shadow - disc(SUPPORT)) / (disc(RADIUS) - disc(SUPPORT));
    let name = Fabric::PRESETS[specimen.preset].name.replace('_', " ");
    overlay.readings = format!("{name}: {:.0} %", 100.0 * coefficient);
}
