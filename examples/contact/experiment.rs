//! The experiments by name.

use std::io;

use bevy::math::Vec3;
use clap::ValueEnum;
use drape_lab::scene::{Scene, Settings, bullet, drape, fold, layers, needle, ribbon, storm, twist};

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

    pub fn scene(self, n: u32, substeps: Option<u32>) -> io::Result<Scene> {
        let settings = |self_collision| Settings { substeps, ..Settings::standard(n, 300, self_collision) };
        let (alone, self_colliding) = (settings(false), settings(true));
        match self {
            Self::Drape => {
                let cloth = alone.cloth(&alone.grid(1.0, 1.0).lying().into())?;
                Ok(drape::on_ball(&alone, [drape::raised(cloth)]))
            }
            Self::Fold => fold::fold(&self_colliding),
            Self::Ribbon => ribbon::ribbon(&self_colliding),
            Self::Twist => twist::twist(&self_colliding),
            Self::Layers => layers::layers(&self_colliding),
            Self::Storm => storm::storm(&self_colliding),
            Self::Needle => needle::needle(&alone, needle::Sharp::Needle),
            Self::Bullet => bullet::ball(&alone, 0.02),
        }
    }

    /// Where the camera is and what it looks at, m.
    pub fn view(self) -> (Vec3, Vec3) {
        match self {
            Self::Ribbon => (Vec3::new(0.25, 0.28, 0.5), Vec3::new(0.0, 0.04, 0.0)),
            Self::Twist => (Vec3::new(0.35, 1.15, 1.05), Vec3::Y),
            Self::Storm => (Vec3::new(-0.3, 1.4, 2.5), Vec3::new(-0.35, 0.95, 0.0)),
            Self::Bullet => (Vec3::new(0.45, 1.45, 1.05), Vec3::new(0.0, 1.0, 0.0)),
            Self::Fold => (Vec3::new(0.95, 0.3, 0.35), Vec3::new(0.25, 0.06, 0.0)),
            Self::Drape | Self::Layers => (Vec3::new(0.45, 0.75, 1.15), Vec3::new(0.0, 0.2, 0.0)),
            Self::Needle => (Vec3::new(0.4, 0.85, 1.1), Vec3::new(0.0, 0.25, 0.0)),
        }
    }
}
