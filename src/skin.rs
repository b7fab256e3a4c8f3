//! How far clothes may be from the body that wears them: `ClothSkin`, and what it makes of a mesh.

mod inertia;
pub(crate) mod outfit;
pub(crate) mod teleport;

pub use inertia::ClothInertia;
pub use outfit::{ClothOutfit, ClothWornBy};
pub use teleport::{ClothTeleport, TeleportMode};

use bevy::{
    mesh::{MeshVertexAttribute, VertexAttributeValues, VertexFormat},
    prelude::*,
};

use crate::{
    error::ClothError,
    parameter::{Parameter, check_parameters},
    pins::PinTarget,
    solver::{Backstop, SkinLimit, build::weld::NO_PARTICLE},
};

/// The vertex attribute that says how far each vertex of clothes may be from where its skeleton has it, m: a max distance, times
/// [`ClothMap::Painted::scale`]. 0 is fixed to the skeleton.
///
/// In glTF files its name is `_CLOTH`, in any format. Without the feature `gltf`, register it with Bevy's plugin, which drops the
/// underscore: `GltfPlugin::default().add_custom_vertex_attribute("CLOTH", ATTRIBUTE_CLOTH)`.
pub const ATTRIBUTE_CLOTH: MeshVertexAttribute =
    MeshVertexAttribute::new("Cloth", 0x6472_6170_6551, VertexFormat::Float32);

/// The vertex attribute that says how far beneath the animated surface the backstop of each vertex begins, m: times
/// [`ClothSkin::backstop`], if that is set. Below 0 there is none. In glTF files its name is `_CLOTH_BACKSTOP`, in any format.
pub const ATTRIBUTE_CLOTH_BACKSTOP: MeshVertexAttribute =
    MeshVertexAttribute::new("ClothBackstop", 0x6472_6170_6552, VertexFormat::Float32);

/// Vertices that may be less than this far from their skeleton, m, are fixed to it.
pub(crate) const FIXED: f32 = 1e-4;

/// How closely a [`Cloth`](crate::prelude::Cloth) on a skinned mesh follows its skeleton. Without it, its pins do, and what is painted
/// as [`ATTRIBUTE_CLOTH`].
///
/// The limits are those of Unreal Engine and Unity: a max distance from where the skeleton alone would have a vertex, and a backstop,
/// a ball beneath the animated surface that cloth stays out of. On meshes without a skeleton only `meets_others` does anything.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_drape::prelude::*;
/// # fn dress(mut commands: Commands, cape: Entity) {
/// commands.entity(cape).insert((
///     Cloth::default(),
///     ClothSkin { max_distance: ClothMap::Uniform(0.4), backstop: Some(0.01), ..default() },
///     Pins::edge(ClothEdge::Top),
/// ));
/// # }
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
pub struct ClothSkin {
    /// Largest distance of each vertex from where its skeleton has it, m. As painted in [`ATTRIBUTE_CLOTH`] by default, and
    /// infinite where nothing is.
    pub max_distance: ClothMap,
    /// How far beneath the animated surface the backstop begins, m, 0 or more, `None` by default, for no backstop. 0 to 0.05. Where
    /// [`ATTRIBUTE_CLOTH_BACKSTOP`] is painted that counts, and this is a factor on it, 1 for none.
    #[reflect(@Parameter::not_negative("m", (0.0, 0.1)).entered((0.0, 10.0)).shown_as("mm", 1e3).titled("Backstop depth"))]
    pub backstop: Option<f32>,
    /// Radius of the backstop's ball, m, greater than 0, 0.1 by default: about that of the limb, so that cloth can slip off
    /// sideways. 10 is all but a plane.
    #[reflect(@Parameter::positive("m", (0.02, 1.0)).logarithmic(0.02).entered((0.001, 100.0)))]
    pub backstop_radius: f32,
    /// Own frequency of a spring that draws each vertex to where its skeleton has it, Hz, 0 or more, 0 by default, for none. 0.5 to 5.
    /// The same for any fabric and frame rate. The cloth's weight hangs through by g / (2 pi f)², 6 cm at 2 Hz.
    #[reflect(@Parameter::not_negative("Hz", (0.0, 10.0)).entered((0.0, 1000.0)))]
    pub pull: f32,
    /// Damping ratio of that spring, no unit, 0 or more, 1 by default, which doesn't swing.
    #[reflect(@Parameter::not_negative("", (0.0, 2.0)).entered((0.0, 100.0)))]
    pub pull_damping: f32,
    /// Whether it meets the bodies of other characters too. By default it meets only the [`ClothBody`](crate::prelude::ClothBody) of
    /// its own, if there is one: bodies that pass through each other, as those of a crowd do, would tear at it.
    pub meets_others: bool,
}

