//! Gusts and turbulence: seeded noise that travels with the wind.
//!
//! Taylor's frozen-turbulence hypothesis: eddies are carried along faster than they change, so noise in space, moved
//! with the mean wind, gives noise in time as well. It is sampled on a coarse lattice around the cloth, because it
//! changes little over less than its length scale, and interpolated in between.

use bevy_math::{UVec3, Vec3, Vec3A};
use fastnoise_lite::{FastNoiseLite, NoiseType};

use crate::input::WindSource;

/// Most samples of a lattice along each axis. Where a cloth is larger, the lattice is coarser, and so are its eddies.
const MOST_SAMPLES: u32 = 8;

/// Samples along the size of an eddy.
const SAMPLES_PER_EDDY: f32 = 2.0;

/// Air velocity around one cloth, m/s.
///
/// The samples stand still in the world while the cloth moves among them, so what it feels has no jumps, unless it is so
/// large that it changes between lattices of [`MOST_SAMPLES`].
pub(crate) struct GustField {
    /// Place of the first sample, m, relative to the cloth's origin.
    corner: Vec3A,
    /// Samples per metre; zero where one sample stands for all.
    scale: f32,
    samples: UVec3,
    velocity: [Vec3A; (MOST_SAMPLES * MOST_SAMPLES * MOST_SAMPLES) as usize],
}

impl GustField {
    /// Samples `wind` over the box around `position`.
    pub fn sample(wind: &WindSource, position: &[Vec3A]) -> Self {
        let mut field = Self::around(wind, position);
        let spacing = if field.scale > 0.0 { 1.0 / field.scale } else { 0.0 };
        let noise = Noise::new(wind);
        for index in 0..field.samples.element_product() {
            let point = field.corner + field.cell(index).as_vec3a() * spacing;
            field.velocity[index as usize] = noise.velocity(point);
        }
        field
    }

    /// A lattice that is fine enough for the eddies, with a single sample where the wind is the same everywhere.
    fn around(wind: &WindSource, position: &[Vec3A]) -> Self {
        let velocity = [Vec3A::ZERO; _];
        let everywhere_the_same = Self { corner: Vec3A::ZERO, scale: 0.0, samples: UVec3::ONE, velocity };
        if wind.gusts.strength == 0.0 && wind.gusts.turbulence == 0.0 {
            return everywhere_the_same;
        }
        let low = wind.origin + position.iter().fold(Vec3A::INFINITY, |a, &b| a.min(b));
        let high = wind.origin + position.iter().fold(Vec3A::NEG_INFINITY, |a, &b| a.max(b));
        let mut spacing = wind.gusts.eddy_size.max(1e-3) / SAMPLES_PER_EDDY;
        while spacing.is_finite() {
            let (first, last) = ((low / spacing).floor(), (high / spacing).ceil());
            let most = (last - first).max_element();
            if most < MOST_SAMPLES as f32 {
                let samples = (last - first).as_uvec3() + 1;
                return Self { corner: first * spacing - wind.origin, scale: 1.0 / spacing, samples, velocity };
            }
            // By whole octaves, so that the samples of the coarser lattice are among those of the finer.
            spacing *= 2.0;
        }
        everywhere_the_same
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

/// Evaluates one wind.
struct Noise<'a> {
    wind: &'a WindSource,
    speed: f32,
    direction: Vec3A,
    noise: FastNoiseLite,
}

impl<'a> Noise<'a> {
    fn new(wind: &'a WindSource) -> Self {
        let mut noise = FastNoiseLite::with_seed(wind.gusts.seed as i32);
        noise.set_noise_type(Some(NoiseType::OpenSimplex2));
        noise.set_frequency(Some(1.0));
        let (direction, speed) = (wind.velocity.normalize_or_zero(), wind.velocity.length());
        Self { wind, speed, direction, noise }
    }

    fn velocity(&self, point: Vec3A) -> Vec3A {
        let WindSource { gusts, travelled, gusts_passed, .. } = self.wind;
        let place = self.wind.origin + point;
        let mut velocity = self.wind.velocity;
        if gusts.strength > 0.0 {
            // A gust is a front that comes with the wind, one period of travel apart from the next.
            let apart = f64::from((self.speed * gusts.period).max(1e-6));
            let front = place.as_dvec3().dot(self.direction.as_dvec3()) / apart - gusts_passed;
            velocity *= 1.0 + gusts.strength * self.noise.get_noise_2d(wrapped(front), 0.5);
        }
        if gusts.turbulence > 0.0 {
            let eddies = (place.as_dvec3() - travelled) / f64::from(gusts.eddy_size.max(1e-3));
            // The slow drift along the third axis lets eddies change as they travel.
            let p = Vec3::from(eddies.to_array().map(wrapped)) + Vec3::Z * wrapped(*gusts_passed);
            let eddy = |shift: f32| self.noise.get_noise_3d(p.x + shift, p.y, p.z);
            velocity +=
                Vec3A::new(eddy(0.0), eddy(31.7), eddy(67.3)) * (self.speed * gusts.turbulence * NOISE_TO_DEVIATION);
        }
        velocity
    }
}

/// The noise begins anew after so many of its own lengths: farther from zero an `f32` has no room for what is between two of
/// them, and much farther they can't be counted.
const AGAIN: f64 = (1 << 20) as f64;

/// A place of the noise. What is too far away to be one is at zero.
fn wrapped(place: f64) -> f32 {
    let place = place % AGAIN;
    if place.is_nan() { 0.0 } else { place as f32 }
}

/// OpenSimplex2 noise spans -1..1 with a standard deviation of about 0.4.
const NOISE_TO_DEVIATION: f32 = 2.5;
