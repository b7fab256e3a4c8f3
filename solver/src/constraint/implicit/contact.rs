//! Contact with obstacles within the implicit step: what would come in is stopped while the cloth is solved, not after it.
//!
//! Contact that comes only after the step is too late for the cloth around: it falls as if nothing held it, and what is pushed
//! back then is a strain that few iterations don't carry to what hangs over. So whatever particle would come into an obstacle within
//! the substep has two more terms in the linear system, in its way w past the surface, with n the outward normal:
//!
//! α m (n · w)²/2  +  κ |w - n (n · w)|²/2,    κ = h² μ λ / max(|v|, ε h)
//!
//! The first keeps it where it is along the normal, where its velocity has been stopped before. The second is Coulomb friction as a viscous force whose coefficient follows
//! the slide v that the substep begins with, as in Li et al., "Incremental Potential Contact" (2020), section 5, with the normal
//! force λ of the substep before: so it is as strong as Coulomb's where the particle slides, and holds where it doesn't. Both are
//! zero at the start of the substep and positive definite, so that contact puts no energy in.
//!
//! λ is what is left of the residual along the normal: also where few iterations haven't converged, it is the force that would
//! have moved the particle on.

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

/// How fast the normal force that friction knows follows the latest one: a share a substep.
const FOLLOWING: f32 = 0.25;

/// A particle that may come into an obstacle within a substep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PredictedContact {
    /// Number of the particle.
    pub particle: u32,
    /// Outward normal of the surface, a unit vector.
    pub normal: Vec3A,
    /// Way of the surface within the substep, m.
    pub way: Vec3A,
    /// Coulomb friction, no unit.
    pub friction: f32,
}

/// The contacts of a substep.
#[derive(Clone, Debug, Default)]
pub(crate) struct ImplicitContacts {
    /// What may touch: found before the substep is solved.
    pub predicted: Vec<PredictedContact>,
    /// What does: a particle's are next to each other.
    tangents: Vec<ContactTangent>,
    /// Normal force on each particle, N. Empty where nothing touched in the substep before.
    load: Vec<f32>,
    /// Residuals while they are scaled, kg m.
    unscaled: Vec<[f32; 4]>,
}

/// What a contact adds to the linear system.
#[derive(Clone, Copy, Debug)]
struct ContactTangent {
    contact: PredictedContact,
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

    /// Whether nothing touches.
    pub fn is_empty(&self) -> bool {
        self.tangents.is_empty()
    }

    /// The particles that touch, and what resists their ways.
    pub fn resistances(&self) -> impl Iterator<Item = (u32, impl Fn(Vec3A) -> Vec3A)> {
        self.tangents.iter().map(|tangent| (tangent.contact.particle, |way| tangent.resist(way)))
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
        if !self.predicted.is_empty() {
            self.load.resize(areas.len(), 0.0);
        }
        // Which of several obstacles was found first is no matter.
        self.predicted.sort_unstable_by_key(|contact| contact.particle);
        self.tangents.clear();
        for contact in &self.predicted {
            let i = contact.particle as usize;
            let mass = masses.mass[i][0];
            let past = contact.past(now, before);
            let out = contact.normal.dot(past);
            let is_tiny = free_fall.length_squared() > LARGEST_FALL * LARGEST_FALL * areas[i];
            if mass == 0.0 || is_tiny || out + contact.normal.dot(free_fall).min(0.0) >= 0.0 {
                continue;
            }
            add(&mut now[i], contact.normal * -out);
            let slide = (past - contact.normal * out).length();
            let friction = contact.friction * self.load[i] * h * h;
            let across = friction / slide.max(CREEP * h);
            self.tangents.push(ContactTangent { contact: *contact, along: STIFFNESS * mass, across });
        }
    }

    /// Adds the gradient, kg m.
    pub fn pull(&self, now: &[[f32; 4]], before: &[[f32; 4]], gradient: &mut [[f32; 4]]) {
        for tangent in &self.tangents {
            let past = tangent.contact.past(now, before);
            add(&mut gradient[tangent.contact.particle as usize], tangent.resist(past));
        }
    }

