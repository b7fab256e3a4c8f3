//! Chooses substeps and levels, so that a cloth is stretched no more than is wanted.

use crate::{
    material::Moduli,
    topology::{Topology, level::LevelPass, structure::MeshStructure},
};

/// How many substeps a step takes, and how many iterations of the coarse levels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SubstepPolicy {
    /// Substeps, and the fewest whatever is at stake.
    pub substeps: u32,
    /// Iterations of the coarse levels. Without tethers, there are none.
    pub levels: Vec<LevelPass>,
    /// Substeps where contact asks for more: something is near that the cloth may touch, a hand holds it, or no tethers do. Unless
    /// they are fixed, rows and columns take three quarters of them where that is but [rough](crate::input::Obstacle::is_rough) and moves along; it takes half as many more where its triangles and edges meet those of cloth, and 16 at least; three
    /// times as many near solids with edges, or thin ones, and 32 at least; and twice that where they end in a tip, or fit
    /// through a cell. Implicit steps, with which contact is solved along, take no more near edges, and 32 near tips, unless
    /// these would go past half an edge of the cloth in one: then up to 64.
    pub contact_substeps: u32,
    /// Levels of those.
    pub contact_levels: Vec<LevelPass>,
    /// Whether the substeps are those of a step of 1/60 s, and a longer one has more of them.
    pub follows_time_step: bool,
}

/// What contact puts at risk in a step: the riskier, the more substeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ContactRisk {
    None,
    /// Nothing is near but limbs of the body that wears it, which only particles meet and which don't sweep past it.
    Limbs,
    /// Something is near that the cloth may touch, a hand holds it, or no tethers do.
    Some,
    /// Its triangles and edges may meet those of cloth: what passes through is hard to bring back.
    SelfCollision,
    /// A solid with edges is near; so many substeps would take it past half an edge of the cloth in each.
    Edge(f32),
    /// One is near that ends in a tip, or fits through a stretched cell; so many substeps as of an edge.
    Tip(f32),
    /// The same two, where contact is solved along with the cloth.
    EdgeSolvedAlong(f32),
    TipSolvedAlong(f32),
}

impl SubstepPolicy {
    /// Fewer leave a cloth on something trembling, and stretch it in the hand.
    const LEAST_AT_CONTACT: f32 = 8.0;

    /// Share of the substeps at contact that rows and columns take near limbs. They don't lie there, but hang by what is pinned to the same
    /// body: with half of them, clothes on a runner were strained by a sixth more, with three quarters as much as with all. Where a body
    /// jumps up in them, with three quarters by a twelfth more.
    const SHARE_NEAR_LIMBS: f32 = 0.75;

    /// Fewest substeps at contact for each particle along a side.
    const LEAST_OF_SIDE: f32 = 1.0 / 6.0;

    /// With fewer, a pile lets go of its order under what falls on it. As many in all steps: where they change, the load that
    /// layers bear gives them a kick.
    const LEAST_WITH_SELF_COLLISION: f32 = 16.0;
    const MORE_WITH_SELF_COLLISION: f32 = 1.5;

    /// With fewer, the corner of a box comes through the triangles of a cloth that falls on it from 0.25 m; with fewer than twice
    /// as many, the tip of a cone, and a ball at 30 m/s that fits through a cell.
    const LEAST_WITH_SHARP: f32 = 32.0;
    const MORE_WITH_SHARP: f32 = 3.0;

    /// The most that something sharp asks for where contact with it is solved along with the cloth. 8 hold uneven sheets that fall
    /// on the corner of a box, or are met by a ball of the size of a cell at 30 m/s, as well as 32 do; but a smaller ball comes
    /// through with fewer than 32.
    const MOST_SOLVED_ALONG: f32 = 64.0;

    /// What a cloth of 64 x 64 particles, 1 m wide and hung by two corners, is stretched while it swings in one substep
    /// of 1/60 s, no unit, as woven cotton and silk; plain springs of 5000 N/m half of that, but with fewer substeps a jerk can leave
    /// cells of theirs turned inside out. It grows with this power of the particles along a side; without rows and columns, on
    /// strands only, with the one below.
    const STRAIN_OF_ONE: f32 = 0.1;
    const GROWTH: f32 = 1.2;
    const GROWTH_ON_STRANDS: f32 = 0.8;

