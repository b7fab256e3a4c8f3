//! What cloths touch with their triangles and edges: themselves, each other, and what is sharp.
//!
//! A search finds the pairs of features that may touch, with the way that everything is on; substeps work on those pairs.
//! As soon as a particle comes off its way there is another search.

use core::ops::Range;

use bevy_math::Vec3A;

use crate::{
    constraint::implicit::{between::ContactsBetween, contact::PredictedContact},
    contact::{
        body::Bodies,
        feature::{
            body_motion::PredictedBodyMotion,
            narrow_phase::Displacements,
            obstacle::{ClothMotion, ObstaclePoint, ObstacleSearch},
            pair::{FeatureContact, FeaturePoints},
            predict::PredictedPair,
            tangle::Tangle,
        },
    },
    geometry::bvh::{TriangleBvh, bounds::BvhBounds, traversal::Traversal},
    input::{Obstacle, SelfCollision, StepContext},
    layout::simd::SimdLevel,
    particles::{Particles, contact_load::FeatureLoad, lanes::Lanes},
    shape::{Shape, sharp_features::Sharpness},
    topology::Topology,
};

pub(crate) mod body_motion;
pub(crate) mod cloths;
pub(crate) mod narrow_phase;
pub(crate) mod obstacle;
pub(crate) mod obstacle_geometry;
pub(crate) mod pair;
pub(crate) mod positions;
pub(crate) mod predict;
pub(crate) mod sharp_feature_cache;
pub(crate) mod tangle;

/// How far particles may come off their way before there is another search: this share of the mean edge at most.
const SLACK: f32 = 0.2;

/// The same where cloth is at rest, m, and as a share of the way by which parts of it move past each other: the less, the
/// fewer layers of a pile are near each other, and the sooner there is another search.
const SLACK_AT_REST: f32 = 0.0005;
const SLACK_OF_WAY: f32 = 0.25;

/// Share of the fall that is taken to happen: nobody knows what is held up, and so neither that comes off its way, nor what
/// falls.
const FALL: f32 = 0.5;

/// How deep the inside of a triangle may sink into what isn't sharp: this much at least, m, and this share of the distance
/// that particles keep. What is seen of the cloth stays outside.
const SINK: f32 = 0.0005;
const SINK_OF_DISTANCE: f32 = 0.5;

/// Edges longer than at rest by this factor are taken for stretched to twice their length: it may come to that before the step
/// is over.
const STRETCHED: f32 = 1.25;

/// How often pairs with obstacles are solved again within a substep.
const AGAIN_AT_OBSTACLES: u32 = 8;

/// Whether two cloths meet, or one itself.
fn meet(one: &StepContext, other: &StepContext) -> bool {
    let is_on =
        one.settings.self_collision != SelfCollision::Off && other.settings.self_collision != SelfCollision::Off;
    let is_same = core::ptr::eq(one, other);
    is_on && (is_same || one.settings.collision_filter.meets(other.settings.collision_filter))
}

/// How deep triangles of a cloth may sink into obstacles, m.
fn sink(ctx: &StepContext) -> f32 {
    ctx.settings.margin.max(SINK).max(SINK_OF_DISTANCE * ctx.contact_distance())
}

/// Length of a cloth's longest edge, m: that at rest, or twice that where the cloth is stretched and something is `near` that fits
/// through its cells only then.
///
/// A pull goes about one edge farther in each substep, so what comes faster than that is going to stretch the cells. It is that or
/// twice that, since outlines are drawn anew where it changes.
pub fn longest_edge<'a>(
    near: impl Iterator<Item = &'a Obstacle>,
    particles: &Particles,
    topology: &Topology,
    ctx: &StepContext,
) -> f32 {
    let surface = topology.surface();
    let at_rest = surface.longest_edge;
    let fit_once_stretched = near.filter(|obstacle| {
        let Shape::Solid(solid) = &obstacle.shape else { return false };
        let fits = |edge| sharp_feature_cache::tightness(obstacle, edge, ctx).pierced_by(solid) == Some(Sharpness::Tip);
        fits(2.0 * at_rest) && !fits(at_rest)
    });
    let ways = fit_once_stretched.map(|obstacle| obstacle.start.translation.distance(obstacle.end.translation));
    let Some(way) = ways.reduce(f32::max) else { return at_rest };
    let place = |i: u32| particles.position[i as usize];
    let longest = surface.edges().map(|[p, q]| place(p).distance_squared(place(q))).fold(0.0, f32::max).sqrt();
    let outrun = at_rest + way / ctx.settings.substep_policy.contact_substeps as f32;
    if longest.max(outrun) > STRETCHED * at_rest { 2.0 * at_rest } else { at_rest }
}

