//! What cloths touch with their triangles and edges: themselves, each other, meshes, and what is sharp.
//!
//! A search finds the pairs of features that may touch, with the way that everything is on; substeps work on those pairs.
//! As soon as a particle comes off its way there is another search.

use core::ops::Range;

use bevy::math::{Isometry3d, Vec3A};

use super::{
    Shape,
    mesh::MeshShape,
    pair::{Pair, Points},
    search::{self, Reach, Side, Ways},
    surface::{Places, Surface, Walk},
    tangle::{self, Tangle},
};
use crate::solver::{Lanes, SelfCollision, StepContext, step::Running};

mod obstacle;

use obstacle::{Approach, AtObstacle, Fixed};

/// How far particles may come off their way before there is another search: this share of the mean edge.
const SLACK: f32 = 0.2;

/// How deep the inside of a triangle may sink into what isn't sharp, m, where the margin isn't more.
const SINK: f32 = 0.0005;

/// Whether two cloths meet, or one itself.
fn meet(one: &StepContext, other: &StepContext) -> bool {
    let is_on = one.self_collision != SelfCollision::Off && other.self_collision != SelfCollision::Off;
    let is_same = core::ptr::eq(one, other);
    let is_in = one.collision_layers & other.collision_mask != 0 && other.collision_layers & one.collision_mask != 0;
    is_on && (is_same || is_in)
}

/// What of a cloth matters here.
impl Running<'_> {
    fn collides(&self) -> bool {
        self.ctx.self_collision != SelfCollision::Off
    }

    /// Distance that the cloth keeps from cloth, m.
    fn self_distance(&self, mode: SelfCollision) -> f32 {
        self.topology.self_distance(mode, self.ctx.self_distance)
    }

    /// How deep triangles may sink into obstacles, m.
    fn sink(&self) -> f32 {
        self.ctx.margin.max(SINK)
    }

    fn is_fixed(&self, particle: u32) -> bool {
        let lanes = &self.scratch.lanes;
        lanes.inverse_mass(lanes.order.slot(particle)) == 0.0
    }

    fn surface(&self) -> &Surface {
        self.topology.surface()
    }
}

/// Working memory and what is found.
#[derive(Clone, Debug, Default)]
pub struct Touch {
    /// All particles, then the points of obstacles.
    points: Points,
    /// Number of the first particle of each cloth, and of the first that is none.
    first: Vec<u32>,
    /// Where particles were at the search, m, and how far they will come until the step's end.
    start: Vec<Vec3A>,
    way: Vec<Vec3A>,
    /// Share of the step that was over at the search.
    since: f32,
    /// By how much each particle may come off its way, m.
    slack: Vec<f32>,
    places: Vec<Places>,
    pairs: Vec<Pair>,
    tangles: Vec<Tangle>,
    is_tangled: Vec<bool>,
    leaves: Vec<(u32, u32)>,
    walk: Walk,
    fixed: Vec<Fixed>,
    at_obstacle: AtObstacle,
    is_off: bool,
}

impl Touch {
    /// Begins a step: nothing is known yet.
    pub fn begin(&mut self) {
        self.is_off = true;
        self.pairs.clear();
        self.tangles.clear();
    }

    /// Looks for pairs in what is left of a step of `dt` seconds, of which the share `now` is over, if it is time to.
    pub fn search(&mut self, cloths: &mut [Running], now: f32, dt: f32) {
        if !core::mem::take(&mut self.is_off) {
            return;
        }
        self.since = now;
        self.take_ways(cloths, (1.0 - now) * dt, now);
        self.pairs.clear();
        self.tangles.clear();
        self.fixed.clear();
        self.is_tangled.clear();
        self.is_tangled.resize(self.start.len(), false);
        if cloths.iter().any(Running::collides) {
            self.search_cloths(cloths);
        }
        for (number, cloth) in cloths.iter().enumerate() {
            let particles = self.first[number] as usize..self.first[number + 1] as usize;
            let ways = Ways { position: &self.start[particles.clone()], way: &self.way[particles] };
            let (first, total) = (self.first[number], self.start.len());
            let at = Approach { cloth, number, first, total, ways, now };
            for i in 0..cloth.ctx.obstacles.len() {
                self.at_obstacle.search(&at, i, &mut self.walk, &mut self.fixed, &mut self.pairs);
            }
        }
        let count = self.start.len() + self.fixed.len();
        for points in [&mut self.points.position, &mut self.points.previous] {
            points.resize(count, Vec3A::ZERO);
        }
        self.points.inverse_mass.resize(count, 0.0);
    }

