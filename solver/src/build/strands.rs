//! Finds the strands of a mesh that is regular, but no rectangle: at each particle, springs in line go on as one.
//!
//! ```text
//!     \ /
//!   ---o---      the two that are straightest first, each spring once
//!     / \
//! ```

use bevy_math::Vec3;

use super::edges::Edges;
use crate::{Spring, SpringKind};

/// Largest cosine between two springs that go on as one: a turn of 50°. A tube of eight particles around keeps its rings;
/// the zigzag at the border of equilateral triangles, which turns by 60°, doesn't reflect strands back into the sheet,
/// where they would cross those of every direction.
const STRAIGHT: f32 = -0.64;

/// A particle with more springs than this is a hub. Strands that cross there couldn't be solved side by side.
const MOST_ARMS: usize = 8;

/// How many springs there have to be for each time that a strand breaks off inside the mesh.
///
/// Strands pay where they are straight, and where they are crooked, they break. Measured on equilateral triangles and on
/// an L of quads, about 64 particles along a side, whose places were moved at random by so much of a cell: 8 substeps with
/// strands over the same with all springs in colours (`lab hang --jitter`; the strain that all but one in a hundred
/// springs stay below, the mean strain and the time).
///
/// | moved by | springs a break | strain | mean | time |
/// |---|---|---|---|---|
/// | 0 | all | 0.31, 0.05 | 0.13, 0.06 | 1.05, 0.85 |
/// | 5 % | all | 0.47, 0.49 | 0.33, 0.37 | 1.05, 0.85 |
/// | 10 % | 670, 130 | 0.78, 0.78 | 0.55, 0.60 | 1.05, 0.85 |
/// | 15 % | 90, 11 | 1.05, 1.1 | 0.72, 0.79 | 1.1, 1.0 |
/// | 20 % | 30, 8 | 1.3, 1.2 | 0.93, 0.84 | 1.3, 1.2 |
/// | Delaunay's triangles | 7 | 1.3 | 0.91 | 1.2 |
const LEAST_SPRINGS_A_BREAK: usize = 100;

/// Springs end to end that pass each particle once.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Strand {
    pub particles: Vec<u32>,
    /// Numbers of the springs from each particle to the next; in a ring, at the end to the first.
    pub springs: Vec<u32>,
    pub closed: bool,
}

/// The strands that structural `springs` between particles at `rest` (m) form. None at all where they break too often
/// to pay.
pub(super) fn find(rest: &[Vec3], edges: &Edges, springs: &[(SpringKind, Spring)]) -> Vec<Strand> {
    let arms = arms(rest, springs);
    let may_end = where_threads_may_end(edges, springs, &arms);
    let net = Net::new(springs, &arms);
    let (count, breaks) = net.count_breaks(&may_end);
    if count >= LEAST_SPRINGS_A_BREAK * breaks { net.trace(rest.len()) } else { Vec::new() }
}

/// A spring at a particle.
#[derive(Clone, Copy, Debug)]
struct Arm {
    spring: u32,
    /// Which end of the spring the particle is: 0 or 1.
    end: usize,
    /// Direction to the other end.
    along: Vec3,
}

/// The structural springs at each particle.
fn arms(rest: &[Vec3], springs: &[(SpringKind, Spring)]) -> Vec<Vec<Arm>> {
    let mut arms = vec![Vec::new(); rest.len()];
    for (spring, (kind, Spring { a, b, rest: length, .. })) in (0..).zip(springs) {
        if *kind == SpringKind::Structural && *length > 0.0 {
            let along = (rest[*b as usize] - rest[*a as usize]) / *length;
            arms[*a as usize].push(Arm { spring, end: 0, along });
            arms[*b as usize].push(Arm { spring, end: 1, along: -along });
        }
    }
    arms
}

/// Whether a strand that ends at a particle isn't broken: at the border, at hubs and next to them.
fn where_threads_may_end(edges: &Edges, springs: &[(SpringKind, Spring)], arms: &[Vec<Arm>]) -> Vec<bool> {
    let mut may_end: Vec<bool> = arms.iter().map(|arms| arms.len() > MOST_ARMS).collect();
    for arm in arms.iter().filter(|arms| arms.len() > MOST_ARMS).flatten() {
        let Spring { a, b, .. } = springs[arm.spring as usize].1;
        may_end[if arm.end == 0 { b } else { a } as usize] = true;
    }
    for sides in edges.iter().filter(|sides| sides.len() != 2) {
        may_end[sides[0].a as usize] = true;
        may_end[sides[0].b as usize] = true;
    }
    may_end
}

/// Springs and how they go on.
struct Net<'a> {
    springs: &'a [(SpringKind, Spring)],
    /// Whether each spring is on a strand.
    is_on_strand: Vec<bool>,
    /// The spring that goes on from either end of each.
    onward: Vec<[Option<u32>; 2]>,
}

impl<'a> Net<'a> {
    fn new(springs: &'a [(SpringKind, Spring)], arms: &[Vec<Arm>]) -> Self {
        let mut is_on_strand = vec![false; springs.len()];
        arms.iter().flatten().for_each(|arm| is_on_strand[arm.spring as usize] = true);
        let hubs = arms.iter().filter(|arms| arms.len() > MOST_ARMS);
        hubs.flatten().for_each(|arm| is_on_strand[arm.spring as usize] = false);
        let mut onward = vec![[None; 2]; springs.len()];
        for arms in arms.iter().filter(|arms| arms.len() <= MOST_ARMS) {
            let arms: Vec<Arm> = arms.iter().copied().filter(|arm| is_on_strand[arm.spring as usize]).collect();
            let pairs = arms.iter().enumerate().flat_map(|(i, p)| arms[i + 1..].iter().map(move |q| (p, q)));
            let mut pairs: Vec<_> = pairs.map(|(p, q)| (p.along.dot(q.along), p, q)).collect();
            pairs.retain(|&(cosine, ..)| cosine <= STRAIGHT);
            // Stable, so pairs that are equally straight keep the order of their springs.
            pairs.sort_by(|(p, ..), (q, ..)| p.total_cmp(q));
            for (_, p, q) in pairs {
                if [p, q].iter().all(|arm| onward[arm.spring as usize][arm.end].is_none()) {
                    onward[p.spring as usize][p.end] = Some(q.spring);
                    onward[q.spring as usize][q.end] = Some(p.spring);
                }
            }
        }
        Self { springs, is_on_strand, onward }
    }

