//! The search for pairs of a cloth and one obstacle.

use core::ops::Range;

use bevy::math::{Isometry3d, Vec3A};

use super::{
    faces::{self, Faces, Meeting},
    sink,
};
use crate::solver::{
    StepContext, Topology,
    contact::{
        Obstacle, Shape,
        inside::{self, Whereabouts},
        mesh::{MeshShape, PseudoNormals},
        outline::{Outline, Tightness},
        pair::{Features, Pair},
        search::{self, Found, Reach, Side, Ways},
        solid::Solid,
        surface::{Bounds, Places, Surface, Walk},
    },
    step::Running,
};

/// Distance that features keep from obstacles at least, m. Nearer, rounding decides which side they are on.
const LEAST: f32 = 0.0002;

/// A cloth on its way.
pub struct Approach<'a> {
    pub cloth: &'a Running<'a>,
    /// Its number among those that are stepped together.
    pub number: usize,
    /// Number of its first particle, and of all particles.
    pub first: u32,
    pub total: usize,
    pub ways: Ways<'a>,
    /// By how much particles may come off their ways, m.
    pub slack: f32,
    /// The part of the step that the search is for.
    pub span: Range<f32>,
    /// Duration of the step, s.
    pub dt: f32,
}

impl Approach<'_> {
    /// Poses of obstacle `i` now, and when the search ends.
    fn poses(&self, i: usize) -> [Isometry3d; 2] {
        self.cloth.scratch.bodies.poses_ahead(self.cloth.ctx, i, self.span.clone(), self.dt)
    }

    /// By how much the cloth and obstacle `i` may come off their ways together, m.
    fn slack(&self, i: usize) -> f32 {
        if self.cloth.ctx.obstacles[i].body.is_some() { 2.0 * self.slack } else { self.slack }
    }
}

/// A point of an obstacle.
#[derive(Clone, Copy, Debug)]
pub struct Fixed {
    /// Number of the cloth, and of the obstacle among those of that cloth.
    pub cloth: u32,
    pub obstacle: u32,
    pub point: u32,
}

/// What of cloths and obstacles may meet.
pub struct Meetings<'a> {
    pub fixed: &'a mut Vec<Fixed>,
    pub pairs: &'a mut Vec<Pair>,
    pub faces: &'a mut Faces,
}

/// What it takes to search at one obstacle after the other.
#[derive(Clone, Debug, Default)]
pub struct AtObstacle {
    /// The cloth in the obstacle's frame.
    position: Vec<Vec3A>,
    way: Vec<Vec3A>,
    places: Places,
    leaves: Vec<(u32, u32)>,
    found: Vec<Found>,
    /// The face that is nearest to each particle.
    nearest: Vec<NearestFace>,
    whereabouts: Vec<Whereabouts>,
    /// Number of each of the obstacle's points among all.
    number: Vec<u32>,
    deformed: Deformed,
    /// Sharp corners and the triangles of the cloth that they have come through.
    pierced: Vec<(u32, usize)>,
    /// Particles, of the cloth, and faces that they may meet.
    at_faces: Vec<(u32, u32)>,
    /// Outlines of the solids among each cloth's obstacles, with what they were drawn for.
    outlines: Vec<Vec<(Solid, Tightness, Outline)>>,
}

/// The face that is nearest to a particle.
#[derive(Clone, Copy, Debug)]
struct NearestFace {
    /// Distance, m.
    length: f32,
    /// From its nearest place to the particle, m.
    between: Vec3A,
    face: usize,
}

impl NearestFace {
    const NONE: Self = Self { length: f32::INFINITY, between: Vec3A::ZERO, face: 0 };

    /// Faces that are no steeper to each other than by this cosine go on from each other.
    const GOES_ON: f32 = 0.9;

