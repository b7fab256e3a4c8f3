//! What bends pull with, eight side by side.

use fearless_simd::{f32x8, prelude::*};

use crate::{
    constraint::unstructured::bend::BendSolver,
    layout::{
        points::{apart, together},
        simd::{LANES, SHORTEST, Vec3x8, lane},
    },
    particles::gathered::{GatheredParticles, gather},
    topology::Bend,
};

/// Times its angle, how much of its lengths a bend counts at least.
const FOLDED: f32 = 3.0;

/// Adds what the bends of one batch pull with, which share no particle.
#[inline(always)]
pub fn pull_batch<S: Simd, const FRAMED: bool>(
    simd: S,
    gathered: &GatheredParticles,
    pull: &mut [[f32; 4]],
    bends: &[Bend],
    bending: BendSolver,
) {
    let (groups, rest) = bends.as_chunks::<LANES>();
    for bends in groups {
        pull_eight::<S, FRAMED>(simd, gathered, pull, bends, bending);
    }
    if !rest.is_empty() {
        let mut bends = [Bend { particles: [gathered.dummy(); 4], ..Bend::default() }; LANES];
        bends[..rest.len()].copy_from_slice(rest);
        pull_eight::<S, FRAMED>(simd, gathered, pull, &bends, bending);
    }
}

#[inline(always)]
fn pull_eight<S: Simd, const FRAMED: bool>(
    simd: S,
    gathered: &GatheredParticles,
    pull: &mut [[f32; 4]],
    bends: &[Bend; LANES],
    bending: BendSolver,
) {
    let [b0, b1, b2, b3, b4, b5, b6, b7] = bends;
    macro_rules! each {
        ($field:ident [$i:literal]) => {
            [
                b0.$field[$i],
                b1.$field[$i],
                b2.$field[$i],
                b3.$field[$i],
                b4.$field[$i],
                b5.$field[$i],
                b6.$field[$i],
                b7.$field[$i],
            ]
        };
    }
    let particles = [each!(particles[0]), each!(particles[1]), each!(particles[2]), each!(particles[3])];
    let eight =
        [&b0.weights, &b1.weights, &b2.weights, &b3.weights, &b4.weights, &b5.weights, &b6.weights, &b7.weights];
    let [_, w1, w2, w3] = apart(simd, eight);
    let weights = [w1, w2, w3];
    let arms = BendElement8::of(simd, &gathered.now, &particles);
    let pulls = if FRAMED {
        let rest =
            Vec3x8 { x: lane(simd, &each!(rest[0])), y: lane(simd, &each!(rest[1])), z: lane(simd, &each!(rest[2])) };
        // Nobody reads it where nothing is damped, and nobody has written it then.
        let before = if bending.c > 0.0 { BendElement8::of(simd, &gathered.before, &particles) } else { arms };
        arms.pull_framed(simd, before, weights, rest, bending)
    } else {
        arms.pull(weights, bending)
    };
    let first = Vec3x8::splat(simd, [0.0; 3]) - (pulls[0] + pulls[1] + pulls[2]);
    add(simd, pull, &particles[0], first);
    add(simd, pull, &particles[1], pulls[0]);
    add(simd, pull, &particles[2], pulls[1]);
    add(simd, pull, &particles[3], pulls[2]);
}

#[inline(always)]
fn add<S: Simd>(simd: S, pull: &mut [[f32; 4]], particles: &[u32; LANES], Vec3x8 { x, y, z }: Vec3x8<S>) {
    for (&i, more) in particles.iter().zip(together([x, y, z, f32x8::splat(simd, 0.0)])) {
        for (pull, more) in pull[i as usize].iter_mut().zip(more) {
            *pull += more;
        }
    }
}

/// Eight bends: from the first particle to the others. With the differences, the numbers are small wherever the cloth is.
#[derive(Clone, Copy)]
struct BendElement8<S: Simd>([Vec3x8<S>; 3]);

