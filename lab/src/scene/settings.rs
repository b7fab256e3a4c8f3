//! What all cloths of a scene have in common.

use std::{io, time::Instant};

use bevy::{
    math::{Mat3A, Vec3A},
    prelude::*,
};
use bevy_drape::{
    build,
    prelude::ClothGrid,
    solver::{
        Elasticity, LevelPass, Material, Method, Particles, Scratch, SpringConstants, SpringKind, StepSettings,
        SubstepPolicy, Topology,
    },
};

use super::{Cloth, FRAME, Rig};

/// Areal density, kg/m².
pub const DENSITY: f32 = 0.2;

/// Stiffness of springs along the threads, of those along diagonals, and of those that bend, N/m.
pub const STIFFNESS: [f32; 3] = [5000.0, 500.0, 20.0];

/// Settings of a scene.
#[derive(Clone)]
pub struct Settings {
    /// Particles along a metre.
    pub n: u32,
    /// Frames that the scene has time for.
    pub frames: u32,
    pub method: Method,
    /// As many as the strain needs where it doesn't say.
    pub substeps: Option<u32>,
    /// The largest strain that is wanted, no unit.
    pub max_strain: f32,
    /// Those that go with the substeps where it doesn't say.
    pub levels: Option<Vec<LevelPass>>,
    pub material: Material,
    pub tether_slack: f32,
    pub self_collision: bool,
    /// Distance that parts of cloth keep from each other, m.
    pub self_distance: f32,
    /// Distance that the cloth keeps from obstacles beside its thickness, m.
    pub margin: f32,
}

impl Settings {
    /// Those that the lab has by default: springs without air.
    pub fn standard(n: u32, frames: u32, self_collision: bool) -> Self {
        let spring = |kind: SpringKind| SpringConstants { stiffness: STIFFNESS[kind.index()], damping: 0.0 };
        let springs = Elasticity::Springs(SpringKind::ALL.map(spring));
        Self {
            n,
            frames,
            method: Method::Strands,
            substeps: None,
            max_strain: 0.01,
            levels: None,
            material: Material { damping: 1.0, friction: 0.5, ..Material::bare(DENSITY, springs) },
            tether_slack: 0.002,
            self_collision,
            self_distance: 0.004,
            margin: 0.0,
        }
    }

    /// How a cloth of this mesh is solved.
    fn solver(&self, topology: &Topology) -> StepSettings {
        StepSettings {
            method: self.method,
            substep_policy: self.substep_policy(topology),
            max_substeps: u32::MAX,
            tether_slack: self.tether_slack,
            margin: self.margin,
            self_collision: self.self_collision,
            self_distance: self.self_distance,
            ..StepSettings::default()
        }
    }

    /// Substeps and levels for a mesh.
    fn substep_policy(&self, topology: &Topology) -> SubstepPolicy {
        let mut policy = match (self.method, self.substeps) {
            (Method::Strands, None) => SubstepPolicy::to_hold(self.max_strain, topology, self.material.moduli()),
            (Method::Strands, Some(substeps)) => {
                SubstepPolicy::fixed(substeps, SubstepPolicy::levels_for(substeps, topology))
            }
            (_, substeps) => SubstepPolicy::fixed(substeps.unwrap_or(8), Vec::new()),
        };
        if let Some(levels) = &self.levels {
            policy.levels.clone_from(levels);
            policy.contact_levels.clone_from(levels);
        }
        policy
    }

    /// Time of all frames, s.
    pub fn duration(&self) -> f32 {
        self.frames as f32 * FRAME
    }

    /// Distance between particles, m.
    pub fn cell(&self) -> f32 {
        1.0 / (self.n - 1) as f32
    }

    /// A rectangle of `width` x `height` metres with `n` particles a metre.
    pub fn grid(&self, width: f32, height: f32) -> ClothGrid {
        let particles = |length: f32| (length / self.cell()).round() as u32 + 1;
        ClothGrid::new(width, height, particles(width), particles(height))
    }

    /// A cloth with the particles and springs of `mesh`, free and at rest.
    ///
    /// # Errors
    ///
    /// Why the mesh can't be a cloth.
    pub fn cloth(&self, mesh: &Mesh) -> io::Result<Cloth> {
        let begun = Instant::now();
        let topology = build::topology_of(mesh, Mat3A::IDENTITY).map_err(io::Error::other)?;
        let build_ms = begun.elapsed().as_secs_f64() * 1e3;
        let rest = topology.rest.iter().copied().map(Vec3A::from).collect();
        Ok(Cloth {
            particles: Particles::at_rest(rest, &topology, &self.material),
            rig: Rig { pin_motions: Vec::new(), tethers: None, settings: self.solver(&topology) },
            scratch: Scratch::default(),
            topology,
            build_ms,
            tethers_ms: 0.0,
        })
    }
}