    /// Whether the particle may come to touch another face before this one: it slides there, or comes from this one to that.
    fn leaves_way_to(&self, other: &Found, target: &Target) -> bool {
        if other.length > self.length + other.approach {
            return false;
        }
        if other.face == self.face
            || self.between.distance_squared(other.nearest.between) <= other.approach * other.approach
        {
            return true;
        }
        let [n, m] = [self.face, other.face].map(|face| target.normal(face));
        n.dot(m) < Self::GOES_ON * (n.length_squared() * m.length_squared()).sqrt()
    }
}

/// A mesh whose points move within its frame.
#[derive(Clone, Debug, Default)]
struct Deformed {
    points: Vec<Vec3A>,
    way: Vec<Vec3A>,
    places: Places,
    normals: PseudoNormals,
}

impl Deformed {
    /// Follows a mesh in the part `span` of a step.
    fn follow(&mut self, surface: &Surface, from: &[Vec3A], to: &[Vec3A], span: &Range<f32>, is_closed: bool) {
        self.points.clear();
        self.points.extend(from.iter().zip(to).map(|(&p, &q)| p.lerp(q, span.start)));
        self.way.clear();
        self.way.extend(from.iter().zip(to).map(|(&p, &q)| (q - p) * (span.end - span.start)));
        let ways = Ways { position: &self.points, way: &self.way };
        self.places.follow(surface, |triangle| ways.bounds(triangle), None::<fn(_) -> _>);
        if is_closed {
            self.normals.find(surface, &self.points);
        }
    }
}

/// An obstacle as the search sees it, in its own frame.
#[derive(Clone, Copy)]
struct Target<'a> {
    points: &'a [Vec3A],
    surface: &'a Surface,
    places: &'a Places,
    radii: &'a [f32],
    has_faces: bool,
    /// Those of a closed mesh.
    normals: Option<&'a PseudoNormals>,
    /// How far the points will come, where they move.
    way: Option<&'a [Vec3A]>,
}

impl Target<'_> {
    /// Normal of a face, as long as twice its area, m².
    fn normal(&self, face: usize) -> Vec3A {
        let [a, b, c] = self.corners(face);
        (b - a).cross(c - a)
    }

    fn corners(&self, face: usize) -> [Vec3A; 3] {
        self.surface.triangles[face].map(|i| self.points[i as usize])
    }

    /// How sharp its corners and edges have to be that the triangles of a cloth sink in too deep at them.
    fn sharper_than(&self, cloth: &Running) -> f32 {
        if self.has_faces { 2.0 * sink(cloth.ctx) / cloth.surface().longest_edge } else { 0.0 }
    }
}

impl AtObstacle {
    /// Whether triangles and edges of a cloth, number `number` of those that are stepped together, may meet anything that its
    /// particles don't.
    pub fn is_needed(&mut self, number: usize, cloth: &Running) -> bool {
        let mut is_needed = false;
        for (i, obstacle) in cloth.ctx.obstacles.iter().enumerate() {
            is_needed |= match &obstacle.shape {
                Shape::Solid(solid) => {
                    draw(&mut self.outlines, number, i, solid, tightness(obstacle, cloth.topology, cloth.ctx));
                    !self.outlines[number][i].2.points.is_empty()
                }
                Shape::Mesh(_) => true,
            };
        }
        is_needed
    }

    /// The outline that a point is of.
    pub fn outline(&self, fixed: &Fixed) -> &Outline {
        &self.outlines[fixed.cloth as usize][fixed.obstacle as usize].2
    }

