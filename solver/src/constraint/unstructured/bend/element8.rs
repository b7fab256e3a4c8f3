//! What bends pull with, eight side by side.

use fearless_simd::{f32x8, prelude::*};

use crate::{
    constraint::unstructured::bend::BendLaw,
    layout::simd::{LANES, Lane, SHORTEST, Vec3x8, lane},
    particles::gathered::{add, gather},
    topology::{Bend, bend_pack::BendPack},
};

/// Times its angle, how much of its lengths a bend counts at least.
const FOLDED: f32 = 3.0;

/// Frames of eight bends: directions along the edge and across it, the sum of weights times positions, how far the span goes along
/// the edge, and one over the lengths of edge and span.
pub type BendFrames = [Lane; 12];

/// Adds what the bends of one batch pull with, which share no particle. The last particle of the lists is nobody.
#[inline(always)]
pub fn pull_batch<S: Simd, const FRAMED: bool>(
    simd: S,
    now: &[[f32; 4]],
    before: &[[f32; 4]],
    pull: &mut [[f32; 4]],
    bends: &[Bend],
    bending: BendLaw,
) {
    for bends in bends.chunks(LANES) {
        pull_pack::<S, FRAMED>(simd, now, before, pull, &BendPack::new(bends, now.len() as u32 - 1), bending);
    }
}

/// Adds what eight bends pull with.
#[inline(always)]
pub fn pull_pack<S: Simd, const FRAMED: bool>(
    simd: S,
    now: &[[f32; 4]],
    before: &[[f32; 4]],
    pull: &mut [[f32; 4]],
    pack: &BendPack,
    bending: BendLaw,
) {
    let weights = weights(simd, pack);
    let arms = BendElement8::of(simd, now, &pack.particles);
    let pulls = if FRAMED {
        // Nobody reads it where nothing is damped, and nobody has written it then.
        let before = if bending.c > 0.0 { BendElement8::of(simd, before, &pack.particles) } else { arms };
        let [x, y, z] = &pack.rest;
        let rest = Vec3x8 { x: lane(simd, x), y: lane(simd, y), z: lane(simd, z) };
        arms.pull_framed(simd, before, weights, rest, bending)
    } else {
        arms.pull(weights, bending)
    };
    add_all(simd, pull, &pack.particles, pulls);
}

/// The frames of eight bends at `now`, in memory.
#[inline(always)]
pub fn frames_of_pack<S: Simd>(simd: S, now: &[[f32; 4]], pack: &BendPack) -> BendFrames {
    let arms = BendElement8::of(simd, now, &pack.particles);
    let Frame8 { along, across, sum, skew, per_length, per_width, .. } = Frame8::new(simd, &arms, weights(simd, pack));
    [
        along.x.into(),
        along.y.into(),
        along.z.into(),
        across.x.into(),
        across.y.into(),
        across.z.into(),
        sum.x.into(),
        sum.y.into(),
        sum.z.into(),
        skew.into(),
        per_length.into(),
        per_width.into(),
    ]
}

/// Adds what eight bends pull with for what they are bent more by as their particles go in a `direction`: seen from their
/// `frames`, which turn with them, or as if these stood still.
#[inline(always)]
pub fn multiply_pack<S: Simd>(
    simd: S,
    frames: Option<&BendFrames>,
    direction: &[[f32; 4]],
    product: &mut [[f32; 4]],
    pack: &BendPack,
    bending: BendLaw,
) {
    let weights = weights(simd, pack);
    let ways = BendElement8::of(simd, direction, &pack.particles);
    let stiffness = f32x8::splat(simd, bending.k + bending.c);
    let pulls = match frames {
        Some(frames) => {
            let frame = Frame8::load(simd, frames);
            frame.pull(frame.bent_by(ways, weights) * stiffness, weights)
        }
        None => {
            let stress = ways.sum(weights) * stiffness;
            [stress * weights[0], stress * weights[1], stress * weights[2]]
        }
    };
    add_all(simd, product, &pack.particles, pulls);
}

