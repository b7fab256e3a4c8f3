//! Meshes and materials in one system parameter, and the props that most examples need.

use bevy::{ecs::system::SystemParam, prelude::*};

use super::weave::fabric_material;

/// Repeats of the weave per metre of cloth.
const WEAVES_PER_METRE: f32 = 10.0;

/// What it takes to make something visible.
#[derive(SystemParam)]
pub struct Studio<'w> {
    pub meshes: ResMut<'w, Assets<Mesh>>,
    pub materials: ResMut<'w, Assets<StandardMaterial>>,
    pub images: ResMut<'w, Assets<Image>>,
}

impl Studio<'_> {
    /// Mesh and woven material of a cloth.
    pub fn cloth(&mut self, mesh: impl Into<Mesh>, color: Color) -> (Mesh3d, MeshMaterial3d<StandardMaterial>) {
        let mesh: Mesh = mesh.into();
        // The relief of the weave needs tangents, which need UVs.
        let mesh = mesh.clone().with_generated_tangents().unwrap_or(mesh);
        let material = fabric_material(&mut self.images, color, Vec2::splat(WEAVES_PER_METRE));
        (Mesh3d(self.meshes.add(mesh)), MeshMaterial3d(self.materials.add(material)))
    }

    /// Mesh and smooth material of an obstacle.
    pub fn solid(&mut self, mesh: impl Into<Mesh>, color: Color) -> (Mesh3d, MeshMaterial3d<StandardMaterial>) {
        let material = StandardMaterial { base_color: color, perceptual_roughness: 0.55, ..default() };
        (Mesh3d(self.meshes.add(mesh)), MeshMaterial3d(self.materials.add(material)))
    }

    /// A wooden rod from one place to another.
    pub fn spawn_rod(&mut self, commands: &mut Commands, from: Vec3, to: Vec3, radius: f32) -> Entity {
        let (way, length) = (to - from).normalize_and_length();
        let rod = self.solid(Cylinder::new(radius, length), Color::srgb(0.42, 0.30, 0.20));
        let turn = Quat::from_rotation_arc(Vec3::Y, way);
        commands.spawn((rod, Transform::from_translation((from + to) / 2.0).with_rotation(turn))).id()
    }
}
