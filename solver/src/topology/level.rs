//! Coarse lattices over a cloth, on which pulls travel far in few iterations.

use bevy_reflect::{Reflect, std_traits::ReflectDefault};

use crate::{
    layout::simd::{LANES, Lane},
    topology::lattice::Lattice,
};

/// A lattice of nodes on a cloth, several particles apart.
///
/// Rows and columns of nodes stand at coordinates on the cloth: for a cloth that is a lattice itself, the numbers of
/// its rows and columns, for any other those of a chart that spreads it out flat.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// About how many particles it is from one node to the next.
    pub stride: u32,
    /// The nodes and the strands between them.
    pub lattice: Lattice,
    /// Coordinate of each row of nodes, rising.
    pub rows: Vec<f32>,
    /// Coordinate of each column of nodes, rising.
    pub columns: Vec<f32>,
    /// Where columns begin again at 0, if rows are rings.
    pub ring: Option<f32>,
    /// How many particles a node stands for.
    pub share: f32,
    /// How the nodes move along with those of the next coarser level, if there is one.
    pub from_coarser: Option<Prolongation>,
    /// How the nodes lie among the particles.
    pub transfer: TransferOperator,
}

/// How the nodes of a level follow the particles, and the particles the nodes. Nodes are in the order of their slots.
#[derive(Clone, Debug, PartialEq)]
pub enum TransferOperator {
    /// For a cloth in rows and columns: nodes are particles.
    Lattice {
        /// Slots of the particles that the nodes are; [`Level::NOBODY`] where there is no node.
        slots: Vec<[u32; LANES]>,
        /// How the particles move along with them.
        spread: Prolongation,
    },
    /// For any other cloth: nodes lie in triangles.
    Chart {
        /// Slots of the corners of the triangle that each node lies in, and its barycentric weights; all zero where
        /// there is no node.
        nodes: Vec<([u32; 3], [f32; 3])>,
        /// Slots of the nodes around each particle, and its shares of them; all zero where there are none.
        particles: Vec<([u32; 4], [f32; 4])>,
    },
}

/// A place between two neighbours.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinearWeights {
    /// The first of the two.
    pub first: u32,
    /// Share of the way to the second, 0..=1.
    pub share: f32,
}

impl Level {
    /// Where there is no node.
    pub const NOBODY: u32 = u32::MAX;
}

/// What the crossings of rows and columns have of the nodes of a coarser lattice: each lies between four.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Prolongation {
    /// Where each row lies between the rows of nodes.
    pub rows: Vec<LinearWeights>,
    /// For each eight columns: the columns of nodes around them, and the share that each of the eight has of them.
    pub columns: Vec<Vec<(u32, Lane)>>,
}

impl Prolongation {
    /// From nodes at the crossings of some rows and columns, at these coordinates, to places at those of others. Where
    /// rows are a `ring`, that is where columns begin again at 0.
    pub fn new([rows, columns]: [&[f32]; 2], ring: Option<f32>, [to_rows, to_columns]: [&[f32]; 2]) -> Self {
        let across: Vec<LinearWeights> =
            to_columns.iter().map(|&at| LinearWeights::locate_on(ring, columns, at)).collect();
        Self {
            rows: to_rows.iter().map(|&at| LinearWeights::locate(rows, at)).collect(),
            columns: across.chunks(LANES).map(|places| shares(places, columns.len() as u32)).collect(),
        }
    }
}

impl LinearWeights {
    /// Where `coordinate` lies between two of `places`, at least two that rise: on a `ring` of that length, or on none.
    fn locate_on(ring: Option<f32>, places: &[f32], coordinate: f32) -> Self {
        let last = places[places.len() - 1];
        match ring {
            Some(length) if coordinate > last => {
                Self { first: places.len() as u32 - 1, share: (coordinate - last) / (length - last) }
            }
            _ => Self::locate(places, coordinate),
        }
    }

    /// Where `coordinate` lies between two of `places`, at least two that rise.
    pub fn locate(places: &[f32], coordinate: f32) -> Self {
        let after = places.partition_point(|&place| place <= coordinate);
        let first = after.clamp(1, places.len() - 1) - 1;
        let share = (coordinate - places[first]) / (places[first + 1] - places[first]);
        Self { first: first as u32, share: share.clamp(0.0, 1.0) }
    }
}

/// The neighbours around eight places in a row of `count` nodes, and the share that each place has of them.
fn shares(places: &[LinearWeights], count: u32) -> Vec<(u32, Lane)> {
    let second = |place: &LinearWeights| (place.first + 1) % count;
    let mut nodes: Vec<u32> = places.iter().flat_map(|place| [place.first, second(place)]).collect();
    nodes.sort_unstable();
    nodes.dedup();
    let share = |node: u32, place: &LinearWeights| match node {
        node if node == place.first => 1.0 - place.share,
        node if node == second(place) => place.share,
        _ => 0.0,
    };
    let lane = |node| core::array::from_fn(|l| places.get(l).map_or(0.0, |place| share(node, place)));
    nodes.into_iter().map(|node| (node, lane(node))).collect()
}

/// How many iterations the levels of a stride take in each substep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub struct LevelPass {
    /// Particles from one node of the level to the next: 4, 8, 16 and so on.
    pub stride: u32,
    /// Iterations. 4 to 16; 0 leaves the level out.
    pub iterations: u32,
}
