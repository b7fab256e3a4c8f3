//! Contact within the implicit step: what would come into something is stopped while the cloth is solved, not after it.
//!
//! Contact that comes only after the step is too late for the cloth around: it falls as if nothing held it, and what is pushed
//! back then is a strain that few iterations don't carry to what hangs over. So a particle, or the nearest place of a triangle or
//! edge, that would come into an obstacle or another part of the cloth has two more terms in the linear system. With its way w past
//! what is touched, the outward normal n, and its effective mass m:
//!
//! α m (n · w)²/2  +  κ |w - n (n · w)|²/2,    κ = h² μ λ / max(|v|, ε h)
//!
//! The first keeps it where it is along the normal, where its velocity has been stopped before. The second is Coulomb friction as
//! a viscous force whose coefficient follows the slide v that the substep begins with, as in Li et al., "Incremental Potential
//! Contact" (2020), section 5, with the normal force λ of the substep before: so it is as strong as Coulomb's where it slides, and
//! holds where it doesn't. Both are zero at the start of the substep and positive definite, so that contact puts no energy in.
//!
//! λ is what is left of the residual along the normal: also where few iterations haven't converged, it is the force that would
//! have moved the cloth on.

use bevy_math::Vec3A;

use crate::constraint::implicit::vectors::{Masses, extended, point};

/// Stiffness α along the normal, in masses of the particle: no unit.
///
/// A particle that carries a hundred times its own weight sinks by 0.4 µm in a substep of 2 ms, which contact after it takes back.
const STIFFNESS: f32 = 1e4;

/// Speed ε up to which a particle that friction holds may slide while the cloth is solved, m/s.
const CREEP: f32 = 3e-3;

/// A particle that slid by less than this share of that is put back: friction has held it.
const STUCK: f32 = 0.8;

/// Largest free fall within a substep, as a share of the cell of the particle: beyond it, only contact after the step stops it.
///
/// Cells of half a millimetre that meet something would be turned too far for one linear step, and be thrown off.
const LARGEST_FALL: f32 = 0.05;

/// Speed up to which parts of cloth that pressed on each other may part while they still count as touching, m/s.
const PARTING: f32 = 1e-3;

/// How fast the normal force that friction knows follows the latest one: a share a substep.
const FOLLOWING: f32 = 0.25;

/// What may come into something within a substep: a particle, or a feature by its corners.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PredictedContact {
    /// Numbers of the particles, the first `count`. Those that aren't of the cloth have no weight.
    pub particles: [u32; 4],
    /// One, or four.
    pub count: u8,
    /// Weight of each in the way past what is touched, no unit.
    pub weights: [f32; 4],
    /// Outward normal of what is touched, a unit vector.
    pub normal: Vec3A,
    /// Way of what is touched within the substep, m.
    pub way: Vec3A,
    /// Effective inverse mass of what touches, 1/kg: of both sides where both move.
    pub inverse_mass: f32,
    /// Coulomb friction, no unit.
    pub friction: f32,
    /// Normal force, N: in the substep before at first, and in this one once it is solved. Zero where nothing touches.
    pub load: f32,
}

/// The contacts of a substep.
#[derive(Clone, Debug, Default)]
pub(crate) struct ImplicitContacts {
    /// What may touch: found before the substep is solved.
    pub predicted: Vec<PredictedContact>,
    /// What does.
    tangents: Vec<ContactTangent>,
    /// Normal force on each particle, N. Empty where nothing touched in the substep before.
    load: Vec<f32>,
    /// Residuals while they are scaled, kg m.
    unscaled: Vec<[f32; 4]>,
}

/// What a contact adds to the linear system.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactTangent {
    contact: PredictedContact,
    /// Its number among those that are predicted.
    pub number: u32,
    /// Stiffness along the normal and across it, kg.
    along: f32,
    across: f32,
}

impl ImplicitContacts {
    /// Begins a step of a cloth of `count` particles with the normal forces of the step before, N: none where that is empty.
    pub fn begin(&mut self, load: &[f32], count: usize) {
        let Self { predicted, tangents, unscaled, .. } = self;
        predicted.clear();
        predicted.reserve(count);
        tangents.clear();
        tangents.reserve(count);
        unscaled.clear();
        unscaled.reserve(count);
        self.load.clear();
        self.load.reserve(count);
        self.load.extend_from_slice(load);
    }

