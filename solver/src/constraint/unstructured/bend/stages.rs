//! Stages that together are as stable as an implicit step.

use bevy_math::ops;
use fearless_simd::prelude::*;

/// What is left of the fastest motions is one over this. More than three, or a cloth would swing up by itself: the
/// velocity of a particle that is turned back by a third goes on forever.
const REDUCTION: f32 = 4.0;

/// The most stages. What would take more is softened: with eight substeps, the cells of such a mesh are a twelfth of the length over which the
/// cloth bends.
const MOST_STAGES: u32 = 64;

/// The polynomial that stages make.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stages {
    pub count: u32,
    w0: f32,
    w1: f32,
}

impl Stages {
    fn new(count: u32) -> Self {
        // T(cosh t) = cosh(count t), which is to be the reduction.
        let angle = ops::acosh(REDUCTION) / count as f32;
        let slope = count as f32 * (REDUCTION * REDUCTION - 1.0).sqrt() / ops::sinh(angle);
        Self { count, w0: ops::cosh(angle), w1: REDUCTION / slope }
    }

    /// The fastest that may be, times h².
    fn most(&self) -> f32 {
        (self.w0 + 1.0) / self.w1
    }

    /// As few as are stable for what is as fast, and the share of its stiffness that they can bear.
    pub fn for_rate(fastest: f32) -> (Self, f32) {
        // Close to what they can bear, and then the next that can.
        let about = (fastest.max(0.0) * 0.9).sqrt().min(MOST_STAGES as f32) as u32;
        let mut stages = Self::new(about.max(1));
        while stages.most() < fastest && stages.count < MOST_STAGES {
            stages = Self::new(stages.count + 1);
        }
        (stages, (stages.most() / fastest).min(1.0))
    }
}

impl Stages {
    /// Shares of the way so far, of that before, and of what pulls, stage after stage: T(n+1) = 2 x T(n) - T(n-1) with
    /// x = w0 - w1 W H, over its value at w0.
    pub fn shares(self) -> impl Iterator<Item = [f32; 3]> {
        let Self { count, w0, w1 } = self;
        let (mut before, mut now) = (0.0, 1.0);
        (0..count).map(move |stage| {
            let factor = if stage == 0 { 1.0 } else { 2.0 };
            let next = factor * w0 * now - before;
            let shares = [factor * w0 * now / next, before / next, factor * w1 * now / next];
            (before, now) = (now, next);
            shares
        })
    }
}

/// Buffers for stages, for each particle four numbers as of the gathered particles.
#[derive(Clone, Debug, Default)]
pub struct ChebyshevBuffers {
    /// Where it was before the first stage, m.
    start: Vec<[f32; 4]>,
    /// The way from there after the stage before, m.
    way: Vec<[f32; 4]>,
    /// The way after the one before that, m.
    earlier: Vec<[f32; 4]>,
    /// The sum of what pulls, times h², kg m.
    pub pull: Vec<[f32; 4]>,
}

impl ChebyshevBuffers {
    pub fn begin(&mut self, now: &[[f32; 4]]) {
        self.start.clear();
        self.start.extend_from_slice(now);
        for list in [&mut self.way, &mut self.earlier, &mut self.pull] {
            list.clear();
            list.resize(now.len(), [0.0; 4]);
        }
    }

    /// Ends a stage: the ways so far, those before, and what pulls, by their shares.
    #[inline(always)]
    pub fn advance<S: Simd>(&mut self, _: S, now: &mut [[f32; 4]], [way_share, earlier_share, pull_share]: [f32; 3]) {
        let Self { start, way, earlier, pull } = self;
        let all = now.iter_mut().zip(start).zip(way).zip(earlier).zip(pull);
        for ((((now, start), way), earlier), pull) in all {
            let moves = now[3] * pull_share;
            for i in 0..4 {
                // The fourth is the inverse mass, which nothing pulls at.
                let next = way[i] * way_share - earlier[i] * earlier_share - pull[i] * moves;
                (earlier[i], way[i], pull[i]) = (way[i], next, 0.0);
                now[i] = start[i] + next;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is left of a motion whose squared frequency times h² is `rate`.
    fn left(stages: Stages, rate: f32) -> f32 {
        let mut ways = ChebyshevBuffers::default();
        let mut now = [[0.0, 0.0, 0.0, 2.0]];
        let begin = 1.0;
        now[0][0] = begin;
        ways.begin(&now);
        for shares in stages.shares() {
            // Half of the rate, as the inverse mass is two.
            ways.pull[0][0] += 0.5 * rate * now[0][0];
            let level = crate::layout::simd::SimdLevel::Baseline.level();
            fearless_simd::dispatch!(level, simd => ways.advance(simd, &mut now, shares));
        }
        assert_eq!(now[0][3], 2.0);
        now[0][0]
    }

    #[test]
    fn slow_motions_get_their_force_and_fast_ones_are_reduced() {
        for count in 1..=MOST_STAGES {
            let stages = Stages::new(count);
            let slow = 1e-3;
            assert!((left(stages, slow) - (1.0 - slow)).abs() < 0.01 * slow, "{count}");
            for i in 0..=1000 {
                let rate = i as f32 / 1000.0 * stages.most();
                let left = left(stages, rate);
                assert!((-1.01 / REDUCTION..=1.0).contains(&left), "{count} stages, {rate}: {left}");
                assert!(rate < 2.0 || left <= 1.01 / REDUCTION, "{count} stages, {rate}: {left}");
            }
        }
    }

    #[test]
    fn there_are_as_many_stages_as_it_takes_and_no_more() {
        for fastest in [0.0, 0.1, 1.0, 3.0, 50.0, 400.0] {
            let (stages, share) = Stages::for_rate(fastest);
            assert!(stages.most() >= fastest && share == 1.0, "{fastest}: {stages:?}");
            assert!(stages.count == 1 || Stages::new(stages.count - 1).most() < fastest, "{fastest}: {stages:?}");
        }
        let (stages, share) = Stages::for_rate(1e6);
        assert!(stages.count == MOST_STAGES && (1e6 * share / stages.most() - 1.0).abs() < 1e-5);
    }
}
