//! Sheets on any triangle mesh: one linearised implicit Euler step a substep.
//!
//! Positions x' at the end of a substep of h seconds minimise, with y = x + h v + h² g where they would be by themselves,
//!
//! |x' - y|²/2 in the masses M  +  h² (energy of stretch and bending, less the work of other loads)
//!
//! (Baraff and Witkin, "Large Steps in Cloth Simulation", 1998; in this form Martin et al., "Example-Based Elastic Materials",
//! 2011). The energy is taken to second order at x + h v, so that cloth at rest is taken as it lies: a free fall of a substep
//! would strain it at its pins. That leaves a linear system for d = x' - y, with K the second derivatives,
//!
//! (M + h² K) d = h² (loads - gradient - h² K g)
//!
//! Where cloth is pressed together, the second derivatives have a negative part, which would make the system indefinite. K leaves
//! it out: of what turning a triangle costs, it has only the part of its tension.
//!
//! **Energy.** Two iterations of conjugate gradients leave an error, and one that starts from y can feed motion: a stiff wave
//! that the substep has set in motion is turned back by more than its share, and agitates the cloth for ever. So the way y - x
//! of the substep itself is the first direction to search along. The way x' - x of the whole substep then is in the space that
//! is searched, and Galerkin's condition for it says, where K is constant,
//!
//! kinetic energy' + elastic energy' = the same before + work of gravity and loads - |v' - v|²/2 in M - h² v'ᵀ K v'/2
//!
//! however few iterations there are, and whatever the preconditioner: it has to be positive definite only. The same holds where
//! y is without a part of the free fall, and the right-hand side has that part of the weight instead; which it is
//! [where the cloth is held](HELD). There, cloth at rest has a right-hand side of zero, and stays.
//!
//! Where touches have just stopped a few particles, y - x strains the cloth around them, and is stiff. A direction has one number
//! for all particles: along this one, the first step would stop the whole sheet. So where cloth meets cloth, which touches in many
//! places, it is the [last direction](system::ROUGH) instead: x' - x, after the iterations have smoothed it, which serves Galerkin's
//! condition as well. On obstacles alone the sheet is calmer if it is the first.
//!
//! **Preconditioner.** The [matrix of one number a particle](crate::topology::two_grid), as stiff in all directions as the cloth
//! is along its stiffest, through its coarse grid and its diagonal; and the [rigid motions](rigid) of each connected component,
//! which that takes for strain.

use bevy_math::Vec3A;
use fearless_simd::{Level, Simd, dispatch};

use crate::{
    constraint::{
        implicit::{
            contact::ImplicitContacts, direction::Direction, edge::EdgeTangent, face::FaceTangent,
            preconditioner::Preconditioner, vectors::Masses,
        },
        strand::law::DirectionModuli,
        unstructured::bend::{
            BendLaw,
            element8::{BendFrames, frames_of_pack, multiply_pack, pull_pack},
        },
    },
    input::{AttachedPin, Method, StepContext},
    layout::points::Points,
    linear::sparse_rows::SparseRows,
    material::Moduli,
    particles::{gathered::GatheredParticles, lanes::Lanes},
    topology::{
        Topology,
        two_grid::{Stiffness, TwoGrid},
    },
};

pub(crate) mod between;
pub(crate) mod contact;
mod direction;
mod edge;
mod face;
mod preconditioner;
mod rigid;
pub(crate) mod system;
mod vectors;

/// Iterations of conjugate gradients in a substep.
const ITERATIONS: usize = 2;

/// Cloth counts as held where its stress undoes this much, or more, of the way y - x: one over it, no unit.
///
/// Where it swings, its free fall is best a part of that way: after half a second it lags 3 cm instead of 5 cm. Where it hangs,
/// undoing the fall would undo its motion too, and it would creep for minutes. The line between them is wide: 4 creeps.
const HELD: f32 = 16.0;

/// A sheet that is solved by implicit steps, and what its substeps have in common.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ImplicitSheet<'a> {
    topology: &'a Topology,
    two_grid: &'a TwoGrid,
    moduli: &'a Moduli,
    laws: [DirectionModuli; 2],
    bend: Option<BendLaw>,
    /// Duration of a substep, s.
    h: f32,
    /// Whether it may touch itself or other cloth.
    meets_cloth: bool,
    /// Longest way that the cloth takes a particle in a substep, m: where numbers end, so does the cloth's motion.
    farthest: f32,
}