    /// Hands over the normal forces that the next step begins with.
    pub fn end(&self, load: &mut Vec<f32>) {
        // Once, however much will touch.
        load.clear();
        load.reserve(self.load.capacity());
        load.extend_from_slice(&self.load);
    }

    /// The number of contacts.
    pub fn len(&self) -> usize {
        self.tangents.len()
    }

    /// Whether nothing touches anything but the cloth itself.
    pub fn is_empty(&self) -> bool {
        self.at_obstacles().next().is_none()
    }

    fn at_obstacles(&self) -> impl Iterator<Item = &ContactTangent> {
        self.tangents.iter().filter(|tangent| tangent.contact.is_at_obstacle())
    }

    /// A particle of each contact with an obstacle, where that touches if particles are at `now` (m), and what resists ways there.
    pub fn resistances(&self, now: &[[f32; 4]]) -> impl Iterator<Item = (u32, Vec3A, impl Fn(Vec3A) -> Vec3A)> {
        self.at_obstacles().map(|tangent| {
            let total: f32 = tangent.contact.weights.iter().sum();
            let place = tangent.contact.weighted(now) / total;
            (tangent.contact.particles[0], place, move |way| tangent.resist(way) * (total * total))
        })
    }

    /// The particles of contacts with obstacles.
    pub fn touching(&self) -> impl Iterator<Item = u32> {
        self.at_obstacles().map(|tangent| tangent.contact.particles[0])
    }

    /// Linearises the contacts of particles that were at `before` and would be at `now` by themselves, m, without a `free_fall`
    /// within the substep of `h` seconds, m: those that all this would bring nearer to the surface. Their ways along the normal end
    /// here, as in an inelastic impact, so that only loads are left for the linear system, which few iterations solve well.
    pub(super) fn linearise(
        &mut self,
        now: &mut [[f32; 4]],
        before: &[[f32; 4]],
        masses: &Masses,
        areas: &[f32],
        free_fall: Vec3A,
        h: f32,
    ) {
        self.tangents.clear();
        for (number, contact) in self.predicted.iter_mut().enumerate() {
            if contact.is_of_particle() {
                contact.load = self.load.get(contact.particles[0] as usize).copied().unwrap_or(0.0);
            }
            let past = contact.past(now, before);
            let out = contact.normal.dot(past);
            let is_parting = if contact.is_at_obstacle() {
                let fall = contact.normal.dot(free_fall) * contact.weights.iter().sum::<f32>();
                out + fall.min(0.0) >= 0.0
            } else {
                contact.is_parting(out, h)
            };
            if contact.inverse_mass == 0.0 || contact.is_tiny(areas, free_fall) || is_parting {
                contact.load = 0.0;
                continue;
            }
            contact.push(contact.normal * (-out / contact.inverse_mass), masses, now);
            let slide = (past - contact.normal * out).length();
            self.tangents.push(ContactTangent::new(*contact, number as u32, slide, h));
        }
    }

    /// Adds the gradient, kg m.
    pub fn pull(&self, now: &[[f32; 4]], before: &[[f32; 4]], gradient: &mut [[f32; 4]]) {
        for tangent in &self.tangents {
            tangent.contact.spread(tangent.resist(tangent.contact.past(now, before)), gradient);
        }
    }

    /// Adds the matrix times a direction, kg m.
    pub fn multiply(&self, ways: &[[f32; 4]], product: &mut [[f32; 4]]) {
        for tangent in &self.tangents {
            tangent.contact.spread(tangent.resist(tangent.contact.weighted(ways)), product);
        }
    }

