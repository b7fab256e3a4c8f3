//! What is known of a cloth's step before its substeps begin: how many there are, and why.

use bevy_math::Vec3A;

use crate::{
    constraint::{attach::grab, implicit::ImplicitSheet},
    contact::{self, feature},
    explicit::{self, Stability},
    input::{ContactRisk, MAX_TIME_STEP, Method, Obstacle, StepContext},
    particles::Particles,
    scratch::Scratch,
    shape::sharp_features::Sharpness,
    step::report::SubstepReason,
    topology::{Topology, level::LevelPass},
};

/// Speed at which limbs sweep past a cloth from which on they count as any obstacle, m/s. Legs that run in it go to and fro, and are far
/// below that; a body that jumps up or lands isn't.
const SWEPT: f32 = 0.5;

/// What is known of a cloth's step before its substeps begin.
pub(super) struct Plan<'a> {
    pub dt: f32,
    pub is_near: bool,
    /// Length that the longest edge is taken to have at obstacles, m.
    pub longest_edge: f32,
    pub levels: &'a [LevelPass],
    pub substeps: u32,
    pub reason: SubstepReason,
    pub stability: Stability,
}

impl<'a> Plan<'a> {
    /// None where there is nothing to do.
    pub fn new(
        particles: &Particles,
        topology: &Topology,
        ctx: &'a StepContext<'a>,
        scratch: &mut Scratch,
    ) -> Option<Self> {
        let dt = ctx.dt.min(MAX_TIME_STEP);
        scratch.bodies.begin(ctx);
        if particles.is_empty() || ctx.dt.is_nan() || ctx.dt <= 0.0 {
            return None;
        }
        let near = contact::near_obstacles(particles, ctx);
        let is_near = near.clone().next().is_some();
        // Nothing else asks for it: a cloth that nothing is near needs no surface.
        let longest_edge = if is_near { feature::longest_edge(near.clone(), particles, topology, ctx) } else { 0.0 };
        let is_implicit = ImplicitSheet::is_for(topology, ctx);
        let is_tethered = is_implicit || ctx.tethers.is_some_and(|tethers| !tethers.is_empty());
        let is_on_body = !ctx.attached_pins.is_empty();
        let lesser_risks = [
            (is_near, SubstepReason::Obstacle),
            (is_on_body, SubstepReason::OnBody),
            (!ctx.grabs.is_empty(), SubstepReason::Grabbed),
            (!is_tethered, SubstepReason::Untethered),
        ];
        let some = lesser_risks.into_iter().find_map(|(is_there, reason)| is_there.then_some(reason));
        let are_others_held = is_on_body || !ctx.grabs.is_empty() || !is_tethered;
        let are_limbs = !is_implicit
            && !are_others_held
            && near.clone().all(|obstacle| obstacle.is_rough)
            && sweep(near.clone(), particles, dt) < SWEPT * dt;
        let is_solved_along = |obstacle: &Obstacle| is_implicit && obstacle.body.is_none();
        let sharpest = |is_solved: bool| {
            let some = near.clone().filter(|obstacle| is_solved_along(obstacle) == is_solved);
            feature::sharpest(some, particles, topology, longest_edge, ctx, dt)
        };
        let risk = match (sharpest(false), ctx.settings.self_collision) {
            (Some((Sharpness::Tip, wanted)), _) => ContactRisk::Tip(wanted),
            (Some((Sharpness::Edge, wanted)), _) => ContactRisk::Edge(wanted),
            (None, true) => ContactRisk::SelfCollision,
            (None, _) if some == Some(SubstepReason::Obstacle) && are_limbs => ContactRisk::Limbs,
            (None, _) if some.is_some() => ContactRisk::Some,
            (None, _) => ContactRisk::None,
        };
        let policy = &ctx.settings.substep_policy;
        let of_risk = |risk| (risk, policy.of_step(risk, dt));
        let solved_along = sharpest(true).map(|sharp| match sharp {
            (Sharpness::Edge, wanted) => of_risk(ContactRisk::EdgeSolvedAlong(wanted)),
            (Sharpness::Tip, wanted) => of_risk(ContactRisk::TipSolvedAlong(wanted)),
        });
        let others = of_risk(risk);
        let more = solved_along.filter(|(_, (substeps, _))| *substeps > others.1.0);
        let (risk, (wanted, levels)) = more.unwrap_or(others);
        let (without_risk, _) = policy.of_step(ContactRisk::None, dt);
        let limit = ctx.substep_limit.max(1);
        let reason = match ctx.settings.method {
            Method::Explicit => SubstepReason::Stability,
            Method::Strands | Method::Xpbd if limit < wanted => SubstepReason::Budget,
            Method::Strands | Method::Xpbd if !policy.follows_time_step => SubstepReason::Fixed,
            Method::Strands | Method::Xpbd if wanted == without_risk => SubstepReason::Strain,
            Method::Strands | Method::Xpbd => SubstepReason::of_risk(risk, some.unwrap_or_default()),
        };
        // Levels move what hangs on a body without its weight on the body.
        let levels = if is_on_body || is_implicit { &[] } else { levels };
        let (most, stability, levels) = match ctx.settings.method {
            Method::Strands => (limit, Stability::unconditional(wanted), levels),
            Method::Xpbd => (limit, Stability::unconditional(wanted), &[][..]),
            Method::Explicit => {
                scratch.lanes.load(particles, topology.order(), scratch.simd_level);
                grab::take_up(&mut scratch.lanes, ctx.grabs);
                scratch.body_attachments.begin(&mut scratch.lanes, topology, ctx);
                let stability = explicit::stability(&scratch.lanes, topology, ctx, dt, &mut scratch.spring_sums);
                (ctx.settings.max_substeps.max(1), stability, &[][..])
            }
        };
        let substeps = stability.needed.min(most);
        Some(Self { dt, is_near, longest_edge, levels, substeps, reason, stability })
    }
}

/// How far what is `near` goes past the free particles of a cloth within a step of `dt` seconds, on the whole, m.
fn sweep<'a>(near: impl Iterator<Item = &'a Obstacle>, particles: &Particles, dt: f32) -> f32 {
    let ways = near.map(|obstacle| obstacle.end.translation - obstacle.start.translation);
    let free = particles.velocity.iter().zip(&particles.inverse_mass).filter(|(_, w)| **w > 0.0);
    let own = mean(free.map(|(velocity, _)| *velocity * dt));
    mean(ways).distance(own)
}

fn mean(ways: impl Iterator<Item = Vec3A>) -> Vec3A {
    let (sum, count) = ways.fold((Vec3A::ZERO, 0.0), |(sum, count), way| (sum + way, count + 1.0));
    sum / f32::max(count, 1.0)
}
