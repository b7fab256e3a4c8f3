//! Winds: entities that blow on cloth.

use bevy::{
    math::{DVec3, Isometry3d, Vec3A},
    prelude::*,
};

use crate::{
    frame::{ClothClock, Pass, Poses},
    parameter::{Parameter, check_parameters},
    solver::{Ellipsoid, Gusts, StepReach, WindRegion, WindSource},
};

/// A wind. It presses on triangles by their area and their side to it, so it fills sails and lets flags flutter.
///
/// Its `Transform` turns the velocity and places the region. Several winds add up. One with a value that isn't finite
/// is left out, with one warning.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_drape::prelude::*;
/// # let mut world = World::new();
/// world.spawn(Wind { velocity: Vec3::X * 4.0, gusts: 0.6, ..default() });
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
#[require(Transform, WindMemory)]
pub struct Wind {
    /// Mean velocity in m/s, in the entity's own space, 0 by default. 2 is a light breeze, 8 a fresh one, 20 a gale. From about
    /// 3 on, wind lifts light cloth that only lies on something: give it a region then.
    #[reflect(@Parameter::finite("m/s", (0.0, 30.0)).entered((0.0, 200.0)).titled("Wind speed"))]
    pub velocity: Vec3,
    /// Where it blows.
    pub region: WindShape,
    /// Width in m of the edge, inside of the region, over which the wind dies down, 0 or more, 0.5 by default.
    #[reflect(@Parameter::not_negative("m", (0.0, 5.0)))]
    pub edge: f32,
    /// Strength of gusts as a share of the mean speed, no unit, 0 or more, 0.4 by default. 0 for none, 0.5 for gusty, 1 for
    /// calm to double.
    #[reflect(@Parameter::not_negative("", (0.0, 1.5)).entered((0.0, 10.0)))]
    pub gusts: f32,
    /// Time from gust to gust in s, 0 or more, 4 by default. 2 to 10.
    #[reflect(@Parameter::not_negative("s", (0.5, 20.0)).logarithmic(0.5).entered((0.01, 1e4)))]
    pub gust_period: f32,
    /// Strength of eddies as a share of the mean speed, no unit, 0 or more, 0.15 by default. 0 for none, 0.1 over open land,
    /// 0.3 in a town.
    #[reflect(@Parameter::not_negative("", (0.0, 1.0)).entered((0.0, 10.0)))]
    pub turbulence: f32,
    /// Size of the eddies in m, 0 or more, 1 by default. 0.3 to 5: small ones ripple the cloth, large ones sway it. A cloth of
    /// more than three of them feels them coarser than they are.
    #[reflect(@Parameter::not_negative("m", (0.1, 10.0)).logarithmic(0.1).entered((0.01, 1e4)))]
    pub eddy_size: f32,
    /// Seed of gusts and eddies: the same seed blows the same on every run.
    pub seed: u32,
}

impl Default for Wind {
    /// Still air everywhere that, given a velocity, is a wind with moderate gusts and eddies.
    fn default() -> Self {
        Self {
            velocity: Vec3::ZERO,
            region: WindShape::default(),
            edge: 0.5,
            gusts: 0.4,
            gust_period: 4.0,
            turbulence: 0.15,
            eddy_size: 1.0,
            seed: 0,
        }
    }
}

/// Where a wind blows, in its entity's own space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub enum WindShape {
    /// Everywhere.
    #[default]
    Everywhere,
    /// In a ball, or in the ellipsoid that it is under a scale that isn't uniform.
    Sphere(Sphere),
    /// In a box.
    Cuboid(Cuboid),
}

