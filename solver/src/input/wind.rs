//! Winds that may reach a cloth.

use bevy_math::{DVec3, Isometry3d, Vec3A};

use crate::shape::{Ellipsoid, Solid};

/// Where a wind blows, relative to the cloth's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WindRegion {
    /// Everywhere.
    Everywhere,
    /// In a sphere.
    Sphere {
        /// Centre, m.
        centre: Vec3A,
        /// Radius, m.
        radius: f32,
        /// Width of the edge inside of which the wind dies down, m.
        edge: f32,
    },
    /// In an ellipsoid.
    Ellipsoid {
        /// Centre and axes of the ellipsoid.
        pose: Isometry3d,
        /// Half of its lengths along its axes.
        shape: Ellipsoid,
        /// Width of the edge inside of which the wind dies down, m.
        edge: f32,
    },
    /// In a box.
    Cuboid {
        /// Centre and axes of the box.
        pose: Isometry3d,
        /// Half of its lengths along its axes, m.
        half_size: Vec3A,
        /// Width of the edge inside of which the wind dies down, m.
        edge: f32,
    },
}

impl WindRegion {
    /// The same region with positions relative to `origin`.
    pub fn relative_to(self, origin: Vec3A) -> Self {
        match self {
            Self::Everywhere => self,
            Self::Sphere { centre, radius, edge } => Self::Sphere { centre: centre - origin, radius, edge },
            Self::Ellipsoid { pose, shape, edge } => {
                let pose = Isometry3d::new(pose.translation - origin, pose.rotation);
                Self::Ellipsoid { pose, shape, edge }
            }
            Self::Cuboid { pose, half_size, edge } => {
                let pose = Isometry3d::new(pose.translation - origin, pose.rotation);
                Self::Cuboid { pose, half_size, edge }
            }
        }
    }

    /// How deep inside `point` is, m: its distance from the border. Negative outside, by that distance at most.
    pub(crate) fn depth(&self, point: Vec3A) -> f32 {
        match *self {
            Self::Everywhere => f32::INFINITY,
            Self::Sphere { centre, radius, .. } => radius - point.distance(centre),
            Self::Ellipsoid { pose, shape, .. } => {
                let local = pose.inverse().transform_point(point);
                -Solid::Ellipsoid(shape).surface(local).distance
            }
            Self::Cuboid { pose, half_size, .. } => {
                let local = pose.inverse().transform_point(point);
                (half_size - local.abs()).min_element()
            }
        }
    }

    /// Width of the edge inside of which the wind dies down, m.
    fn edge(&self) -> f32 {
        match *self {
            Self::Everywhere => 0.0,
            Self::Sphere { edge, .. } | Self::Ellipsoid { edge, .. } | Self::Cuboid { edge, .. } => edge,
        }
    }

    /// Share of the wind that is felt at `point`: 1 inside, 0 outside, smooth over the edge.
    pub fn weight(&self, point: Vec3A) -> f32 {
        let (depth, edge) = (self.depth(point), self.edge());
        if depth <= 0.0 {
            0.0
        } else if depth >= edge {
            1.0
        } else {
            let t = depth / edge;
            t * t * (3.0 - 2.0 * t)
        }
    }
}

/// A wind that may reach a cloth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindSource {
    /// Mean velocity, m/s.
    pub velocity: Vec3A,
    /// What is added to the mean: gusts and turbulence.
    pub gusts: Gusts,
    /// Where it blows.
    pub region: WindRegion,
    /// The cloth's origin in the noise, m, which belongs to the world and not to the cloth.
    pub origin: Vec3A,
    /// How far its air has come since it began to blow, m: what carries the eddies.
    pub travelled: DVec3,
    /// How many gusts have come since it began to blow.
    pub gusts_passed: f64,
}

impl WindSource {
    /// Lets the air move on for `dt` seconds. Summed up step by step, so that a change of wind now moves nothing that
    /// has come before.
    pub fn advance(&mut self, dt: f32) {
        self.travelled += (self.velocity * dt).as_dvec3();
        self.gusts_passed += f64::from(dt / self.gusts.period.max(1e-3));
    }
}

/// How a wind differs from its mean, in space and time. The same seed gives the same wind on every run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gusts {
    /// Strength of slow gusts as a share of the mean speed: 0 for none, 1 for from calm to twice the speed.
    pub strength: f32,
    /// Time from gust to gust, s.
    pub period: f32,
    /// Strength of eddies as a share of the mean speed. 0.1 over open land, 0.3 in a town.
    pub turbulence: f32,
    /// Size of the eddies, m.
    pub eddy_size: f32,
    /// Seed of the noise.
    pub seed: u32,
}
