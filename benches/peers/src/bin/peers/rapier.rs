//! Rapier's soft bodies: springs as soft constraints among the contacts and joints of its rigid-body solver.

use std::f32::consts::TAU;

use bevy_drape_peers::{
    line::Line,
    measure::{self, Name, Peer},
    scene::{BEND, Cloth, FRAME, GRAVITY, SHEAR, STRUCTURAL},
};
use rapier3d::prelude::{PhysicsWorld, SoftBodyBuilder, SoftBodyHandle, SoftBodyMaterial, SpringCoefficients, Vector};

/// What is swept: substeps a frame, which Rapier calls solver iterations. 4 is its default.
const ITERATIONS: [usize; 4] = [4, 8, 16, 32];

/// Runs all settings.
pub fn sweep(cloth: &Cloth, each: fn(&Line)) {
    for (suffix, has_springs) in [("", true), (", its default springs", false)] {
        for iterations in if has_springs { &ITERATIONS[..] } else { &ITERATIONS[..1] } {
            let setting = format!("{iterations} iterations{suffix}");
            let name = Name { system: "Rapier", version: "0.36.1", setting: &setting };
            each(&measure::run(&name, cloth, &mut Rapier::new(cloth, *iterations, has_springs)));
        }
    }
}

/// A world with nothing in it but the cloth.
struct Rapier {
    world: PhysicsWorld,
    cloth: SoftBodyHandle,
}

impl Rapier {
    /// `has_springs`: those of the scene, and not Rapier's default material.
    fn new(cloth: &Cloth, iterations: usize, has_springs: bool) -> Self {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, -GRAVITY, 0.0);
        world.integration_parameters.dt = FRAME;
        world.integration_parameters.num_solver_iterations = iterations;
        let body = if has_springs { with_springs(cloth) } else { grid(cloth) };
        let cloth = world.insert_soft_body(body);
        Self { world, cloth }
    }
}

/// The cloth as Rapier makes it, and nothing that it meets.
fn grid(cloth: &Cloth) -> SoftBodyBuilder {
    let [across, along] = [Vector::X, Vector::Z].map(|axis| axis * cloth.spacing());
    // Its particles go row by row too.
    let grid = SoftBodyBuilder::cloth(Vector::ZERO, along, across, cloth.n, cloth.n);
    with_the_scenes_particles(grid, cloth)
}

/// The same with the stiffness of the scene.
fn with_springs(cloth: &Cloth) -> SoftBodyBuilder {
    let [across, along] = [Vector::X, Vector::Z].map(|axis| axis * cloth.spacing());
    let springs = [STRUCTURAL, SHEAR, BEND].map(|stiffness| spring(stiffness, cloth));
    let [structural, shear, bend_softness] = springs;
    let n = cloth.n;
    let grid = SoftBodyBuilder::cloth_anisotropic(Vector::ZERO, along, across, n, n, structural, structural, shear);
    let material = SoftBodyMaterial { bend_softness, ..SoftBodyMaterial::default() };
    with_the_scenes_particles(grid.material(material), cloth)
}

/// Where they are, what they weigh, and which are pinned.
fn with_the_scenes_particles(grid: SoftBodyBuilder, cloth: &Cloth) -> SoftBodyBuilder {
    let start = cloth.start.iter().map(|&place| Vector::from(place)).collect();
    let pins = cloth.pins.iter().map(|&pin| pin as u32);
    let mut grid = grid.positions(start).particle_mass(cloth.particle_mass()).pinned_particles(pins).can_sleep(false);
    grid.collider_template = None;
    grid
}

/// A spring without damping between two particles: Rapier takes its natural frequency, Hz, for which the two count as half of one.
fn spring(stiffness: f32, cloth: &Cloth) -> SpringCoefficients<f32> {
    let frequency = (stiffness / (0.5 * cloth.particle_mass())).sqrt() / TAU;
    SpringCoefficients::new(frequency, 0.0)
}

impl Peer for Rapier {
    fn step(&mut self) {
        self.world.step();
    }

    fn positions(&self) -> Vec<[f32; 3]> {
        self.world.soft_bodies[self.cloth].particle_positions().map(|place| place.to_array()).collect()
    }
}

#[cfg(test)]
mod tests;
