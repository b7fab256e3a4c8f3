//! Contact between sheets that are solved as one system.

use bevy_math::Vec3A;

use crate::constraint::implicit::{
    ImplicitBuffers,
    contact::{ContactTangent, PredictedContact},
    direction::Direction,
    system::SheetSystem,
};

/// A pair of features of two sheets that may touch within a substep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactBetween {
    /// Numbers of the sheets.
    pub sheets: [u32; 2],
    /// The part of each: the weights of the first add up to one, those of the other to minus one, or the other way around.
    pub sides: [PredictedContact; 2],
}

/// The contacts between sheets in a substep.
#[derive(Clone, Debug, Default)]
pub(crate) struct ContactsBetween {
    /// What may touch.
    pub predicted: Vec<ContactBetween>,
    /// What does.
    tangents: Vec<(ContactBetween, ContactTangent)>,
    /// Residuals while they are scaled, kg m.
    unscaled: Vec<[[[f32; 4]; 4]; 2]>,
}

impl ContactsBetween {
    /// Linearises those that come nearer, and ends that.
    pub fn linearise(&mut self, sheets: &mut [SheetSystem]) {
        self.tangents.clear();
        let Some(h) = sheets.first().map(|system| system.sheet.h) else { return };
        for (number, predicted) in self.predicted.iter_mut().enumerate() {
            // From numbers of cloths to those of this system.
            let index = |cloth: u32| sheets.iter().position(|system| system.number == cloth);
            let [Some(one), Some(other)] = predicted.sheets.map(index) else { continue };
            let contact = ContactBetween { sheets: [one as u32, other as u32], ..*predicted };
            let [PredictedContact { inverse_mass, .. }, _] = contact.sides;
            let past =
                contact.vector_sum(sheets, |side, system| side.past(&system.gathered.now, &system.gathered.before));
            let [first, _] = &mut predicted.sides;
            let out = first.normal.dot(past);
            if inverse_mass == 0.0 || first.is_parting(out, h) {
                first.load = 0.0;
                continue;
            }
            let impulse = first.normal * (-out / inverse_mass);
            for (side, system) in contact.sides(sheets) {
                side.push(impulse, &system.buffers.masses, &mut system.gathered.now);
            }
            let slide = (past - contact.sides[0].normal * out).length();
            let tangent = ContactTangent::new(contact.sides[0], number as u32, slide, h);
            self.tangents.push((contact, tangent));
        }
    }

    /// A particle of each contact that the cloth of a number has.
    pub fn touching(&self, cloth: u32) -> impl Iterator<Item = u32> {
        self.tangents.iter().flat_map(move |(contact, tangent)| {
            let sides = contact.sides.iter().zip(self.predicted[tangent.number as usize].sheets);
            sides.filter(move |&(_, number)| number == cloth).map(|(side, _)| side.particles[0])
        })
    }

    /// Adds the gradient, kg m.
    pub fn pull(&self, sheets: &mut [SheetSystem]) {
        for (contact, tangent) in &self.tangents {
            let past =
                contact.vector_sum(sheets, |side, system| side.past(&system.gathered.now, &system.gathered.before));
            let force = tangent.resist(past);
            contact.sides(sheets).for_each(|(side, system)| side.spread(force, &mut system.buffers.gradient));
        }
    }

    /// Adds the matrix times a direction, kg m.
    pub(super) fn multiply(&self, sheets: &mut [SheetSystem], direction: fn(&mut ImplicitBuffers) -> &mut Direction) {
        for (contact, tangent) in &self.tangents {
            let ways = contact.sides(sheets).map(|(side, system)| side.weighted(&direction(system.buffers).way));
            let force = tangent.resist(ways.sum());
            contact.sides(sheets).for_each(|(side, system)| side.spread(force, &mut direction(system.buffers).product));
        }
    }

