//! Distances along the cloth from every particle to its nearest pins, for tethers.
//!
//! Dijkstra's algorithm over particles, where a triangle with two known corners also gives the third: unfolded into
//! the plane, the two distances fix the (virtual) source, and the straight line from there is the shortest way if it
//! crosses the edge between them.
//!
//! ```text
//!            c
//!           /|\
//!          / | \       distance(c) = |s - c|  if the line crosses a b
//!         a--+--b      else the shorter way along an edge
//!          \ | /
//!            s
//! ```
//!
//! Kimmel and Sethian, "Computing geodesic paths on manifolds" (1998), with the planar update of Novotni and Klein
//! (2002). Exact on flat cloth; along edges alone a way across a grid would come out up to 41 % too long.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use bevy_math::{FloatOrd, Vec2, Vec3};

use super::grouped::Grouped;
use crate::{GrabTether, Tether, Tethers, Topology};

/// Most pins that hold one particle.
const MOST_TETHERS: usize = 4;

/// A pin adds nothing where a nearer one is closer to it than this share of its own distance.
const TELLING_APART: f32 = 0.8;

/// Tethers of every particle to the nearest few of `pins` (indices of particles).
///
/// A tether is as long as the cloth between its ends; a particle that no pin can reach has none.
pub fn tethers(topology: &Topology, pins: &[u32]) -> Tethers {
    let mut tying = TetherBuild::begin(pins.to_vec());
    tying.advance(topology, usize::MAX);
    tying.finish(topology)
}

/// Tethers that are being worked out, a part at a time.
#[derive(Clone, Debug)]
pub struct TetherBuild {
    pins: Vec<u32>,
    /// None before the first part.
    search: Option<Search>,
}

impl TetherBuild {
    /// Begins at `pins`.
    pub fn begin(pins: Vec<u32>) -> Self {
        Self { pins, search: None }
    }

    /// Settles as many as `most` distances. True where all are settled.
    pub fn advance(&mut self, topology: &Topology, most: usize) -> bool {
        let search = self.search.get_or_insert_with(|| {
            let mut search = Search::new(topology, Kept::AllRound);
            for &pin in &self.pins {
                search.propose(pin, pin, 0.0);
            }
            search
        });
        search.run(&topology.rest, most)
    }

    /// The tethers, once all are settled.
    pub fn finish(&self, topology: &Topology) -> Tethers {
        let is_pin = |labels: &[Label]| labels.first().is_some_and(|label| label.distance == 0.0);
        let labels = self.search.iter().flat_map(|search| &search.labels);
        let held = (0..).zip(labels).filter(|(_, labels)| !is_pin(labels));
        let tether = |particle, label: &Label| Tether { particle, pin: label.pin, length: label.distance };
        let tethers: Vec<Tether> =
            held.flat_map(|(particle, labels)| labels.iter().map(move |label| tether(particle, label))).collect();
        Tethers::new(&tethers, topology)
    }
}

/// Tethers of all other particles to a point of a triangle, given by its barycentric `weights`. Sorted by particle.
///
/// A particle that is no part of the same piece of cloth has none.
pub fn grab_tethers(topology: &Topology, triangle: [u32; 3], weights: [f32; 3]) -> Vec<GrabTether> {
    let rest = triangle.map(|particle| topology.rest[particle as usize]);
    let point = rest[0] * weights[0] + rest[1] * weights[1] + rest[2] * weights[2];
    let mut search = Search::new(topology, Kept::AllRound);
    for (particle, corner) in triangle.into_iter().zip(rest) {
        // The point isn't a particle: one of its corners names it.
        search.propose(particle, triangle[0], corner.distance(point));
    }
    search.run(&topology.rest, usize::MAX);
    let reached = (0..).zip(&search.labels).filter(|(particle, _)| !triangle.contains(particle));
    reached.filter_map(|(particle, labels)| Some(GrabTether { particle, length: labels.first()?.distance })).collect()
}

/// A pin, or what stands for some of them, and how far it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Label {
    pub pin: u32,
    pub distance: f32,
}

/// Which distances are kept of those to all pins.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kept {
    /// Those to the nearest few pins in different directions.
    AllRound,
    /// So many, the shortest.
    Nearest(usize),
}

#[derive(Clone, Debug)]
pub(super) struct Search {
    kept: Kept,
    /// Triangles at each particle, as the other two corners; cells are split along both diagonals.
    fans: Grouped<[u32; 2]>,
    /// What is settled, nearest first.
    pub labels: Vec<Vec<Label>>,
    /// The shortest proposal for each particle and pin so far.
    proposed: Vec<Vec<Label>>,
    /// Proposals (distance, particle, pin), the shortest first.
    queue: BinaryHeap<Reverse<(FloatOrd, u32, u32)>>,
}

