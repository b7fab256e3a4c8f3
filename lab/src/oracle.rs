//! The truth that a hanging cloth is compared with: the same springs in f64, with steps so small that only the springs
//! count.
//!
//! A solver can look right and be wrong: too stiff, too soft or too slow, with a strain that flatters it. The oracle
//! couldn't catch it at anything that they have in common, so nothing here is the crate's but the springs.
//!
//! At 64 x 64 halving its step moves it by 0.1 mm RMS (grid) to 0.6 mm (delaunay), and by 3 mm on the skirt, whose hem
//! buckles one way or another for little. What is closer to it than that can't be told apart.

use bevy::math::{DVec3, Vec3A};
use bevy_drape::solver::{SpringKind, StepContext};

use super::scene::{self, Scene};

/// The frame after which a run is compared: 0.5 s.
pub const FRAME: u32 = 30;

/// The moment of the comparison, s.
const MOMENT: f64 = 0.5;

/// Longest time step, s. Where it wouldn't be stable, as on a very fine mesh, the step is shorter.
const LONGEST_STEP: f64 = 1e-5;

/// ω h stays below this. Symplectic Euler is stable below 2.
const STABLE: f64 = 1.5;

/// Below this length (m) a spring has no direction.
const SHORTEST: f64 = 1e-12;

/// The cloth after 0.5 s.
pub struct Oracle {
    /// Position of each particle, m.
    positions: Vec<DVec3>,
    /// Strain of the structural spring that is stretched the most, no unit.
    pub max_strain: f64,
    /// Mean strain of the structural springs, no unit.
    pub mean_strain: f64,
}

impl Oracle {
    /// Runs the springs of the cloth in `scene` from where it stands. Fixed particles stay, and there are no tethers.
    pub fn run(scene: &Scene) -> Self {
        let hung = &scene.cloths[0];
        let ctx = scene.surroundings.context(&hung.rig, None);
        let mut cloth = Cloth::new(hung, &ctx);
        let steps = (MOMENT / cloth.longest_step()).ceil();
        let h = MOMENT / steps;
        let decay = (-f64::from(ctx.material.damping) * h).exp();
        for _ in 0..steps as u64 {
            cloth.step(h, decay);
        }
        let structural = hung.topology.springs_of(SpringKind::Structural);
        let strains = structural.map(|s| {
            let [a, b] = [s.a, s.b].map(|i| cloth.position[i as usize]);
            a.distance(b) / f64::from(s.rest) - 1.0
        });
        let (count, sum, most) = strains
            .fold((0.0, 0.0, f64::NEG_INFINITY), |(count, sum, most), s| (count + 1.0, sum + s, f64::max(most, s)));
        Self { positions: cloth.position, max_strain: most, mean_strain: sum / count }
    }

    /// Root of the mean squared distance of `positions` from the truth, m.
    pub fn rms_distance(&self, positions: &[Vec3A]) -> f64 {
        let pairs = self.positions.iter().zip(positions);
        let squares: f64 = pairs.map(|(truth, position)| truth.distance_squared(position.as_dvec3())).sum();
        (squares / self.positions.len() as f64).sqrt()
    }
}

/// A spring of `stiffness` k, N/m, and length `rest`, m.
struct Spring {
    a: u32,
    b: u32,
    rest: f64,
    stiffness: f64,
}

struct Cloth {
    springs: Vec<Spring>,
    position: Vec<DVec3>,
    velocity: Vec<DVec3>,
    force: Vec<DVec3>,
    inverse_mass: Vec<f64>,
    gravity: DVec3,
}

impl Cloth {
    fn new(hung: &scene::Cloth, ctx: &StepContext) -> Self {
        let count = hung.particles.len();
        let springs = hung.topology.batches.iter().flat_map(|batch| {
            let springs = hung.topology.springs[batch.range.clone()].iter();
            springs.map(move |s| {
                let stiffness = ctx.material.spring(batch.kind, s).constants.stiffness.into();
                Spring { a: s.a, b: s.b, rest: s.rest.into(), stiffness }
            })
        });
        Self {
            springs: springs.collect(),
            position: hung.particles.position.iter().map(|p| p.as_dvec3()).collect(),
            velocity: vec![DVec3::ZERO; count],
            force: vec![DVec3::ZERO; count],
            inverse_mass: hung.particles.inverse_mass.iter().copied().map(f64::from).collect(),
            gravity: ctx.gravity.as_dvec3(),
        }
    }

    /// The longest stable step up to [`LONGEST_STEP`], s: Gershgorin's circles bound ω² by twice the sum over a
    /// particle's springs of k/m.
    fn longest_step(&self) -> f64 {
        let mut stiffness = vec![0.0; self.position.len()];
        for spring in &self.springs {
            stiffness[spring.a as usize] += spring.stiffness;
            stiffness[spring.b as usize] += spring.stiffness;
        }
        let squares = stiffness.iter().zip(&self.inverse_mass).map(|(k, w)| 2.0 * k * w);
        LONGEST_STEP.min(STABLE / squares.fold(0.0, f64::max).sqrt())
    }

    /// Symplectic Euler: velocities from the forces (N), then positions from the new velocities.
    fn step(&mut self, h: f64, decay: f64) {
        self.force.fill(DVec3::ZERO);
        for spring in &self.springs {
            let (a, b) = (spring.a as usize, spring.b as usize);
            let along = self.position[a] - self.position[b];
            // A spring without length has no direction and rests.
            let length = along.length().max(SHORTEST);
            let pull = along * (spring.stiffness * (spring.rest - length) / length);
            self.force[a] += pull;
            self.force[b] -= pull;
        }
        let state = self.position.iter_mut().zip(&mut self.velocity).zip(self.force.iter().zip(&self.inverse_mass));
        for ((position, velocity), (&force, &w)) in state.filter(|(_, (_, w))| **w > 0.0) {
            *velocity = *velocity * decay + (self.gravity + force * w) * h;
            *position += *velocity * h;
        }
    }
}