    /// Reads where all particles are and where they go within `left` seconds.
    fn take_ways(&mut self, cloths: &mut [Running], left: f32, now: f32) {
        self.first.clear();
        self.start.clear();
        self.way.clear();
        self.slack.clear();
        self.points.inverse_mass.clear();
        for cloth in cloths {
            let first = self.start.len();
            self.first.push(first as u32);
            let count = cloth.topology.particle_count();
            self.start.resize(first + count, Vec3A::ZERO);
            self.way.resize(first + count, Vec3A::ZERO);
            let Lanes { order, previous, velocity, .. } = &cloth.scratch.lanes;
            previous.store(*order, &mut self.start[first..], cloth.scratch.instructions);
            velocity.store(*order, &mut self.way[first..], cloth.scratch.instructions);
            let fall = cloth.ctx.gravity * (0.5 * left * left);
            for (start, way) in self.start[first..].iter_mut().zip(&mut self.way[first..]) {
                *start += cloth.offset;
                *way = *way * left + fall;
            }
            for particle in 0..count {
                self.points.inverse_mass.push(cloth.scratch.lanes.inverse_mass(order.slot(particle as u32)));
            }
            for anchor in cloth.ctx.anchors {
                self.way[first + anchor.particle as usize] = (anchor.end - anchor.start) * (1.0 - now);
            }
            let surface = cloth.surface();
            let slack = SLACK * surface.mean_edge;
            self.slack.resize(first + count, slack);
        }
        self.first.push(self.start.len() as u32);
    }

    /// Looks for pairs between cloths, and between parts of one.
    fn search_cloths(&mut self, cloths: &[Running]) {
        self.places.resize_with(cloths.len().max(self.places.len()), Places::default);
        for (i, cloth) in cloths.iter().enumerate() {
            let particles = self.first[i] as usize..self.first[i + 1] as usize;
            let (start, way) = (&self.start[particles.clone()], &self.way[particles]);
            // With a ball against a robust cloth, the larger distance counts.
            let distance = cloth.self_distance(cloth.ctx.self_collision);
            let margin = 0.5 * distance + SLACK * cloth.surface().mean_edge;
            let ways = Ways { position: start, way };
            let corners = |triangle: [u32; 3]| triangle.map(|i| start[i as usize]);
            let bounds = |triangle| ways.bounds(triangle).grown(margin);
            self.places[i].follow(cloth.surface(), bounds, Some(corners));
        }
        for i in 0..cloths.len() {
            for j in i..cloths.len() {
                if !meet(cloths[i].ctx, cloths[j].ctx) {
                    continue;
                }
                if i != j && !self.places[i].whole().meets(&self.places[j].whole()) {
                    continue;
                }
                self.search_between(cloths, i, j);
            }
        }
    }

    fn search_between(&mut self, cloths: &[Running], i: usize, j: usize) {
        let Self { first, start, way, places, walk, leaves, pairs, is_tangled, tangles, .. } = self;
        let side = |i: usize| {
            let particles = first[i] as usize..first[i + 1] as usize;
            Side {
                surface: cloths[i].surface(),
                places: &places[i],
                ways: Ways { position: &start[particles.clone()], way: &way[particles] },
                first: first[i],
                sharper_than: 0.0,
                has_faces: true,
                radii: &[],
            }
        };
        let (a, b) = (side(i), side(j));
        leaves.clear();
        match i == j {
            true => walk.within(a.surface, a.places, |p, q| leaves.push((p, q))),
            false => walk.between((a.surface, a.places), (b.surface, b.places), |p, q| leaves.push((p, q))),
        }
        // The more careful of the two ways.
        let mode = cloths[i].ctx.self_collision.max(cloths[j].ctx.self_collision);
        let reach = Reach {
            distance: 0.5 * (cloths[i].self_distance(mode) + cloths[j].self_distance(mode)),
            slack: SLACK * (a.surface.mean_edge + b.surface.mean_edge),
            friction: 0.5 * (cloths[i].ctx.self_friction + cloths[j].ctx.self_friction),
            rest: (i == j).then_some(&*cloths[i].topology.rest),
        };
        for &(p, q) in &*leaves {
            if mode == SelfCollision::Particles {
                search::balls_between((&a, p), (&b, q), &reach, |found| pairs.push(found.pair));
                continue;
            }
            for s in a.surface.of_leaf(p) {
                for t in b.surface.of_leaf(q) {
                    // Of a leaf with itself, each two triangles once.
                    if i == j && p == q && s >= t || !a.places.of_triangles[s].meets(&b.places.of_triangles[t]) {
                        continue;
                    }
                    let (one, other) = (a.surface.triangles[s], b.surface.triangles[t]);
                    if !(i == j && one.iter().any(|corner| other.contains(corner))) {
                        let numbers = [one.map(|k| k + a.first), other.map(|k| k + b.first)];
                        let known = tangles.len();
                        tangle::find(numbers, start, tangles);
                        if tangles.len() > known {
                            for &particle in numbers.as_flattened() {
                                is_tangled[particle as usize] = true;
                            }
                        }
                    }
                    search::pairs_between((&a, s), (&b, t), &reach, |found| pairs.push(found.pair));
                }
            }
        }
        // What is tangled finds out by the tangle's own way.
        if !tangles.is_empty() {
            pairs.retain(|pair| pair.points.iter().filter(|&&i| is_tangled[i as usize]).count() < 2);
        }
    }