/// What is sharpest among the obstacles `near` a cloth, and into how many substeps to cut a step of `dt` seconds so that nothing
/// sharp goes by more than half an edge of the cloth in one of them. None where nothing is sharp, or nothing moves.
pub fn sharpest<'a>(
    near: impl Iterator<Item = &'a Obstacle>,
    particles: &Particles,
    topology: &Topology,
    longest_edge: f32,
    ctx: &StepContext,
    dt: f32,
) -> Option<(Sharpness, f32)> {
    let sharp = near.filter_map(|obstacle| match &obstacle.shape {
        Shape::Solid(solid) => {
            let sharp = sharp_feature_cache::tightness(obstacle, longest_edge, ctx).pierced_by(solid)?;
            Some((sharp, obstacle.start.translation.distance(obstacle.end.translation)))
        }
        Shape::Mesh(_) => None,
    });
    let (sharp, way) = sharp.reduce(|(one, way), (other, far)| (one.max(other), way.max(far)))?;
    let speed = particles.velocity.iter().map(|v| v.length_squared()).fold(0.0, f32::max).sqrt();
    // What stays goes past nothing yet: a cloth that begins inside of something parts from it in fewer, gentler substeps.
    let way = way + speed * dt;
    (way > 0.0).then_some((sharp, way / (0.5 * topology.surface().mean_edge)))
}

/// What contact by features reads and moves of a cloth within its step.
pub(crate) trait ClothInStep {
    /// What surrounds the cloth.
    fn ctx(&self) -> &StepContext<'_>;
    /// What is connected to what.
    fn topology(&self) -> &Topology;
    /// Its particles.
    fn lanes(&self) -> &Lanes;
    /// The lanes, to be moved.
    fn lanes_mut(&mut self) -> &mut Lanes;
    /// The bodies among its obstacles.
    fn bodies(&self) -> &Bodies;
    /// The bodies, to be pushed.
    fn bodies_mut(&mut self) -> &mut Bodies;
    /// Instructions that it is stepped with.
    fn simd_level(&self) -> SimdLevel;
    /// Its origin from that of the first cloth, m.
    fn offset(&self) -> Vec3A;
    /// Length that its longest edge is taken to have at obstacles, m.
    fn longest_edge(&self) -> f32;
    /// Whether an obstacle may be touched.
    fn is_near(&self) -> bool;
    /// Whether its step is implicit.
    fn is_implicit(&self) -> bool;
    /// The contacts that its implicit step solves.
    fn predicted(&self) -> &[PredictedContact];
    /// The list of them, to be added to.
    fn predicted_mut(&mut self) -> &mut Vec<PredictedContact>;
    /// Normal forces of its pairs before the latest search.
    fn feature_loads(&self) -> &[FeatureLoad];
    /// The list of them, to be made anew.
    fn feature_loads_mut(&mut self) -> &mut Vec<FeatureLoad>;

    /// Whether it meets itself or other cloths.
    fn collides(&self) -> bool {
        self.ctx().settings.self_collision != SelfCollision::Off
    }

    /// Distance that it keeps from cloth, m.
    fn self_distance(&self, mode: SelfCollision) -> f32 {
        mode.distance_on(self.topology(), self.ctx().settings.self_distance)
    }

    /// Its triangles.
    fn surface(&self) -> &TriangleBvh {
        self.topology().surface()
    }
}

/// Working memory and what is found.
#[derive(Clone, Debug, Default)]
pub struct FeatureContacts {
    /// All particles, then the points of obstacles.
    points: FeaturePoints,
    /// Number of the first particle of each cloth, and of the first that is none.
    first: Vec<u32>,
    /// Where particles were at the search, m, and how far they will come until the step's end.
    start: Vec<Vec3A>,
    way: Vec<Vec3A>,
    /// The part of the step that the search was for.
    searched: Range<f32>,
    /// By how much the particles of each cloth may come off their ways, m.
    slack: Vec<f32>,
    places: Vec<BvhBounds>,
    pairs: Vec<FeatureContact>,
    tangles: Vec<Tangle>,
    is_tangled: Vec<bool>,
    /// Numbers of the pairs that touched an obstacle.
    at_obstacles: Vec<u32>,
    leaves: Vec<(u32, u32)>,
    traversal: Traversal,
    fixed: Vec<ObstaclePoint>,
    body_ways: Vec<PredictedBodyMotion>,
    at_obstacle: ObstacleSearch,
    /// Whether there has been a search in this step.
    is_begun: bool,
    /// Pairs that were to touch in this substep.
    predicted: Vec<PredictedPair>,
    /// Those of two cloths, and their numbers.
    between: ContactsBetween,
    pairs_between: Vec<u32>,
    /// Whether that has searched already.
    is_searched: bool,
}