    /// Scales the residual for a preconditioner that knows of no contact, but has the `inverse_diagonal` (1/kg): that becomes the
    /// inverse of the diagonal and the contact if what it makes of the residual is [scaled](Self::scale_ways) likewise.
    ///
    /// Of several contacts of a particle, one after the other.
    pub fn scale_residual(&mut self, inverse_diagonal: &[f32], residual: &mut [[f32; 4]]) {
        self.unscaled.clear();
        for tangent in &self.tangents {
            let contact = &tangent.contact;
            self.unscaled.extend(contact.parts().map(|(i, _)| residual[i]));
            let way = contact.weighted_by(|i| inverse_diagonal[i], residual);
            contact.spread(tangent.taken(contact.compliance(|i| inverse_diagonal[i]), way), residual);
        }
    }

    /// Scales what the preconditioner has made of the residual, and puts that back.
    pub fn scale_ways(&self, inverse_diagonal: &[f32], residual: &mut [[f32; 4]], ways: &mut [[f32; 4]]) {
        // Backwards: so the whole is symmetric.
        let mut unscaled = &self.unscaled[..];
        for tangent in self.tangents.iter().rev() {
            let contact = &tangent.contact;
            let (others, own) = unscaled.split_at(unscaled.len() - usize::from(contact.count));
            unscaled = others;
            for ((i, _), unscaled) in contact.parts().zip(own) {
                residual[i] = *unscaled;
            }
            let taken = tangent.taken(contact.compliance(|i| inverse_diagonal[i]), contact.weighted(ways));
            contact.spread_by(taken, |i| inverse_diagonal[i], ways);
        }
    }

    /// Measures the normal forces from what is left of the `residual` (kg m) after a `correction` (m) within a substep of `h`
    /// seconds, and puts back what friction has held.
    pub(super) fn finish(
        &mut self,
        before: &[[f32; 4]],
        [correction, residual]: [&[[f32; 4]]; 2],
        masses: &Masses,
        h: f32,
        now: &mut [[f32; 4]],
    ) {
        let Self { predicted, tangents, load, .. } = self;
        load.clear();
        for tangent in &*tangents {
            let contact = &tangent.contact;
            let inverse_mass = contact.inverse_mass;
            let left = contact.weighted_by(|i| masses.inverse(i), residual) / inverse_mass;
            predicted[tangent.number as usize].load = tangent.load(contact.weighted(correction), left, h);
            if let Some(slide) = tangent.held_slide(contact.past(now, before), h) {
                contact.push(slide / -inverse_mass, masses, now);
            }
        }
        if tangents.is_empty() {
            return;
        }
        load.resize(before.len(), 0.0);
        for contact in predicted.iter().filter(|contact| contact.is_of_particle()) {
            // Of several obstacles, friction knows the strongest.
            let load = &mut load[contact.particles[0] as usize];
            *load = load.max(contact.load);
        }
    }
}

impl PredictedContact {
    /// That of one particle.
    pub fn of_particle(particle: u32, inverse_mass: f32, [normal, way]: [Vec3A; 2], friction: f32) -> Self {
        let (particles, weights) = ([particle; 4], [1.0, 0.0, 0.0, 0.0]);
        Self { particles, count: 1, weights, normal, way, inverse_mass, friction, load: 0.0 }
    }

    fn is_of_particle(&self) -> bool {
        self.count == 1
    }

    /// Whether it isn't between parts of the same cloth: the weights of such add up to nothing.
    fn is_at_obstacle(&self) -> bool {
        self.weights.iter().sum::<f32>().abs() > 0.5
    }

    /// Whether its cell, of one of the `areas` (m²), is too small for a linear step that ends such a `free_fall`, m.
    pub fn is_tiny(&self, areas: &[f32], free_fall: Vec3A) -> bool {
        let area = areas[self.particles[0] as usize];
        free_fall.length_squared() > LARGEST_FALL * LARGEST_FALL * area
    }

    /// Whether parts of cloth that come away from each other by `out` (m) within `h` seconds don't touch any more.
    pub(super) fn is_parting(&self, out: f32, h: f32) -> bool {
        out > if self.load > 0.0 { PARTING * h } else { 0.0 }
    }

    /// The particles and their weights.
    fn parts(&self) -> impl Iterator<Item = (usize, f32)> {
        let parts = self.particles.into_iter().zip(self.weights).take(self.count.into());
        parts.map(|(i, weight)| (i as usize, weight))
    }

