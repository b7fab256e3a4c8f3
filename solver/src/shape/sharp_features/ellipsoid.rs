//! The outline of an ellipsoid: balls along its rim.

use bevy_math::{Vec3A, ops};

use crate::shape::{
    Ellipsoid,
    sharp_features::{OutlineBuilder, RIM},
};

/// What is less wide than this, in lengths of its shortest half, is a ball, or as thin one way as the other.
const NARROW: f32 = 0.01;

impl OutlineBuilder {
    /// The largest balls that fit in at its rim, and all that lies between each and the next.
    ///
    /// Those that touch the surface on both sides have their centres on an elliptic disc. Its border is where they touch it
    /// only once, as the rim is curved there:
    ///
    /// ```text
    ///       . - - - - .            centre  ((a² - c²) / a cos u, (b² - c²) / b sin u)
    ///     (o o o o o o o)  c       radius  c² sqrt(cos² u / a² + sin² u / b²)
    ///       ' - - - - '
    ///             a
    /// ```
    ///
    /// That of a needle is a line, and that of a ball a point.
    pub fn ellipsoid(&mut self, ellipsoid: &Ellipsoid) {
        let ([a, b, c], axes) = ellipsoid.sorted();
        let (mut wide, mut beside) = ((b * b - c * c) / b, b);
        let long = (a * a - c * c) / a;
        if long < NARROW * c {
            self.bone([Vec3A::ZERO; 2], [c; 2]);
            return;
        }
        let is_needle = wide < NARROW * c;
        if is_needle {
            (wide, beside) = (0.0, c);
        }
        let count = if is_needle { RIM / 2 + 1 } else { RIM };
        let first = self.points.len() as u32;
        for i in 0..count {
            let (sine, cosine) = ops::sin_cos(i as f32 * core::f32::consts::TAU / RIM as f32);
            let mut centre = Vec3A::ZERO;
            centre[axes[0]] = long * cosine;
            centre[axes[1]] = wide * sine;
            self.point(centre, c * c * ops::hypot(cosine / a, sine / beside));
        }
        let edges = if is_needle { count - 1 } else { count };
        self.edges.extend((0..edges).map(|i| [first + i, first + (i + 1) % count, first + i]));
    }
}
