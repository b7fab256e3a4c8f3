//! What cloths touch with their triangles and edges: themselves, each other, and what is sharp.
//!
//! A search finds the pairs of features that may touch, with the way that everything is on; substeps work on those pairs.
//! As soon as a particle comes too far off its way there is another search.

use core::ops::Range;

use bevy_math::Vec3A;

use crate::{
    constraint::implicit::{between::ContactsBetween, contact::PredictedContact},
    contact::{
        body::Bodies,
        feature::{
            body_motion::PredictedBodyMotion,
            obstacle::{ObstaclePoint, ObstacleSearch},
            pair::{FeatureContact, FeaturePoints, Touch},
            predict::PredictedPair,
            tangle::Tangle,
            triangle_pack::LeafPacks,
        },
    },
    geometry::bvh::{TriangleBvh, bounds::BvhBounds, traversal::Traversal},
    input::{Obstacle, StepContext},
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
mod search;
pub(crate) mod sharp_feature_cache;
pub(crate) mod tangle;
pub(crate) mod triangle_pack;

/// How deep the inside of a triangle may sink into what isn't sharp: this much at least, m, and this share of the distance
/// that particles keep. What is seen of the cloth stays outside.
const SINK: f32 = 0.0005;
const SINK_OF_DISTANCE: f32 = 0.5;

/// Edges longer than at rest by this factor are taken for stretched to twice their length: it may come to that before the step
/// is over.
const STRETCHED: f32 = 1.25;

/// How often pairs are solved within a substep: once, and again while features of cloth are nearer than they should be by this share
/// of their distance, since one pair undoes what another did. What is pulled tight, such as a rope, passes through itself otherwise.
const PASSES: u32 = 4;
const DEEP: f32 = 0.3;

/// How often pairs with obstacles are solved again within a substep.
const AGAIN_AT_OBSTACLES: u32 = 8;

/// Whether two cloths meet, or one itself.
fn meet(one: &StepContext, other: &StepContext) -> bool {
    let is_on = one.settings.self_collision && other.settings.self_collision;
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
        self.ctx().settings.self_collision
    }

    /// Distance that it keeps from cloth, m.
    fn self_distance(&self) -> f32 {
        self.ctx().settings.self_distance_on(self.topology())
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
    /// By how much each particle may come off its way towards other cloth, and those of each cloth towards obstacles, m.
    slack: Vec<f32>,
    obstacle_slack: Vec<f32>,
    /// Boxes around the triangles of each cloth, and its leaves that are near others.
    places: Vec<BvhBounds>,
    packs: Vec<LeafPacks>,
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
    /// Whether a cloth meets itself or another one, whether one is near something sharp, and whether one has an implicit step, which
    /// solves its contact along.
    collides: bool,
    is_sharp: bool,
    is_solved_along: bool,
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
        self.collides = cloths.iter().any(ClothInStep::collides);
        self.is_solved_along = cloths.iter().any(ClothInStep::is_implicit);
        self.is_sharp = false;
        for (number, cloth) in cloths.iter().enumerate() {
            self.is_sharp |= cloth.is_near() && self.at_obstacle.is_needed(number, cloth);
        }
        self.collides || self.is_sharp
    }

    /// Whether cloths are to be kept out of obstacles before they meet, too: layers meet where obstacles leave them, and one that is
    /// pushed out of an obstacle afterwards goes through the next. Implicit steps solve both along with the cloth.
    pub fn comes_after_obstacles(&self) -> bool {
        self.collides && !self.is_solved_along
    }

    fn forget(&mut self) {
        self.pairs.clear();
        self.tangles.clear();
    }

    /// Keeps features apart within the part `span` (0..=1) of the step, a substep of `h` seconds.
    pub fn solve(&mut self, cloths: &mut [impl ClothInStep], span: Range<f32>, h: f32, dt: f32) -> SolvedFeatures {
        if self.is_searched {
            self.read_loads(cloths);
            self.take_places(cloths);
        } else {
            self.search(cloths, span.clone(), dt);
        }
        let mut solved = SolvedFeatures::default();
        if !(self.pairs.is_empty() && self.tangles.is_empty()) {
            self.lead_fixed(cloths, span.clone());
            self.points.has_parted = false;
            let most_parted =
                cloths.iter().map(|cloth| cloth.ctx().settings.max_depenetration_velocity).fold(0.0, f32::max) * h;
            for tangle in &self.tangles {
                tangle.solve(&mut self.points, most_parted, h);
            }
            let touched = self.solve_pairs(cloths, span.clone(), most_parted);
            solved = SolvedFeatures { touched, has_moved: touched > 0 || !self.tangles.is_empty() };
            if solved.has_moved {
                self.give_places(cloths, span);
            }
        }
        solved
    }

    /// Solves the pairs until no two features of cloth are deep in each other, and returns how many touched.
    fn solve_pairs(&mut self, cloths: &mut [impl ClothInStep], span: Range<f32>, most_parted: f32) -> u32 {
        let is_on_bodies = cloths.iter().any(|cloth| cloth.bodies().is_any());
        let passes = if self.is_solved_along { 1 } else { PASSES };
        self.at_obstacles.clear();
        let mut touched = 0;
        for pass in 0..passes {
            let solved = match is_on_bodies {
                true => self.solve_each_on_bodies(cloths, span.clone(), most_parted, pass == 0),
                false => self.solve_each(most_parted, pass == 0),
            };
            touched = solved.touched.max(touched);
            if !solved.is_deep {
                break;
            }
        }
        self.solve_again_at_obstacles();
        touched
    }

    /// Solves all pairs, one after the other. The first time, notes those that touched an obstacle.
    fn solve_each(&mut self, most_parted: f32, is_first_pass: bool) -> SolvedPairs {
        let count = self.particle_count() as u32;
        let Self { pairs, points, at_obstacles, .. } = self;
        let mut solved = SolvedPairs::default();
        for (i, pair) in pairs.iter_mut().enumerate() {
            let touch = match is_first_pass {
                true => pair.solve(points, most_parted, None),
                false => pair.solve_again(points, most_parted, None),
            };
            let Some(touch) = touch else { continue };
            let is_at_obstacle = pair.points.iter().any(|&point| point >= count);
            solved.note(pair, &touch, is_at_obstacle);
            if is_at_obstacle && is_first_pass {
                at_obstacles.push(i as u32);
            }
        }
        solved
    }

    /// Solves pairs with obstacles again: what is sharp gives no way, and so one pair undoes what another did, more than between cloths.
    fn solve_again_at_obstacles(&mut self) {
        let Self { pairs, points, at_obstacles, .. } = self;
        for _ in 0..AGAIN_AT_OBSTACLES {
            let mut is_any_left = false;
            for &i in &*at_obstacles {
                is_any_left |= pairs[i as usize].solve(points, 0.0, None).is_some();
            }
            if !is_any_left {
                break;
            }
        }
    }
}

/// What keeping features apart came to.
#[derive(Clone, Copy, Debug, Default)]
pub struct SolvedFeatures {
    /// How many pairs touched.
    pub touched: u32,
    /// Whether a particle was moved.
    pub has_moved: bool,
}

/// What solving all pairs once came to.
#[derive(Clone, Copy, Debug, Default)]
struct SolvedPairs {
    /// How many touched.
    touched: u32,
    /// Whether features of cloth were as [`DEEP`] in each other.
    is_deep: bool,
}

impl SolvedPairs {
    fn note(&mut self, pair: &FeatureContact, touch: &Touch, is_at_obstacle: bool) {
        self.touched += 1;
        self.is_deep |= !is_at_obstacle && touch.depth > DEEP * pair.distance;
    }
}
