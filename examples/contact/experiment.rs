//! The experiments by name.

use std::io;

use bevy::math::Vec3;
use bevy_drape::solver::SelfCollision;
use clap::ValueEnum;

use super::scene::{Scene, Settings, bullet, drape, fold, layers, needle, ribbon, storm, twist};

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Experiment {
    /// On a ball over a ground
    Drape,
    /// Out of waves into folds
    Fold,
    /// Into a pile
    Ribbon,
    /// Three turns, and back
    Twist,
    /// Three cloths on each other
    Layers,
    /// A flag, until it gets calm
    Storm,
    /// On a capsule of 2 mm radius
    Needle,
    /// A ball of 20 mm radius at 30 m/s
    Bullet,
}

impl Experiment {
    /// One line that says what is to be seen.
    pub fn about(self) -> &'static str {
        match self {
            Self::Drape => "A square metre falls on a ball",
            Self::Fold => "A square metre stands on its edge and falls in folds",
            Self::Ribbon => "A ribbon of 2 m falls end first",
            Self::Twist => "A strip is turned three times at its ends, and back",
            Self::Layers => "Three square metres fall on each other, on a ball",
            Self::Storm => "A flag in gusts of 15 to 25 m/s from all sides, until it gets calm",
            Self::Needle => "A square metre falls on a needle of 2 mm radius",
            Self::Bullet => "A ball of 20 mm radius hits a cloth at 30 m/s",
        }
    }

    pub fn scene(self, n: u32) -> io::Result<Scene> {
        let settings = |self_collision| Settings::standard(n, 300, self_collision);
        let (alone, robust) = (settings(SelfCollision::Off), settings(SelfCollision::Robust));
        match self {
            Self::Drape => {
                let cloth = alone.cloth(&alone.grid(1.0, 1.0).lying().into())?;
                Ok(drape::on_ball(&alone, [drape::raised(cloth)]))
            }
            Self::Fold => fold::fold(&robust),
            Self::Ribbon => ribbon::ribbon(&robust),
            Self::Twist => twist::twist(&robust),
            Self::Layers => layers::layers(&robust),
            Self::Storm => storm::storm(&robust),
            Self::Needle => needle::needle(&alone, needle::Sharp::Needle),
            Self::Bullet => bullet::ball(&alone, 0.02),
        }
    }

    /// Where the camera is and what it looks at, m.
    pub fn view(self) -> (Vec3, Vec3) {
        match self {
            Self::Ribbon => (Vec3::new(0.4, 0.35, 0.8), Vec3::new(0.0, 0.08, 0.0)),
            Self::Twist => (Vec3::new(0.3, 1.1, 1.6), Vec3::Y),
            Self::Storm | Self::Bullet => (Vec3::new(0.7, 1.5, 2.0), Vec3::Y),
            Self::Fold => (Vec3::new(0.7, 0.8, 1.5), Vec3::new(0.0, 0.15, 0.0)),
            Self::Drape | Self::Layers | Self::Needle => (Vec3::new(0.6, 1.0, 1.6), Vec3::new(0.0, 0.25, 0.0)),
        }
    }
}