    /// The sum of vectors of the particles by their weights.
    pub(super) fn weighted(&self, list: &[[f32; 4]]) -> Vec3A {
        self.weighted_by(|_| 1.0, list)
    }

    /// The same, of vectors times a number of each particle.
    pub(super) fn weighted_by(&self, number: impl Fn(usize) -> f32, list: &[[f32; 4]]) -> Vec3A {
        self.parts().map(|(i, weight)| point(&list[i]) * (weight * number(i))).sum()
    }

    /// Adds a vector to those of the particles, times their weights.
    pub(super) fn spread(&self, vector: Vec3A, list: &mut [[f32; 4]]) {
        self.spread_by(vector, |_| 1.0, list);
    }

    /// The same, times a number of each particle too.
    pub(super) fn spread_by(&self, vector: Vec3A, number: impl Fn(usize) -> f32, list: &mut [[f32; 4]]) {
        for (i, weight) in self.parts() {
            list[i] = extended(point(&list[i]) + vector * (weight * number(i)));
        }
    }

    /// How much one unit of force moves what touches, by a number of each particle.
    pub(super) fn compliance(&self, number: impl Fn(usize) -> f32) -> f32 {
        self.parts().map(|(i, weight)| weight * weight * number(i)).sum()
    }

    /// Moves the particles by an impulse times h, kg m.
    pub(super) fn push(&self, impulse: Vec3A, masses: &Masses, now: &mut [[f32; 4]]) {
        self.spread_by(impulse, |i| masses.inverse(i), now);
    }

    /// The way past what is touched from `before` to `now`, m.
    pub(super) fn past(&self, now: &[[f32; 4]], before: &[[f32; 4]]) -> Vec3A {
        self.weighted(now) - self.weighted(before) - self.way
    }
}

impl ContactTangent {
    /// That of a contact where a substep of `h` seconds begins with a `slide`, m.
    pub fn new(contact: PredictedContact, number: u32, slide: f32, h: f32) -> Self {
        let across = contact.friction * contact.load * h * h / slide.max(CREEP * h);
        Self { contact, number, along: STIFFNESS / contact.inverse_mass, across }
    }

    /// The normal force that friction of the next substep knows, N, where a correction has `moved` it (m) and a residual is `left`
    /// of it, kg m.
    pub fn load(&self, moved: Vec3A, left: Vec3A, h: f32) -> f32 {
        let Self { contact: PredictedContact { normal, load, .. }, along, .. } = *self;
        let latest = -normal.dot(moved * along + left) / (h * h);
        let followed = if load > 0.0 { load + (latest - load) * FOLLOWING } else { latest };
        followed.max(0.0)
    }

    /// The slide within a way `past` what is touched, m, if friction has held it: it is to be put back.
    pub fn held_slide(&self, past: Vec3A, h: f32) -> Option<Vec3A> {
        let normal = self.contact.normal;
        let slide = past - normal * normal.dot(past);
        (self.across > 0.0 && slide.length() < STUCK * CREEP * h).then_some(slide)
    }

    /// What resists a way past the surface, kg m.
    pub(super) fn resist(&self, way: Vec3A) -> Vec3A {
        self.by_direction(way, [self.along, self.across])
    }

    /// The change of a way `w x` that makes an inverse diagonal D⁻¹ that of D + wᵀ k w, for stiffness k, when it comes before and
    /// after: with S = 1 + D⁻¹ wᵀ g w, g = (1/√(1 + k c) - 1)/c and the `compliance` c = w D⁻¹ wᵀ (1/kg), that is S D⁻¹ Sᵀ.
    pub(super) fn taken(&self, compliance: f32, way: Vec3A) -> Vec3A {
        let part = |stiffness: f32| ((1.0 + stiffness * compliance).sqrt().recip() - 1.0) / compliance;
        self.by_direction(way, [self.along, self.across].map(part))
    }

    /// A vector times one number along the normal and another across it.
    fn by_direction(&self, vector: Vec3A, [along, across]: [f32; 2]) -> Vec3A {
        let normal = self.contact.normal;
        vector * across + normal * (normal.dot(vector) * (along - across))
    }
}