    /// Adds what of a cloth and obstacle `i` of it may meet.
    pub fn search(&mut self, at: &Approach, i: usize, walk: &mut Walk, into: &mut Meetings) {
        let (cloth, obstacle) = (at.cloth, &at.cloth.ctx.obstacles[i]);
        let surface = cloth.surface();
        let distance = distance_to(obstacle, cloth.ctx);
        let Self {
            position,
            way,
            places,
            leaves,
            found,
            nearest,
            whereabouts,
            number,
            deformed,
            outlines,
            at_faces,
            pierced,
        } = self;
        let Some(target) = target(obstacle, &at.span, deformed, || &outlines[at.number][i].2) else { return };
        // In the obstacle's own frame it stays, and the cloth's way is that past it.
        let (poses, slack) = (at.poses(i), at.slack(i));
        let reached = distance + slack;
        let bounds = to_frame(at, poses, position, way).grown(reached);
        if !bounds.meets(&target.places.whole()) {
            return;
        }
        let ways = Ways { position, way };
        places.follow(surface, |triangle| ways.bounds(triangle).grown(reached), None::<fn(_) -> _>);
        let a = Side { surface, places, ways, first: at.first, sharper_than: 0.0, has_faces: true, radii: &[] };
        let b = Side {
            surface: target.surface,
            places: target.places,
            ways: Ways { position: target.points, way: target.way.unwrap_or(&[]) },
            first: 0,
            sharper_than: target.sharper_than(cloth),
            has_faces: false,
            radii: target.radii,
        };
        let friction = cloth.ctx.material.friction * obstacle.friction;
        let reach = Reach { distance, slack, friction, rest: None };
        found.clear();
        nearest.clear();
        nearest.resize(position.len(), NearestFace::NONE);
        if target.has_faces {
            find_at_faces(&a, &b, &reach, (walk, leaves), found, nearest);
        }
        find_at_edges(&a, &b, &reach, (walk, leaves), found, pierced);
        whereabouts.clear();
        if let Some(normals) = target.normals {
            whereabouts.resize(position.len(), Whereabouts::Unknown);
            for one in found.iter().filter(|one| one.is_of_face()) {
                let particle = (one.pair.points[0] - at.first) as usize;
                if one.length <= nearest[particle].length {
                    whereabouts[particle] = whereabouts_of(one, &target, normals);
                }
            }
            let whole = target.places.whole();
            for (place, whereabouts) in position.iter().zip(&mut *whereabouts) {
                if *whereabouts == Whereabouts::Unknown && !whole.meets(&Bounds::around([*place])) {
                    *whereabouts = Whereabouts::Outside;
                }
            }
            inside::find_out(whereabouts, position, surface, (target.surface, target.places, target.points));
        }
        let is_inside = |particle: u32| whereabouts.get(particle as usize) == Some(&Whereabouts::Inside);
        number.clear();
        number.resize(target.points.len(), u32::MAX);
        let Meetings { fixed, pairs, faces: into_faces } = into;
        let mut numbered = |point: u32| {
            let number = &mut number[point as usize];
            if *number == u32::MAX {
                *number = (at.total + fixed.len()) as u32;
                fixed.push(Fixed { cloth: at.number as u32, obstacle: i as u32, point });
            }
            *number
        };
        // What is thinner than an edge is caught by the triangles alone, however deep they are in it.
        let thin = target.radii.iter().copied().filter(|&radius| radius < 0.5 * surface.longest_edge);
        let thickness = thin.fold(0.0, f32::max);
        at_faces.clear();
        for one in &*found {
            let mut pair = one.pair;
            if one.is_of_face() {
                let particle = pair.points[0] - at.first;
                if nearest[particle as usize].leaves_way_to(one, &target) {
                    at_faces.push((particle, one.face as u32));
                }
                continue;
            }
            if let Shape::Solid(solid) = &obstacle.shape
                && !pierced.contains(&(pair.points[0], one.face))
                && depth_of(one, solid, position, at.first) > 2.0 * sink(cloth.ctx) + thickness
            {
                // Its particles find the way out.
                continue;
            }
            // The cloth's features come first but where a corner of the obstacle meets a face.
            let of_obstacle = if pair.features == Features::PointFace { 0..1 } else { 2..4 };
            let of_cloth = (0..4).filter(|k| !of_obstacle.contains(k));
            if of_cloth.into_iter().any(|k| is_inside(pair.points[k] - at.first)) {
                // It is on its way out.
                continue;
            }
            for k in of_obstacle {
                pair.points[k] = numbered(pair.points[k]);
            }
            pair.normal = poses[0].rotation * pair.normal;
            pairs.push(pair);
        }
        // Deep inside, nothing was near.
        for particle in (0..position.len() as u32).filter(|&particle| is_inside(particle)) {
            if nearest[particle as usize].length == f32::INFINITY && !cloth.is_fixed(particle) {
                let place = position[particle as usize];
                let near = inside::nearest(place, target.surface, target.places, target.points);
                at_faces.extend(near.map(|(face, _)| (particle, face as u32)));
            }
        }
        at_faces.sort_unstable();
        let is_closed = target.normals.is_some();
        for some in at_faces.chunk_by(|(particle, _), (other, _)| particle == other) {
            let first = into_faces.corners.len() as u32;
            into_faces
                .corners
                .extend(some.iter().map(|&(_, face)| target.surface.triangles[face as usize].map(&mut numbered)));
            let (particle, end) = (at.first + some[0].0, into_faces.corners.len() as u32);
            let corners = |&(_, face): &(u32, u32)| target.corners(face as usize);
            let is_convex = is_closed && faces::are_convex(some.iter().map(corners));
            into_faces.meetings.push(Meeting {
                particle,
                faces: [first, end],
                distance,
                friction,
                is_closed,
                is_convex,
            });
        }
    }
}