impl Wind {
    /// The wind in the world, or what is wrong with it.
    fn placed(&self, transform: &GlobalTransform) -> Result<WindSource, String> {
        check_parameters(self, |_| true).map_err(|error| error.to_string())?;
        let (scale, rotation, translation) = transform.to_scale_rotation_translation();
        let pose = Isometry3d::new(translation, rotation);
        let (region, size) = match self.region {
            WindShape::Everywhere => (WindRegion::Everywhere, 0.0),
            WindShape::Sphere(Sphere { radius }) => {
                let shape = Ellipsoid { half_size: radius * scale.abs() };
                let region = if shape.is_ball() {
                    let (centre, radius) = (pose.translation, shape.half_size.max_element());
                    WindRegion::Sphere { centre, radius, edge: self.edge }
                } else {
                    WindRegion::Ellipsoid { pose, shape, edge: self.edge }
                };
                (region, shape.half_size.element_sum())
            }
            WindShape::Cuboid(Cuboid { half_size }) => {
                let half_size = Vec3A::from(half_size * scale.abs());
                let region = WindRegion::Cuboid { pose, half_size, edge: self.edge };
                (region, half_size.min_element())
            }
        };
        // Turned, and mirrored, as the entity is, and as fast at any scale.
        let direction = transform.affine().matrix3 * Vec3A::from(self.velocity);
        let velocity = direction.normalize_or_zero() * self.velocity.length();
        let is_placed = size.is_finite() && size >= 0.0 && velocity.is_finite() && pose.translation.is_finite();
        if !is_placed {
            return Err("give it a finite speed and transform, and a region of a finite size of zero or more".into());
        }
        Ok(WindSource {
            velocity,
            gusts: Gusts {
                strength: self.gusts,
                period: self.gust_period,
                turbulence: self.turbulence,
                eddy_size: self.eddy_size,
                seed: self.seed,
            },
            region,
            origin: Vec3A::ZERO,
            travelled: DVec3::ZERO,
            gusts_passed: 0.0,
        })
    }
}

/// What is remembered of a wind from step to step. A copy of the wind has nothing to remember.
#[derive(Component, Clone, Copy, Debug, Default)]
#[component(clone_behavior = Ignore)]
pub(crate) struct WindMemory {
    /// The wind was left out and a warning said so.
    warned: bool,
    /// How far its air has come, m.
    travelled: DVec3,
    /// How many gusts have come.
    gusts_passed: f64,
}

/// All winds of the coming step, in world space.
#[derive(Resource, Debug, Default)]
pub(crate) struct Winds {
    list: Vec<(Entity, WindSource)>,
    /// How far the world has been shifted since it began, m: gusts and eddies have come along.
    shift: DVec3,
}

impl Winds {
    /// Writes all winds into `felt`, relative to `origin`.
    pub fn around(&self, origin: Vec3, felt: &mut Vec<WindSource>) {
        // As it was before the world was shifted.
        let unshifted = (origin.as_dvec3() - self.shift).as_vec3a();
        let origin = Vec3A::from(origin);
        felt.clear();
        felt.extend(self.list.iter().map(|&(_, wind)| WindSource {
            region: wind.region.relative_to(origin),
            origin: unshifted,
            ..wind
        }));
    }

    /// Whether any of them may move a cloth that has this `reach`, relative to `origin`.
    pub fn blow_in(&self, reach: &StepReach, origin: Vec3) -> bool {
        let relative =
            |&(_, wind): &(Entity, WindSource)| WindSource { region: wind.region.relative_to(origin.into()), ..wind };
        self.list.iter().map(relative).any(|wind| reach.is_in_wind(&wind))
    }

    /// The world has been shifted, and all winds with it.
    pub fn shift(&mut self, by: Vec3) {
        self.shift += by.as_dvec3();
        for (_, wind) in &mut self.list {
            wind.region = wind.region.relative_to(Vec3A::from(-by));
        }
    }
}

/// Reads all winds. Their air goes on with the plugin's schedule, and only with that: for cloth that steps late it has come by so
/// much farther as that step is ahead.
pub(crate) fn gather_winds(
    mut sources: Query<(Entity, &Wind, &mut WindMemory)>,
    mut winds: ResMut<Winds>,
    poses: Poses,
    (time, clock): (Res<Time>, ClothClock),
) {
    let is_late = poses.pass() == Pass::Late;
    let passed = if is_late { clock.ahead_of_fixed() } else { time.delta_secs() };
    winds.list.clear();
    for (entity, wind, mut memory) in &mut sources {
        let pose = poses.compute_global_transform(entity).map_err(|error| error.to_string());
        let placed = pose.and_then(|pose| wind.placed(&pose));
        if let Err(cause) = &placed
            && !memory.warned
        {
            warn!("wind {entity} is left out: {cause}");
        }
        memory.warned = placed.is_err();
        if let Ok(wind) = placed {
            let WindMemory { travelled, gusts_passed, .. } = *memory;
            let mut wind = WindSource { travelled, gusts_passed, ..wind };
            wind.advance(passed);
            if !is_late {
                memory.travelled = wind.travelled;
                memory.gusts_passed = wind.gusts_passed;
            }
            winds.list.push((entity, wind));
        }
    }
    // Sums come out the same whatever order the world keeps its entities in.
    winds.list.sort_unstable_by_key(|&(entity, _)| entity);
}
