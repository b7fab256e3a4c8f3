//! Solves sparse symmetric positive definite systems exactly, by L D Lᵀ.
//!
//! Which entries of L can be other than zero depends on the matrix's pattern alone, and is found once: George and Liu,
//! "Computer Solution of Large Sparse Positive Definite Systems" (1981). The matrix is given by its lower triangle: row j
//! of a [`SparseRows`] holds column j, from the diagonal on.

use std::collections::BTreeSet;

use fearless_simd::{f32x4, prelude::*};

use crate::linear::sparse_rows::SparseRows;

/// Smallest share of a diagonal element that is left of it as a pivot: less is rounding.
const SMALLEST_PIVOT: f64 = 1e-7;

/// An order of elimination that keeps L sparse: who has the fewest neighbours left is next. `neighbours` are those of each
/// node, without itself.
pub(crate) fn minimum_degree(mut neighbours: Vec<BTreeSet<u32>>) -> Vec<u32> {
    let mut queue: BTreeSet<(usize, u32)> = (0..).zip(&neighbours).map(|(i, of)| (of.len(), i)).collect();
    let mut order = Vec::with_capacity(neighbours.len());
    while let Some((_, node)) = queue.pop_first() {
        order.push(node);
        let around = core::mem::take(&mut neighbours[node as usize]);
        for &one in &around {
            queue.remove(&(neighbours[one as usize].len(), one));
            neighbours[one as usize].remove(&node);
            neighbours[one as usize].extend(around.iter().filter(|&&other| other != one));
        }
        queue.extend(around.iter().map(|&one| (neighbours[one as usize].len(), one)));
    }
    order
}

/// Where L can be other than zero, below its diagonal, column by column.
pub(crate) fn pattern<T: Copy>(lower: &SparseRows<T>) -> SparseRows<()> {
    let mut columns: Vec<BTreeSet<u32>> = Vec::with_capacity(lower.len());
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); lower.len()];
    for j in 0..lower.len() {
        let below = |&row: &u32| row as usize > j;
        let mut rows: BTreeSet<u32> = lower.columns(j).iter().copied().filter(below).collect();
        for &child in &children[j] {
            rows.extend(columns[child].iter().copied().filter(below));
        }
        if let Some(&parent) = rows.first() {
            children[parent as usize].push(j);
        }
        columns.push(rows);
    }
    let mut pattern = SparseRows::default();
    for rows in columns {
        pattern.push_row(rows.into_iter().map(|row| (row, ())));
    }
    pattern
}

/// The factor of a matrix.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Factor {
    /// L below its diagonal of ones, as its pattern has it.
    values: Vec<f32>,
    /// 1/D.
    inverse_pivots: Vec<f32>,
}

impl Factor {
    /// Factors the matrix with a `pattern` and the entries (row, value) of the `column`s of its lower triangle.
    pub fn new<I: Iterator<Item = (usize, f64)>>(pattern: &SparseRows<()>, column: impl Fn(usize) -> I) -> Self {
        let count = pattern.len();
        let mut values = vec![0.0_f64; pattern.values().len()];
        let mut pivots = vec![0.0_f64; count];
        // The columns that have an entry in a row, and where it is, as far as they are done.
        let mut in_row: Vec<Vec<(usize, usize)>> = vec![Vec::new(); count];
        let mut sums = vec![0.0_f64; count];
        for j in 0..count {
            for (row, value) in column(j) {
                sums[row] += value;
            }
            let diagonal = sums[j];
            for (k, at) in core::mem::take(&mut in_row[j]) {
                let range = at..pattern.range(k).end;
                let rows = &pattern.columns(k)[at - pattern.range(k).start..];
                let factor = values[at] * pivots[k];
                for (&row, value) in rows.iter().zip(&values[range]) {
                    sums[row as usize] -= factor * value;
                }
                if let Some(&next) = rows.get(1) {
                    in_row[next as usize].push((k, at + 1));
                }
            }
            // A node that nothing is left of: as if alone in the world.
            let least = if diagonal > 0.0 { diagonal * SMALLEST_PIVOT } else { 1.0 };
            pivots[j] = sums[j].max(least);
            sums[j] = 0.0;
            for (&row, value) in pattern.columns(j).iter().zip(&mut values[pattern.range(j)]) {
                *value = core::mem::take(&mut sums[row as usize]) / pivots[j];
            }
            if let Some(&next) = pattern.columns(j).first() {
                in_row[next as usize].push((j, pattern.range(j).start));
            }
        }
        Self {
            values: values.into_iter().map(|value| value as f32).collect(),
            inverse_pivots: pivots.into_iter().map(|pivot| pivot.recip() as f32).collect(),
        }
    }

