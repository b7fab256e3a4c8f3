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

/// How far particles may come off their way before there is another search: this share of the mean edge at most.
const SLACK: f32 = 0.2;

/// The same where cloth is at rest, m, and as a share of the way by which parts of it move past each other: the less, the
/// fewer layers of a pile are near each other, and the sooner there is another search.
const SLACK_AT_REST: f32 = 0.0005;
const SLACK_OF_WAY: f32 = 0.25;

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
    /// The part of the step that the search was for.
    searched: Range<f32>,
    /// By how much the particles of each cloth may come off their ways, m.
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
    fn search(&mut self, cloths: &mut [Running], span: Range<f32>, dt: f32) {
        if !self.is_off && span.end <= self.searched.end {
            return;
        }
        self.take_velocities(cloths);
        let now = span.start;
        self.searched = now..self.horizon(cloths, span, dt);
        self.take_ways(cloths, dt);
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
            let (slack, span) = (self.slack[number], self.searched.clone());
            let at = Approach { cloth, number, first, total, ways, slack, span };
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

    /// Reads where all particles are when the substep begins, and their velocities, as ways.
    fn take_velocities(&mut self, cloths: &[Running]) {
        self.first.clear();
        self.start.clear();
        self.way.clear();
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
            self.start[first..].iter_mut().for_each(|place| *place += cloth.offset);
            let masses = (0..count as u32).map(|particle| cloth.scratch.lanes.inverse_mass(order.slot(particle)));
            self.points.inverse_mass.extend(masses);
        }
        self.first.push(self.start.len() as u32);
    }

    /// The moment of the step (0..=1) up to which a search is worth while: the farther things move past each other, the
    /// more is near their ways, and within the length of an edge that is little.
    ///
    /// Sets by how much particles may come off their ways until then, too.
    fn horizon(&mut self, cloths: &[Running], span: Range<f32>, dt: f32) -> f32 {
        let mean = self.way.iter().sum::<Vec3A>() / self.way.len().max(1) as f32;
        let mut fastest = self.way.iter().map(|velocity| velocity.distance_squared(mean)).fold(0.0, f32::max).sqrt();
        let mut edge = f32::INFINITY;
        for cloth in cloths {
            edge = edge.min(cloth.surface().mean_edge);
            for obstacle in cloth.ctx.obstacles {
                let speed = (obstacle.end.translation - obstacle.start.translation) / dt;
                fastest = fastest.max(speed.distance(mean));
            }
        }
        let share = edge / (fastest * dt).max(f32::MIN_POSITIVE);
        let end = (span.start + share).clamp(span.end, 1.0);
        let needed = SLACK_AT_REST + SLACK_OF_WAY * fastest * (end - span.start) * dt;
        self.slack.clear();
        self.slack.extend(cloths.iter().map(|cloth| needed.min(SLACK * cloth.surface().mean_edge)));
        end
    }

    /// Works out how far all particles will come within the time that the search is for.
    fn take_ways(&mut self, cloths: &[Running], dt: f32) {
        let share = self.searched.end - self.searched.start;
        let left = share * dt;
        for (number, cloth) in cloths.iter().enumerate() {
            let particles = self.first[number] as usize..self.first[number + 1] as usize;
            let fall = cloth.ctx.gravity * (0.5 * left * left);
            let way = &mut self.way[particles];
            way.iter_mut().for_each(|way| *way = *way * left + fall);
            for anchor in cloth.ctx.anchors {
                way[anchor.particle as usize] = (anchor.end - anchor.start) * share;
            }
        }
    }

    /// Looks for pairs between cloths, and between parts of one.
    fn search_cloths(&mut self, cloths: &[Running]) {
        self.places.resize_with(cloths.len().max(self.places.len()), Places::default);
        for (i, cloth) in cloths.iter().enumerate() {
            let particles = self.first[i] as usize..self.first[i + 1] as usize;
            let (start, way) = (&self.start[particles.clone()], &self.way[particles]);
            // With a ball against a robust cloth, the larger distance counts.
            let distance = cloth.self_distance(cloth.ctx.self_collision);
            let margin = 0.5 * distance + self.slack[i];
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
        let Self { first, start, way, places, walk, leaves, pairs, is_tangled, tangles, slack, .. } = self;
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
            slack: slack[i] + slack[j],
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
        self.search(cloths, span.clone(), dt);
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
        let share = (now - self.searched.start) / (self.searched.end - self.searched.start);
        (0..self.slack.len()).any(|cloth| {
            let particles = self.first[cloth] as usize..self.first[cloth + 1] as usize;
            let far = self.slack[cloth] * self.slack[cloth];
            let ways = self.start[particles.clone()].iter().zip(&self.way[particles.clone()]);
            let mut ways = ways.zip(&self.points.position[particles]);
            ways.any(|((&start, &way), place)| place.distance_squared(start + way * share) > far)
        })
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