    /// Keeps features apart within the part `span` (0..=1) of the step, a substep of `h` seconds. Returns the number of
    /// pairs that touched.
    pub fn solve(&mut self, cloths: &mut [Running], span: Range<f32>, h: f32, dt: f32) -> u32 {
        self.search(cloths, span.start, dt);
        let count = self.start.len();
        self.points.position.resize(count + self.fixed.len(), Vec3A::ZERO);
        self.points.previous.resize(count + self.fixed.len(), Vec3A::ZERO);
        for (i, cloth) in cloths.iter().enumerate() {
            let particles = self.first[i] as usize..self.first[i + 1] as usize;
            let Lanes { order, position, previous, .. } = &cloth.scratch.lanes;
            for (values, of) in [(&mut self.points.position, position), (&mut self.points.previous, previous)] {
                of.store(*order, &mut values[particles.clone()], cloth.scratch.instructions);
                if cloth.offset != Vec3A::ZERO {
                    values[particles.clone()].iter_mut().for_each(|p| *p += cloth.offset);
                }
            }
        }
        let mut touched = 0;
        if !self.pairs.is_empty() || !self.tangles.is_empty() {
            self.lead_fixed(cloths, span.clone());
            let most_parted = cloths.iter().map(|cloth| cloth.ctx.max_depenetration_velocity).fold(0.0, f32::max) * h;
            for tangle in &self.tangles {
                tangle.solve(&mut self.points, most_parted);
            }
            for pair in &mut self.pairs {
                touched += u32::from(pair.solve(&mut self.points, most_parted));
            }
            for (i, cloth) in cloths.iter_mut().enumerate() {
                let particles = self.first[i] as usize..self.first[i + 1] as usize;
                let places = &mut self.points.position[particles];
                if cloth.offset != Vec3A::ZERO {
                    places.iter_mut().for_each(|p| *p -= cloth.offset);
                }
                let order = cloth.scratch.lanes.order;
                cloth.scratch.lanes.position.load(order, places, cloth.scratch.instructions);
                if cloth.offset != Vec3A::ZERO {
                    places.iter_mut().for_each(|p| *p += cloth.offset);
                }
            }
        }
        self.is_off = self.has_come_off(span.end);
        touched
    }

    /// Whether a particle has come off its way.
    fn has_come_off(&self, now: f32) -> bool {
        let left = 1.0 - self.since;
        let share = if left > 0.0 { (now - self.since) / left } else { 1.0 };
        let ways = self.start.iter().zip(&self.way).zip(&self.slack);
        ways.zip(&self.points.position)
            .any(|(((&start, &way), &slack), place)| place.distance_squared(start + way * share) > slack * slack)
    }

    /// Brings the points of obstacles to where they are in the part `span` of the step.
    fn lead_fixed(&mut self, cloths: &[Running], span: Range<f32>) {
        let count = self.start.len();
        let mut latest: Option<(u32, u32, [Isometry3d; 2])> = None;
        for (k, fixed) in self.fixed.iter().enumerate() {
            let cloth = &cloths[fixed.cloth as usize];
            let obstacle = &cloth.ctx.obstacles[fixed.obstacle as usize];
            let poses = match latest {
                Some((cloth, obstacle, poses)) if (cloth, obstacle) == (fixed.cloth, fixed.obstacle) => poses,
                _ => [span.start, span.end].map(|t| obstacle.pose(t)),
            };
            latest = Some((fixed.cloth, fixed.obstacle, poses));
            let point = fixed.point as usize;
            let local = |t: f32| match &obstacle.shape {
                Shape::Solid(_) => self.at_obstacle.outline(fixed).points[point],
                Shape::Mesh(MeshShape { mesh, deformed: None }) => mesh.points[point],
                Shape::Mesh(MeshShape { deformed: Some([from, to]), .. }) => from[point].lerp(to[point], t),
            };
            self.points.previous[count + k] = poses[0].transform_point(local(span.start)) + cloth.offset;
            self.points.position[count + k] = poses[1].transform_point(local(span.end)) + cloth.offset;
        }
    }
}
