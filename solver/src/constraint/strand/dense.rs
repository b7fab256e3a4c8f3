//! What eliminations are to find, from the whole matrix in double precision: for tests.

use bevy_math::DVec3;

/// Solves a system by Gauss' elimination with pivots. Each row has one right side in each of three directions.
pub fn solve(mut rows: Vec<Vec<f64>>, mut right: Vec<DVec3>) -> Vec<DVec3> {
    let count = rows.len();
    for i in 0..count {
        let largest = (i..count).max_by(|&a, &b| rows[a][i].abs().total_cmp(&rows[b][i].abs())).unwrap_or(i);
        rows.swap(i, largest);
        right.swap(i, largest);
        let (pivots, pivot_right) = (rows[i].clone(), right[i]);
        for (j, (row, right)) in rows.iter_mut().zip(&mut right).enumerate() {
            let factor = if i == j { 0.0 } else { row[i] / pivots[i] };
            row.iter_mut().zip(&pivots).for_each(|(entry, pivot)| *entry -= pivot * factor);
            *right -= pivot_right * factor;
        }
    }
    (0..count).map(|i| right[i] / rows[i][i]).collect()
}

/// A strand, as [`tridiagonal`](crate::constraint::strand::tridiagonal) has it.
#[derive(Clone, Debug, Default)]
pub struct Strand {
    /// Where its nodes are, and where they were before the substep, m.
    pub position: Vec<DVec3>,
    pub previous: Vec<DVec3>,
    /// Inverse mass of each node, 1/kg.
    pub inverse_mass: Vec<f64>,
    /// Rest length of the spring from each node to the next, m, and of a ring from the last to the first; zero for none.
    pub rest: Vec<f64>,
    /// k h² and c h of each of these, kg.
    pub constants: Vec<[f64; 2]>,
}

impl Strand {
    /// The nodes at both ends of a spring.
    fn ends(&self, spring: usize) -> [usize; 2] {
        [spring, (spring + 1) % self.position.len()]
    }

    /// Directions of springs, m: none of those that aren't there.
    fn along(&self, spring: usize) -> DVec3 {
        let [a, b] = self.ends(spring);
        if self.rest[spring] > 0.0 { self.position[b] - self.position[a] } else { DVec3::ZERO }
    }

    /// Whether a spring is longer than at rest.
    pub fn is_too_long(&self, spring: usize) -> bool {
        self.along(spring).length() > self.rest[spring]
    }

    /// What each spring pushes its ends apart with, over its length, kg.
    pub fn pushes(&self) -> Vec<f64> {
        let springs = 0..self.rest.len();
        let row = |j: usize| {
            let (along, [a, b]) = (self.along(j), self.ends(j));
            let factor: f64 = self.constants[j].iter().sum();
            let of_spring = |i: usize| {
                // A node that two springs share is the end of one and the beginning of the other.
                let shared = |node: usize, sign: f64| {
                    let at = self.ends(i);
                    let by = if at[0] == node { -sign } else { 0.0 } + if at[1] == node { sign } else { 0.0 };
                    by * self.inverse_mass[node] * self.along(i).dot(along)
                };
                let own = if i != j {
                    0.0
                } else if self.rest[j] > 0.0 {
                    along.length_squared()
                } else {
                    1.0
                };
                own + factor * (shared(b, 1.0) + shared(a, -1.0))
            };
            springs.clone().map(of_spring).collect()
        };
        let right = |j: usize| {
            let (along, [a, b], [k, c]) = (self.along(j), self.ends(j), self.constants[j]);
            let way = along - (self.previous[b] - self.previous[a]);
            let damped = k * along.length() * (self.rest[j] - along.length()) - c * along.dot(way);
            DVec3::X * if self.rest[j] > 0.0 { damped } else { 0.0 }
        };
        solve(springs.clone().map(row).collect(), springs.clone().map(right).collect()).iter().map(|mu| mu.x).collect()
    }

    /// Where its nodes are when each spring has pushed along the direction that it had.
    pub fn pushed(&self, pushes: &[f64]) -> Vec<DVec3> {
        let mut position = self.position.clone();
        for (j, push) in pushes.iter().enumerate() {
            let [a, b] = self.ends(j);
            position[a] -= self.along(j) * (push * self.inverse_mass[a]);
            position[b] += self.along(j) * (push * self.inverse_mass[b]);
        }
        position
    }

    /// Where its nodes are when those that are taut have pulled along the direction that they have then. What closes a ring
    /// pulls along the one that it had.
    pub fn solved(&self) -> Vec<DVec3> {
        let (pushes, count) = (self.pushes(), self.position.len());
        let is_turned = |j: usize| pushes[j] < 0.0 && j + 1 < count;
        let others: Vec<f64> = (0..pushes.len()).map(|j| if is_turned(j) { 0.0 } else { pushes[j] }).collect();
        let mut rows: Vec<Vec<f64>> =
            (0..count).map(|i| (0..count).map(|j| f64::from(u8::from(i == j))).collect()).collect();
        for j in (0..pushes.len()).filter(|&j| is_turned(j)) {
            for (node, other) in [(j, j + 1), (j + 1, j)] {
                rows[node][node] -= self.inverse_mass[node] * pushes[j];
                rows[node][other] += self.inverse_mass[node] * pushes[j];
            }
        }
        solve(rows, self.pushed(&others))
    }
}