    /// Substeps of implicit steps for a strain of 1 %. What they stretch hardly depends on their number; how far fast falls lag
    /// does, and how much of a swing is lost. They go by the root of the strain.
    const OF_IMPLICIT: f32 = 4.0;

    /// Strain of one substep with levels.
    const STRAIN_WITH_LEVELS: f32 = 0.03;

    /// Strain of one substep with levels and without strands, which all but one in a hundred springs stay below.
    const LOOSE_STRAIN: f32 = 0.04;

    /// With fewer, plain springs on triangles, which are solved one after the other, feed energy into a cloth that is pulled in its
    /// plane.
    const LEAST_ON_TRIANGLES: f32 = 8.0;

    /// Fewest substeps on triangles for each particle along a side.
    const LEAST_ON_TRIANGLES_OF_SIDE: f32 = 0.3;

    /// Largest number of substeps that narrow triangles ask for, which is the length of the narrowest over its height.
    const MOST_FOR_SLIVERS: f32 = 32.0;

    /// Where more substeps than this would be needed, levels help.
    const MOST_WITHOUT_LEVELS: f32 = 16.0;

    /// Substeps that hold the largest strain of [`Method::Strands`](crate::input::Method::Strands) at about `max_strain` (no
    /// unit) at 60 steps a second, with levels where it takes them: of a sheet with `moduli`, or of plain springs.
    ///
    /// Measured with `lab hang` over grids of 16 to 256 particles a side: strain falls with the number of substeps, and
    /// grows with the power 1.2 of the particles along a side, with levels 0.9. Levels keep a hung cloth moving, by some
    /// millimetres a second, so they are used where substeps alone would be too many, and on meshes without strands. A cloth that is
    /// stretched more by its own weight stays so. On triangles a few springs are stretched several times as much: those
    /// next to a pin carry its whole load.
    pub fn to_hold(max_strain: f32, topology: &Topology, moduli: Option<&Moduli>) -> Self {
        if moduli.is_some() && topology.two_grid.is_some() {
            return Self::of_implicit_steps(max_strain);
        }
        let grown = |of_64: f32, power: f32| of_64 * bevy_math::ops::powf(side(topology) / 64.0, power) / max_strain;
        let without = match topology.structure() {
            MeshStructure::Grid { .. } => grown(Self::STRAIN_OF_ONE, Self::GROWTH),
            MeshStructure::Strands { .. } => grown(Self::STRAIN_OF_ONE, Self::GROWTH_ON_STRANDS),
            MeshStructure::Triangles { .. } | MeshStructure::Unstructured { .. } => f32::INFINITY,
        };
        let with_levels = without > Self::MOST_WITHOUT_LEVELS;
        let of_64 = if without < f32::INFINITY { Self::STRAIN_WITH_LEVELS } else { Self::LOOSE_STRAIN };
        let needed = if with_levels { grown(of_64, 0.9) } else { without };
        let in_range = |substeps: f32| substeps.ceil().clamp(2.0, 64.0) as u32;
        let (substeps, needed) = (in_range(needed.max(least_on_triangles(topology))), in_range(needed));
        let least = Self::LEAST_AT_CONTACT.max(Self::LEAST_OF_SIDE * side(topology)).ceil() as u32;
        Self {
            substeps,
            levels: if with_levels { Self::levels_down_to(substeps, 1, topology) } else { Vec::new() },
            // Without the floor: near what is sharp, a multiple of these is enough.
            contact_substeps: needed.max(least),
            contact_levels: Vec::new(),
            follows_time_step: true,
        }
    }

    /// Those of sheets that implicit steps solve. They have no levels.
    fn of_implicit_steps(max_strain: f32) -> Self {
        let substeps = (Self::OF_IMPLICIT * (0.01 / max_strain).sqrt()).ceil().clamp(2.0, 16.0) as u32;
        let contact_substeps = substeps.max(Self::LEAST_AT_CONTACT as u32);
        Self { substeps, contact_substeps, follows_time_step: true, ..Self::default() }
    }

