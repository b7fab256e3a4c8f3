//! Gusts and turbulence: seeded noise that travels with the wind.
//!
//! Taylor's frozen-turbulence hypothesis: eddies are carried along faster than they change, so noise in space, moved
//! with the mean wind, gives noise in time as well. It is sampled on a coarse lattice around the cloth, because it
//! changes little over less than its length scale, and interpolated in between.

use bevy::math::{UVec3, Vec3A};
use fastnoise_lite::{FastNoiseLite, NoiseType};

use super::WindSource;

/// Most samples of a lattice along each axis.
const MOST_SAMPLES: u32 = 5;

/// How a wind differs from its mean, in space and time. The same seed gives the same wind on every run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gusts {
    /// Strength of slow gusts as a share of the mean speed: 0 for none, 1 for from calm to twice the speed.
    pub strength: f32,
    /// Time from gust to gust, s.
    pub period: f32,
    /// Strength of eddies as a share of the mean speed. 0.1 over open land, 0.3 in a town.
    pub turbulence: f32,
    /// Size of the eddies, m.
    pub eddy_size: f32,
    /// Seed of the noise.
    pub seed: u32,
}

/// Air velocity around one cloth, m/s.
pub(super) struct Field {
    corner: Vec3A,
    /// Lattice cells per metre along each axis.
    scale: Vec3A,
    samples: UVec3,
    velocity: [Vec3A; (MOST_SAMPLES * MOST_SAMPLES * MOST_SAMPLES) as usize],
}

impl Field {
    /// Samples `wind` over the box around `position` at `time` seconds.
    pub fn sample(wind: &WindSource, position: &[Vec3A], time: f32) -> Self {
        let mut field = Self::around(wind, position);
        let noise = Noise::new(wind, time);
        for index in 0..field.samples.element_product() {
            let cell = field.cell(index);
            let point = field.corner + cell.as_vec3a() / field.scale.max(Vec3A::splat(1e-6));
            field.velocity[index as usize] = noise.velocity(point);
        }
        field
    }

    /// A lattice that is fine enough for the eddies, with a single sample where the wind is the same everywhere.
    fn around(wind: &WindSource, position: &[Vec3A]) -> Self {
        let low = position.iter().fold(Vec3A::INFINITY, |a, &b| a.min(b));
        let high = position.iter().fold(Vec3A::NEG_INFINITY, |a, &b| a.max(b));
        let steady = wind.gusts.strength == 0.0 && wind.gusts.turbulence == 0.0;
        let cells = if steady {
            Vec3A::ZERO
        } else {
            let wanted = ((high - low) * 2.0 / wind.gusts.eddy_size.max(1e-3)).ceil();
            wanted.clamp(Vec3A::ONE, Vec3A::splat((MOST_SAMPLES - 1) as f32))
        };
        Self {
            corner: low,
            scale: cells / (high - low).max(Vec3A::splat(1e-6)),
            samples: cells.as_uvec3() + 1,
            velocity: [Vec3A::ZERO; _],
        }
    }

    fn cell(&self, index: u32) -> UVec3 {
        let UVec3 { x, y, .. } = self.samples;
        UVec3::new(index % x, index / x % y, index / (x * y))
    }

    /// The trilinear interpolation at `point`, which lies in the lattice.
    pub fn at(&self, point: Vec3A) -> Vec3A {
        let last = self.samples - 1;
        let place = ((point - self.corner) * self.scale).clamp(Vec3A::ZERO, last.as_vec3a());
        let low = place.as_uvec3().min(last.saturating_sub(UVec3::ONE));
        let t = place - low.as_vec3a();
        // From a sample to the next along each axis; none along an axis of one sample.
        let steps = UVec3::new(1, self.samples.x, self.samples.x * self.samples.y);
        let first = low.dot(steps) as usize;
        let [x, y, z] = (steps * last.min(UVec3::ONE)).to_array().map(|step| step as usize);
        let row = |i: usize| self.velocity[i].lerp(self.velocity[i + x], t.x);
        let layer = |i: usize| row(i).lerp(row(i + y), t.y);
        layer(first).lerp(layer(first + z), t.z)
    }
}

/// Evaluates one wind at one time.
struct Noise<'a> {
    wind: &'a WindSource,
    speed: f32,
    /// How far the air has travelled, m.
    travelled: Vec3A,
    time: f32,
    noise: FastNoiseLite,
}

impl<'a> Noise<'a> {
    fn new(wind: &'a WindSource, time: f32) -> Self {
        let mut noise = FastNoiseLite::with_seed(wind.gusts.seed as i32);
        noise.set_noise_type(Some(NoiseType::OpenSimplex2));
        noise.set_frequency(Some(1.0));
        Self { wind, speed: wind.velocity.length(), travelled: wind.velocity * time, time, noise }
    }

    fn velocity(&self, point: Vec3A) -> Vec3A {
        let gusts = &self.wind.gusts;
        let material_point = self.wind.origin + point - self.travelled;
        let mut velocity = self.wind.velocity;
        if gusts.strength > 0.0 {
            // A gust is a front that comes with the wind, one period of travel apart from the next.
            let front = material_point.dot(self.wind.velocity.normalize_or_zero());
            let phase = front / (self.speed * gusts.period).max(1e-6);
            velocity *= 1.0 + gusts.strength * self.noise.get_noise_2d(phase, 0.5);
        }
        if gusts.turbulence > 0.0 {
            // The slow drift along the third axis lets eddies change as they travel.
            let p = material_point / gusts.eddy_size.max(1e-3);
            let drift = self.time / gusts.period.max(1e-3);
            let eddy = |shift: f32| self.noise.get_noise_3d(p.x + shift, p.y, p.z + drift);
            velocity +=
                Vec3A::new(eddy(0.0), eddy(31.7), eddy(67.3)) * (self.speed * gusts.turbulence * NOISE_TO_DEVIATION);
        }
        velocity
    }
}

/// OpenSimplex2 noise spans -1..1 with a standard deviation of about 0.4.
const NOISE_TO_DEVIATION: f32 = 2.5;