impl<S: Simd> BendElement8<S> {
    #[inline(always)]
    fn of(simd: S, gathered: &[[f32; 4]], [p0, p1, p2, p3]: &[[u32; LANES]; 4]) -> Self {
        let [x, y, z, _] = gather(simd, gathered, p0);
        let first = Vec3x8 { x, y, z };
        let [x, y, z, _] = gather(simd, gathered, p1);
        let one = Vec3x8 { x, y, z } - first;
        let [x, y, z, _] = gather(simd, gathered, p2);
        let two = Vec3x8 { x, y, z } - first;
        let [x, y, z, _] = gather(simd, gathered, p3);
        Self([one, two, Vec3x8 { x, y, z } - first])
    }

    #[inline(always)]
    fn sum(&self, [w1, w2, w3]: [f32x8<S>; 3]) -> Vec3x8<S> {
        self.0[0] * w1 + self.0[1] * w2 + self.0[2] * w3
    }

    /// What pulls at the particles but the first, where the cloth is flat at rest and nothing is damped.
    #[inline(always)]
    fn pull(&self, weights: [f32x8<S>; 3], bending: BendSolver) -> [Vec3x8<S>; 3] {
        let [w1, w2, w3] = weights;
        let [k1, k2, k3] = [w1 * bending.k, w2 * bending.k, w3 * bending.k];
        let sum = self.sum(weights);
        [sum * k1, sum * k2, sum * k3]
    }

    /// The same with all that there is.
    #[inline(always)]
    fn pull_framed(
        &self,
        simd: S,
        before: Self,
        weights: [f32x8<S>; 3],
        rest: Vec3x8<S>,
        bending: BendSolver,
    ) -> [Vec3x8<S>; 3] {
        let [w1, w2, w3] = weights;
        let sum = self.sum(weights);
        let edge = self.0[0];
        let span = self.0[2] - self.0[1];
        let shortest = f32x8::splat(simd, SHORTEST);
        let length = edge.dot(edge).sqrt().max(shortest);
        let along = edge * (f32x8::splat(simd, 1.0) / length);
        let skew = span.dot(along);
        let across = span - along * skew;
        let width = across.dot(across).sqrt().max(shortest);
        let across = across * (f32x8::splat(simd, 1.0) / width);
        let normal = along.cross(across);

        let bent = sum - (along * rest.x + across * rest.y + normal * rest.z);
        let mut stress = bent * f32x8::splat(simd, bending.k);
        // A bend that is folded up turns with its slightest motion: there, its frame follows by less.
        let size = sum.dot(sum).sqrt() * FOLDED;
        let least = f32x8::splat(simd, f32::MIN_POSITIVE);
        let one = f32x8::splat(simd, 1.0);
        let width = width.max(size / (w2.abs() + w3.abs()).max(least));
        // Where it lies along the edge rather than across, a turn about the edge takes the edge's ends along as far.
        let lean = (skew / width).abs().max(one);
        let length = length.max(size * lean / (w2 + w3).abs().max(least));
        let (per_length, per_width) = (one / length, one / width);
        if bending.c > 0.0 {
            let (edge_way, span_way) = (edge - before.0[0], span - (before.0[2] - before.0[1]));
            let rise = normal.dot(edge_way) * per_length;
            let turn = along * ((normal.dot(span_way) - skew * rise) * per_width) - across * rise
                + normal * (across.dot(edge_way) * per_length);
            // What goes farther than it is long within a substep was put there, as by tethers, and isn't slowed down.
            let (size, way) = (edge.dot(edge) + span.dot(span), edge_way.dot(edge_way) + span_way.dot(span_way));
            let moved = (size / way.max(least)).sqrt().min(one);
            stress = stress + (sum - before.sum(weights) - turn.cross(sum)) * (moved * bending.c);
        }
        let torque = sum.cross(stress);
        let about_along = torque.dot(along) * per_width;
        let on_edge = across * (torque.dot(normal) * per_length)
            - normal * ((torque.dot(across) + about_along * skew) * per_length);
        let on_span = normal * about_along;
        [stress * w1 - on_edge, stress * w2 + on_span, stress * w3 - on_span]
    }
}

