//! Particles that an obstacle supports: they don't move along its normal while the cloth is solved.
//!
//! Contact comes after the implicit step, and would be too late for it: cloth that lies on something would fall in each substep
//! as if nothing held it, and be pushed back with a strain that few iterations don't carry to what hangs over. So what contact
//! pushed in the substep before is filtered out of all directions of search, as the constraints of Baraff and Witkin, "Large
//! Steps in Cloth Simulation" (1998). What is left of its residual is the load on the obstacle: the particle is pressed in by as
//! much as that would move it, so that contact pushes it out again, and friction holds it in proportion. A particle that is pulled
//! away isn't pressed, and so is free in the next substep.

use bevy_math::{Vec3A, Vec4};

use crate::{
    constraint::implicit::vectors::Masses,
    layout::points::Points,
    particles::{Particles, lanes::Lanes},
};

/// The supported particles of a substep.
#[derive(Clone, Debug, Default)]
pub(crate) struct Support {
    /// Where all particles were before contact pushed some in the latest substep, m. Empty where there was none.
    unpushed: Points,
    /// The supported particles, in order, and directions of the pushes.
    particles: Vec<(u32, Vec3A)>,
    /// Whether these are from the step before.
    is_from_before: bool,
    /// Parts of the residual along them, kg m.
    loads: Vec<f32>,
}

impl Support {
    /// Begins a step of a cloth that had this support at the end of the step before.
    pub fn begin(&mut self, particles: &Particles) {
        self.unpushed.0.clear();
        self.particles.clear();
        let count = particles.len();
        self.particles.reserve(count);
        self.particles.extend(particles.support.iter().filter(|(i, _)| (*i as usize) < count));
        self.is_from_before = true;
    }

    /// Hands over what the next step begins with, of a cloth in `lanes`.
    pub fn end(&mut self, lanes: &Lanes, most: f32, particles: &mut Particles) {
        self.is_from_before = false;
        let is_free = |i: u32| lanes.inverse_mass(i as usize) > 0.0;
        self.find(particles.len(), |i| lanes.position.get(i), is_free, most);
        if !self.particles.is_empty() {
            // Once, however many there will be.
            let count = particles.len();
            particles.support.reserve(count.saturating_sub(particles.support.len()));
        }
        particles.support.clone_from(&self.particles);
    }

    /// Takes note of where the particles are before contact pushes some.
    pub fn note(&mut self, position: &Points) {
        self.unpushed.0.clone_from(&position.0);
    }

    /// Finds out which free particles contact has pushed to where they are before a substep. A push of more than `most` (m) is an
    /// impact, and supports nothing.
    pub fn find(&mut self, count: usize, place: impl Fn(usize) -> Vec3A, is_free: impl Fn(u32) -> bool, most: f32) {
        if self.is_from_before {
            self.is_from_before = false;
            return self.particles.retain(|&(i, _)| is_free(i));
        }
        self.particles.clear();
        if self.unpushed.0.is_empty() {
            return;
        }
        for i in 0..count {
            let (direction, length) = (place(i) - self.unpushed.get(i)).normalize_and_length();
            if length > 0.0 && length <= most && is_free(i as u32) {
                self.particles.push((i as u32, direction));
            }
        }
        self.unpushed.0.clear();
    }

    /// The supported particles.
    pub fn particles(&self) -> impl Iterator<Item = u32> {
        self.particles.iter().map(|&(i, _)| i)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.particles.is_empty()
    }

    /// Leaves nothing of a direction of search where it leads along a normal.
    pub fn filter(&self, ways: &mut [[f32; 4]]) {
        for &(i, normal) in &self.particles {
            take(&mut ways[i as usize], normal);
        }
    }

    /// Takes the loads out of the residual, for the preconditioner.
    pub fn take_loads(&mut self, residual: &mut [[f32; 4]]) {
        self.loads.clear();
        self.loads.extend(self.particles.iter().map(|&(i, normal)| take(&mut residual[i as usize], normal)));
    }

    /// Puts them back.
    pub fn put_loads(&self, residual: &mut [[f32; 4]]) {
        for (&(i, normal), load) in self.particles.iter().zip(&self.loads) {
            add(&mut residual[i as usize], normal * *load);
        }
    }

    /// Presses particles in by what the `residual` (kg m) and their weight, which would take them by `free_fall` (m), would move
    /// them, by no more than `most`, m.
    pub(super) fn press(
        &self,
        residual: &[[f32; 4]],
        free_fall: Vec3A,
        masses: &Masses,
        most: f32,
        places: &mut [[f32; 4]],
    ) {
        for &(i, normal) in &self.particles {
            let i = i as usize;
            let way = Vec3A::from_slice(&residual[i]).dot(normal) / masses.mass[i][0] + free_fall.dot(normal);
            if way < 0.0 {
                add(&mut places[i], normal * way.max(-most));
            }
        }
    }
}

fn add(point: &mut [f32; 4], more: Vec3A) {
    *point = (Vec4::from_array(*point) + Vec4::from((more, 0.0))).to_array();
}

/// Takes the part along a normal out of a vector, and says how long it was.
fn take(vector: &mut [f32; 4], normal: Vec3A) -> f32 {
    let along = Vec3A::from_slice(vector).dot(normal);
    add(vector, normal * -along);
    along
}