/// Working memory of the implicit solver.
#[derive(Clone, Debug, Default)]
pub(crate) struct ImplicitBuffers {
    masses: Masses,
    preconditioner: Preconditioner,
    faces: Vec<FaceTangent>,
    edges: Vec<EdgeTangent>,
    /// What touches obstacles.
    pub contacts: ImplicitContacts,
    /// Particles that are part of a body.
    attached: Vec<u32>,
    /// Frames of packs of bends, where they need them.
    frames: Vec<BendFrames>,
    /// Packs of faces, and of bends, of which some corner doesn't fall with the cloth.
    held_faces: Vec<u32>,
    held_bends: Vec<u32>,
    /// The way h² g of a free fall, m.
    free_fall: Vec3A,
    /// The same of particles that fall in a component that something holds, and h² K times it, kg m.
    fall: Direction,
    /// The way y - x of free particles, m.
    inertia: Direction,
    /// The latest direction of search, m.
    latest: Direction,
    /// The residual, kg m, and the preconditioner times it, m.
    residual: Vec<[f32; 4]>,
    preconditioned: Vec<[f32; 4]>,
    /// h² times the gradient of the energy, and then times the loads, kg m.
    gradient: Vec<[f32; 4]>,
    /// d, m.
    correction: Vec<[f32; 4]>,
}

impl ImplicitBuffers {
    fn fit(&mut self, count: usize) {
        let Self { fall, inertia, latest, residual, preconditioned, gradient, correction, .. } = self;
        for Direction { way, product, .. } in [fall, inertia, latest] {
            way.resize(count, [0.0; 4]);
            product.resize(count, [0.0; 4]);
        }
        for list in [residual, preconditioned, gradient, correction] {
            list.resize(count, [0.0; 4]);
        }
    }
}

impl<'a> ImplicitSheet<'a> {
    /// Whether this is how a step is solved: the sheet has moduli, and its mesh no rows and columns.
    pub fn is_for(topology: &Topology, ctx: &StepContext) -> bool {
        ctx.settings.method != Method::Explicit && ctx.material.moduli().is_some() && topology.two_grid.is_some()
    }

    /// The sheet of a step, if this is how it is solved.
    pub fn new(topology: &'a Topology, ctx: &'a StepContext, h: f32) -> Option<Self> {
        let (moduli, two_grid) = ctx.material.moduli().zip(topology.two_grid.as_ref())?;
        Self::is_for(topology, ctx).then(|| Self {
            topology,
            two_grid,
            moduli,
            laws: DirectionModuli::both(moduli, h),
            bend: BendLaw::new(topology, &ctx.material, h),
            h,
            meets_cloth: ctx.settings.self_collision,
            farthest: FARTHEST * ctx.settings.max_velocity * h,
        })
    }

    /// Prepares for the substeps of a step: masses, and the factor of the coarse matrix.
    pub fn prepare(&self, lanes: &Lanes, ctx: &StepContext, buffers: &mut ImplicitBuffers) {
        // One more: nobody. An even number: two to a register of eight.
        buffers.fit((lanes.order.particle_count() + 1).next_multiple_of(2));
        buffers.masses.read(lanes, self.topology, ctx.material.density);
        let [stretch, bend] = stiffness(self.moduli, self.h);
        buffers.preconditioner.prepare(self.two_grid, &buffers.masses, ctx.material.density, stretch, bend);
        let attached = |pin: &AttachedPin| ctx.pin_motions[pin.pin_motion as usize].particle;
        buffers.attached.clear();
        buffers.attached.extend(ctx.attached_pins.iter().map(attached));
        buffers.free_fall = ctx.gravity * (self.h * self.h);
        let ImplicitBuffers { masses, preconditioner, attached, .. } = &mut *buffers;
        preconditioner.rigid.prepare(self.two_grid, masses.held.iter().chain(&*attached).copied());
        self.let_fall(buffers);
    }

