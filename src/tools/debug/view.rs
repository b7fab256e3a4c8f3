//! What is drawn.

use bevy::prelude::*;

/// What is drawn of the cloth that it is on, besides what [`ClothDebugConfig`] has drawn of all. All off by default.
///
/// Sizes are the entity's own where it has a view of its own.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
pub struct ClothDebugView {
    /// Structural springs: along the threads.
    pub structural_springs: bool,
    /// Shear springs: across the cells. Paler than structural ones.
    pub shear_springs: bool,
    /// Bend springs: two steps along the threads. Paler than shear springs.
    pub bend_springs: bool,
    /// Strain at which the colour of springs is full, no unit, greater than 0. 0.01 to 0.2.
    ///
    /// Springs at rest are grey, pressed ones blue, stretched ones yellow at half of it and red at all of it.
    pub full_strain: f32,
    /// A cross at each pinned particle: green where it is pinned to the cloth's own entity, blue to the world, magenta to
    /// another entity.
    pub pins: bool,
    /// Tethers from particle to pin: orange where they are taut, else faint. None where the cloth has none:
    /// [`ClothSolver::Explicit`](crate::prelude::ClothSolver::Explicit).
    pub tethers: bool,
    /// The normal of each particle.
    pub normals: bool,
    /// Length of normals, m. 0.01 to 0.2.
    pub normal_length: f32,
    /// A ball at each point that is held, and a line to where it is led.
    pub grabs: bool,
    /// The box that Bevy culls the cloth by.
    pub bounds: bool,
    /// Radius of the marks of pins and grabs, m. 0.005 to 0.05.
    pub mark_size: f32,
}

impl Default for ClothDebugView {
    /// Nothing.
    fn default() -> Self {
        Self {
            structural_springs: false,
            shear_springs: false,
            bend_springs: false,
            full_strain: 0.05,
            pins: false,
            tethers: false,
            normals: false,
            normal_length: 0.05,
            grabs: false,
            bounds: false,
            mark_size: 0.015,
        }
    }
}

impl ClothDebugView {
    /// Everything.
    pub fn all() -> Self {
        Self { pins: true, tethers: true, normals: true, grabs: true, bounds: true, ..Self::springs() }
    }

    /// The springs of all kinds.
    pub fn springs() -> Self {
        Self { structural_springs: true, shear_springs: true, bend_springs: true, ..default() }
    }

    /// Whether anything is on.
    pub fn is_any(&self) -> bool {
        self.structural_springs
            || self.shear_springs
            || self.bend_springs
            || self.pins
            || self.tethers
            || self.normals
            || self.grabs
            || self.bounds
    }

    /// Also what is on in `other`.
    pub(super) fn or(&self, other: &Self) -> Self {
        Self {
            structural_springs: self.structural_springs || other.structural_springs,
            shear_springs: self.shear_springs || other.shear_springs,
            bend_springs: self.bend_springs || other.bend_springs,
            pins: self.pins || other.pins,
            tethers: self.tethers || other.tethers,
            normals: self.normals || other.normals,
            grabs: self.grabs || other.grabs,
            bounds: self.bounds || other.bounds,
            ..*self
        }
    }
}

/// What is drawn of all cloths, and of what surrounds them. All off by default.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Deref, DerefMut, Reflect)]
#[reflect(Resource, Default, Debug, Clone, PartialEq)]
pub struct ClothDebugConfig {
    /// What is drawn of every cloth. Its fields are also this one's: `config.pins = true`.
    #[deref]
    pub view: ClothDebugView,
    /// Colliders where and as large as the latest step saw them; of half-spaces a part of their plane, of meshes
    /// with very many edges the sharp ones and some of the others.
    pub colliders: bool,
    /// The wind in the box of each cloth, as arrows at the middle of its cells: what cloth there would feel.
    pub wind: bool,
    /// Length of an arrow by the speed of the wind, s: 0.05 draws 4 m/s as 0.2 m.
    pub wind_scale: f32,
    /// Number of cells along the longest side of a cloth's box, 1 to 16. A flat sheet has one layer of them.
    pub wind_cells: u32,
}

impl Default for ClothDebugConfig {
    /// Nothing.
    fn default() -> Self {
        Self { view: default(), colliders: false, wind: false, wind_scale: 0.05, wind_cells: 5 }
    }
}

impl ClothDebugConfig {
    /// Everything.
    pub fn all() -> Self {
        Self { view: ClothDebugView::all(), colliders: true, wind: true, ..default() }
    }

    /// Whether anything is on.
    pub fn is_any(&self) -> bool {
        self.view.is_any() || self.colliders || self.wind
    }
}