    /// So many substeps in every step.
    pub fn fixed(substeps: u32, levels: Vec<LevelPass>) -> Self {
        let contact_levels = levels.clone();
        Self { substeps, levels, contact_substeps: substeps, contact_levels, follows_time_step: false }
    }

    /// Substeps and levels of a step of `dt` seconds.
    pub(crate) fn of_step(&self, risk: ContactRisk, dt: f32) -> (u32, &[LevelPass]) {
        let factor = if self.follows_time_step { dt * 60.0 } else { 1.0 };
        let (substeps, levels) = match risk {
            ContactRisk::None => (self.substeps, &self.levels[..]),
            _ => (self.contact_substeps, &self.contact_levels[..]),
        };
        let for_edges = (Self::MORE_WITH_SHARP * substeps as f32).max(Self::LEAST_WITH_SHARP);
        let substeps = match risk {
            _ if !self.follows_time_step => substeps as f32,
            ContactRisk::None | ContactRisk::Some => substeps as f32,
            ContactRisk::Limbs => (Self::SHARE_NEAR_LIMBS * substeps as f32).ceil(),
            ContactRisk::EdgeSolvedAlong(wanted) => (wanted / factor).min(Self::MOST_SOLVED_ALONG).max(substeps as f32),
            ContactRisk::TipSolvedAlong(wanted) => {
                (2.0 * wanted / factor).clamp(Self::LEAST_WITH_SHARP, Self::MOST_SOLVED_ALONG).max(substeps as f32)
            }
            ContactRisk::SelfCollision => {
                (Self::MORE_WITH_SELF_COLLISION * substeps as f32).max(Self::LEAST_WITH_SELF_COLLISION)
            }
            ContactRisk::Edge(wanted) => (wanted / factor).clamp(for_edges, 2.0 * for_edges),
            ContactRisk::Tip(wanted) => 2.0 * (wanted / factor).clamp(for_edges, 2.0 * for_edges),
        };
        let substeps = substeps.max(self.substeps as f32);
        // A step of 1/60 s isn't longer than that by a rounding.
        ((substeps * factor - 0.01).ceil().max(1.0) as u32, levels)
    }

    /// The levels that go with so many substeps: the fewer there are, the farther a pull has to travel in one. Where
    /// substeps are enough by themselves, levels would only stiffen the cloth.
    pub fn levels_for(substeps: u32, topology: &Topology) -> Vec<LevelPass> {
        Self::levels_down_to(substeps, 0, topology)
    }

    /// Levels that go with so many substeps, the finest `least` of them in any case.
    fn levels_down_to(substeps: u32, least: usize, topology: &Topology) -> Vec<LevelPass> {
        let widest = side(topology) / (2.5 * substeps as f32);
        let iterations = if substeps <= 4 { 8 } else { 4 };
        let count = topology.levels.len();
        let levels = topology.levels.iter().enumerate();
        let used = levels.filter(|&(i, level)| level.stride as f32 <= widest || i + least >= count);
        used.map(|(_, level)| LevelPass { stride: level.stride, iterations }).collect()
    }
}

/// Substeps that triangles need whatever the strain: none in rows and columns.
fn least_on_triangles(topology: &Topology) -> f32 {
    if topology.lattice.is_some() {
        return 0.0;
    }
    let of_side = SubstepPolicy::LEAST_ON_TRIANGLES_OF_SIDE * side(topology);
    let of_slivers = narrowest(topology).min(SubstepPolicy::MOST_FOR_SLIVERS);
    SubstepPolicy::LEAST_ON_TRIANGLES.max(of_side).max(of_slivers)
}

/// Longest side over height of the narrowest triangle, no unit. 1 where there is none.
fn narrowest(topology: &Topology) -> f32 {
    let narrowness = |[a, b, c]: [u32; 3]| {
        let [a, b, c] = [a, b, c].map(|i| topology.rest[i as usize]);
        let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
        longest / (b - a).cross(c - a).length().max(f32::MIN_POSITIVE)
    };
    topology.triangles.iter().copied().map(narrowness).fold(1.0, f32::max)
}

/// Particles along a side, if the cloth were a square.
fn side(topology: &Topology) -> f32 {
    (topology.particle_count() as f32).sqrt()
}
