//! Particles out of obstacles, eight at a time.

use core::ops::Range;

use bevy_math::{Isometry3d, Quat, Vec3A};
use fearless_simd::{dispatch, f32x8, mask32x8, prelude::*};

use crate::{
    constraint::implicit::contact::PredictedContact,
    contact::{
        body::Bodies,
        broad_phase::{BroadPhase, CandidateRange, STRETCH},
        mesh::{self, MeshContacts},
        particle::{
            ccd::ObstacleSweep,
            frame::{MovingFrame, ObstacleFrame, RotatedFrame, TranslatedFrame},
            query::UniformField,
            response::{Dynamic, Kinematic, Response},
        },
    },
    input::StepContext,
    layout::{
        points::Block,
        simd::{LANES, Lane, SimdLevel, Vec3x8, lane},
    },
    particles::lanes::{Lanes, Run},
    shape::{Shape, Solid},
};

pub(crate) mod ccd;
pub(crate) mod frame;
pub(crate) mod query;
pub(crate) mod response;

pub(crate) use crate::contact::particle::query::DistanceQuery;

/// Projects all free particles out of all obstacles within the part `span` (0..=1) of the step, a substep of `h` seconds.
/// Returns the number of contacts.
pub(crate) fn project(
    lanes: &mut Lanes,
    around: (&mut BroadPhase, &mut [MeshContacts], &mut Bodies),
    ctx: &StepContext,
    span: Range<f32>,
    h: f32,
    simd_level: SimdLevel,
) -> u32 {
    pass_obstacles(lanes, around, ctx, span, h, None, simd_level)
}

/// Finds the particles that would come into obstacles within the part `span` of the step, a substep of `h` seconds: from where they
/// were before it to where they are, and a free fall farther. Moves nothing, and leaves out obstacles that are bodies: how far
/// these are pushed is not known yet.
pub(crate) fn predict(
    lanes: &mut Lanes,
    around: (&mut BroadPhase, &mut [MeshContacts], &mut Bodies),
    ctx: &StepContext,
    span: Range<f32>,
    h: f32,
    contacts: &mut Vec<PredictedContact>,
    simd_level: SimdLevel,
) {
    let prediction = Prediction { contacts, free_fall: ctx.gravity * (h * h) };
    pass_obstacles(lanes, around, ctx, span, h, Some(prediction), simd_level);
}

/// Where contacts are predicted, instead of projected.
struct Prediction<'a> {
    contacts: &'a mut Vec<PredictedContact>,
    /// Way of a free fall within the substep, m.
    free_fall: Vec3A,
}

/// Lets all particles pass all obstacles, whether their contacts are projected or predicted.
fn pass_obstacles(
    lanes: &mut Lanes,
    (near, known, bodies): (&mut BroadPhase, &mut [MeshContacts], &mut Bodies),
    ctx: &StepContext,
    span: Range<f32>,
    h: f32,
    mut prediction: Option<Prediction>,
    simd_level: SimdLevel,
) -> u32 {
    near.follow(lanes, ctx, span.clone(), bodies, simd_level);
    let mut run = lanes.whole();
    let mut contacts = 0;
    for number in 0..near.obstacles.len() {
        let obstacle = near.obstacles[number].obstacle;
        let it = &ctx.obstacles[obstacle];
        if prediction.is_some() && it.body.is_some() {
            continue;
        }
        let poses @ [start, end] = bodies.poses(ctx, obstacle, span.clone());
        let sweep = ObstacleSweep::new(it, poses, ctx, h);
        let stretches = near.stretches(number);
        let prediction = prediction
            .as_mut()
            .map(|Prediction { contacts, free_fall }| Prediction { contacts, free_fall: *free_fall });
        let mut past = ParticleProjector { sweep, prediction, obstacle, bodies, run: &mut run, stretches, simd_level };
        contacts += match &it.shape {
            Shape::Solid(solid) => {
                let mut solid = *solid;
                if start == end && it.body.is_none() {
                    (past.sweep, solid) = sweep.unturned(solid);
                }
                match solid {
                    Solid::Sphere(field) => past.go(&mut UniformField(field)),
                    Solid::Ellipsoid(field) => past.go(&mut UniformField(field)),
                    Solid::Cuboid(field) => past.go(&mut UniformField(field)),
                    Solid::Capsule(field) => past.go(&mut UniformField(field)),
                    Solid::TaperedCapsule(field) => past.go(&mut UniformField(field)),
                    Solid::Cylinder(field) => past.go(&mut UniformField(field)),
                    Solid::Cone(field) => past.go(&mut UniformField(field)),
                    Solid::HalfSpace(field) => past.go(&mut UniformField(field)),
                }
            }
            Shape::Mesh(mesh) => {
                past.sweep.distance = sweep.distance.max(mesh::LEAST + it.rounding);
                let (moving, sweep) = ((&*past.bodies, obstacle), past.sweep);
                let mut query = known[obstacle].query(mesh, ctx, moving, &sweep, span.clone(), past.run.position.len());
                past.go(&mut query)
            }
        };
    }
    contacts
}