impl Default for ClothSkin {
    fn default() -> Self {
        Self {
            max_distance: ClothMap::default(),
            backstop: None,
            backstop_radius: 0.1,
            pull: 0.0,
            pull_damping: 1.0,
            meets_others: false,
        }
    }
}

/// A number for each vertex of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub enum ClothMap {
    /// As [`ATTRIBUTE_CLOTH`] has it. What is painted below 0, or isn't finite, counts as 0, with one warning.
    Painted {
        /// Factor on what is painted, no unit, 0 or more, 1 by default.
        #[reflect(@Parameter::within("", (0.0, f32::INFINITY), (0.0, 2.0)).entered((0.0, 1000.0)).titled("Paint scale"))]
        scale: f32,
        /// For meshes that nothing is painted on, m, 0 or more, infinity by default, for free.
        #[reflect(@Parameter::within("m", (0.0, f32::INFINITY), (0.0, 1.0)).entered((0.0, 1000.0)).titled("Without paint"))]
        missing: f32,
    },
    /// The same for all, m, 0 or more, infinity for free.
    Uniform(
        /// For every vertex, m, 0 or more: 0 is fixed to the skeleton. 0.1 to 1 for a cape.
        #[reflect(@Parameter::within("m", (0.0, f32::INFINITY), (0.0, 1.0)).entered((0.0, 1000.0)).titled("Everywhere"))]
        f32,
    ),
}

impl Default for ClothMap {
    /// What is painted, in m; without paint all are free.
    fn default() -> Self {
        Self::Painted { scale: 1.0, missing: f32::INFINITY }
    }
}

/// What a [`ClothSkin`] makes of the particles of a mesh.
pub(crate) struct ParticleLimits {
    pub limits: Vec<SkinLimit>,
    /// The first vertex that is painted with what is no distance.
    pub badly_painted: Option<usize>,
}

impl ParticleLimits {
    /// Fixes particles that may be nowhere else to the skeleton, but for those that are pinned to something already.
    pub fn fix(&self, targets: &mut [PinTarget]) {
        for (target, limit) in targets.iter_mut().zip(&self.limits) {
            if limit.max_distance < FIXED && *target == PinTarget::Free {
                *target = PinTarget::Cloth;
            }
        }
    }
}

impl ClothSkin {
    /// Checks the ranges of all settings.
    ///
    /// # Errors
    ///
    /// [`ClothError::InvalidParameter`] with the first field that is out of its range.
    pub fn validate(&self) -> Result<(), ClothError> {
        check_parameters(self, |_| true)
    }

    /// The limits of `count` particles, of which each vertex of `mesh` is one: the least of its vertices'.
    pub(crate) fn limits(&self, mesh: &Mesh, particle_of_vertex: &[u32], count: usize) -> ParticleLimits {
        let uniform = self.backstop.map(|distance| Backstop { distance, radius: self.backstop_radius });
        let backstops = self.painted_backstops(mesh, particle_of_vertex, count).unwrap_or(vec![uniform; count]);
        let limit = |max_distance| -> Vec<SkinLimit> {
            backstops.iter().map(|&backstop| SkinLimit { max_distance, backstop }).collect()
        };
        let (scale, missing) = match self.max_distance {
            ClothMap::Painted { scale, missing } => (scale, missing),
            ClothMap::Uniform(distance) => (0.0, distance),
        };
        let is_painted = matches!(self.max_distance, ClothMap::Painted { .. });
        let Some(VertexAttributeValues::Float32(paint)) =
            mesh.try_attribute(ATTRIBUTE_CLOTH).ok().filter(|_| is_painted)
        else {
            return ParticleLimits { limits: limit(missing), badly_painted: None };
        };
        let mut limits = limit(f32::INFINITY);
        for (&paint, &particle) in
            paint.iter().zip(particle_of_vertex).filter(|(_, particle)| **particle != NO_PARTICLE)
        {
            let distance = if paint.is_finite() { (scale * paint).max(0.0) } else { 0.0 };
            let known = &mut limits[particle as usize].max_distance;
            *known = known.min(distance);
        }
        let is_bad = |paint: &f32| !paint.is_finite() || *paint < 0.0;
        ParticleLimits { limits, badly_painted: paint.iter().position(is_bad) }
    }

