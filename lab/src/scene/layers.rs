//! Three cloths fall on each other, on a ball over a ground.

use std::io;

use bevy::{math::Vec3A, prelude::*};

use super::{
    Scene, Settings, crossing,
    drape::{self, CENTRE},
};

const CLOTHS: u32 = 3;

/// From one to the next, m.
const APART: f32 = 0.03;

/// By how much each is turned against the one below, rad: their cells don't lie on each other.
const TURN: f32 = 0.35;

/// A square metre each. What it counts is the share of rays from the ball on which the cloths aren't in their order.
pub fn layers(settings: &Settings) -> io::Result<Scene> {
    let cloth = |i: u32| {
        let turn = Quat::from_rotation_y(i as f32 * TURN);
        let cloth = settings.cloth(&settings.grid(1.0, 1.0).lying().into())?;
        Ok(drape::raised(cloth.placed(|rest| Vec3A::from(turn * rest) + Vec3A::Y * (i as f32 * APART))))
    };
    let cloths = (0..CLOTHS).map(cloth).collect::<io::Result<Vec<_>>>()?;
    Ok(drape::on_ball(settings, cloths).judged_by("out_of_order", out_of_order))
}

/// Rays from the centre of the ball to all sides of its upper half, by which all cloths lie on it from the inside out.
fn out_of_order(scene: &Scene) -> f32 {
    const ACROSS: i32 = 10;
    let (mut rays, mut wrong) = (0, 0);
    for (x, z) in (-ACROSS..=ACROSS).flat_map(|x| (-ACROSS..=ACROSS).map(move |z| (x, z))) {
        let way = Vec3A::new(x as f32, ACROSS as f32, z as f32) * (1.0 / ACROSS as f32 + 1e-3);
        let first = |cloth: usize| {
            let cloth = &scene.cloths[cloth];
            let at = |corners: &[u32; 3]| corners.map(|i| cloth.particles.position[i as usize]);
            let triangles = cloth.topology.triangles.iter().map(at);
            let centre = Vec3A::from(CENTRE);
            crossing::crossings(triangles, [centre, centre + way]).reduce(f32::min)
        };
        let met: Vec<f32> = (0..scene.cloths.len()).filter_map(first).collect();
        if met.len() == scene.cloths.len() {
            rays += 1;
            wrong += u32::from(!met.is_sorted());
        }
    }
    wrong as f32 / rays.max(1) as f32
}