/// Parts of a cloth that may come past an obstacle.
pub(crate) struct CandidateRanges<'a> {
    pub reachable: &'a [CandidateRange],
    /// How far each stretch has come off where it was, m.
    pub moved: &'a mut [f32],
    /// Where that was, m.
    pub start: &'a [Block],
    /// Pose of the obstacle then.
    pub pose: Isometry3d,
    /// The farthest from its origin that anything happens, m.
    pub far: f32,
}

/// A cloth on its way past an obstacle.
struct ParticleProjector<'a, 'b> {
    sweep: ObstacleSweep,
    prediction: Option<Prediction<'a>>,
    /// Number of the obstacle.
    obstacle: usize,
    bodies: &'a mut Bodies,
    run: &'a mut Run<'b>,
    stretches: CandidateRanges<'a>,
    simd_level: SimdLevel,
}

/// What touches a surface in a block.
pub(crate) struct Contacts8<S: Simd> {
    place: Vec3x8<S>,
    before: Vec3x8<S>,
    inverse_mass: f32x8<S>,
    /// Those that do.
    touches: mask32x8<S>,
    /// Outward normal of the surface.
    normal: Vec3x8<S>,
    /// How far each came to be behind the surface within the substep, m.
    penetration: f32x8<S>,
    /// How far each leaves of what it was inside before, m.
    parted: f32x8<S>,
    /// How far each goes back that was inside before and left faster than it may, m.
    clamped: f32x8<S>,
    /// Way past the surface, m.
    slide: Vec3x8<S>,
    /// Which lanes see another side of the shape than before.
    swept: u64,
    /// Those that are near the surface, on the same side of it as before.
    is_beside: mask32x8<S>,
    /// How deep each is behind it, m.
    depth: f32x8<S>,
    /// Way of the surface within the substep, m.
    surface_way: Vec3x8<S>,
}

impl ParticleProjector<'_, '_> {
    fn go(&mut self, query: &mut impl DistanceQuery) -> u32 {
        let level = self.simd_level.level();
        if self.bodies.get(self.obstacle).is_some() {
            dispatch!(level, simd => self.pass::<_, MovingFrame<_>, Dynamic, _>(simd, query))
        } else if self.sweep.moves() {
            dispatch!(level, simd => self.pass::<_, MovingFrame<_>, Kinematic, _>(simd, query))
        } else if self.sweep.end.rotation == Quat::IDENTITY {
            dispatch!(level, simd => self.pass::<_, TranslatedFrame<_>, Kinematic, _>(simd, query))
        } else {
            dispatch!(level, simd => self.pass::<_, RotatedFrame<_>, Kinematic, _>(simd, query))
        }
    }