/// Distance that a cloth keeps from an obstacle, m.
fn distance_to(obstacle: &Obstacle, ctx: &StepContext) -> f32 {
    ctx.contact_distance().max(LEAST) + obstacle.rounding
}

/// How tightly a cloth lies on an obstacle.
pub fn tightness(obstacle: &Obstacle, topology: &Topology, ctx: &StepContext) -> Tightness {
    Tightness { edge: topology.surface().longest_edge, distance: distance_to(obstacle, ctx), sink: sink(ctx) }
}

/// Draws the outline of obstacle `i` of a cloth, where it isn't drawn yet for what the cloth `needs`.
fn draw(outlines: &mut Vec<Vec<(Solid, Tightness, Outline)>>, cloth: usize, i: usize, solid: &Solid, needs: Tightness) {
    if outlines.len() <= cloth {
        outlines.resize_with(cloth + 1, Vec::new);
    }
    let outlines = &mut outlines[cloth];
    if outlines.len() <= i {
        outlines.resize_with(i + 1, || {
            (*solid, Tightness { edge: f32::NAN, distance: 0.0, sink: 0.0 }, Outline::default())
        });
    }
    let (drawn, met, outline) = &mut outlines[i];
    if *drawn != *solid || *met != needs {
        (*drawn, *met, *outline) = (*solid, needs, Outline::of(solid, needs));
    }
}

/// An obstacle where it is when the part `span` of the step begins. None where nothing of it is sharp.
fn target<'a>(
    obstacle: &'a Obstacle,
    span: &Range<f32>,
    deformed: &'a mut Deformed,
    outline: impl FnOnce() -> &'a Outline,
) -> Option<Target<'a>> {
    match &obstacle.shape {
        Shape::Solid(_) => {
            let Outline { points, radii, surface, places } = outline();
            let target = Target { points, surface, places, radii, has_faces: false, normals: None, way: None };
            (!points.is_empty()).then_some(target)
        }
        Shape::Mesh(MeshShape { mesh, deformed: None }) => {
            let normals = mesh.is_closed.then_some(&mesh.normals);
            let (points, surface, places) = (&mesh.points, &mesh.surface, &mesh.places);
            Some(Target { points, surface, places, radii: &[], has_faces: true, normals, way: None })
        }
        Shape::Mesh(MeshShape { mesh, deformed: Some([from, to]) }) => {
            deformed.follow(&mesh.surface, from, to, span, mesh.is_closed);
            let Deformed { points, way, places, normals } = deformed;
            let normals = mesh.is_closed.then_some(&*normals);
            let surface = &mesh.surface;
            Some(Target { points, surface, places, radii: &[], has_faces: true, normals, way: Some(way) })
        }
    }
}