#[inline(always)]
fn weights<S: Simd>(simd: S, pack: &BendPack) -> [f32x8<S>; 3] {
    let [w1, w2, w3] = &pack.weights;
    [lane(simd, w1), lane(simd, w2), lane(simd, w3)]
}

/// Adds pulls at the particles but the first, which takes what is left.
#[inline(always)]
fn add_all<S: Simd>(simd: S, sums: &mut [[f32; 4]], particles: &[[u32; LANES]; 4], pulls: [Vec3x8<S>; 3]) {
    let first = Vec3x8::splat(simd, [0.0; 3]) - (pulls[0] + pulls[1] + pulls[2]);
    add(simd, sums, &particles[0], first);
    add(simd, sums, &particles[1], pulls[0]);
    add(simd, sums, &particles[2], pulls[1]);
    add(simd, sums, &particles[3], pulls[2]);
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
    fn pull(&self, weights: [f32x8<S>; 3], bending: BendLaw) -> [Vec3x8<S>; 3] {
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
        bending: BendLaw,
    ) -> [Vec3x8<S>; 3] {
        let frame = Frame8::new(simd, self, weights);
        let Frame8 { along, across, normal, sum, .. } = frame;
        let bent = sum - (along * rest.x + across * rest.y + normal * rest.z);
        let mut stress = bent * f32x8::splat(simd, bending.k);
        if bending.c > 0.0 {
            let way = self.since(before);
            // What goes farther than it is long within a substep was put there, as by tethers, and isn't slowed down.
            let (size, moved) = (self.size(), way.size());
            let least = f32x8::splat(simd, f32::MIN_POSITIVE);
            let share = (size / moved.max(least)).sqrt().min(f32x8::splat(simd, 1.0));
            stress = stress + frame.bent_by(way, weights) * (share * bending.c);
        }
        frame.pull(stress, weights)
    }

    /// The ways from where they were.
    #[inline(always)]
    fn since(&self, before: Self) -> Self {
        let ([a, b, c], [d, e, f]) = (self.0, before.0);
        Self([a - d, b - e, c - f])
    }

    /// Edge and span, squared.
    #[inline(always)]
    fn size(&self) -> f32x8<S> {
        let (edge, span) = (self.0[0], self.0[2] - self.0[1]);
        edge.dot(edge) + span.dot(span)
    }
}

/// The frames of eight bends, which turn with them.
#[derive(Clone, Copy)]
struct Frame8<S: Simd> {
    along: Vec3x8<S>,
    across: Vec3x8<S>,
    normal: Vec3x8<S>,
    /// The sum of weights times positions.
    sum: Vec3x8<S>,
    /// How far the span goes along the edge, m.
    skew: f32x8<S>,
    /// 1 over the length of the edge, and over that of the span across it, 1/m.
    per_length: f32x8<S>,
    per_width: f32x8<S>,
}

impl<S: Simd> Frame8<S> {
    #[inline(always)]
    fn new(simd: S, arms: &BendElement8<S>, weights: [f32x8<S>; 3]) -> Self {
        let [_, w2, w3] = weights;
        let sum = arms.sum(weights);
        let edge = arms.0[0];
        let span = arms.0[2] - arms.0[1];
        let shortest = f32x8::splat(simd, SHORTEST);
        let length = edge.dot(edge).sqrt().max(shortest);
        let along = edge * (f32x8::splat(simd, 1.0) / length);
        let skew = span.dot(along);
        let across = span - along * skew;
        let width = across.dot(across).sqrt().max(shortest);
        let across = across * (f32x8::splat(simd, 1.0) / width);
        let normal = along.cross(across);
        // A bend that is folded up turns with its slightest motion: there, its frame follows by less.
        let size = sum.dot(sum).sqrt() * FOLDED;
        let least = f32x8::splat(simd, f32::MIN_POSITIVE);
        let one = f32x8::splat(simd, 1.0);
        let width = width.max(size / (w2.abs() + w3.abs()).max(least));
        // Where it lies along the edge rather than across, a turn about the edge takes the edge's ends along as far.
        let lean = (skew / width).abs().max(one);
        let length = length.max(size * lean / (w2 + w3).abs().max(least));
        Self { along, across, normal, sum, skew, per_length: one / length, per_width: one / width }
    }

