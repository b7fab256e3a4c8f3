//! What holds particles to where an animated mesh has them: limits that stay, and places that change with every step.
//!
//! The words are those of the field: maximum distance and backstop in Unreal Engine and Unity, motion and separation constraints
//! in NvCloth.

use bevy_math::Vec3A;

use crate::{
    layout::{
        order::Order,
        simd::{LANES, Lane},
    },
    topology::Topology,
};

/// Larger backstops than this, m, are planes to any cloth, and are cut down to it.
const MOST: f32 = 100.0;

/// Beyond this distance from the cloth's origin, m, a skin doesn't hold: no character is that large, and squares stay finite.
pub(crate) const FARTHEST: f32 = 1e4;

/// Highest own frequency of a pull, Hz: more is as good as rigid.
const HIGHEST_PULL: f32 = 1e3;

/// Largest damping ratio of a pull, no unit.
const MOST_DAMPING: f32 = 100.0;

/// How far a particle may be from where the animated mesh has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkinLimit {
    /// Largest distance from there, m, 0 or more. 0 follows the mesh, 0.02 to 0.5 is clothing, infinite, as by default, is free.
    /// What is negative or no number counts as 0.
    pub max_distance: f32,
    /// What keeps it off the inside of the mesh. None by default.
    pub backstop: Option<Backstop>,
}

impl Default for SkinLimit {
    fn default() -> Self {
        Self { max_distance: f32::INFINITY, backstop: None }
    }
}

/// A sphere beneath the animated surface that a particle stays out of: a piece of the body there.
///
/// ```text
///        n ^
///     -----t-----   surface, t: where the mesh has the particle
///          |  distance
///        .---.
///       (  q  )     centre: q = t - (distance + radius) n
///        '---'
/// ```
///
/// What is negative or no number counts as 0, and what is more than 100 m as that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Backstop {
    /// How far beneath the surface the sphere begins, m, 0 or more. 0 to 0.05.
    pub distance: f32,
    /// Radius of the sphere, m, greater than 0: 0 is no backstop. About that of the limb, 0.05 to 0.3, so that cloth can slip off
    /// sideways; 10 is all but a plane.
    pub radius: f32,
}

/// How far all particles of a cloth may be from an animated mesh: built once, and shared by cloths that are alike.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkinLimits {
    /// Who stands where.
    order: Order,
    blocks: Vec<SkinBlock>,
    /// Mean edge of the cloth, m.
    mean_edge: f32,
}

/// The limits of the eight particles of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SkinBlock {
    /// Whether any of them is limited.
    pub is_limited: bool,
    /// Whether any of them has a backstop.
    pub has_backstop: bool,
    /// Largest distance of each, m; infinite where there is none.
    pub max_distance: Lane,
    /// Distance to each one's backstop, m.
    pub backstop_distance: Lane,
    /// Radius of each one's backstop, m; 0 where there is none.
    pub backstop_radius: Lane,
}

impl SkinLimits {
    /// Puts the limits of a cloth's particles side by side, in the particles' order. Particles beyond the end of the list are free.
    pub fn new(limits: &[SkinLimit], topology: &Topology) -> Self {
        let order = topology.order();
        let limit = |particle: Option<u32>| {
            let limit = particle.and_then(|particle| limits.get(particle as usize)).copied();
            limit.unwrap_or_default()
        };
        let blocks = order.particles().map(|particles| SkinBlock::new(particles.map(limit))).collect();
        Self { order, blocks, mean_edge: mean_edge(topology) }
    }

    /// Limits of the blocks.
    pub(crate) fn blocks(&self) -> &[SkinBlock] {
        &self.blocks
    }

    /// Largest distance of the particle in a slot, m.
    pub(crate) fn max_distance(&self, slot: usize) -> f32 {
        self.blocks.get(slot / LANES).map_or(f32::INFINITY, |block| block.max_distance[slot % LANES])
    }

    /// Whether a largest distance (m) is so small, less than an edge, that the skin alone says where a particle is.
    pub(crate) fn is_tight(&self, max_distance: f32) -> bool {
        max_distance < self.mean_edge
    }
}

impl SkinBlock {
    fn new(limits: [SkinLimit; LANES]) -> Self {
        let max_distance = limits.map(|limit| up_to(f32::INFINITY, limit.max_distance));
        let backstop = |number: fn(&Backstop) -> f32| {
            limits.map(|limit| limit.backstop.as_ref().map_or(0.0, |it| up_to(MOST, number(it))))
        };
        let backstop_radius = backstop(|it| it.radius);
        let has_backstop = backstop_radius.iter().any(|&radius| radius > 0.0);
        Self {
            is_limited: has_backstop || max_distance.iter().any(|&distance| distance < f32::INFINITY),
            has_backstop,
            max_distance,
            backstop_distance: backstop(|it| it.distance),
            backstop_radius,
        }
    }
}

/// A number between 0 and another: 0 where it is none.
fn up_to(most: f32, number: f32) -> f32 {
    if number > 0.0 { number.min(most) } else { 0.0 }
}

