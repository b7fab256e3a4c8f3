//! Rigid motions of each connected component: a second coarse space, of six numbers.
//!
//! A particle at X from the middle of its component moves by t + w × X. The matrix between these numbers has the masses, and
//! the stiffness of the triangles that hold the component: those with a corner that doesn't go along, as it is held. To the others,
//! a rigid motion is no strain. Without it a hung cloth of 1 m that falls is 30 cm behind after half a second.
//!
//! Nothing holds a free component: its six numbers follow from the loads alone, and are solved for first. All directions of
//! search are then without them, so that momentum stays, to rounding, and angular momentum nearly.

use bevy_math::Vec3A;

use crate::{
    constraint::implicit::{
        face::FaceTangent,
        vectors::{Masses, extended, point},
    },
    layout::simd::LANES,
    topology::{face_pack::FacePack, two_grid::TwoGrid},
};

/// Added to the diagonal, as a share of it: a component in one line has no inertia about it.
const REGULARISATION: f64 = 1e-5;

/// A matrix between rigid motions.
type Six = [[f64; 6]; 6];

/// The rigid motions of a substep.
#[derive(Clone, Debug, Default)]
pub(super) struct RigidMotions {
    components: Vec<Component>,
    /// From the middle of its component to each particle, m, and one; zero for those that are held.
    arms: Vec<[f32; 4]>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Component {
    is_held: bool,
    /// Number of particles that go along.
    count: f32,
    middle: Vec3A,
    matrix: Six,
    inverse: [[f32; 6]; 6],
    /// Force and torque, kg m and kg m².
    force: Vec3A,
    torque: Vec3A,
    /// Shift, m, and turn.
    shift: Vec3A,
    turn: Vec3A,
}

impl RigidMotions {
    /// Prepares for a step, in which `held` particles are fixed, or led by something heavy.
    pub fn prepare(&mut self, two_grid: &TwoGrid, held: impl Iterator<Item = u32>) {
        self.components.clear();
        self.components.resize(two_grid.component_count, Component::default());
        self.hold_components(two_grid, held);
    }

    /// Counts the components of some particles as held. Says whether that is new of any.
    pub fn hold_components(&mut self, two_grid: &TwoGrid, particles: impl Iterator<Item = u32>) -> bool {
        let mut is_new = false;
        for particle in particles {
            let component = &mut self.components[two_grid.component[particle as usize] as usize];
            is_new |= !component.is_held;
            component.is_held = true;
        }
        is_new
    }

    /// Whether nothing holds the component that a particle belongs to.
    pub fn is_free(&self, two_grid: &TwoGrid, particle: usize) -> bool {
        !self.components[two_grid.component[particle] as usize].is_held
    }

    /// Whether any component is `held`, or free.
    pub fn has(&self, held: bool) -> bool {
        self.components.iter().any(|component| component.is_held == held)
    }

    /// Begins a substep, with particles at `now`, m.
    pub fn begin(&mut self, two_grid: &TwoGrid, now: &[[f32; 4]], masses: &Masses) {
        let Self { components, arms } = self;
        for component in &mut *components {
            *component = Component { is_held: component.is_held, ..Component::default() };
        }
        arms.clear();
        arms.extend(now.iter().map(|&[x, y, z, _]| [x, y, z, 1.0]));
        for &particle in &masses.held {
            arms[particle as usize] = [0.0; 4];
        }
        for (&number, arm) in two_grid.component.iter().zip(&*arms) {
            let component = &mut components[number as usize];
            component.middle += point(arm);
            component.count += arm[3];
        }
        for component in &mut *components {
            component.middle /= component.count.max(1.0);
        }
        for ((&number, arm), mass) in two_grid.component.iter().zip(arms).zip(&masses.mass) {
            if arm[3] > 0.0 {
                let component = &mut components[number as usize];
                let from_middle = point(arm) - component.middle;
                arm[..3].copy_from_slice(&from_middle.to_array());
                add_mass(&mut component.matrix, from_middle, mass[0]);
            }
        }
        self.invert(false);
    }

