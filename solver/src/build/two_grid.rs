//! Gathers particles into aggregates and interpolates between them: the coarse grid of a mesh without rows and columns.
//!
//! Smoothed aggregation: Vaněk, Mandel and Brezina, "Algebraic Multigrid by Smoothed Aggregation for Second and Fourth Order
//! Elliptic Problems" (1996). A particle and its neighbours are an aggregate, so that there are about nine times fewer; what is
//! constant on each is smoothed by one step of Jacobi's method.

use std::collections::{BTreeMap, BTreeSet};

use crate::{
    Bend, Face, Spring,
    linear::{cholesky, sparse_rows::SparseRows},
    topology::two_grid::{Stiffness, TwoGrid},
};

/// Damping of Jacobi's method. Without a smoothing step, cloth falls two to three times as far behind.
const SMOOTHING: f32 = 0.6;

/// Smaller weights than this are left out.
const LEAST_WEIGHT: f32 = 0.02;

/// An aggregate that isn't there yet.
const NONE: u32 = u32::MAX;

type Rows<T> = Vec<BTreeMap<u32, T>>;

/// The two grids of particles with `areas` (m²), joined by `faces`, those `springs` that carry a part of a sheet, and `bends`.
pub(super) fn find(areas: &[f32], faces: &[Face], springs: &[Spring], bends: &[Bend]) -> TwoGrid {
    let rows = stiffness_rows(areas.len(), faces, springs, bends);
    let aggregates = aggregate(&rows);
    let interpolation = smooth(&rows, &aggregates);
    let coarse = coarsen(areas, &rows, &interpolation);
    let neighbours = neighbours(&coarse);
    let order = cholesky::minimum_degree(neighbours);
    let mut number = vec![0; order.len()];
    for (new, &old) in (0..).zip(&order) {
        number[old as usize] = new;
    }
    let mut lower: Rows<(f32, Stiffness)> = vec![BTreeMap::new(); order.len()];
    for (row, of_row) in coarse.iter().enumerate() {
        for (&column, &value) in of_row {
            let (row, column) = (number[row], number[column as usize]);
            if row >= column {
                lower[column as usize].insert(row, value);
            }
        }
    }
    let coarse = packed(lower);
    let (component, component_count) = components(&rows);
    let renumbered = |row: BTreeMap<u32, f32>| row.into_iter().map(|(to, w)| (number[to as usize], w)).collect();
    let interpolation = packed(interpolation.into_iter().map(renumbered).collect());
    TwoGrid::new(packed(rows), interpolation, coarse, component, component_count)
}

fn packed<T: Copy>(rows: Rows<T>) -> SparseRows<T> {
    let mut packed = SparseRows::default();
    rows.into_iter().for_each(|row| packed.push_row(row));
    packed
}

/// Matrices of one number a particle, of stiffness and rigidity 1: a sheet is as stiff along the warp as along the weft.
fn stiffness_rows(count: usize, faces: &[Face], springs: &[Spring], bends: &[Bend]) -> Rows<Stiffness> {
    let mut rows: Rows<Stiffness> = vec![BTreeMap::new(); count];
    let mut add = |i: u32, j: u32, more: Stiffness| {
        let entry = rows[i as usize].entry(j).or_default();
        entry.stretch += more.stretch;
        entry.bend += more.bend;
    };
    for &Face { particles, warp, weft, area } in faces {
        let whole = |[b, c]: [f32; 2]| [-b - c, b, c];
        let (u, v) = (whole(warp), whole(weft));
        for i in 0..3 {
            for j in 0..3 {
                let stretch = area * (u[i] * u[j] + v[i] * v[j]);
                add(particles[i], particles[j], Stiffness { stretch, bend: 0.0 });
            }
        }
    }
    for spring in springs {
        let [warp, weft, _] = spring.share;
        for (i, j, sign) in [
            (spring.a, spring.a, 1.0),
            (spring.b, spring.b, 1.0),
            (spring.a, spring.b, -1.0),
            (spring.b, spring.a, -1.0),
        ] {
            add(i, j, Stiffness { stretch: sign * (warp + weft), bend: 0.0 });
        }
    }
    for Bend { particles, weights, .. } in bends {
        for (&i, w) in particles.iter().zip(weights) {
            for (&j, v) in particles.iter().zip(weights) {
                add(i, j, Stiffness { stretch: 0.0, bend: w * v });
            }
        }
    }
    // One that nothing holds has a row as well.
    (0..count as u32).for_each(|i| add(i, i, Stiffness::default()));
    rows
}