/// Mean length of the triangles' sides at rest, m. The surface has one as well, but is made only for cloth that touches something.
fn mean_edge(topology: &Topology) -> f32 {
    let place = |i: u32| topology.rest[i as usize];
    let around =
        |[a, b, c]: [u32; 3]| place(a).distance(place(b)) + place(b).distance(place(c)) + place(c).distance(place(a));
    let sum: f32 = topology.triangles.iter().map(|&triangle| around(triangle)).sum();
    sum / (3 * topology.triangles.len()).max(1) as f32
}

/// Where an animated mesh has the particles of a cloth at one moment, one entry a particle in each list.
///
/// A place that isn't finite, or farther than 10 km from the cloth's origin, doesn't hold its particle. A normal needs no length
/// of 1; without a direction there is no backstop.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkinPose {
    /// Place of each, m, relative to the cloth's origin.
    pub place: Vec<Vec3A>,
    /// Outward normal of the mesh at each. Read only where there are backstops.
    pub normal: Vec<Vec3A>,
}

/// What holds a cloth to an animated mesh within one step.
///
/// Two [poses](SkinPose) are enough: from step to step they change places, and the one that becomes the end is written anew. A
/// skin whose limits or lists are of another cloth's size holds nothing. Obstacles come after it in a substep, and
/// largest distances once more: where both can't be, a particle is no farther from the mesh than it may be, and in the obstacle.
#[derive(Clone, Copy, Debug)]
pub struct Skin<'a> {
    /// How far particles may be from the mesh.
    pub limits: &'a SkinLimits,
    /// The mesh at the start of the step. Within the step it moves straight.
    pub start: &'a SkinPose,
    /// The mesh at the end of the step.
    pub end: &'a SkinPose,
    /// Own frequency of the spring by which each particle is drawn to its place, Hz, 0 or more. 0, as by default, doesn't draw;
    /// 0.5 to 5: the weight of the cloth hangs g / (2 pi f)² through, 6 cm at 2 Hz. The same whatever it weighs.
    pub pull: f32,
    /// Damping ratio of that spring, no unit, 0 or more. 1, which doesn't swing, by default.
    pub pull_damping: f32,
}

impl<'a> Skin<'a> {
    /// Limits, and how the mesh moves, without a pull.
    pub const fn new(limits: &'a SkinLimits, start: &'a SkinPose, end: &'a SkinPose) -> Self {
        Self { limits, start, end, pull: 0.0, pull_damping: 1.0 }
    }

    /// Whether it is one of a cloth in this `order`, and holds anything.
    pub(crate) fn is_of(&self, order: Order) -> bool {
        let holds = self.pulls() || self.limits.blocks.iter().any(|block| block.is_limited);
        self.limits.order == order && self.is_whole() && holds
    }

    /// Whether its lists are as long as the one of its limits.
    fn is_whole(&self) -> bool {
        let (count, has_backstop) = (self.limits.order.particle_count(), self.has_backstop());
        let is_whole = |pose: &SkinPose| pose.place.len() == count && (!has_backstop || pose.normal.len() == count);
        is_whole(self.start) && is_whole(self.end)
    }

    /// Whether there is any backstop.
    pub(crate) fn has_backstop(&self) -> bool {
        self.limits.blocks.iter().any(|block| block.has_backstop)
    }

    /// Own frequency and damping ratio of the pull, if there is one.
    pub(crate) fn pulling(&self) -> Option<[f32; 2]> {
        let damping = up_to(MOST_DAMPING, self.pull_damping);
        self.pulls().then(|| [self.pull.min(HIGHEST_PULL), damping])
    }

    fn pulls(&self) -> bool {
        self.pull > 0.0
    }

    /// Where particles may be taken within the step: start and end of the places that hold some, m.
    pub(crate) fn ways(self) -> impl Iterator<Item = [Vec3A; 2]> {
        let holds = move |(particle, _): &(u32, [Vec3A; 2])| {
            self.pulls() || self.limits.max_distance(self.limits.order.slot(*particle)) < f32::INFINITY
        };
        let count = if self.is_whole() { self.start.place.len() } else { 0 };
        let ways = self.start.place.iter().zip(&self.end.place).map(|(&start, &end)| [start, end]).take(count);
        let is_near = |way: &[Vec3A; 2]| way.iter().all(|place| place.length_squared() <= FARTHEST * FARTHEST);
        (0..).zip(ways).filter(holds).map(|(_, way)| way).filter(is_near)
    }

    /// Mean velocity of what holds the cloth over a step of `dt` seconds, m/s.
    pub(crate) fn mean_velocity(self, dt: f32) -> Vec3A {
        let add = |(way, count): (Vec3A, f32), [start, end]: [Vec3A; 2]| (way + (end - start), count + 1.0);
        let (way, count) = self.ways().fold((Vec3A::ZERO, 0.0_f32), add);
        way / (count.max(1.0) * dt)
    }
}
