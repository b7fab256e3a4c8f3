//! The heavy elastica: the curve of a strip that is clamped level at one end and bends under its own weight.
//!
//! With u from the free end towards the clamp, θ the angle below the level and c³ = B / (density g), the moment at u is that
//! of the weight beyond it, so that
//!
//! ```text
//!   θ''(u) = -(u / c³) cos θ,   θ'(0) = 0,   θ = 0 at the clamp
//! ```
//!
//! Bickley, "The heavy elastica" (1934). It is solved from the free end with c = 1 for an angle there, by Runge and Kutta's
//! method of fourth order, up to where the curve is level: that is the clamp.

use super::roots;

/// Steps are this long, as a share of the bending length.
const STEP: f64 = 1e-3;

/// The angle of the chord at which a laboratory reads the bending length off: ASTM D1388's, rad.
pub const PLANE: f64 = 41.5 * core::f64::consts::PI / 180.0;

/// A curve with bending length 1, from the free end to the clamp.
pub struct Elastica {
    /// Arc length from the free end, way towards the clamp along the level and upwards.
    points: Vec<[f64; 3]>,
}

impl Elastica {
    /// The one whose free end is so steep, rad.
    pub fn with_tip(angle: f64) -> Self {
        // θ, θ', x, y
        let derivative = |u: f64, [angle, turn, ..]: [f64; 4]| [turn, -u * angle.cos(), angle.cos(), angle.sin()];
        let add = |state: [f64; 4], by: f64, d: [f64; 4]| [0, 1, 2, 3].map(|i| state[i] + by * d[i]);
        let mut state = [angle, 0.0, 0.0, 0.0];
        let mut points = vec![[0.0; 3]];
        let mut u = 0.0;
        loop {
            let k1 = derivative(u, state);
            let k2 = derivative(u + 0.5 * STEP, add(state, 0.5 * STEP, k1));
            let k3 = derivative(u + 0.5 * STEP, add(state, 0.5 * STEP, k2));
            let k4 = derivative(u + STEP, add(state, STEP, k3));
            let next = [0, 1, 2, 3].map(|i| state[i] + STEP / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
            if next[0] <= 0.0 {
                // The rest of the way to where it is level.
                let share = state[0] / (state[0] - next[0]);
                let last = [2, 3].map(|i| state[i] + share * (next[i] - state[i]));
                points.push([u + share * STEP, last[0], last[1]]);
                return Self { points };
            }
            (u, state) = (u + STEP, next);
            points.push([u, state[2], state[3]]);
        }
    }

    /// The one whose chord from the clamp to the free end goes down at `angle`, rad, up to some 80°.
    pub fn with_chord(angle: f64) -> Self {
        let excess = |tip: f64| Self::with_tip(tip).chord() - angle;
        // With its end upright the curve would have no end.
        let steepest = core::f64::consts::FRAC_PI_2 - 1e-4;
        Self::with_tip(roots::bisect(40, 1e-4, steepest, excess))
    }

    /// Overhang over bending length.
    pub fn overhang(&self) -> f64 {
        self.end()[0]
    }

    /// Angle of the chord below the level, rad.
    pub fn chord(&self) -> f64 {
        let [_, x, y] = self.end();
        y.atan2(x)
    }

    /// The curve from the clamp, as far and as deep: in bending lengths.
    pub fn profile(&self) -> impl Iterator<Item = [f64; 2]> {
        let [_, x, y] = self.end();
        self.points.iter().rev().map(move |point| [x - point[1], y - point[2]])
    }

    fn end(&self) -> [f64; 3] {
        self.points[self.points.len() - 1]
    }
}

/// Peirce's approximation of bending length over overhang for a chord at `angle`, rad. Peirce, "The 'handle' of cloth as a
/// measurable quantity" (1930).
pub fn peirce(angle: f64) -> f64 {
    ((0.5 * angle).cos() / (8.0 * angle.tan())).cbrt()
}