    #[inline(always)]
    fn pass<S: Simd, C: ObstacleFrame<S>, H: Response, V: DistanceQuery>(&mut self, simd: S, query: &mut V) -> u32 {
        let mut frame = C::new(simd, &self.sweep);
        let zero = f32x8::splat(simd, 0.0);
        let (mut way, mut drift) = self.ways();
        let fall = self.prediction.as_ref().map_or(0.0, |prediction| prediction.free_fall.length());
        let mut contacts = 0;
        for reachable in self.stretches.reachable {
            let mut moved = self.stretches.moved[reachable.stretch];
            if reachable.clearance > moved + way + fall {
                continue;
            }
            let mut farthest = zero;
            let first = reachable.stretch * STRETCH;
            for block in first..(first + STRETCH).min(self.run.position.len()) {
                let local = frame.to_local(Vec3x8::load(simd, &self.run.position[block]));
                if !query.turn_to(simd, block, self.run, local) {
                    continue;
                }
                for _ in 0..query.passes() {
                    let Some(touching) = self.meet(simd, query, &frame, drift + fall, block) else { break };
                    if self.prediction.is_some() {
                        self.predict(simd, &touching, block);
                        break;
                    }
                    let Contacts8 { touches, mut swept, .. } = touching;
                    let known = contacts;
                    if touches.any_true() {
                        let (now, left) = H::resolve(simd, &touching, self.sweep.friction, self.bodies, self.obstacle);
                        now.store(&mut self.run.position[block]);
                        left.store(&mut self.run.previous[block]);
                        let off = now - Vec3x8::load(simd, &self.stretches.start[block]);
                        farthest = farthest.max(touches.select(off.dot(off), zero));
                        contacts += touches.to_bitmask().count_ones();
                    }
                    while swept != 0 {
                        let i = swept.trailing_zeros() as usize;
                        swept &= swept - 1;
                        if let Some(off) = self.sweep(query, block, i) {
                            moved = moved.max(off);
                            contacts += 1;
                        }
                    }
                    if contacts == known {
                        break;
                    }
                    if H::MOVES {
                        self.follow_body();
                        frame = C::new(simd, &self.sweep);
                        (way, drift) = self.ways();
                    }
                }
            }
            if self.prediction.is_some() {
                continue;
            }
            self.stretches.moved[reachable.stretch] = farthest.reduce_max().sqrt().max(moved);
        }
        contacts
    }

    /// Adds the contacts that are predicted in a block.
    #[inline(always)]
    fn predict<S: Simd>(&mut self, simd: S, touching: &Contacts8<S>, block: usize) {
        let Some(Prediction { contacts, free_fall }) = &mut self.prediction else { return };
        let Contacts8 { is_beside, depth, normal, surface_way, .. } = *touching;
        let fallen = depth - normal.dot(Vec3x8::splat(simd, free_fall.to_array()));
        let mut left = (is_beside & fallen.simd_gt(f32x8::splat(simd, 0.0))).to_bitmask();
        let lanes = |Vec3x8 { x, y, z }: Vec3x8<S>| -> [Lane; 3] { [x.into(), y.into(), z.into()] };
        let (normals, ways) = (lanes(normal), lanes(surface_way));
        while left != 0 {
            let i = left.trailing_zeros() as usize;
            left &= left - 1;
            let normal_and_way = [normals, ways].map(|lists| Vec3A::from(lists.map(|lanes| lanes[i])));
            let particle = (block * LANES + i) as u32;
            let inverse_mass = self.run.inverse_mass[block][i];
            contacts.push(PredictedContact::of_particle(particle, inverse_mass, normal_and_way, self.sweep.friction));
        }
    }

    /// Goes on from where the body has been pushed to.
    fn follow_body(&mut self) {
        if let Some(body) = self.bodies.get(self.obstacle) {
            self.sweep.end = body.end;
        }
    }

