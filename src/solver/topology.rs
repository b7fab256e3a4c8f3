//! What is connected to what: built once from the rest shape, immutable, shared by all cloths of that shape.

use core::ops::Range;

use bevy::math::Vec3;

use super::{Braid, Lattice, Level, order::Order};

/// What a spring resists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SpringKind {
    /// Stretch along the threads: left, right, up and down on a grid.
    Structural,
    /// Shear of a cell: both of its diagonals.
    Shear,
    /// Bending: joins particles two steps apart.
    Bend,
}

impl SpringKind {
    /// All kinds, in the order of their index.
    pub const ALL: [Self; 3] = [Self::Structural, Self::Shear, Self::Bend];

    /// Index into arrays of one entry a kind.
    pub const fn index(self) -> usize {
        self as usize
    }
}

/// A spring between two particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Index of the one particle.
    pub a: u32,
    /// Index of the other particle.
    pub b: u32,
    /// Rest length, m.
    pub rest: f32,
}

/// A run of springs of one kind and one colour: no two of them share a particle.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringBatch {
    /// Kind of all springs of the batch.
    pub kind: SpringKind,
    /// Their place in [`Topology::springs`].
    pub range: Range<usize>,
    /// Whether [`Topology::lattice`] or [`Topology::braids`] have them too: [`Method::Strands`](super::Method::Strands)
    /// solves them there.
    pub woven: bool,
}

/// Springs, triangles and areas of a cloth's rest shape.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Topology {
    /// Rest position of each particle, m: the mesh's own axes in the scale and rotation of its entity.
    pub rest: Vec<Vec3>,
    /// All springs, batch after batch.
    pub springs: Vec<Spring>,
    /// The batches, in the order in which the solver visits them.
    pub batches: Vec<SpringBatch>,
    /// Particles of each triangle; the order gives the side of its normal.
    pub triangles: Vec<[u32; 3]>,
    /// Area of each triangle, m².
    pub triangle_areas: Vec<f32>,
    /// Area that each particle stands for, m²: a third of its triangles. Never zero.
    pub areas: Vec<f32>,
    /// Corners of each near-rectangle of two triangles, around it. The mesh's own diagonal joins the first and third.
    pub cells: Vec<[u32; 4]>,
    /// The rows and columns that all particles are in, where they are in rows and columns.
    pub lattice: Option<Lattice>,
    /// The threads of a regular mesh without a lattice, in the order in which the solver visits them.
    pub braids: Vec<Braid>,
    /// Coarse lattices, the coarsest first.
    pub levels: Vec<Level>,
}

impl Topology {
    /// Number of particles.
    pub fn particle_count(&self) -> usize {
        self.areas.len()
    }

    /// Where the particles stand while a step runs.
    pub(super) fn order(&self) -> Order {
        self.lattice.as_ref().map_or(Order::plain(self.particle_count()), Lattice::order)
    }

    /// All springs of one kind.
    pub fn springs_of(&self, kind: SpringKind) -> impl Iterator<Item = &Spring> {
        self.batches.iter().filter(move |batch| batch.kind == kind).flat_map(|batch| &self.springs[batch.range.clone()])
    }
}