    /// Adds the stiffness of the `packs` of faces that hold the components, with their tangents and a `coupling` of G h², kg, and
    /// of `contacts`: a particle of each, and what resists ways at its place.
    pub fn hold<'a>(
        &mut self,
        two_grid: &TwoGrid,
        now: &[[f32; 4]],
        packs: impl Iterator<Item = (&'a FacePack, &'a FaceTangent)>,
        coupling: f32,
        contacts: impl Iterator<Item = (u32, Vec3A, impl Fn(Vec3A) -> Vec3A)>,
    ) {
        let Self { components, arms } = self;
        for (pack, tangent) in packs {
            for lane in 0..LANES {
                let corners = pack.particles.map(|corners| corners[lane] as usize);
                if pack.area[lane] == 0.0 {
                    continue;
                }
                let is_moved = corners.map(|i| arms[i][3]);
                // Gradient of what is one at corners that go along and zero at those that are held.
                let slope = |[b, c]: [f32; 2]| b * (is_moved[1] - is_moved[0]) + c * (is_moved[2] - is_moved[0]);
                let by_u = slope(pack.warp.map(|lanes| lanes[lane]));
                let by_v = slope(pack.weft.map(|lanes| lanes[lane]));
                let component = &mut components[two_grid.component[corners[0]] as usize];
                let middle = corners.iter().map(|&i| point(&now[i])).sum::<Vec3A>() / 3.0;
                let g = pack.area[lane] * coupling;
                let stress = |way: Vec3A| tangent.resist(lane, way, [by_u, by_v], g);
                add_stiffness(&mut component.matrix, middle - component.middle, stress);
            }
        }
        for (particle, place, stress) in contacts {
            let component = &mut components[two_grid.component[particle as usize] as usize];
            add_stiffness(&mut component.matrix, place - component.middle, stress);
        }
        self.invert(true);
    }

    fn invert(&mut self, held: bool) {
        for component in self.components.iter_mut().filter(|component| component.is_held == held) {
            component.inverse = if component.count > 0.0 { inverse(component.matrix) } else { Default::default() };
        }
    }

    /// Adds what the held components do under the residual to ways.
    pub fn add_held(&mut self, two_grid: &TwoGrid, residual: &[[f32; 4]], ways: &mut [[f32; 4]]) {
        if !self.has(true) {
            return;
        }
        self.respond(two_grid, |i| point(&residual[i]));
        self.move_by(two_grid, true, 1.0, |i, more| ways[i] = extended(point(&ways[i]) + more));
    }

    /// Takes the rigid motions of free components from ways, of which nothing else is left in the masses' inner product.
    pub fn remove_free(&mut self, two_grid: &TwoGrid, masses: &Masses, ways: &mut [[f32; 4]]) {
        if !self.has(false) {
            return;
        }
        self.respond(two_grid, |i| point(&ways[i]) * masses.mass[i][0]);
        self.move_by(two_grid, false, -1.0, |i, more| ways[i] = extended(point(&ways[i]) + more));
    }

    /// Moves free components as `loads` (kg m) ask, of which nothing rigid is left then.
    pub fn carry_free(&mut self, two_grid: &TwoGrid, masses: &Masses, [correction, loads]: [&mut [[f32; 4]]; 2]) {
        self.respond(two_grid, |i| point(&loads[i]));
        self.move_by(two_grid, false, 1.0, |i, more| {
            correction[i] = extended(point(&correction[i]) + more);
            loads[i] = extended(point(&loads[i]) - more * masses.mass[i][0]);
        });
    }

