//! A cloth falls on something sharp on a ground.

use std::io;

use bevy::{
    math::{Isometry3d, Vec3A},
    prelude::*,
};
use bevy_drape::solver::Solid;

use super::{
    Cloth, Scene, Settings, crossing,
    drape::{self, GROUND},
};

/// What is sharp, with its tip at 0.5 m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sharp {
    /// A capsule of 2 mm radius, upright.
    Needle,
    /// A box of 0.3 m that stands on a corner.
    Corner,
    /// A cone of 0.1 m radius.
    Cone,
}

impl Sharp {
    const TIP: f32 = 0.5;

    /// The solid, where it stands, and the way inside of it up to just below its tip.
    fn solid(self) -> (Solid, Isometry3d, [Vec3A; 2]) {
        let way = |from: f32, below: f32| [from, Self::TIP - below].map(|y| Vec3A::Y * y);
        match self {
            Self::Needle => {
                const RADIUS: f32 = 0.002;
                let capsule = Capsule3d::new(RADIUS, Self::TIP - 2.0 * RADIUS);
                (Solid::Capsule(capsule), Isometry3d::from_translation(Vec3::Y * (Self::TIP / 2.0)), way(0.0, RADIUS))
            }
            Self::Corner => {
                const SIDE: f32 = 0.3;
                let cuboid = Cuboid::from_length(SIDE);
                let corner = cuboid.half_size;
                let turn = Quat::from_rotation_arc(corner.normalize(), Vec3::Y);
                let centre = Self::TIP - corner.length();
                (Solid::Cuboid(cuboid), Isometry3d::new(Vec3::Y * centre, turn), way(centre, 1e-4))
            }
            Self::Cone => {
                let cone = Cone::new(0.1, Self::TIP);
                (Solid::Cone(cone), Isometry3d::from_translation(Vec3::Y * (Self::TIP / 2.0)), way(0.0, 1e-4))
            }
        }
    }
}

/// A grid of a square metre.
pub fn needle(settings: &Settings, sharp: Sharp) -> io::Result<Scene> {
    Ok(below(settings, settings.cloth(&settings.grid(1.0, 1.0).lying().into())?, sharp))
}

/// A cloth that lies in the plane, with the tip below no particle and no edge of a grid. What it counts are triangles that the tip
/// has gone through.
pub fn below(settings: &Settings, cloth: Cloth, sharp: Sharp) -> Scene {
    let aside = Vec3A::new(0.3, 0.0, 0.2) * settings.cell();
    let cloth = cloth.placed(|rest| Vec3A::from(rest) + aside);
    let (solid, pose, way) = sharp.solid();
    let scene = Scene::new(settings, [drape::raised(cloth)]).with_shape(solid, solid, pose).with(GROUND, Vec3::ZERO);
    scene.judged_by("pierced", move |scene| crossing::crossings(scene.triangles(), way).count() as f32)
}