/// The aggregate of each particle.
fn aggregate(rows: &Rows<Stiffness>) -> Vec<u32> {
    let joined = |i: usize| rows[i].iter().filter(|(_, value)| value.stretch != 0.0);
    let (mut of, mut count) = (vec![NONE; rows.len()], 0);
    for i in 0..rows.len() {
        if of[i] == NONE && joined(i).all(|(&j, _)| of[j as usize] == NONE) {
            of[i] = count;
            joined(i).for_each(|(&j, _)| of[j as usize] = count);
            count += 1;
        }
    }
    // What is left goes to the neighbour that it is joined with most.
    loop {
        let before = of.clone();
        for i in (0..rows.len()).filter(|&i| before[i] == NONE) {
            let taken = joined(i).filter(|&(&j, _)| before[j as usize] != NONE);
            if let Some((&j, _)) = taken.min_by(|(_, a), (_, b)| a.stretch.total_cmp(&b.stretch)) {
                of[i] = before[j as usize];
            }
        }
        if of == before {
            return of;
        }
    }
}

/// The interpolation (1 - SMOOTHING D⁻¹ K) P with P one within an aggregate, in rows that add up to one.
fn smooth(rows: &Rows<Stiffness>, aggregates: &[u32]) -> Rows<f32> {
    let row = |(i, of_row): (usize, &BTreeMap<u32, Stiffness>)| {
        let diagonal = of_row[&(i as u32)].stretch;
        let mut weights = BTreeMap::from([(aggregates[i], 1.0)]);
        if diagonal > 0.0 {
            for (&j, value) in of_row.iter().filter(|(_, value)| value.stretch != 0.0) {
                *weights.entry(aggregates[j as usize]).or_insert(0.0) -= SMOOTHING * value.stretch / diagonal;
            }
        }
        weights.retain(|_, weight| weight.abs() > LEAST_WEIGHT);
        let sum: f32 = weights.values().sum();
        if sum.is_nan() || sum <= LEAST_WEIGHT {
            return BTreeMap::from([(aggregates[i], 1.0)]);
        }
        weights.values_mut().for_each(|weight| *weight /= sum);
        weights
    };
    rows.iter().enumerate().map(row).collect()
}

/// Pᵀ A P and Pᵀ K P, both triangles.
fn coarsen(areas: &[f32], rows: &Rows<Stiffness>, interpolation: &Rows<f32>) -> Rows<(f32, Stiffness)> {
    let count = interpolation.iter().flat_map(BTreeMap::keys).max().map_or(0, |&last| last as usize + 1);
    let mut coarse: Rows<(f32, Stiffness)> = vec![BTreeMap::new(); count];
    for (i, row) in rows.iter().enumerate() {
        for (&j, value) in row {
            let area = if j as usize == i { areas[i] } else { 0.0 };
            for (&p, w) in &interpolation[i] {
                for (&q, v) in &interpolation[j as usize] {
                    let (sum, stiffness) = coarse[p as usize].entry(q).or_default();
                    *sum += area * w * v;
                    stiffness.stretch += value.stretch * w * v;
                    stiffness.bend += value.bend * w * v;
                }
            }
        }
    }
    coarse
}

fn neighbours<T>(rows: &Rows<T>) -> Vec<BTreeSet<u32>> {
    let others = |(i, row): (usize, &BTreeMap<u32, T>)| row.keys().copied().filter(|&j| j as usize != i).collect();
    rows.iter().enumerate().map(others).collect()
}

/// The connected component of each particle, and how many there are.
fn components(rows: &Rows<Stiffness>) -> (Vec<u32>, usize) {
    let (mut of, mut count) = (vec![NONE; rows.len()], 0);
    let mut left = Vec::new();
    for start in 0..rows.len() {
        if of[start] != NONE {
            continue;
        }
        left.push(start);
        while let Some(i) = left.pop() {
            of[i] = count;
            left.extend(rows[i].keys().map(|&j| j as usize).filter(|&j| of[j] == NONE));
        }
        count += 1;
    }
    (of, count as usize)
}