    #[inline(always)]
    fn load(simd: S, [a, b, c, d, e, f, g, h, i, skew, per_length, per_width]: &BendFrames) -> Self {
        let along = Vec3x8 { x: lane(simd, a), y: lane(simd, b), z: lane(simd, c) };
        let across = Vec3x8 { x: lane(simd, d), y: lane(simd, e), z: lane(simd, f) };
        Self {
            along,
            across,
            normal: along.cross(across),
            sum: Vec3x8 { x: lane(simd, g), y: lane(simd, h), z: lane(simd, i) },
            skew: lane(simd, skew),
            per_length: lane(simd, per_length),
            per_width: lane(simd, per_width),
        }
    }

    /// How the sum changes in the frame as the particles go their ways.
    #[inline(always)]
    fn bent_by(&self, ways: BendElement8<S>, weights: [f32x8<S>; 3]) -> Vec3x8<S> {
        let Self { along, across, normal, sum, skew, per_length, per_width } = *self;
        let (edge_way, span_way) = (ways.0[0], ways.0[2] - ways.0[1]);
        let rise = normal.dot(edge_way) * per_length;
        let turn = along * ((normal.dot(span_way) - skew * rise) * per_width) - across * rise
            + normal * (across.dot(edge_way) * per_length);
        ways.sum(weights) - turn.cross(sum)
    }

    /// What a stress pulls with at the particles but the first: the transpose of [`bent_by`](Self::bent_by).
    #[inline(always)]
    fn pull(&self, stress: Vec3x8<S>, [w1, w2, w3]: [f32x8<S>; 3]) -> [Vec3x8<S>; 3] {
        let Self { along, across, normal, sum, skew, per_length, per_width } = *self;
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
        constraint::unstructured::bend::element::{
            BendElement,
            tests::{hinge, state},
        },
        layout::simd::SimdLevel,
        material::Moduli,
    };

    /// What eleven copies of a bend pull with, each at its own particles.
    fn pulls(bend: Bend, now: [Vec3A; 4], before: [Vec3A; 4], bending: BendLaw) -> Vec<Vec3A> {
        const COUNT: usize = 11;
        let bends: Vec<Bend> =
            (0..COUNT as u32).map(|i| Bend { particles: [4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3], ..bend }).collect();
        let list = |points: [Vec3A; 4]| -> Vec<[f32; 4]> {
            let points = points.map(|p| [p.x, p.y, p.z, 1.0]);
            points.into_iter().cycle().take(4 * COUNT).chain([[0.0; 4]]).collect()
        };
        let (now, before) = (list(now), list(before));
        let mut pull = vec![[0.0; 4]; now.len()];
        for simd_level in [SimdLevel::Best, SimdLevel::Baseline] {
            pull.fill([0.0; 4]);
            dispatch!(simd_level.level(), simd => match bending.framed {
                true => pull_batch::<_, true>(simd, &now, &before, &mut pull, &bends, bending),
                false => pull_batch::<_, false>(simd, &now, &before, &mut pull, &bends, bending),
            });
        }
        assert!(pull[..4 * COUNT].chunks(4).all(|four| four == &pull[..4]) && pull[4 * COUNT] == [0.0; 4]);
        pull[..4].iter().map(|&[x, y, z, _]| Vec3A::new(x, y, z)).collect()
    }

    fn bending(k: f32, c: f32, framed: bool) -> BendLaw {
        BendLaw { k, c, framed }
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
