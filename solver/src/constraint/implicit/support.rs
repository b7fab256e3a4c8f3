//! Particles that an obstacle supports: they don't move along its normal while the cloth is solved.
//!
//! Contact comes after the implicit step, and would be too late for it: cloth that lies on something would fall in each substep
//! as if nothing held it, and be pushed back with a strain that few iterations don't carry to what hangs over. So what contact
//! pushed in the substep before is filtered out of all directions of search, as the constraints of Baraff and Witkin, "Large
//! Steps in Cloth Simulation" (1998). What is left of its residual is the load on the obstacle: the particle is pressed in by as
//! much as that would move it, so that contact pushes it out again, and friction holds it in proportion. A particle that is pulled
//! away isn't pressed, and so is free in the next substep.

use bevy_math::{Vec3A, Vec4};

use crate::{constraint::implicit::vectors::Masses, layout::points::Points};

/// The supported particles of a substep.
#[derive(Clone, Debug, Default)]
pub(crate) struct Support {
    /// Where all particles were before contact pushed some in the latest substep, m. Empty where there was none.
    unpushed: Points,
    /// The supported particles, in order, and directions of the pushes.
    particles: Vec<(u32, Vec3A)>,
    /// Parts of the residual along them, kg m.
    loads: Vec<f32>,
}

impl Support {
    /// Takes note of where the particles are before contact pushes some.
    pub fn note(&mut self, position: &Points) {
        self.unpushed.0.clone_from(&position.0);
    }

    /// Finds out what contact has pushed to where it is `before` a substep. A push of more than `most` (m) is none that supports
    /// anything: an impact, or somebody has moved the cloth since.
    pub(super) fn find(&mut self, before: &[[f32; 4]], masses: &Masses, most: f32) {
        self.particles.clear();
        if self.unpushed.0.is_empty() {
            return;
        }
        for (i, (before, mass)) in (0..).zip(before.iter().zip(&masses.mass)).take(masses.count()) {
            let push = Vec3A::from_slice(before) - self.unpushed.get(i as usize);
            let length = push.length();
            if length > 0.0 && length <= most && mass[0] > 0.0 {
                self.particles.push((i, push / length));
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