    /// Scales the residuals as [those of one sheet's contacts](super::contact::ImplicitContacts::scale_residual).
    pub fn scale_residuals(&mut self, sheets: &mut [SheetSystem]) {
        self.unscaled.clear();
        for (contact, tangent) in &self.tangents {
            let mut unscaled = [[[0.0; 4]; 4]; 2];
            let (mut compliance, mut way) = (0.0, Vec3A::ZERO);
            for (k, (side, system)) in contact.sides(sheets).enumerate() {
                let ImplicitBuffers { residual, preconditioner, .. } = &*system.buffers;
                unscaled[k] = side.particles.map(|i| residual[i as usize]);
                compliance += side.compliance(|i| preconditioner.inverse_diagonal[i]);
                way += side.weighted_by(|i| preconditioner.inverse_diagonal[i], residual);
            }
            self.unscaled.push(unscaled);
            let taken = tangent.taken(compliance, way);
            contact.sides(sheets).for_each(|(side, system)| side.spread(taken, &mut system.buffers.residual));
        }
    }

    /// Scales what the preconditioner has made of them, and puts them back.
    pub fn scale_ways(&self, sheets: &mut [SheetSystem]) {
        for ((contact, tangent), unscaled) in self.tangents.iter().zip(&self.unscaled).rev() {
            let (mut compliance, mut way) = (0.0, Vec3A::ZERO);
            for ((side, system), unscaled) in contact.sides(sheets).zip(unscaled) {
                let ImplicitBuffers { residual, preconditioner, preconditioned, .. } = &mut *system.buffers;
                for (&i, unscaled) in side.particles.iter().zip(unscaled) {
                    residual[i as usize] = *unscaled;
                }
                compliance += side.compliance(|i| preconditioner.inverse_diagonal[i]);
                way += side.weighted(preconditioned);
            }
            let taken = tangent.taken(compliance, way);
            for (side, system) in contact.sides(sheets) {
                let ImplicitBuffers { preconditioner, preconditioned, .. } = &mut *system.buffers;
                side.spread_by(taken, |i| preconditioner.inverse_diagonal[i], preconditioned);
            }
        }
    }

    /// Measures the normal forces, and puts back what friction has held.
    pub fn finish(&mut self, sheets: &mut [SheetSystem]) {
        let Some(h) = sheets.first().map(|system| system.sheet.h) else { return };
        for (contact, tangent) in &self.tangents {
            let [PredictedContact { inverse_mass, .. }, _] = contact.sides;
            let moved = contact.vector_sum(sheets, |side, system| side.weighted(&system.buffers.correction));
            let left = contact.vector_sum(sheets, |side, system| {
                side.weighted_by(|i| system.buffers.masses.inverse(i), &system.buffers.residual)
            });
            let past =
                contact.vector_sum(sheets, |side, system| side.past(&system.gathered.now, &system.gathered.before));
            self.predicted[tangent.number as usize].sides[0].load = tangent.load(moved, left / inverse_mass, h);
            if let Some(slide) = tangent.held_slide(past, h) {
                for (side, system) in contact.sides(sheets) {
                    side.push(slide / -inverse_mass, &system.buffers.masses, &mut system.gathered.now);
                }
            }
        }
    }
}

impl ContactBetween {
    /// Each side with its sheet, one after the other.
    fn sides<'a, 's>(
        &'a self,
        sheets: &'a mut [SheetSystem<'s>],
    ) -> impl Iterator<Item = (&'a PredictedContact, &'a mut SheetSystem<'s>)> {
        let [one, other] = self.sheets.map(|i| i as usize);
        let pair = sheets.get_disjoint_mut([one, other]).ok();
        self.sides.iter().zip(pair.into_iter().flatten())
    }

    /// The sum of a vector of both sides.
    fn vector_sum(&self, sheets: &[SheetSystem], of: impl Fn(&PredictedContact, &SheetSystem) -> Vec3A) -> Vec3A {
        self.sides.iter().zip(self.sheets).map(|(side, i)| of(side, &sheets[i as usize])).sum()
    }
}
