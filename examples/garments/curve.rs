//! Plane curves by their length.

use bevy::math::DVec2;

/// A plane curve as a chain of short straight pieces, m.
pub struct Curve {
    points: Vec<DVec2>,
    /// Length from the begin to each of the points.
    lengths: Vec<f64>,
}

impl Curve {
    /// So many pieces deviate by less than 0.1 mm from what is worn.
    const PIECES: u32 = 64;

    /// Follows `place` from 0 to 1.
    pub fn new(place: impl Fn(f64) -> DVec2) -> Self {
        let points: Vec<DVec2> = (0..=Self::PIECES).map(|i| place(f64::from(i) / f64::from(Self::PIECES))).collect();
        let mut length = 0.0;
        let steps = points.windows(2).map(|ends| {
            length += ends[0].distance(ends[1]);
            length
        });
        let lengths = core::iter::once(0.0).chain(steps).collect();
        Self { points, lengths }
    }

    /// A straight line.
    pub fn line(from: impl Into<DVec2>, to: impl Into<DVec2>) -> Self {
        let (from, to) = (from.into(), to.into());
        Self::new(|share| from.lerp(to, share))
    }

    /// An ellipse around the origin with semi-axes along X and Y, from one angle to another, rad from +X on.
    pub fn ellipse(axes: impl Into<DVec2>, from: f64, to: f64) -> Self {
        let axes = axes.into();
        Self::new(|share| DVec2::from_angle(from + share * (to - from)) * axes)
    }

    /// Its whole length, m.
    pub fn length(&self) -> f64 {
        self.lengths[self.lengths.len() - 1]
    }

    /// The point after a share of its length.
    pub fn at(&self, share: f64) -> DVec2 {
        let length = share.clamp(0.0, 1.0) * self.length();
        let end = self.lengths.partition_point(|&l| l < length).clamp(1, self.points.len() - 1);
        let (before, after) = (self.lengths[end - 1], self.lengths[end]);
        let way = (length - before) / (after - before).max(f64::MIN_POSITIVE);
        self.points[end - 1].lerp(self.points[end], way)
    }

    /// Points as far from each other along it, at most `step`: from its begin on, without its end.
    pub fn steps(&self, step: f64) -> impl Iterator<Item = DVec2> {
        let count = (self.length() / step).ceil().max(1.0);
        (0..count as u32).map(move |i| self.at(f64::from(i) / count))
    }
}

/// Points around a closed outline that consists of these curves, each of which begins where the one before ends.
pub fn outline(curves: &[Curve], step: f64) -> Vec<DVec2> {
    curves.iter().flat_map(|curve| curve.steps(step)).collect()
}
