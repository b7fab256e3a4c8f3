//! The standard scenes, so that every measurement means the same cloth.

use std::{io, time::Instant};

use bevy::{
    math::{Isometry3d, Mat3A, Vec3A, ops, primitives::InfinitePlane3d},
    prelude::*,
    tasks::TaskPool,
};
use bevy_drape::{
    build,
    prelude::{ClothError, Fabric},
    solver::{
        Anchor, Effort, Elasticity, Material, Method, Obstacle, Particles, SelfCollision, Solid, SpringConstants,
        SpringKind, StepContext, Tethers, Topology,
    },
};

use super::{
    Options, PinnedPart, SelfContact, Solver, Switch,
    mesh::{self, MeshSource, Top},
    pins,
};

/// Duration of a frame, s.
pub const FRAME: f32 = 1.0 / 60.0;

/// Areal density, kg/m².
pub const DENSITY: f32 = 0.2;

/// A cloth and all that acts on it.
pub struct Scene {
    pub mesh: MeshSource,
    pub topology: Topology,
    pub particles: Particles,
    anchors: Vec<Anchor>,
    tethers: Option<Tethers>,
    pub obstacles: Vec<Obstacle>,
    effort: Effort,
    /// Time that the topology took, ms.
    pub build_ms: f64,
    /// Time that the tethers took, ms.
    pub tethers_ms: f64,
    material: Material,
}

impl Scene {
    /// The coarse levels as the option writes them.
    pub fn levels(&self) -> String {
        let levels: Vec<String> =
            self.effort.levels.iter().map(|level| format!("{}x{}", level.stride, level.iterations)).collect();
        if levels.is_empty() { "none".into() } else { levels.join(",") }
    }

    /// What surrounds the cloth during a frame, with threads of `pool` to help.
    pub fn context<'a>(&'a self, options: &Options, pool: Option<&'a TaskPool>) -> StepContext<'a> {
        StepContext {
            dt: FRAME,
            method: match options.solver {
                Solver::Strands => Method::Strands,
                Solver::Xpbd => Method::Xpbd,
                Solver::Explicit => Method::Explicit,
            },
            effort: &self.effort,
            max_substeps: u32::MAX,
            material: self.material,
            gravity: Vec3A::NEG_Y * 9.81,
            anchors: &self.anchors,
            mounts: &[],
            mounted: &[],
            grabs: &[],
            max_velocity: 50.0,
            tethers: self.tethers.as_ref(),
            tether_slack: options.tether_slack,
            margin: 0.0,
            max_depenetration_velocity: 1.0,
            self_collision: match options.self_collision {
                SelfContact::Off => SelfCollision::Off,
                SelfContact::Particles => SelfCollision::Particles,
                SelfContact::Robust => SelfCollision::Robust,
            },
            collision_layers: 1,
            collision_mask: 1,
            self_distance: 0.004,
            self_friction: 0.3,
            obstacles: &self.obstacles,
            fluid_density: 0.0,
            winds: &[],
            pool,
        }
    }
}

/// The cloth hangs from two corners of its top, or from the whole of it.
pub fn hang(options: &Options, mesh: &MeshSource, pinned: PinnedPart) -> io::Result<Scene> {
    let (mut scene, top) = free_cloth(options, mesh)?;
    let pins = pins::choose(&scene.topology, &top, pinned);
    for &pin in &pins {
        let place = scene.particles.position[pin as usize];
        scene.particles.inverse_mass[pin as usize] = 0.0;
        scene.anchors.push(Anchor { particle: pin, start: place, end: place });
    }
    if options.tethers == Switch::On {
        let begun = Instant::now();
        scene.tethers = Some(build::tethers(&scene.topology, &pins));
        scene.tethers_ms = begun.elapsed().as_secs_f64() * 1e3;
    }
    Ok(scene)
}