#[cfg(test)]
mod tests {
    use bevy_math::Vec3A;
    use fearless_simd::dispatch;
    use proptest::{collection, prop_assert, proptest, test_runner::Config};

    use super::*;
    use crate::{
        constraint::unstructured::bend::{
            element::{
                BendElement,
                tests::{hinge, state},
            },
            stages::Stages,
        },
        layout::simd::SimdLevel,
        material::Moduli,
    };

    /// What eleven copies of a bend pull with, each at its own particles.
    fn pulls(bend: Bend, now: [Vec3A; 4], before: [Vec3A; 4], bending: BendSolver) -> Vec<Vec3A> {
        const COUNT: usize = 11;
        let bends: Vec<Bend> =
            (0..COUNT as u32).map(|i| Bend { particles: [4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3], ..bend }).collect();
        let list = |points: [Vec3A; 4]| -> Vec<[f32; 4]> {
            let points = points.map(|p| [p.x, p.y, p.z, 1.0]);
            points.into_iter().cycle().take(4 * COUNT).chain([[0.0; 4]]).collect()
        };
        let gathered = GatheredParticles { now: list(now), before: list(before) };
        let mut pull = vec![[0.0; 4]; gathered.now.len()];
        for simd_level in [SimdLevel::Best, SimdLevel::Baseline] {
            pull.fill([0.0; 4]);
            dispatch!(simd_level.level(), simd => match bending.framed {
                true => pull_batch::<_, true>(simd, &gathered, &mut pull, &bends, bending),
                false => pull_batch::<_, false>(simd, &gathered, &mut pull, &bends, bending),
            });
        }
        assert!(pull[..4 * COUNT].chunks(4).all(|four| four == &pull[..4]) && pull[4 * COUNT] == [0.0; 4]);
        pull[..4].iter().map(|&[x, y, z, _]| Vec3A::new(x, y, z)).collect()
    }

    fn bending(k: f32, c: f32, framed: bool) -> BendSolver {
        BendSolver { k, c, framed, stages: Stages::for_rate(1.0).0 }
    }

    proptest! {
        #![proptest_config(Config { failure_persistence: None, ..Config::default() })]

        #[test]
        fn eight_side_by_side_pull_as_the_textbook_does(noise in collection::vec(-1.0_f32..1.0, 24)) {
            // Not so bent that it counts as folded.
            let (now, velocities) = state(&noise.iter().map(|x| 0.1 * x).collect::<Vec<f32>>());
            let before = [0, 1, 2, 3].map(|i| now[i] - velocities[i]);
            let moduli = Moduli { bending: 2.0, bend_damping: 0.25, ..Moduli::default() };
            let bend = hinge();
            let expected = BendElement::new(&bend, now).forces(&bend, &moduli, &BendElement::new(&bend, velocities));
            for (pull, force) in pulls(bend, now, before, bending(2.0, 0.5, true)).into_iter().zip(expected) {
                prop_assert!((pull + force).length() < 1e-3 * (1.0 + force.length()), "{pull} {force}");
            }
            let flat = Bend { rest: [0.0; 3], ..bend };
            let [with, without] =
                [true, false].map(|framed| pulls(flat, now, before, bending(2.0, 0.0, framed)));
            for (with, without) in with.into_iter().zip(without) {
                prop_assert!((with - without).length() < 1e-3, "{with} {without}");
            }
        }
    }

    #[test]
    fn nothing_is_infinite_where_points_fall_together() {
        for points in [[Vec3A::ZERO; 4], [Vec3A::ZERO, Vec3A::X, Vec3A::X, Vec3A::X]] {
            let pulls = pulls(hinge(), points, points.map(|p| p * 2.0), bending(1e9, 1e9, true));
            assert!(pulls.iter().all(|pull| pull.is_finite()), "{pulls:?}");
        }
    }
}
