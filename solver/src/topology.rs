//! What is connected to what: built once from the rest shape, immutable, shared by all cloths of that shape.

use core::ops::Range;
use std::sync::OnceLock;

use bevy_math::Vec3;

use crate::{
    geometry::bvh::TriangleBvh,
    layout::order::Order,
    topology::{
        bend_pack::BendPack, face_pack::FacePack, lattice::Lattice, level::Level, strand_pack::StrandPack,
        two_grid::TwoGrid,
    },
};

pub mod bend_pack;
pub mod face_pack;
pub mod lattice;
pub mod level;
pub mod strand_pack;
pub mod structure;
pub mod two_grid;

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

/// A direction of the threads that a cloth is woven of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Grain {
    /// Along the length of the cloth as it comes from the loom: down a texture.
    #[default]
    Warp,
    /// From selvedge to selvedge: across a texture.
    Weft,
}

impl Grain {
    /// Index into arrays of one entry a direction.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The direction across it.
    pub const fn other(self) -> Self {
        match self {
            Self::Warp => Self::Weft,
            Self::Weft => Self::Warp,
        }
    }
}

/// A spring between two particles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spring {
    /// Index of the one particle.
    pub a: u32,
    /// Index of the other particle.
    pub b: u32,
    /// Rest length, m.
    pub rest: f32,
    /// How much it carries of a sheet's [`Moduli`](crate::material::Moduli), no unit: its stiffness in N/m is the sum of these
    /// times Cu, Cv and G. All zero for a spring that has no cell beside it.
    pub share: [f32; 3],
}

impl Spring {
    /// The direction of threads that it goes along, rather than the other.
    pub fn grain(&self) -> Grain {
        if self.share[0] >= self.share[1] { Grain::Warp } else { Grain::Weft }
    }
}

/// A triangle that carries a sheet's [`Moduli`](crate::material::Moduli) by itself: one that is in no cell.
///
/// The deformation takes a step along the warp to `warp[0] (xb - xa) + warp[1] (xc - xa)` for its corners a, b, c, and
/// one along the weft likewise.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Face {
    /// Its corners.
    pub particles: [u32; 3],
    /// 1/m.
    pub warp: [f32; 2],
    /// 1/m.
    pub weft: [f32; 2],
    /// Area, m².
    pub area: f32,
}

/// A linear measure of how much a place of the cloth is bent: the sum of the weights times the positions.
///
/// Its energy is B/2 times the squared length of that sum less its rest. It is one of three:
///
/// ```text
///   three of a strand      corners of a cell           hinge of two triangles
///        0---2---1              0---3                        3
///            |                  |   |                       / \\
///            3                  2---1                      0---1
///                                                           \\ /
///                                                            2
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bend {
    /// The particles. One without a weight only shows where the surface is.
    pub particles: [u32; 4],
    /// The weights, 1/m. Their sum is zero.
    pub weights: [f32; 4],
    /// The sum at rest, no unit: along from particle 0 to particle 1, across from 2 to 3 as far as that isn't along, and normal
    /// to both. Zero where the cloth is flat.
    pub rest: [f32; 3],
}

/// A run of bends of one colour: no two of them share a particle.
#[derive(Clone, Debug, PartialEq)]
pub struct BendBatch {
    /// Their place in [`Topology::bends`].
    pub range: Range<usize>,
    /// Whether [`Topology::lattice`] has them too: [`Method::Strands`](crate::input::Method::Strands) solves them there.
    pub on_strand: bool,
}

/// A run of springs of one kind and one colour: no two of them share a particle.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringBatch {
    /// Kind of all springs of the batch.
    pub kind: SpringKind,
    /// Their place in [`Topology::springs`].
    pub range: Range<usize>,
    /// Whether [`Topology::lattice`] or [`Topology::strand_packs`] have them too: [`Method::Strands`](crate::input::Method::Strands)
    /// solves them there.
    pub on_strand: bool,
    /// Whether any of them carries a part of a sheet's moduli.
    pub carries: bool,
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
    /// The triangles that are in no cell of a lattice, batch after batch.
    pub faces: Vec<Face>,
    /// Runs of up to eight faces, in the order in which the solver visits them: none of a run share a particle.
    pub face_batches: Vec<Range<usize>>,
    /// The same, component by component: a pack a run.
    pub face_packs: Vec<FacePack>,
    /// All that resists bending as a sheet does, batch after batch.
    pub bends: Vec<Bend>,
    /// The batches, in the order in which the solver visits them.
    pub bend_batches: Vec<BendBatch>,
    /// The same, component by component, where there are no rows and columns: a pack a batch.
    pub bend_packs: Vec<BendPack>,
    /// Whether any bend has a rest other than zero: the cloth isn't flat.
    pub is_curved: bool,
    /// No less than the square of the fastest frequency of bending if areal density and rigidity were 1, 1/m⁴.
    pub bend_rate: f32,
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
    /// The strands of a regular mesh without a lattice, in the order in which the solver visits them.
    pub strand_packs: Vec<StrandPack>,
    /// Coarse lattices, the coarsest first.
    pub levels: Vec<Level>,
    /// The particles of a mesh without rows and columns as the fine one of two grids.
    pub two_grid: Option<TwoGrid>,
    /// Triangles, corners and edges to be found by what touches them.
    pub(crate) surface: OnceLock<TriangleBvh>,
}

impl Topology {
    /// Number of particles.
    pub fn particle_count(&self) -> usize {
        self.areas.len()
    }

    /// Triangles, corners and edges to be found by what touches them: sorted when that is asked for first.
    pub(crate) fn surface(&self) -> &TriangleBvh {
        self.surface.get_or_init(|| TriangleBvh::new(&self.rest, &self.triangles))
    }

    /// Where the particles stand while a step runs.
    pub(crate) fn order(&self) -> Order {
        self.lattice.as_ref().map_or(Order::plain(self.particle_count()), Lattice::order)
    }

    /// All springs of one kind.
    pub fn springs_of(&self, kind: SpringKind) -> impl Iterator<Item = &Spring> {
        self.batches.iter().filter(move |batch| batch.kind == kind).flat_map(|batch| &self.springs[batch.range.clone()])
    }
}
