//! The loop over the substeps.

use bevy_math::Vec3A;

use crate::{
    constraint::implicit::{
        between::ContactsBetween,
        system::{self, SheetSystem},
    },
    contact::feature::FeatureContacts,
    input::{MAX_TIME_STEP, StepContext},
    particles::Particles,
    scratch::Scratch,
    step::{plan::Plan, report::StepReport, running::Running, substep::Substep},
    topology::Topology,
};

mod plan;
pub(crate) mod report;
mod running;
mod substep;

/// Advances one cloth by `ctx.dt`.
///
/// One substep of duration h integrates the velocities (symplectic Euler), moves the fixed particles, solves the
/// constraints and projects the particles out of the obstacles. Small substeps with one iteration each follow
/// Macklin et al., "Small Steps in Physics Simulation" (2019).
///
/// Nothing is allocated once `scratch` has seen a cloth of this size, but for what threads need that share one. The same
/// input gives the same bits. A time step that isn't positive does nothing.
pub fn step(particles: &mut Particles, topology: &Topology, ctx: &StepContext, scratch: &mut Scratch) -> StepReport {
    let mut touch = core::mem::take(&mut scratch.touch);
    let report = match Plan::new(particles, topology, ctx, scratch) {
        None => StepReport::NOTHING,
        Some(plan) => {
            let substeps = plan.substeps;
            let mut running = [Running::begin(plan, particles, topology, ctx, scratch, substeps, Vec3A::ZERO)];
            run(&mut running, substeps, &mut touch);
            let [running] = running;
            running.end()
        }
    };
    scratch.touch = touch;
    report
}

/// One of several cloths that are stepped together.
#[derive(Debug)]
pub struct Member<'a> {
    /// Its state.
    pub particles: &'a mut Particles,
    /// What is connected to what.
    pub topology: &'a Topology,
    /// What surrounds it. All members have the same time step.
    pub ctx: &'a StepContext<'a>,
    /// Working memory, of each member its own.
    pub scratch: &'a mut Scratch,
    /// Its origin from that of the first member, m.
    pub offset: Vec3A,
    /// What the step did, afterwards.
    pub report: Option<StepReport>,
}

/// Advances cloths that may touch each other, substep by substep, by the time step that they share.
///
/// Those whose [`self_collision`](crate::StepSettings::self_collision) isn't off meet each other. All take as many substeps as the
/// one that needs most.
pub fn step_together(members: &mut [Member]) {
    let Some(first) = members.first_mut() else { return };
    let mut touch = core::mem::take(&mut first.scratch.touch);
    let plans: Vec<Option<Plan>> = members
        .iter_mut()
        .map(|Member { particles, topology, ctx, scratch, .. }| Plan::new(particles, topology, ctx, scratch))
        .collect();
    let substeps = plans.iter().flatten().map(|plan| plan.substeps).max().unwrap_or(0);
    let mut numbers = Vec::new();
    let mut running = Vec::new();
    for (number, (member, plan)) in members.iter_mut().zip(plans).enumerate() {
        member.report = Some(StepReport::NOTHING);
        let Some(plan) = plan else { continue };
        let Member { particles, topology, ctx, scratch, offset, .. } = member;
        running.push(Running::begin(plan, particles, topology, ctx, scratch, substeps, *offset));
        numbers.push(number);
    }
    run(&mut running, substeps, &mut touch);
    let reports: Vec<StepReport> = running.into_iter().map(Running::end).collect();
    for (number, report) in numbers.into_iter().zip(reports) {
        members[number].report = Some(report);
    }
    if let Some(first) = members.first_mut() {
        first.scratch.touch = touch;
    }
}

/// The substeps of cloths that may touch each other.
fn run(cloths: &mut [Running], substeps: u32, touch: &mut FeatureContacts) {
    let may_touch = touch.begin(cloths);
    for i in 0..substeps {
        let span = i as f32 / substeps as f32..(i + 1) as f32 / substeps as f32;
        for cloth in &mut *cloths {
            cloth.predict(i, span.clone());
        }
        let first = cloths.first().map(|cloth| cloth.substep).filter(|_| may_touch);
        if let Some(Substep { h, ctx, .. }) = first {
            touch.predict(cloths, span.clone(), h, ctx.dt.min(MAX_TIME_STEP));
        }
        for cloth in &mut *cloths {
            cloth.solve(span.clone());
        }
        solve_sheets(cloths, touch.between_mut());
        cloths.iter_mut().for_each(|cloth| cloth.settle(span.clone()));
        let comes_after_obstacles = touch.comes_after_obstacles();
        if comes_after_obstacles {
            cloths.iter_mut().for_each(|cloth| cloth.project(span.clone()));
        }
        let mut has_moved = false;
        if let Some(Substep { h, ctx, .. }) = first {
            let solved = touch.solve(cloths, span.clone(), h, ctx.dt.min(MAX_TIME_STEP));
            has_moved = solved.has_moved;
            // Whose they are isn't known: they count once.
            cloths[0].touched = solved.touched;
        }
        for cloth in &mut *cloths {
            if has_moved || !comes_after_obstacles {
                cloth.project(span.clone());
            }
            cloth.finish(span.clone());
        }
    }
    touch.keep_loads(cloths);
}

/// The implicit steps: sheets that touch each other are solved as one system, and each other by itself.
fn solve_sheets(cloths: &mut [Running], between: &mut ContactsBetween) {
    let is_together = |number: u32| between.predicted.iter().any(|contact| contact.sheets.contains(&number));
    for (number, cloth) in (0..).zip(&mut *cloths) {
        if !is_together(number) {
            let alone = cloth.system(number);
            alone.into_iter().for_each(|alone| system::solve(&mut [alone], &mut ContactsBetween::default()));
        }
    }
    if !between.predicted.is_empty() {
        let systems = (0..).zip(cloths).filter(|(number, _)| is_together(*number));
        let mut systems: Vec<SheetSystem> = systems.filter_map(|(number, cloth)| cloth.system(number)).collect();
        system::solve(&mut systems, between);
    }
}