impl FeatureContacts {
    /// Begins a step: nothing is known yet. Returns whether there may be anything to do.
    pub fn begin(&mut self, cloths: &[impl ClothInStep]) -> bool {
        self.is_begun = false;
        self.between.predicted.clear();
        self.forget();
        let mut is_needed = cloths.iter().any(ClothInStep::collides);
        for (number, cloth) in cloths.iter().enumerate() {
            is_needed |= cloth.is_near() && self.at_obstacle.is_needed(number, cloth);
        }
        is_needed
    }

    fn forget(&mut self) {
        self.pairs.clear();
        self.tangles.clear();
    }

    /// Looks for pairs in what is left of a step of `dt` seconds, of which the share `now` is over, if it is time to.
    fn search(&mut self, cloths: &mut [impl ClothInStep], span: Range<f32>, dt: f32) {
        self.take_places(cloths);
        let is_known = self.is_begun && span.end <= self.searched.end && self.tangles.is_empty();
        if is_known && !self.has_come_off(span.start) && !self.has_body_come_off(cloths, span.start) {
            return;
        }
        if core::mem::replace(&mut self.is_begun, true) {
            self.keep_loads(cloths);
        }
        self.take_velocities(cloths);
        let now = span.start;
        self.searched = now..self.horizon(cloths, span, dt);
        self.take_ways(cloths, dt);
        self.forget();
        self.fixed.clear();
        self.body_ways.clear();
        self.is_tangled.clear();
        self.is_tangled.resize(self.start.len(), false);
        if cloths.iter().any(ClothInStep::collides) {
            self.search_cloths(cloths);
        }
        for (number, cloth) in cloths.iter().enumerate() {
            self.note_bodies(number, cloth, dt);
            if !cloth.is_near() {
                continue;
            }
            let particles = self.particles(number);
            let ways = Displacements { position: &self.start[particles.clone()], way: &self.way[particles] };
            let (first, total) = (self.first[number], self.start.len());
            let (slack, span) = (self.slack[number], self.searched.clone());
            let at = ClothMotion { cloth, number, first, total, ways, slack, span, dt };
            for i in 0..cloth.ctx().obstacles.len() {
                self.at_obstacle.search(&at, i, &mut self.traversal, (&mut self.fixed, &mut self.pairs));
            }
        }
        let count = self.start.len() + self.fixed.len();
        for points in [&mut self.points.position, &mut self.points.previous] {
            points.resize(count, Vec3A::ZERO);
        }
        self.points.inverse_mass.resize(count, 0.0);
        self.recall_loads(cloths);
    }

    /// Keeps where particles were when the substep began, for a search, and reads their velocities, as ways.
    fn take_velocities(&mut self, cloths: &[impl ClothInStep]) {
        let count = self.particle_count();
        self.start.clear();
        self.start.extend_from_slice(&self.points.previous[..count]);
        self.way.resize(count, Vec3A::ZERO);
        self.points.inverse_mass.clear();
        for (i, cloth) in cloths.iter().enumerate() {
            let particles = self.particles(i);
            let Lanes { order, velocity, .. } = &cloth.lanes();
            velocity.store(*order, &mut self.way[particles.clone()], cloth.simd_level());
            let masses = (0..particles.len() as u32).map(|particle| cloth.lanes().inverse_mass(order.slot(particle)));
            self.points.inverse_mass.extend(masses);
        }
    }

