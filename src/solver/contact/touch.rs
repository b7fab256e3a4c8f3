//! What cloths touch with their triangles and edges: themselves, each other, meshes, and what is sharp.
//!
//! A search finds the pairs of features that may touch, with the way that everything is on; substeps work on those pairs.
//! As soon as a particle comes off its way there is another search.

use core::ops::Range;

use bevy::math::{Isometry3d, Vec3A};

use super::{
    Obstacle, Shape,
    mesh::{MeshShape, PseudoNormals},
    outline::Outline,
    pair::{Features, Pair, Points},
    search::{self, Found, Reach, Side, Ways},
    solid::Solid,
    surface::{Bounds, Places, Surface, Walk},
    tangle::{self, Tangle},
};
use crate::solver::{Lanes, SelfCollision, StepContext, step::Running};

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

/// A point of an obstacle.
#[derive(Clone, Copy, Debug)]
struct Fixed {
    cloth: u32,
    obstacle: u32,
    point: u32,
}

/// What a search at one obstacle needs.
#[derive(Clone, Debug, Default)]
struct AtObstacle {
    position: Vec<Vec3A>,
    way: Vec<Vec3A>,
    still: Vec<Vec3A>,
    places: Places,
    deformed: Places,
    normals: PseudoNormals,
    found: Vec<Found>,
    /// Distance of each particle to the nearest face, m.
    nearest: Vec<f32>,
    /// Number of each of the obstacle's points among all.
    number: Vec<u32>,
    /// Of each cloth's obstacles.
    outlines: Vec<Vec<(Solid, [f32; 3], Outline)>>,
    obstacle_way: Vec<Vec3A>,
}