    /// Finds how components that something holds fall, and what doesn't fall along with them.
    fn let_fall(&self, buffers: &mut ImplicitBuffers) {
        let ImplicitBuffers { masses, preconditioner, held_faces, held_bends, fall, free_fall, attached, .. } = buffers;
        let [x, y, z] = free_fall.to_array();
        for (i, (way, mass)) in fall.way.iter_mut().zip(&masses.mass).enumerate() {
            *way = if mass[0] > 0.0 && !preconditioner.rigid.is_free(self.two_grid, i) {
                [x, y, z, 0.0]
            } else {
                [0.0; 4]
            };
        }
        // What is part of a body falls with it.
        attached.iter().for_each(|&particle| fall.way[particle as usize] = [0.0; 4]);
        let nobody = self.topology.particle_count() as u32;
        let is_still = |particle: u32| fall.way[particle as usize] == [0.0; 4];
        let is_held = |particles: &[u32]| {
            let of_held = |&&particle: &&u32| {
                particle < nobody && !preconditioner.rigid.is_free(self.two_grid, particle as usize)
            };
            particles.iter().filter(of_held).any(|&particle| is_still(particle))
        };
        let Topology { face_packs, bend_packs, .. } = self.topology;
        held_faces.clear();
        held_faces.extend(numbered(face_packs, |pack| is_held(pack.particles.as_flattened())));
        held_bends.clear();
        held_bends.extend(numbered(bend_packs, |pack| is_held(pack.particles.as_flattened())));
    }

    /// Linearises the contacts with obstacles and within the sheet, and ends the ways into them.
    fn linearise_contacts(&self, gathered: &mut GatheredParticles, buffers: &mut ImplicitBuffers) {
        let GatheredParticles { now, before } = gathered;
        let ImplicitBuffers { masses, free_fall, contacts, .. } = buffers;
        contacts.linearise(now, before, masses, &self.topology.areas, *free_fall, self.h);
    }

    /// Linearises the sheet where its particles would be by themselves. Some of them are `touching` other sheets.
    fn linearise(
        &self,
        level: Level,
        touching: impl Iterator<Item = u32>,
        gathered: &mut GatheredParticles,
        buffers: &mut ImplicitBuffers,
    ) {
        let GatheredParticles { now, before } = gathered;
        let ImplicitBuffers { preconditioner, contacts, .. } = &mut *buffers;
        if preconditioner.rigid.hold_components(self.two_grid, contacts.touching().chain(touching)) {
            self.let_fall(buffers);
        }
        let ImplicitBuffers { masses, preconditioner, free_fall, fall, inertia, .. } = &mut *buffers;
        let rigid = &mut preconditioner.rigid;
        // Who falls together isn't strained.
        if rigid.has(false) {
            for (i, place) in now.iter_mut().enumerate().take(self.topology.particle_count()) {
                if rigid.is_free(self.two_grid, i) {
                    place.iter_mut().zip(free_fall.to_array()).for_each(|(place, way)| *place += way);
                }
            }
        }
        dispatch!(level, simd => vectors::inertia(simd, now, before, &fall.way, masses, &mut inertia.way));
        rigid.begin(self.two_grid, now, masses);
        rigid.remove_free(self.two_grid, masses, &mut inertia.way);
        self.linearise_energy(level, now, before, buffers);
        let ImplicitBuffers { preconditioner, faces, held_faces, contacts, .. } = &mut *buffers;
        let held = held_faces.iter().map(|&i| (&self.topology.face_packs[i as usize], &faces[i as usize]));
        preconditioner.rigid.hold(self.two_grid, now, held, face::coupling(self.laws[0]), contacts.resistances(now));
    }