/// Takes the cloth's ways into the obstacle's frame, and returns the box around them.
fn to_frame(at: &Approach, poses: [Isometry3d; 2], position: &mut Vec<Vec3A>, way: &mut Vec<Vec3A>) -> Bounds {
    let [now, end] = poses.map(|pose| pose.inverse());
    position.clear();
    way.clear();
    let mut bounds = Bounds::NOTHING;
    for (&start, &far) in at.ways.position.iter().zip(at.ways.way) {
        let start = start - at.cloth.offset;
        let (from, to) = (now.transform_point(start), end.transform_point(start + far));
        position.push(from);
        way.push(to - from);
        bounds = bounds.union(Bounds { low: from.min(to), high: from.max(to) });
    }
    bounds
}

/// Finds pairs of particles and faces that are near, and how far each particle is from the nearest one.
fn find_at_faces(
    a: &Side,
    b: &Side,
    reach: &Reach,
    (walk, leaves): (&mut Walk, &mut Vec<(u32, u32)>),
    found: &mut Vec<Found>,
    nearest: &mut [NearestFace],
) {
    leaves.clear();
    walk.between((a.surface, a.places), (b.surface, b.places), |p, q| leaves.push((p, q)));
    for &(p, q) in &*leaves {
        search::points_at_faces((a, p), (b, q), reach, |one| {
            let nearest = &mut nearest[(one.pair.points[0] - a.first) as usize];
            if one.length < nearest.length {
                *nearest = NearestFace { length: one.length, between: one.nearest.between, face: one.face };
            }
            found.push(one);
        });
    }
}

/// Finds pairs of the cloth's faces and edges with what is sharp.
fn find_at_edges(
    a: &Side,
    b: &Side,
    reach: &Reach,
    (walk, leaves): (&mut Walk, &mut Vec<(u32, u32)>),
    found: &mut Vec<Found>,
    pierced: &mut Vec<(u32, usize)>,
) {
    leaves.clear();
    pierced.clear();
    walk.between_sharp((a.surface, a.places), (b.surface, b.places), b.sharper_than, |p, q| leaves.push((p, q)));
    for &(p, q) in &*leaves {
        for s in a.surface.of_leaf(p) {
            for t in b.surface.of_leaf(q) {
                if a.places.of_triangles[s].meets(&b.places.of_triangles[t]) {
                    search::pairs_between((a, s), (b, t), reach, |one| found.push(one));
                    pierced.extend(search::tips_through((a, s), (b, t)).map(|tip| (tip, s)));
                }
            }
        }
    }
    if pierced.is_empty() {
        return;
    }
    // Those are to go back.
    pierced.sort_unstable();
    pierced.dedup();
    found.retain(|one| one.is_first_of_a || !pierced.contains(&(one.pair.points[0], one.face)));
    found.extend(pierced.iter().map(|&(tip, face)| search::back_through((a, face), (b, tip), reach)));
}

/// How deep the cloth's place of a pair is inside of a solid, m.
fn depth_of(found: &Found, solid: &Solid, position: &[Vec3A], first: u32) -> f32 {
    let Found { pair, nearest, is_first_of_a, .. } = found;
    let of_cloth = if *is_first_of_a { 1.0 } else { -1.0 };
    let weights = nearest.weights.map(|weight| (weight * of_cloth).max(0.0));
    let places = pair.points.into_iter().zip(weights).filter(|&(_, weight)| weight > 0.0);
    let place = places.map(|(point, weight)| position[(point - first) as usize] * weight).sum();
    -solid.surface(place).distance
}

/// On which side of its nearest face a particle is, by the normal of the closest place.
fn whereabouts_of(found: &Found, target: &Target, normals: &PseudoNormals) -> Whereabouts {
    let triangle = target.surface.triangles[found.face];
    let weights = [1, 2, 3].map(|i| -found.nearest.weights[i]);
    let normal = normals.at(triangle, target.normal(found.face), weights);
    if found.nearest.between.dot(normal) < 0.0 { Whereabouts::Inside } else { Whereabouts::Outside }
}