/// The cloth falls from 0.75 m, its lowest point, on a sphere of 0.3 m radius at (0, 0.15, 0) over a ground at 0.
pub fn drape(options: &Options, mesh: &MeshSource) -> io::Result<Scene> {
    let (mut scene, _) = free_cloth(options, mesh)?;
    let lowest = scene.topology.rest.iter().map(|p| p.y).fold(f32::INFINITY, f32::min);
    for place in &mut scene.particles.position {
        place.y += 0.75 - lowest;
    }
    let obstacle = |shape, height: f32| {
        let pose = Isometry3d::from_translation(Vec3::Y * height);
        Obstacle::still(shape, pose)
    };
    scene.obstacles = vec![
        obstacle(Solid::Sphere(Sphere::new(0.3)), 0.15),
        obstacle(Solid::HalfSpace(InfinitePlane3d::default()), 0.0),
    ];
    Ok(scene)
}

/// The sheet or the springs that are asked for, without thickness and air.
fn material(options: &Options) -> Result<Material, ClothError> {
    if let Some(fabric) = &options.fabric {
        let bending_rigidity = options.rigidity.unwrap_or(fabric.bending_rigidity);
        let Material { density, elasticity, .. } = Fabric { bending_rigidity, ..fabric.clone() }.material()?;
        return Ok(Material::bare(density, elasticity));
    }
    let spring = |kind: SpringKind| SpringConstants { stiffness: options.stiffness[kind.index()], damping: 0.0 };
    Ok(Material::bare(DENSITY, Elasticity::Springs(SpringKind::ALL.map(spring))))
}

/// The cloth at rest but for a smooth ripple of 1 mm, and what it hangs by.
fn free_cloth(options: &Options, mesh: &MeshSource) -> io::Result<(Scene, Top)> {
    let unusable = |cause: String| io::Error::other(format!("{mesh} can't be used: {cause}"));
    let mut sheet = mesh.sheet(options.n).map_err(unusable)?;
    if options.jitter > 0.0 {
        mesh::jitter(&mut sheet.mesh, options.jitter, options.n);
    }
    let begun = Instant::now();
    let topology = build::topology_of(&sheet.mesh, Mat3A::IDENTITY).map_err(|error| unusable(error.to_string()))?;
    let build_ms = begun.elapsed().as_secs_f64() * 1e3;
    let material = Material { damping: options.damping, friction: 0.5, ..material(options).map_err(io::Error::other)? };
    let mut particles = Particles::at_rest(rippled(&topology, &sheet.top), &topology, &material);
    if let MeshSource::Grid = mesh {
        // The standard cloth has the same mass at its border as inside.
        particles.inverse_mass.fill((options.n * options.n) as f32 / material.density);
    }
    let (anchors, tethers, obstacles) = (Vec::new(), None, Vec::new());
    let effort = options.effort(&topology);
    let scene = Scene {
        mesh: mesh.clone(),
        topology,
        particles,
        anchors,
        tethers,
        obstacles,
        effort,
        material,
        build_ms,
        tethers_ms: 0.0,
    };
    Ok((scene, sheet.top))
}

/// The rest shape, moved by up to 1 mm along its normals: up and down where it lies. What stands stays at rest at its
/// top, where pins would keep a ring stretched.
fn rippled(topology: &Topology, top: &Top) -> Vec<Vec3A> {
    let mut normals = vec![Vec3A::ZERO; topology.particle_count()];
    for triangle in &topology.triangles {
        let [a, b, c] = triangle.map(|i| Vec3A::from(topology.rest[i as usize]));
        for &particle in triangle {
            normals[particle as usize] += (b - a).cross(c - a);
        }
    }
    let wave = |x: f32| ops::sin(core::f32::consts::TAU * x);
    let ripple = |((p, normal), depth): ((&Vec3, Vec3A), f32)| {
        let normal = normal / normal.length().max(f32::MIN_POSITIVE);
        let amplitude = if top.stands() { 0.001 * depth } else { 0.001 };
        Vec3A::from(*p) + normal * (amplitude * wave(p.x) * wave(p.z + 0.25))
    };
    topology.rest.iter().zip(normals).zip(top.depths(&topology.rest)).map(ripple).collect()
}
