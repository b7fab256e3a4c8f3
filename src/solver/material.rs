//! The physical constants of a cloth, as the solver reads them.

use super::SpringKind;

/// Constants of one kind of spring.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpringConstants {
    /// Stiffness k of Hooke's law, N/m. Zero switches the kind off.
    pub stiffness: f32,
    /// Damping along the spring, N·s/m.
    pub damping: f32,
}

/// What a cloth is made of. All values are finite and not negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Areal density, kg/m². Greater than zero.
    pub density: f32,
    /// Constants by [`SpringKind::index`].
    pub springs: [SpringConstants; 3],
    /// Damping of the velocity, 1/s.
    pub damping: f32,
    /// Distance that particles keep from obstacles, m.
    pub thickness: f32,
    /// Coulomb friction against obstacles, no unit.
    pub friction: f32,
    /// Drag coefficient, no unit.
    pub drag: f32,
    /// Lift coefficient, no unit.
    pub lift: f32,
}

impl Material {
    /// Constants of one kind of spring.
    pub fn spring(&self, kind: SpringKind) -> SpringConstants {
        self.springs[kind.index()]
    }
}