    /// Finds the motions that forces (kg m) on the particles ask for.
    fn respond(&mut self, two_grid: &TwoGrid, force: impl Fn(usize) -> Vec3A) {
        for component in &mut self.components {
            (component.force, component.torque) = (Vec3A::ZERO, Vec3A::ZERO);
        }
        for (i, (&number, arm)) in two_grid.component.iter().zip(&self.arms).enumerate() {
            let component = &mut self.components[number as usize];
            let force = force(i) * arm[3];
            component.force += force;
            component.torque += point(arm).cross(force);
        }
        for component in &mut self.components {
            let load = [component.force.to_array(), component.torque.to_array()];
            let row = |row: &[f32; 6]| row.iter().zip(load.as_flattened()).map(|(a, b)| a * b).sum::<f32>();
            let [x, y, z, a, b, c] = component.inverse.each_ref().map(row);
            (component.shift, component.turn) = (Vec3A::new(x, y, z), Vec3A::new(a, b, c));
        }
    }

    /// Calls `go` with each particle of components that are `held`, or free, and so many times the way that it goes along, m.
    fn move_by(&self, two_grid: &TwoGrid, held: bool, times: f32, mut go: impl FnMut(usize, Vec3A)) {
        for (i, (&number, arm)) in two_grid.component.iter().zip(&self.arms).enumerate() {
            let component = &self.components[number as usize];
            if component.is_held == held {
                go(i, (component.shift * arm[3] + component.turn.cross(point(arm))) * times);
            }
        }
    }
}

/// Adds a mass (kg) at an `arm` (m) from the middle.
fn add_mass(matrix: &mut Six, arm: Vec3A, mass: f32) {
    let ([x, y, z], m) = (arm.to_array().map(f64::from), f64::from(mass));
    for i in 0..3 {
        matrix[i][i] += m;
        matrix[3 + i][3 + i] += m * (x * x + y * y + z * z);
    }
    for (i, p) in [x, y, z].into_iter().enumerate() {
        for (j, q) in [x, y, z].into_iter().enumerate() {
            matrix[3 + i][3 + j] -= m * p * q;
        }
    }
    for (i, j, arm) in [(0, 1, z), (1, 2, x), (2, 0, y)] {
        matrix[i][3 + j] += m * arm;
        matrix[3 + j][i] += m * arm;
        matrix[j][3 + i] -= m * arm;
        matrix[3 + i][j] -= m * arm;
    }
}

/// Adds what a `stress` against ways (m) at an `arm` (m) from the middle is to the six numbers.
fn add_stiffness(matrix: &mut Six, arm: Vec3A, stress: impl Fn(Vec3A) -> Vec3A) {
    for (column, axis) in [Vec3A::X, Vec3A::Y, Vec3A::Z].into_iter().enumerate() {
        for (column, way) in [(column, axis), (3 + column, axis.cross(arm))] {
            let force = stress(way);
            let torque = arm.cross(force);
            for (row, more) in force.to_array().into_iter().chain(torque.to_array()).enumerate() {
                matrix[row][column] += f64::from(more);
            }
        }
    }
}

/// The inverse of a symmetric positive definite matrix, by Gauss and Jordan.
fn inverse(mut matrix: Six) -> [[f32; 6]; 6] {
    let largest = (0..6).map(|i| matrix[i][i]).fold(0.0, f64::max);
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] += row[i] * REGULARISATION + largest * REGULARISATION * REGULARISATION;
    }
    let mut inverse = Six::default();
    for (i, row) in inverse.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    for pivot in 0..6 {
        let per = matrix[pivot][pivot].recip();
        for row in [&mut matrix, &mut inverse] {
            row[pivot].iter_mut().for_each(|value| *value *= per);
        }
        for row in (0..6).filter(|&row| row != pivot) {
            let factor = matrix[row][pivot];
            for both in [&mut matrix, &mut inverse] {
                let from = both[pivot];
                both[row].iter_mut().zip(from).for_each(|(value, from)| *value -= factor * from);
            }
        }
    }
    if inverse.as_flattened().iter().all(|value| value.is_finite()) {
        inverse.map(|row| row.map(|value| value as f32))
    } else {
        Default::default()
    }
}