impl Search {
    pub fn new(topology: &Topology, kept: Kept) -> Self {
        let crossed = topology.cells.iter().flat_map(|&[a, b, c, d]| [[a, b, d], [b, c, d]]);
        let triangles = topology.triangles.iter().copied().chain(crossed);
        let corners = triangles.flat_map(|[i, j, k]| [(i, [j, k]), (j, [k, i]), (k, [i, j])]);
        let fans = Grouped::new(topology.particle_count(), corners);
        Self {
            kept,
            fans,
            labels: vec![Vec::new(); topology.particle_count()],
            proposed: vec![Vec::new(); topology.particle_count()],
            queue: BinaryHeap::new(),
        }
    }

    /// Proposes a distance of a particle to a pin, m.
    pub fn propose(&mut self, particle: u32, pin: u32, distance: f32) {
        let proposed = &mut self.proposed[particle as usize];
        match proposed.iter_mut().find(|label| label.pin == pin) {
            Some(label) if label.distance <= distance => return,
            Some(label) => label.distance = distance,
            None => proposed.push(Label { pin, distance }),
        }
        self.queue.push(Reverse((FloatOrd(distance), particle, pin)));
    }

    /// Settles as many as `most` distances on the rest shape `rest`. True where all are settled.
    pub fn run(&mut self, rest: &[Vec3], most: usize) -> bool {
        let mut settled = 0;
        while settled < most {
            let Some(Reverse((FloatOrd(distance), particle, pin))) = self.queue.pop() else { return true };
            if self.is_wanted(rest, particle, pin, distance) {
                self.labels[particle as usize].push(Label { pin, distance });
                self.spread(rest, particle, pin, distance);
                settled += 1;
            }
        }
        self.queue.is_empty()
    }

    fn is_wanted(&self, rest: &[Vec3], particle: u32, pin: u32, distance: f32) -> bool {
        let labels = &self.labels[particle as usize];
        let is_new = labels.iter().all(|label| label.pin != pin);
        match self.kept {
            Kept::Nearest(count) => is_new && labels.len() < count,
            Kept::AllRound => {
                let apart = |label: &Label| rest[pin as usize].distance(rest[label.pin as usize]);
                let is_telling = |label: &Label| apart(label) >= TELLING_APART * distance;
                is_new && labels.len() < MOST_TETHERS && labels.iter().all(is_telling)
            }
        }
    }

    /// Proposes distances for all neighbours of a particle that has just been settled.
    fn spread(&mut self, rest: &[Vec3], particle: u32, pin: u32, distance: f32) {
        for index in self.fans.range(particle) {
            let [a, b] = self.fans.items()[index];
            for (known, unknown) in [(a, b), (b, a)] {
                // What is settled can't be settled better.
                if self.distance_to(pin, unknown).is_some() {
                    continue;
                }
                if let Some(length) = self.distance_to(pin, known) {
                    let length = unfold(rest, [particle, known], [distance, length], unknown);
                    self.propose(unknown, pin, length);
                }
                let along = distance + edge(rest, particle, unknown);
                self.propose(unknown, pin, along);
            }
        }
    }

    fn distance_to(&self, pin: u32, particle: u32) -> Option<f32> {
        let label = self.labels[particle as usize].iter().find(|label| label.pin == pin)?;
        Some(label.distance)
    }
}

fn edge(rest: &[Vec3], p: u32, q: u32) -> f32 {
    rest[p as usize].distance(rest[q as usize])
}

/// Distance of `c` from the source that is `distance` away from `a` and `b`.
fn unfold(rest: &[Vec3], [a, b]: [u32; 2], distance: [f32; 2], c: u32) -> f32 {
    let (ab, ac, bc) = (edge(rest, a, b), edge(rest, a, c), edge(rest, b, c));
    let along_edges = (distance[0] + ac).min(distance[1] + bc);
    if ab <= 0.0 {
        return along_edges;
    }
    // In the plane, a at 0, b at (ab, 0), c above the line and the source below it.
    let place = |from_a: f32, from_b: f32| {
        let x = (from_a * from_a - from_b * from_b + ab * ab) / (2.0 * ab);
        Vec2::new(x, (from_a * from_a - x * x).max(0.0).sqrt())
    };
    let (c, s) = (place(ac, bc), place(distance[0], distance[1]) * Vec2::new(1.0, -1.0));
    let height = c.y - s.y;
    let crossing = s.x + (c.x - s.x) * if height > 0.0 { -s.y / height } else { 0.0 };
    if (0.0..=ab).contains(&crossing) { c.distance(s).min(along_edges) } else { along_edges }
}