    /// Begins the search: with the residual, and the inertia without what has to be undone of the fall.
    fn begin_search(&self, level: Level, force: Option<&Points>, is_touching: bool, buffers: &mut ImplicitBuffers) {
        let ImplicitBuffers { masses, preconditioner, fall, inertia, residual, gradient, correction, contacts, .. } =
            buffers;
        // Begins with the fall: the masses times it are the gravity that is left to be done.
        correction.clone_from(&fall.way);
        dispatch!(level, simd => vectors::residual(simd, [gradient, &fall.product], masses, residual));
        if let Some(force) = force {
            // The cloth's own stress moves no free component: what rounding leaves of it mustn't either.
            vectors::scaled(force, self.h * self.h, masses, gradient);
            preconditioner.rigid.carry_free(self.two_grid, masses, [correction, gradient]);
            dispatch!(level, simd => vectors::add_part(simd, 1.0, gradient, residual));
        }
        dispatch!(level, simd => vectors::add_masses(simd, masses, &fall.way, &mut fall.product));
        // What is held doesn't fall: if that had to be undone along the same direction, it would take the motion with it. A few
        // particles that touch something are stiff enough for that, where all others swing.
        let is_touching = is_touching || !contacts.is_empty();
        let held = if is_touching { 1.0 } else { (-HELD * inertia.step(level, residual)).clamp(0.0, 1.0) };
        let fallen = [&fall.way[..], &fall.product[..]];
        dispatch!(level, simd => vectors::advance(simd, -held, fallen, [correction, residual]));
        dispatch!(level, simd => vectors::add_part(simd, -held, &fall.way, &mut inertia.way));
        dispatch!(level, simd => vectors::add_part(simd, -held, &fall.product, &mut inertia.product));
    }

    /// Makes a way of the residual.
    fn precondition(&self, level: Level, buffers: &mut ImplicitBuffers) {
        let ImplicitBuffers { masses, preconditioner, residual, preconditioned, contacts, .. } = buffers;
        dispatch!(level, simd => preconditioner.apply(simd, self.two_grid, masses, contacts, residual, preconditioned));
    }

    /// Moves the particles by the correction, and ends the contacts.
    fn move_particles(&self, gathered: &mut GatheredParticles, buffers: &mut ImplicitBuffers) {
        let GatheredParticles { now, before } = gathered;
        let ImplicitBuffers { masses, contacts, correction, residual, .. } = buffers;
        vectors::go(correction, self.farthest, now);
        contacts.finish(before, [correction, residual], masses, self.h, now);
    }

    /// The gradient of the energy at x + h v, what its second derivatives are made of, and their products with the way y - x and
    /// with the fall.
    fn linearise_energy(&self, level: Level, now: &[[f32; 4]], before: &[[f32; 4]], buffers: &mut ImplicitBuffers) {
        let Self { topology, laws, .. } = self;
        let ImplicitBuffers {
            masses,
            faces,
            edges,
            frames,
            held_faces,
            held_bends,
            fall,
            inertia,
            gradient,
            contacts,
            ..
        } = buffers;
        gradient.fill([0.0; 4]);
        inertia.product.fill([0.0; 4]);
        fall.product.fill([0.0; 4]);
        faces.clear();
        let sums = face::Sums { gradient, product: &mut inertia.product };
        let (packs, places) = (&topology.face_packs, face::Places { now, before, inertia: &inertia.way });
        if laws[0].damping > 0.0 {
            dispatch!(level, simd => face::linearise::<_, true>(simd, packs, laws, places, sums, faces));
        } else {
            dispatch!(level, simd => face::linearise::<_, false>(simd, packs, laws, places, sums, faces));
        }
        for &i in &*held_faces {
            let (packs, faces) = (&packs[i as usize..][..1], &faces[i as usize..][..1]);
            dispatch!(level, simd => face::multiply(simd, packs, faces, laws[0], &fall.way, &mut fall.product));
        }
        edges.clear();
        edges.extend(edge::carrying(topology).map(|spring| EdgeTangent::new(spring, laws, now, before)));
        for tangent in &*edges {
            tangent.pull(gradient);
            tangent.multiply(&inertia.way, &mut inertia.product);
            tangent.multiply(&fall.way, &mut fall.product);
        }
        contacts.pull(now, before, gradient);
        contacts.multiply(&inertia.way, &mut inertia.product);
        contacts.multiply(&fall.way, &mut fall.product);
        if let Some(law) = self.bend {
            dispatch!(level, simd => self.pull_bends(simd, law, now, before, gradient, frames));
            dispatch!(level, simd => self.multiply_bends(simd, law, None, frames, inertia));
            dispatch!(level, simd => self.multiply_bends(simd, law, Some(held_bends), frames, fall));
        }
        dispatch!(level, simd => vectors::add_masses(simd, masses, &inertia.way, &mut inertia.product));
    }

