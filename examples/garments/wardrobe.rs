//! What is shown: garments, what they are made of, and how they hang.

use core::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use bevy::prelude::*;
use bevy_drape::prelude::*;

use super::{flat, shirt, trousers};

/// Mean length of a mesh's edges, m: no fabric here needs less.
const EDGE: f64 = 0.019;

/// Something to wear, or to lean on.
pub struct Item {
    pub name: &'static str,
    pub fabric: Fabric,
    pub color: Color,
    pub mesh: Mesh,
    pub hook: Hook,
    /// Where it hangs, from the rod's middle.
    pub hung: Transform,
    /// Where it begins to fall on a ball, from the top of that.
    pub dropped: Transform,
}

/// What a garment hangs by.
pub enum Hook {
    /// It lies on the arms of a hanger, and nothing else holds it.
    Hanger,
    /// A hoop in a skirt's waist.
    Hoop,
    /// Pegs at some places of it, m.
    Pegs(Vec<Vec3>),
}

impl Hook {
    pub fn pins(&self) -> Pins {
        /// Reach of a peg, m.
        const REACH: f32 = 0.025;
        match self {
            Self::Hanger => Pins::none(),
            Self::Hoop => Pins::predicate(|vertex| vertex.position.length() < flat::WAIST as f32 + 1e-3),
            Self::Pegs(places) => {
                let places = places.clone();
                Pins::predicate(move |vertex| places.iter().any(|peg| peg.distance(vertex.position) < REACH))
            }
        }
    }
}

/// All of them, from left to right.
pub fn items() -> [Item; 5] {
    let lying = Quat::from_rotation_x(-FRAC_PI_2);
    let both_sides = |x: f32| Hook::Pegs(vec![Vec3::X * x, Vec3::NEG_X * x]);
    let hung = |x: f32, y: f32, turn: f32| Transform::from_xyz(x, y, 0.0).with_rotation(Quat::from_rotation_y(turn));
    let on_corner = Quat::from_rotation_z(FRAC_PI_4);
    [
        Item {
            name: "T-shirt",
            fabric: Fabric::COTTON_JERSEY,
            color: Color::srgb(0.86, 0.83, 0.76),
            mesh: shirt::shirt(EDGE),
            hook: Hook::Hanger,
            hung: hung(-1.5, -0.36, 0.25),
            dropped: Transform::from_xyz(0.0, 0.14, -0.06).with_rotation(lying),
        },
        Item {
            name: "Circle skirt",
            fabric: Fabric::SILK,
            color: Color::srgb(0.70, 0.17, 0.26),
            mesh: flat::skirt(EDGE),
            hook: Hook::Hoop,
            hung: hung(-0.72, -0.2, 0.0),
            dropped: Transform::from_xyz(0.0, 0.03, 0.0),
        },
        Item {
            name: "Poncho",
            fabric: Fabric::WOOL_FLANNEL,
            color: Color::srgb(0.26, 0.40, 0.42),
            mesh: flat::poncho(EDGE),
            hook: both_sides(flat::NECK.x as f32),
            hung: hung(0.08, -0.01, 0.2),
            dropped: Transform::from_xyz(0.0, 0.03, 0.0),
        },
        Item {
            name: "Trousers",
            fabric: Fabric::DENIM,
            color: Color::srgb(0.15, 0.22, 0.38),
            mesh: trousers::trousers(EDGE),
            hook: both_sides(trousers::WAIST as f32),
            hung: hung(0.87, -0.01, -0.2),
            dropped: Transform::from_xyz(0.0, 0.16, -0.45).with_rotation(lying),
        },
        Item {
            name: "Cushion cover",
            fabric: Fabric::COTTON_WOVEN,
            color: Color::srgb(0.80, 0.60, 0.25),
            mesh: flat::cushion(EDGE),
            hook: Hook::Pegs(vec![Vec3::new(flat::CUSHION as f32, flat::CUSHION as f32, 0.0)]),
            hung: Transform { rotation: Quat::from_rotation_y(-0.5) * on_corner, ..hung(1.5, -0.32, 0.0) },
            dropped: Transform::from_xyz(0.0, 0.12, 0.0).with_rotation(Quat::from_rotation_y(0.4) * lying),
        },
    ]
}