    /// Solves for four right-hand sides at once, which become the solutions.
    #[inline(always)]
    pub fn solve<S: Simd>(&self, simd: S, pattern: &SparseRows<()>, right: &mut [[f32; 4]]) {
        for j in 0..pattern.len() {
            let from = f32x4::simd_from(simd, right[j]);
            for (&row, &value) in pattern.columns(j).iter().zip(&self.values[pattern.range(j)]) {
                let to = &mut right[row as usize];
                *to = (f32x4::simd_from(simd, *to) - from * value).into();
            }
        }
        for j in (0..pattern.len()).rev() {
            let mut sum = f32x4::simd_from(simd, right[j]) * self.inverse_pivots[j];
            for (&row, &value) in pattern.columns(j).iter().zip(&self.values[pattern.range(j)]) {
                sum -= f32x4::simd_from(simd, right[row as usize]) * value;
            }
            right[j] = sum.into();
        }
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::dispatch;
    use proptest::{collection, prop_assert, proptest, test_runner::Config};

    use super::*;
    use crate::layout::simd::SimdLevel;

    proptest! {
        #![proptest_config(Config { failure_persistence: None, ..Config::default() })]

        #[test]
        fn a_solution_gives_back_its_right_hand_side(
            links in collection::vec((0_usize..40, 0_usize..40, 0.1_f64..10.0), 0..120),
            right in collection::vec(-1.0_f32..1.0, 40),
        ) {
            const COUNT: usize = 40;
            // Springs between nodes, each held a little.
            let mut matrix = vec![vec![0.0_f64; COUNT]; COUNT];
            for (i, row) in matrix.iter_mut().enumerate() {
                row[i] = 0.5;
            }
            for &(a, b, k) in links.iter().filter(|(a, b, _)| a != b) {
                matrix[a][a] += k;
                matrix[b][b] += k;
                matrix[a][b] -= k;
                matrix[b][a] -= k;
            }
            let others = |i: usize| (0..COUNT as u32).filter(move |&j| j as usize != i);
            let neighbours = (0..COUNT).map(|i| others(i).filter(|&j| matrix[i][j as usize] != 0.0).collect()).collect();
            let order = minimum_degree(neighbours);
            let at = |i: usize, j: usize| matrix[order[i] as usize][order[j] as usize];
            let mut lower = SparseRows::default();
            for j in 0..COUNT {
                lower.push_row((j..COUNT).filter(|&i| at(i, j) != 0.0).map(|i| (i as u32, at(i, j))));
            }
            let pattern = pattern(&lower);
            let factor = Factor::new(&pattern, |j| lower.row(j));
            let mut x: Vec<[f32; 4]> = right.iter().map(|&r| [r, -r, 0.0, 2.0 * r]).collect();
            dispatch!(SimdLevel::Best.level(), simd => factor.solve(simd, &pattern, &mut x));
            for (i, right) in right.into_iter().enumerate() {
                let sums = (0..COUNT).fold([0.0; 4], |sums: [f64; 4], j| {
                    [0, 1, 2, 3].map(|k| sums[k] + at(i, j) * f64::from(x[j][k]))
                });
                for (sum, share) in sums.into_iter().zip([1.0, -1.0, 0.0, 2.0]) {
                    prop_assert!((sum - share * f64::from(right)).abs() < 1e-3, "{sum} {right}");
                }
            }
        }
    }

    #[test]
    fn a_node_without_an_entry_is_left_alone() {
        let mut lower = SparseRows::default();
        lower.push_row([(0, 2.0), (2, -1.0)]);
        lower.push_row([]);
        lower.push_row([(2, 2.0)]);
        let pattern = pattern(&lower);
        let factor = Factor::new(&pattern, |j| lower.row(j));
        let mut x = [[3.0, 0.0, 0.0, 0.0]; 3];
        dispatch!(SimdLevel::Best.level(), simd => factor.solve(simd, &pattern, &mut x));
        assert!(x.iter().zip([3.0, 3.0, 3.0]).all(|(x, expected)| (x[0] - expected).abs() < 1e-5), "{x:?}");
    }
}
