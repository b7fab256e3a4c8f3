//! The standard scenes, so that every measurement means the same cloth.

use bevy::{
    math::{Isometry3d, Mat3A, Vec3A, ops, primitives::InfinitePlane3d},
    prelude::*,
};
use bevy_drape::{
    build,
    prelude::ClothGrid,
    solver::{
        Anchor, ColliderShape, Material, Method, Obstacle, Particles, SpringConstants, StepContext, Tether, Topology,
    },
};

use super::{Options, PinnedPart, Solver, Switch};

/// Duration of a frame, s.
pub const FRAME: f32 = 1.0 / 60.0;

/// Mass of the whole cloth, kg.
const MASS: f32 = 0.2;

/// A cloth and all that acts on it.
pub struct Scene {
    pub topology: Topology,
    pub particles: Particles,
    anchors: Vec<Anchor>,
    tethers: Vec<Tether>,
    pub obstacles: Vec<Obstacle>,
    material: Material,
}

impl Scene {
    /// What surrounds the cloth during a frame.
    pub fn context<'a>(&'a self, options: &Options) -> StepContext<'a> {
        StepContext {
            dt: FRAME,
            method: match options.solver {
                Solver::Xpbd => Method::Xpbd,
                Solver::Explicit => Method::Explicit,
            },
            substeps: options.substeps,
            max_substeps: u32::MAX,
            material: self.material,
            gravity: Vec3A::NEG_Y * 9.81,
            anchors: &self.anchors,
            grabs: &[],
            tethers: &self.tethers,
            tether_slack: options.tether_slack,
            obstacles: &self.obstacles,
            fluid_density: 0.0,
            winds: &[],
        }
    }
}

/// The cloth hangs from two corners of one edge, or from the whole edge.
pub fn hang(options: &Options, pinned: PinnedPart) -> Scene {
    let last = options.n - 1;
    let pins: Vec<u32> = match pinned {
        PinnedPart::Corners => vec![0, last],
        PinnedPart::Top => (0..options.n).collect(),
    };
    let mut scene = free_cloth(options);
    for &pin in &pins {
        let place = scene.particles.position[pin as usize];
        scene.particles.inverse_mass[pin as usize] = 0.0;
        scene.anchors.push(Anchor { particle: pin, start: place, end: place });
    }
    if options.tethers == Switch::On {
        scene.tethers = build::tethers(&scene.topology, &pins);
    }
    scene
}

/// The cloth falls from 0.75 m on a sphere of 0.3 m radius at (0, 0.15, 0) over a ground at 0.
pub fn drape(options: &Options) -> Scene {
    let mut scene = free_cloth(options);
    for place in &mut scene.particles.position {
        place.y += 0.75;
    }
    let obstacle = |shape, height: f32| {
        let pose = Isometry3d::from_translation(Vec3::Y * height);
        Obstacle { shape, start: pose, end: pose, friction: 1.0 }
    };
    scene.obstacles = vec![
        obstacle(ColliderShape::Sphere(Sphere::new(0.3)), 0.15),
        obstacle(ColliderShape::HalfSpace(InfinitePlane3d::default()), 0.0),
    ];
    scene
}

/// A square metre of cloth at the origin, horizontal but for a smooth ripple of 1 mm.
fn free_cloth(options: &Options) -> Scene {
    let mesh = Mesh::from(ClothGrid::new(1.0, 1.0, options.n, options.n).lying());
    let topology = build::topology_of(&mesh, Mat3A::IDENTITY).expect("a grid is a mesh with an area");
    let spring = |stiffness| SpringConstants { stiffness, damping: 0.0 };
    let material = Material {
        density: MASS,
        springs: [spring(5000.0), spring(500.0), spring(20.0)],
        damping: options.damping,
        thickness: 0.0,
        friction: 0.5,
        drag: 0.0,
        lift: 0.0,
    };
    let ripple = |p: &Vec3| {
        let wave = |x: f32| ops::sin(core::f32::consts::TAU * x);
        Vec3A::from(*p) + Vec3A::Y * (0.001 * wave(p.x) * wave(p.z + 0.25))
    };
    let start: Vec<Vec3A> = topology.rest.iter().map(ripple).collect();
    let mut particles = Particles::at_rest(start, &topology, &material);
    // The standard cloth has the same mass at its border as inside.
    particles.inverse_mass.fill((options.n * options.n) as f32 / MASS);
    Scene { topology, particles, anchors: Vec::new(), tethers: Vec::new(), obstacles: Vec::new(), material }
}