    /// Adds the matrix times a direction, kg m.
    pub fn multiply(&self, ways: &[[f32; 4]], product: &mut [[f32; 4]]) {
        for tangent in &self.tangents {
            let i = tangent.contact.particle as usize;
            add(&mut product[i], tangent.resist(point(&ways[i])));
        }
    }

    /// Scales the residual for a preconditioner that knows of no contact, but has the `inverse_diagonal` (1/kg): that becomes the
    /// inverse of the whole diagonal if what it makes of the residual is [scaled](Self::scale_ways) likewise.
    pub fn scale_residual(&mut self, inverse_diagonal: &[f32], residual: &mut [[f32; 4]]) {
        self.unscaled.clear();
        for tangent in &self.tangents {
            let i = tangent.contact.particle as usize;
            self.unscaled.push(residual[i]);
            let scaled = tangent.scale(inverse_diagonal[i], point(&residual[i]));
            residual[i] = extended(scaled);
        }
    }

    /// Scales what the preconditioner has made of the residual, and puts that back.
    pub fn scale_ways(&self, inverse_diagonal: &[f32], residual: &mut [[f32; 4]], ways: &mut [[f32; 4]]) {
        // Backwards: so the whole is symmetric where several obstacles touch a particle.
        for (tangent, unscaled) in self.tangents.iter().zip(&self.unscaled).rev() {
            let i = tangent.contact.particle as usize;
            residual[i] = *unscaled;
            let scaled = tangent.scale(inverse_diagonal[i], point(&ways[i]));
            ways[i] = extended(scaled);
        }
    }

    /// Measures the normal forces from what is left of the `residual` (kg m) after a `correction` (m) within a substep of `h`
    /// seconds, and puts back what friction has held.
    pub(super) fn finish(
        &mut self,
        before: &[[f32; 4]],
        [correction, residual]: [&[[f32; 4]]; 2],
        h: f32,
        now: &mut [[f32; 4]],
    ) {
        let Self { tangents, load, .. } = self;
        if tangents.is_empty() {
            return load.clear();
        }
        let mut rest = &tangents[..];
        for (i, load) in load.iter_mut().enumerate() {
            let count = rest.iter().take_while(|tangent| tangent.contact.particle as usize == i).count();
            let (own, others) = rest.split_at(count);
            rest = others;
            // Of several obstacles, friction knows the strongest.
            let mut latest = f32::NEG_INFINITY;
            for ContactTangent { contact, along, across } in own {
                let [moved, left] = [correction, residual].map(|list| contact.normal.dot(point(&list[i])));
                latest = latest.max(-(along * moved + left) / (h * h));
                let past = contact.past(now, before);
                let slide = past - contact.normal * contact.normal.dot(past);
                if *across > 0.0 && slide.length() < STUCK * CREEP * h {
                    add(&mut now[i], -slide);
                }
            }
            let followed = if *load > 0.0 { *load + (latest - *load) * FOLLOWING } else { latest };
            *load = followed.max(0.0);
        }
    }
}

impl PredictedContact {
    /// The way of its particle past the surface from `before` to `now`, m.
    fn past(&self, now: &[[f32; 4]], before: &[[f32; 4]]) -> Vec3A {
        let i = self.particle as usize;
        point(&now[i]) - point(&before[i]) - self.way
    }
}

impl ContactTangent {
    /// What resists a way past the surface, kg m.
    fn resist(&self, way: Vec3A) -> Vec3A {
        self.by_direction(way, [self.along, self.across])
    }

    /// A vector scaled by the root of what the contact leaves of an inverse of the diagonal.
    fn scale(&self, inverse_diagonal: f32, vector: Vec3A) -> Vec3A {
        let part = |stiffness: f32| (1.0 + stiffness * inverse_diagonal).sqrt().recip();
        self.by_direction(vector, [self.along, self.across].map(part))
    }

    /// A vector times one number along the normal and another across it.
    fn by_direction(&self, vector: Vec3A, [along, across]: [f32; 2]) -> Vec3A {
        let normal = self.contact.normal;
        vector * across + normal * (normal.dot(vector) * (along - across))
    }
}

fn add(sum: &mut [f32; 4], more: Vec3A) {
    *sum = extended(point(sum) + more);
}
