//! The particles one by one, for constraints between any of them.

use fearless_simd::{dispatch, f32x4, f32x8, prelude::*};

use crate::{
    layout::{
        points::{apart, together},
        simd::{LANES, SimdLevel, Vec3Wide, Vec3x8, lane},
    },
    particles::lanes::Lanes,
};

/// One end of springs side by side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct End<F> {
    pub position: Vec3Wide<F>,
    /// Position before the substep; read only where springs are damped.
    pub previous: Vec3Wide<F>,
    pub inverse_mass: F,
}

/// The particles one by one: what constraints between any of them read and write.
#[derive(Clone, Debug, Default)]
pub(crate) struct GatheredParticles {
    /// Position, m, and inverse mass, 1/kg.
    pub now: Vec<[f32; 4]>,
    /// Position before the substep, m; only where something is damped.
    pub before: Vec<[f32; 4]>,
}

impl GatheredParticles {
    /// Takes over where the particles are, and where something `is_damped` also where they were before the substep.
    pub fn read(&mut self, lanes: &Lanes, is_damped: bool, simd_level: SimdLevel) {
        let level = simd_level.level();
        if is_damped {
            dispatch!(level, simd => self.read_blocks::<_, true>(simd, lanes));
        } else {
            dispatch!(level, simd => self.read_blocks::<_, false>(simd, lanes));
        }
    }

    /// Hands back where they are.
    pub fn write(&self, lanes: &mut Lanes, simd_level: SimdLevel) {
        dispatch!(simd_level.level(), simd => self.write_blocks(simd, lanes));
    }

    /// The particle that is where one is missing: fixed, and joined to nothing else.
    pub fn dummy(&self) -> u32 {
        self.now.len() as u32 - 1
    }

    #[inline(always)]
    fn read_blocks<S: Simd, const DAMPED: bool>(&mut self, simd: S, lanes: &Lanes) {
        // One more: nobody.
        let count = lanes.order.particle_count() + 1;
        self.now.resize(count, [0.0; 4]);
        let blocks = lanes.order.blocks().zip(&lanes.position.0).zip(&lanes.inverse_mass);
        for (((first, count), [x, y, z]), masses) in blocks {
            let gathered = together([lane(simd, x), lane(simd, y), lane(simd, z), lane(simd, masses)]);
            self.now[first..first + count].copy_from_slice(&gathered[..count]);
        }
        if DAMPED {
            self.before.resize(count, [0.0; 4]);
            for ((first, count), [x, y, z]) in lanes.order.blocks().zip(&lanes.previous.0) {
                let z = lane(simd, z);
                let gathered = together([lane(simd, x), lane(simd, y), z, z]);
                self.before[first..first + count].copy_from_slice(&gathered[..count]);
            }
        }
    }

    #[inline(always)]
    fn write_blocks<S: Simd>(&self, simd: S, lanes: &mut Lanes) {
        for ((first, count), block) in lanes.order.blocks().zip(&mut lanes.position.0) {
            let mut gathered = [[0.0; 4]; LANES];
            gathered[..count].copy_from_slice(&self.now[first..first + count]);
            let [a, b, c, d, e, f, g, h] = &gathered;
            let [x, y, z, _] = apart(simd, [a, b, c, d, e, f, g, h]);
            *block = [x.into(), y.into(), z.into()];
        }
    }
}

impl GatheredParticles {
    /// One end of eight springs, at eight particles.
    #[inline(always)]
    pub fn end<S: Simd, const DAMPED: bool>(&self, simd: S, particles: &[u32; LANES]) -> End<f32x8<S>> {
        let [x, y, z, inverse_mass] = gather(simd, &self.now, particles);
        let position = Vec3x8 { x, y, z };
        let previous = if DAMPED {
            let [x, y, z, _] = gather(simd, &self.before, particles);
            Vec3x8 { x, y, z }
        } else {
            position
        };
        End { position, previous, inverse_mass }
    }

    /// Moves eight particles.
    #[inline(always)]
    pub fn put<S: Simd>(&mut self, particles: &[u32; LANES], Vec3x8 { x, y, z }: Vec3x8<S>, inverse_mass: f32x8<S>) {
        for (&i, bead) in particles.iter().zip(together([x, y, z, inverse_mass])) {
            self.now[i as usize] = bead;
        }
    }
}

/// What eight particles have in a list.
#[inline(always)]
pub(crate) fn gather<S: Simd>(
    simd: S,
    gathered: &[[f32; 4]],
    [a, b, c, d, e, f, g, h]: &[u32; LANES],
) -> [f32x8<S>; 4] {
    apart(
        simd,
        [
            bead(gathered, a),
            bead(gathered, b),
            bead(gathered, c),
            bead(gathered, d),
            bead(gathered, e),
            bead(gathered, f),
            bead(gathered, g),
            bead(gathered, h),
        ],
    )
}

/// Adds to what eight particles have in a list, one after the other: they may be the same.
#[inline(always)]
pub(crate) fn add<S: Simd>(simd: S, sums: &mut [[f32; 4]], particles: &[u32; LANES], Vec3x8 { x, y, z }: Vec3x8<S>) {
    for (&i, more) in particles.iter().zip(together([x, y, z, f32x8::splat(simd, 0.0)])) {
        let sum = &mut sums[i as usize];
        *sum = (f32x4::simd_from(simd, *sum) + f32x4::simd_from(simd, more)).into();
    }
}

#[inline(always)]
fn bead<'a>(gathered: &'a [[f32; 4]], i: &u32) -> &'a [f32; 4] {
    &gathered[*i as usize]
}