    /// How far the obstacle has come at most since it is known what is near, and within this substep, m.
    fn ways(&self) -> (f32, f32) {
        if !self.sweep.moves() && self.bodies.get(self.obstacle).is_none() {
            return (0.0, 0.0);
        }
        let (ObstacleSweep { start, end, .. }, CandidateRanges { pose, far, .. }) = (&self.sweep, &self.stretches);
        let since = |to: &Isometry3d| ccd::way_between(pose, to, *far);
        (since(start).max(since(end)), ccd::way_between(start, end, *far))
    }

    /// How a block meets the surface. None where it doesn't.
    #[inline(always)]
    fn meet<S: Simd, C: ObstacleFrame<S>>(
        &self,
        simd: S,
        query: &impl DistanceQuery,
        frame: &C,
        drift: f32,
        block: usize,
    ) -> Option<Contacts8<S>> {
        let ObstacleSweep { distance, parting, .. } = self.sweep;
        let zero = f32x8::splat(simd, 0.0);
        let place = Vec3x8::load(simd, &self.run.position[block]);
        let before = Vec3x8::load(simd, &self.run.previous[block]);
        let inverse_mass = lane(simd, &self.run.inverse_mass[block]);
        let local = frame.to_local(place);
        let after = query.sample(simd, local);
        // A particle that is farther away than it can have come this substep is left alone.
        let (depth, way) = (-after.distance + distance, place - before);
        let beyond = (-depth - drift).max(zero);
        let is_near = inverse_mass.simd_gt(zero) & (beyond * beyond).simd_le(way.dot(way));
        if is_near.all_false() {
            return None;
        }
        let old = query.seen_before(simd, frame.start_to_local(before));
        let after = query.keep_side(simd, old, after);
        let depth = -after.distance + distance;
        let sees_the_same = old.normal.dot(after.normal).simd_gt(zero);
        // What leaves by itself needs that much less of a push, and none that makes it too fast.
        let (was_inside, is_inside) = ((-old.distance + distance).max(zero), depth.max(zero));
        let old_depth = was_inside.min(is_inside);
        let left = was_inside - old_depth;
        let most = f32x8::splat(simd, parting);
        let is_deep = was_inside.simd_gt(most);
        let normal = frame.turned(after.normal);
        let past = frame.past(way, local + after.normal * depth) - frame.turned(query.own_way(simd, local));
        Some(Contacts8 {
            place,
            before,
            inverse_mass,
            touches: is_near & sees_the_same & (depth.simd_gt(zero) | is_deep),
            normal,
            penetration: is_inside - old_depth,
            parted: old_depth.min((most - left).max(zero)),
            clamped: is_deep.select((was_inside - depth - most).max(zero), zero),
            slide: past - normal * past.dot(normal),
            swept: (is_near & !sees_the_same).to_bitmask(),
            is_beside: is_near & sees_the_same,
            depth,
            surface_way: way - past,
        })
    }

    /// Takes one particle of a block, which may have come through the obstacle, back to where it came in. Says how far it is
    /// then from where its stretch was, m, if it was.
    #[cold]
    #[inline(never)]
    fn sweep(&mut self, query: &impl DistanceQuery, block: usize, i: usize) -> Option<f32> {
        let get = |[x, y, z]: &Block| Vec3A::new(x[i], y[i], z[i]);
        let (mut position, mut previous) = (get(&self.run.position[block]), get(&self.run.previous[block]));
        let correction = query.correction(i, &self.sweep, position, previous)?;
        let inverse_mass = self.run.inverse_mass[block][i];
        let friction = self.sweep.friction;
        response::one(&correction, [&mut position, &mut previous], inverse_mass, friction, self.bodies, self.obstacle);
        for (points, value) in [(&mut self.run.position[block], position), (&mut self.run.previous[block], previous)] {
            (points[0][i], points[1][i], points[2][i]) = value.into();
        }
        Some(position.distance(get(&self.stretches.start[block])))
    }
}