    /// The moment of the step (0..=1) up to which a search is worth while: the farther things move past each other, the
    /// more is near their ways, and within the length of an edge that is little.
    ///
    /// Sets by how much particles may come off their ways until then, too.
    fn horizon(&mut self, cloths: &[impl ClothInStep], span: Range<f32>, dt: f32) -> f32 {
        let mean = self.way.iter().sum::<Vec3A>() / self.way.len().max(1) as f32;
        let mut fastest = self.way.iter().map(|velocity| velocity.distance_squared(mean)).fold(0.0, f32::max).sqrt();
        let mut edge = f32::INFINITY;
        for cloth in cloths {
            edge = edge.min(cloth.surface().mean_edge);
            for obstacle in cloth.ctx().obstacles {
                let speed = (obstacle.end.translation - obstacle.start.translation) / dt;
                fastest = fastest.max(speed.distance(mean));
            }
        }
        let share = edge / (fastest * dt).max(f32::MIN_POSITIVE);
        let end = (span.start + share).clamp(span.end, 1.0);
        let left = (end - span.start) * dt;
        let needed = SLACK_AT_REST + SLACK_OF_WAY * fastest * left;
        self.slack.clear();
        self.slack.extend(cloths.iter().map(|cloth| {
            let fall = 0.5 * cloth.ctx().gravity.length() * left * left;
            (needed + FALL * fall).min(SLACK * cloth.surface().mean_edge)
        }));
        end
    }

    /// Works out how far all particles will come within the time that the search is for.
    fn take_ways(&mut self, cloths: &[impl ClothInStep], dt: f32) {
        let share = self.searched.end - self.searched.start;
        let left = share * dt;
        for (number, cloth) in cloths.iter().enumerate() {
            let particles = self.particles(number);
            let fall = cloth.ctx().gravity * (0.5 * FALL * left * left);
            let way = &mut self.way[particles];
            way.iter_mut().for_each(|way| *way = *way * left + fall);
            for anchor in cloth.ctx().pin_motions {
                way[anchor.particle as usize] = (anchor.end - anchor.start) * share;
            }
        }
    }

    /// Keeps features apart within the part `span` (0..=1) of the step, a substep of `h` seconds. Returns the number of
    /// pairs that touched.
    pub fn solve(&mut self, cloths: &mut [impl ClothInStep], span: Range<f32>, h: f32, dt: f32) -> u32 {
        if self.is_searched {
            self.read_loads(cloths);
            self.take_places(cloths);
        } else {
            self.search(cloths, span.clone(), dt);
        }
        let mut touched = 0;
        if !(self.pairs.is_empty() && self.tangles.is_empty()) {
            self.lead_fixed(cloths, span.clone());
            self.points.has_parted = false;
            let most_parted =
                cloths.iter().map(|cloth| cloth.ctx().settings.max_depenetration_velocity).fold(0.0, f32::max) * h;
            for tangle in &self.tangles {
                tangle.solve(&mut self.points, most_parted, h);
            }
            touched = match cloths.iter().any(|cloth| cloth.bodies().is_any()) {
                true => self.solve_pairs_on_bodies(cloths, span.clone(), most_parted),
                false => self.solve_pairs(most_parted),
            };
            self.give_places(cloths, span);
        }
        touched
    }

    /// Solves all pairs, and returns how many touched.
    fn solve_pairs(&mut self, most_parted: f32) -> u32 {
        let count = self.particle_count() as u32;
        let Self { pairs, points, at_obstacles, .. } = self;
        let mut touched = 0;
        at_obstacles.clear();
        for (i, pair) in pairs.iter_mut().enumerate() {
            if pair.solve(points, most_parted, None).is_some() {
                touched += 1;
                if pair.points.iter().any(|&point| point >= count) {
                    at_obstacles.push(i as u32);
                }
            }
        }
        // What is sharp gives no way, and so one pair undoes what another did, more than between cloths.
        for _ in 0..AGAIN_AT_OBSTACLES {
            let mut is_any_left = false;
            for &i in &*at_obstacles {
                is_any_left |= pairs[i as usize].solve(points, 0.0, None).is_some();
            }
            if !is_any_left {
                break;
            }
        }
        touched
    }

    /// Whether a particle was off its way when a substep began, at the moment `now` (0..=1) of the step.
    fn has_come_off(&self, now: f32) -> bool {
        let share = (now - self.searched.start) / (self.searched.end - self.searched.start);
        (0..self.slack.len()).any(|cloth| {
            let particles = self.particles(cloth);
            let far = self.slack[cloth] * self.slack[cloth];
            let ways = self.start[particles.clone()].iter().zip(&self.way[particles.clone()]);
            let mut ways = ways.zip(&self.points.previous[particles]);
            ways.any(|((&start, &way), place)| place.distance_squared(start + way * share) > far)
        })
    }
}