    /// The backstop of each particle, the nearest to the surface of its vertices', where a mesh has them painted.
    fn painted_backstops(
        &self,
        mesh: &Mesh,
        particle_of_vertex: &[u32],
        count: usize,
    ) -> Option<Vec<Option<Backstop>>> {
        let Ok(VertexAttributeValues::Float32(paint)) = mesh.try_attribute(ATTRIBUTE_CLOTH_BACKSTOP) else {
            return None;
        };
        let mut backstops: Vec<Option<Backstop>> = vec![None; count];
        let is_any = |&(&paint, &particle): &(&f32, &u32)| paint >= 0.0 && paint.is_finite() && particle != NO_PARTICLE;
        for (&paint, &particle) in paint.iter().zip(particle_of_vertex).filter(is_any) {
            let distance = self.backstop.unwrap_or(1.0) * paint;
            let known = &mut backstops[particle as usize];
            if known.is_none_or(|known| known.distance > distance) {
                *known = Some(Backstop { distance, radius: self.backstop_radius });
            }
        }
        Some(backstops)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(paint: Vec<f32>) -> Mesh {
        Mesh::from(Triangle3d::default()).with_inserted_attribute(ATTRIBUTE_CLOTH, paint)
    }

    fn distances(skin: &ClothSkin, mesh: &Mesh) -> Vec<f32> {
        skin.limits(mesh, &[0, 1, 1], 2).limits.iter().map(|limit| limit.max_distance).collect()
    }

    #[test]
    fn a_particle_has_the_least_of_what_is_painted_on_its_vertices() {
        let skin = ClothSkin { max_distance: ClothMap::Painted { scale: 2.0, missing: 7.0 }, ..default() };
        assert_eq!(distances(&skin, &mesh(vec![0.5, 0.25, 0.1])), [1.0, 0.2]);
        assert_eq!(distances(&skin, &Triangle3d::default().into()), [7.0; 2], "nothing is painted");
        let uniform = ClothSkin { max_distance: ClothMap::Uniform(0.3), ..default() };
        assert_eq!(distances(&uniform, &mesh(vec![0.5, 0.25, 0.1])), [0.3; 2]);
    }

    #[test]
    fn a_painted_backstop_counts_and_the_setting_is_a_factor_on_it() {
        let paint = vec![0.02_f32, -1.0, 0.01];
        let mesh = Mesh::from(Triangle3d::default()).with_inserted_attribute(ATTRIBUTE_CLOTH_BACKSTOP, paint);
        let distances = |skin: ClothSkin, particles: &[u32]| {
            let limits = skin.limits(&mesh, particles, 3).limits;
            limits.iter().map(|limit| limit.backstop.map(|backstop| backstop.distance)).collect::<Vec<_>>()
        };
        assert_eq!(distances(ClothSkin::default(), &[0, 1, 2]), [Some(0.02), None, Some(0.01)]);
        let doubled = ClothSkin { backstop: Some(2.0), ..default() };
        assert_eq!(distances(doubled, &[0, 0, 0]), [Some(0.02), None, None], "the nearest counts");
    }

    #[test]
    fn paint_that_is_no_distance_fixes_and_is_told_of() {
        let bad = mesh(vec![1.0, f32::NAN, 1.0]);
        let limits = ClothSkin::default().limits(&bad, &[0, 1, 2], 3);
        assert_eq!(limits.badly_painted, Some(1));
        let mut targets = [PinTarget::World, PinTarget::Free, PinTarget::Free];
        limits.fix(&mut targets);
        assert_eq!(targets, [PinTarget::World, PinTarget::Cloth, PinTarget::Free]);
        assert_eq!(ClothSkin::default().limits(&mesh(vec![-1.0, 0.0, 1.0]), &[0, 1, 2], 3).badly_painted, Some(0));
    }

    #[test]
    fn what_is_out_of_range_is_refused() {
        assert_eq!(ClothSkin::default().validate(), Ok(()));
        let map = |max_distance| ClothSkin { max_distance, ..default() };
        for bad in [-0.1, f32::NAN] {
            assert!(map(ClothMap::Uniform(bad)).validate().is_err());
            assert!(map(ClothMap::Painted { scale: bad, missing: 1.0 }).validate().is_err());
            assert!(map(ClothMap::Painted { scale: 1.0, missing: bad }).validate().is_err());
            assert!(ClothSkin { backstop: Some(bad), ..default() }.validate().is_err());
            assert!(ClothSkin { pull: bad, ..default() }.validate().is_err());
        }
        assert!(ClothSkin { backstop_radius: 0.0, ..default() }.validate().is_err());
    }
}