impl Touch {
    /// Number of pairs that may touch.
    pub fn pair_count(&self) -> usize {
        self.pairs.len()
    }

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
            for (i, obstacle) in cloth.ctx.obstacles.iter().enumerate() {
                self.search_at(cloth, number, i, obstacle, now);
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
            for s in a.surface.of_leaf(p) {
                for t in b.surface.of_leaf(q) {
                    // Of a leaf with itself, each two triangles once.
                    if i == j && p == q && s >= t || !a.places.of_triangles[s].meets(&b.places.of_triangles[t]) {
                        continue;
                    }
                    if mode == SelfCollision::Particles {
                        search::balls_between((&a, s), (&b, t), &reach, |found| pairs.push(found.pair));
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

    /// Looks for pairs of a cloth and an obstacle.
    fn search_at(&mut self, cloth: &Running, number: usize, i: usize, obstacle: &Obstacle, now: f32) {
        let Self { first, start, way, slack, at_obstacle, walk, leaves, pairs, fixed, .. } = self;
        let surface = cloth.surface();
        let distance = cloth.ctx.contact_distance();
        let AtObstacle {
            position,
            way: local_way,
            still,
            places,
            deformed,
            normals,
            found,
            nearest,
            number: numbers,
            outlines,
            obstacle_way,
        } = at_obstacle;
        let (points, other, other_places, radii, has_faces, is_closed, edges): (
            &[Vec3A],
            &Surface,
            &Places,
            &[f32],
            bool,
            bool,
            f32,
        ) = match &obstacle.shape {
            Shape::Solid(solid) => {
                let needs = [surface.longest_edge, distance, cloth.sink()];
                if outlines.len() <= number {
                    outlines.resize_with(number + 1, Vec::new);
                }
                let outlines = &mut outlines[number];
                // As many as there are obstacles; each is drawn anew only when it changes.
                if outlines.len() <= i {
                    outlines.resize_with(i + 1, || (*solid, [f32::NAN; 3], Outline::default()));
                }
                let (drawn, met, outline) = &mut outlines[i];
                if *drawn != *solid || *met != needs {
                    (*drawn, *met) = (*solid, needs);
                    *outline = Outline::of(solid, needs[0], needs[1], needs[2]);
                }
                if outline.is_empty() {
                    return;
                }
                (&outline.points, &outline.surface, &outline.places, &outline.radii, false, false, 0.0)
            }
            Shape::Mesh(MeshShape { mesh, deformed: None }) => {
                let sharper_than = 2.0 * cloth.sink() / surface.longest_edge;
                (&mesh.points, &mesh.surface, &mesh.places, &[], true, mesh.is_closed, sharper_than)
            }
            Shape::Mesh(MeshShape { mesh, deformed: Some([from, to]) }) => {
                still.clear();
                still.extend(from.iter().zip(&**to).map(|(&p, &q)| p.lerp(q, now)));
                let ends = |triangle: [u32; 3]| {
                    let ways = triangle.map(|i| Bounds::around([still[i as usize], to[i as usize]]));
                    ways[0].union(ways[1]).union(ways[2])
                };
                deformed.follow(&mesh.surface, ends, None::<fn(_) -> _>);
                let sharper_than = 2.0 * cloth.sink() / surface.longest_edge;
                (&still[..], &mesh.surface, &*deformed, &[], true, mesh.is_closed, sharper_than)
            }
        };
        // In the obstacle's own frame it stays, and the cloth's way is that past it.
        let particles = first[number] as usize..first[number + 1] as usize;
        let (to_local, to_local_end) = (obstacle.pose(now).inverse(), obstacle.end.inverse());
        position.clear();
        local_way.clear();
        for (&start, &way) in start[particles.clone()].iter().zip(&way[particles.clone()]) {
            let start = start - cloth.offset;
            let place = to_local.transform_point(start);
            position.push(place);
            local_way.push(to_local_end.transform_point(start + way) - place);
        }
        let ways = Ways { position: &*position, way: &*local_way };
        let slack = slack[particles.start];
        let reached = distance + slack;
        let whole =
            Bounds::around(position.iter().copied().chain(position.iter().zip(&*local_way).map(|(&p, &w)| p + w)));
        if !whole.grown(reached).meets(&other_places.whole()) {
            return;
        }
        places.follow(surface, |triangle| ways.bounds(triangle).grown(reached), None::<fn(_) -> _>);
        leaves.clear();
        walk.between((surface, places), (other, other_places), |p, q| leaves.push((p, q)));
        if leaves.is_empty() {
            return;
        }
        let deformation: Option<&[Vec3A]> = match &obstacle.shape {
            Shape::Mesh(MeshShape { deformed: Some([_, to]), .. }) => Some(to),
            _ => None,
        };
        obstacle_way.clear();
        match deformation {
            Some(to) => obstacle_way.extend(to.iter().zip(points).map(|(&q, &p)| q - p)),
            None => obstacle_way.resize(points.len(), Vec3A::ZERO),
        }
        let a = Side { surface, places, ways, first: first[number], sharper_than: 0.0, has_faces: true, radii: &[] };
        let b = Side {
            surface: other,
            places: other_places,
            ways: Ways { position: points, way: obstacle_way },
            first: 0,
            sharper_than: edges,
            has_faces,
            radii,
        };
        let friction = cloth.ctx.material.friction * obstacle.friction;
        let reach = Reach { distance, slack, friction, rest: None };
        found.clear();
        nearest.clear();
        nearest.resize(position.len(), f32::INFINITY);
        for &(p, q) in &*leaves {
            for s in surface.of_leaf(p) {
                for t in other.of_leaf(q) {
                    if places.of_triangles[s].meets(&other_places.of_triangles[t]) {
                        search::pairs_between((&a, s), (&b, t), &reach, |one| {
                            if one.is_of_face() {
                                let nearest = &mut nearest[(one.pair.points[0] - a.first) as usize];
                                *nearest = nearest.min(one.length);
                            }
                            found.push(one);
                        });
                    }
                }
            }
        }
        if has_faces && is_closed {
            normals.find(other, points);
        }
        numbers.clear();
        numbers.resize(points.len(), u32::MAX);
        let to_world = obstacle.pose(now);
        for one in &*found {
            let mut pair = one.pair;
            if one.is_of_face() {
                let nearest = nearest[(pair.points[0] - a.first) as usize];
                // Farther faces count where the particle may slide to them.
                if one.length > nearest + one.approach {
                    continue;
                }
                if is_closed && is_inside(one, other, points, normals) {
                    if one.length > nearest {
                        continue;
                    }
                    (pair.normal, pair.gap) = (-pair.normal, -pair.gap);
                }
            }
            // The cloth's features come first but where a corner of the obstacle meets a face.
            let of_obstacle = match (pair.features, one.is_first_of_a) {
                (Features::PointFace, true) => 1..4,
                (Features::PointFace, false) => 0..1,
                (Features::EdgeEdge, _) => 2..4,
                (Features::PointPoint, _) => 1..4,
            };
            for k in of_obstacle {
                let number = &mut numbers[pair.points[k] as usize];
                if *number == u32::MAX {
                    *number = (start.len() + fixed.len()) as u32;
                    fixed.push(Fixed { cloth: a.first, obstacle: i as u32, point: pair.points[k] });
                }
                pair.points[k] = *number;
            }
            pair.normal = to_world.rotation * pair.normal;
            pairs.push(pair);
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
            let number = self.first.binary_search(&fixed.cloth).unwrap_or(0);
            let cloth = &cloths[number];
            let obstacle = &cloth.ctx.obstacles[fixed.obstacle as usize];
            let poses = match latest {
                Some((cloth, obstacle, poses)) if (cloth, obstacle) == (fixed.cloth, fixed.obstacle) => poses,
                _ => [span.start, span.end].map(|t| obstacle.pose(t)),
            };
            latest = Some((fixed.cloth, fixed.obstacle, poses));
            let point = fixed.point as usize;
            let local = |t: f32| match &obstacle.shape {
                Shape::Solid(_) => self.at_obstacle.outlines[number][fixed.obstacle as usize].2.points[point],
                Shape::Mesh(MeshShape { mesh, deformed: None }) => mesh.points[point],
                Shape::Mesh(MeshShape { deformed: Some([from, to]), .. }) => from[point].lerp(to[point], t),
            };
            self.points.previous[count + k] = poses[0].transform_point(local(span.start)) + cloth.offset;
            self.points.position[count + k] = poses[1].transform_point(local(span.end)) + cloth.offset;
        }
    }
}

/// Whether the particle of a pair is behind the face, by the normal of the closest place.
fn is_inside(found: &Found, surface: &Surface, points: &[Vec3A], normals: &PseudoNormals) -> bool {
    let triangle = surface.triangles[found.face];
    let [a, b, c] = triangle.map(|i| points[i as usize]);
    let weights = [1, 2, 3].map(|i| -found.nearest.weights[i]);
    let normal = normals.at(triangle, (b - a).cross(c - a), weights);
    found.nearest.between.dot(normal) < 0.0
}