    /// The springs on strands.
    fn springs(&self) -> impl Iterator<Item = u32> {
        (0..).zip(&self.is_on_strand).filter(|(_, is_on_strand)| **is_on_strand).map(|(spring, _)| spring)
    }

    /// Number of springs, and how often strands break off where they shouldn't: each break has two ends.
    fn count_breaks(&self, may_end: &[bool]) -> (usize, usize) {
        let is_broken = |spring: u32| {
            let Spring { a, b, .. } = self.springs[spring as usize].1;
            let ends = self.onward[spring as usize].iter().zip([a, b]);
            ends.filter(|(onward, end)| onward.is_none() && !may_end[*end as usize]).count()
        };
        (self.springs().count(), self.springs().map(is_broken).sum::<usize>().div_ceil(2))
    }

    /// The other end of a spring, and what goes on from there.
    fn across(&self, (spring, from): (u32, u32)) -> (u32, Option<u32>) {
        let Spring { a, b, .. } = self.springs[spring as usize].1;
        let (to, end) = if from == a { (b, 1) } else { (a, 0) };
        (to, self.onward[spring as usize][end])
    }

    /// All strands between `count` particles.
    fn trace(&self, count: usize) -> Vec<Strand> {
        let mut strands = Vec::new();
        let mut is_traced = vec![false; self.springs.len()];
        // The latest strand that passed each particle, counted from one.
        let mut passed_by = vec![0; count];
        for spring in self.springs() {
            if !is_traced[spring as usize] {
                self.trace_from(self.start(spring), &mut is_traced, &mut passed_by, &mut strands);
            }
        }
        strands
    }

    /// Where the strand of a spring begins: a spring and the end to start from. In a ring, next to where it was asked.
    fn start(&self, first: u32) -> (u32, u32) {
        let mut at = (first, self.springs[first as usize].1.b);
        loop {
            let (to, next) = self.across(at);
            match next {
                Some(next) if next != first => at = (next, to),
                _ => return (at.0, to),
            }
        }
    }

    /// Follows a strand to its end. One that comes back to a particle is cut there; one that closes is a ring.
    fn trace_from(
        &self,
        start: (u32, u32),
        is_traced: &mut [bool],
        passed_by: &mut [usize],
        strands: &mut Vec<Strand>,
    ) {
        let mut at = start;
        let mut strand = Strand { particles: vec![start.1], ..Strand::default() };
        passed_by[start.1 as usize] = strands.len() + 1;
        loop {
            let (spring, from) = at;
            let (to, next) = self.across(at);
            is_traced[spring as usize] = true;
            let is_whole = strand.particles[0] == start.1;
            strand.closed = is_whole && (Some(start.0), start.1) == (next, to);
            if !strand.closed {
                if passed_by[to as usize] == strands.len() + 1 {
                    strands.push(core::mem::take(&mut strand));
                    strand.particles.push(from);
                    passed_by[from as usize] = strands.len() + 1;
                }
                strand.particles.push(to);
                passed_by[to as usize] = strands.len() + 1;
            }
            strand.springs.push(spring);
            match next {
                Some(next) if !is_traced[next as usize] => at = (next, to),
                _ => break,
            }
        }
        strands.push(strand);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_strand_that_crosses_itself_is_cut_there() {
        // To the right, around in three quarters of a circle, and up across where it came from.
        let angle = |i: i32| i as f32 / 90.0 * 1.5 * core::f32::consts::PI;
        let around = |i: i32| Vec3::new(bevy_math::ops::sin(angle(i)), bevy_math::ops::cos(angle(i)) - 1.0, 0.0);
        let right = (-10..=10).map(|x| Vec3::X * x as f32);
        let arc = (1..90).map(|i| 10.0 * (around(i) + Vec3::X));
        let up = (-10..=10).filter(|&y| y != 0).map(|y| Vec3::Y * y as f32);
        let rest: Vec<Vec3> = right.chain(arc).chain(up).collect();
        let crossing = 10;
        let before = 21 + 89 + 9;
        let mut path: Vec<u32> = (0..rest.len() as u32).collect();
        path.insert(before + 1, crossing);
        let spring = |&[a, b]: &[u32; 2]| {
            (
                SpringKind::Structural,
                Spring { a, b, rest: rest[a as usize].distance(rest[b as usize]), ..Spring::default() },
            )
        };
        let springs: Vec<_> = path.array_windows().map(spring).collect();
        let strands = find(&rest, &Edges::new(rest.len(), &[]), &springs);
        assert_eq!(strands.len(), 2);
        assert_eq!(strands.iter().map(|strand| strand.springs.len()).sum::<usize>(), springs.len());
        for strand in strands {
            assert_eq!(strand.particles.len(), strand.springs.len() + 1);
            let mut particles = strand.particles;
            particles.sort_unstable();
            assert!(particles.array_windows().all(|[a, b]| a < b), "it comes by a particle twice");
        }
    }
}