    /// The matrix times the latest direction.
    fn multiply(&self, level: Level, buffers: &mut ImplicitBuffers) {
        let ImplicitBuffers { masses, faces, edges, frames, latest, contacts, .. } = buffers;
        latest.product.fill([0.0; 4]);
        contacts.multiply(&latest.way, &mut latest.product);
        let packs = &self.topology.face_packs;
        dispatch!(level, simd => face::multiply(simd, packs, faces, self.laws[0], &latest.way, &mut latest.product));
        edges.iter().for_each(|tangent| tangent.multiply(&latest.way, &mut latest.product));
        if let Some(law) = self.bend {
            dispatch!(level, simd => self.multiply_bends(simd, law, None, frames, latest));
        }
        dispatch!(level, simd => vectors::add_masses(simd, masses, &latest.way, &mut latest.product));
    }

    /// The matrix of all bends, where it is constant: they have no frames, and are as they were built.
    fn bend_matrix(&self, law: BendLaw) -> Option<&SparseRows<Stiffness>> {
        (!law.framed && !self.two_grid.is_stretched).then_some(&self.two_grid.fine)
    }

    #[inline(always)]
    fn pull_bends<S: Simd>(
        &self,
        simd: S,
        law: BendLaw,
        now: &[[f32; 4]],
        before: &[[f32; 4]],
        gradient: &mut [[f32; 4]],
        frames: &mut Vec<BendFrames>,
    ) {
        frames.clear();
        if let Some(matrix) = self.bend_matrix(law) {
            return vectors::multiply_bends(simd, matrix, law.k, now, gradient);
        }
        for pack in &self.topology.bend_packs {
            if law.framed {
                pull_pack::<_, true>(simd, now, before, gradient, pack, law);
                frames.push(frames_of_pack(simd, now, pack));
            } else {
                pull_pack::<_, false>(simd, now, before, gradient, pack, law);
            }
        }
    }

    /// Adds the second derivatives of the bends' energy times a direction: of all bends, or of some packs.
    #[inline(always)]
    fn multiply_bends<S: Simd>(
        &self,
        simd: S,
        law: BendLaw,
        packs: Option<&[u32]>,
        frames: &[BendFrames],
        direction: &mut Direction,
    ) {
        let Direction { way, product, .. } = direction;
        let all = &self.topology.bend_packs;
        match (packs, self.bend_matrix(law)) {
            (Some(packs), _) => {
                for &i in packs {
                    multiply_pack(simd, frames.get(i as usize), way, product, &all[i as usize], law);
                }
            }
            (None, Some(matrix)) => vectors::multiply_bends(simd, matrix, law.k, way, product),
            (None, None) => {
                for (i, pack) in all.iter().enumerate() {
                    multiply_pack(simd, frames.get(i), way, product, pack, law);
                }
            }
        }
    }
}

/// Numbers of the items that `is_one`.
fn numbered<T>(items: &[T], is_one: impl Fn(&T) -> bool) -> impl Iterator<Item = u32> {
    (0..).zip(items).filter(move |(_, item)| is_one(item)).map(|(i, _)| i)
}

/// How many times as fast as particles may be the cloth may take them along.
const FARTHEST: f32 = 10.0;

/// Strain for which the preconditioner is made, no unit: cloth that stiffens is that stiff where it hangs by few points.
const WORKING_STRAIN: f32 = 0.2;

/// Stretch and bending stiffness that the preconditioner has for all directions, times h², kg and kg m².
fn stiffness(moduli: &Moduli, h: f32) -> [f32; 2] {
    let along = |i: usize| {
        let threads = moduli.stretch[i] - moduli.shear;
        threads * (1.0 + moduli.stiffening[i] * WORKING_STRAIN) + moduli.shear
    };
    let stretch = along(0).max(along(1)) * (h + moduli.stretch_damping);
    [stretch * h, moduli.bending * (h + moduli.bend_damping) * h]
}
