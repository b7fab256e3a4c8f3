//! Components at random: within the ranges that their documentation gives, or not.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use super::dice::Dice;

pub fn cloth(dice: &mut Dice) -> Cloth {
    let solver = match dice.count(0..=9) {
        0 => ClothSolver::Explicit,
        1 | 2 => ClothSolver::Xpbd,
        _ => ClothSolver::Strands,
    };
    let self_collision = dice.chance(0.3);
    let gravity_scale = dice.one_of([1.0, 1.0, 1.0, 0.0, -1.0, 0.2, 3.0]);
    Cloth {
        solver,
        timing: ClothTiming::default(),
        max_strain: dice.setting(0.001, 0.1),
        substeps: substeps(dice),
        levels: dice.chance(0.2).then(|| levels(dice)),
        max_substeps: dice.one_of([1, 8, 64, 512]),
        // With fewer substeps than are asked for, cloth may go through what it shouldn't.
        max_work: None,
        gravity_scale: if dice.wild(0.1) { dice.anything() } else { gravity_scale },
        tether_slack: dice.chance(0.8).then(|| dice.setting(0.0, 0.01)),
        max_velocity: dice.setting(1.0, 100.0),
        fluid_density: dice.setting(0.0, 1.3),
        collision_margin: dice.setting(0.0, 0.02),
        max_depenetration_velocity: dice.setting(0.5, 3.0),
        self_collision,
        self_distance: dice.setting(0.002, 0.01),
        self_friction: dice.setting(0.0, 0.4),
        collision_layers: dice.one_of([1, 1, 1, 3, 0]),
        collision_mask: dice.one_of([u32::MAX, u32::MAX, u32::MAX, 1, 2]),
    }
}

fn substeps(dice: &mut Dice) -> Option<u32> {
    if dice.wild(0.02) {
        return dice.any(&[0, 10_001, u32::MAX]);
    }
    dice.chance(0.3).then(|| dice.spread(1.0, 40.0) as u32)
}

fn levels(dice: &mut Dice) -> Vec<LevelPass> {
    let count = dice.count(0..=3);
    (0..count).map(|_| LevelPass { stride: dice.one_of([2, 4, 8, 3]), iterations: dice.count(0..=8) }).collect()
}

pub fn fabric(dice: &mut Dice) -> Fabric {
    if dice.chance(0.2)
        && let Some(preset) = dice.any(&Fabric::PRESETS)
    {
        return preset.fabric;
    }
    let [warp, weft] = [dice.setting(30.0, 20_000.0), dice.setting(30.0, 20_000.0)];
    let most_shear = warp * weft / (warp - weft).abs();
    let shear = dice.setting(0.0, 1000.0);
    Fabric {
        density: dice.setting(0.02, 2.0),
        thickness: dice.setting(0.0001, 0.005),
        warp_stiffness: warp,
        weft_stiffness: weft,
        warp_stiffening: dice.setting(0.0, 30.0),
        weft_stiffening: dice.setting(0.0, 30.0),
        compression: dice.setting(0.0, 1.0),
        shear_stiffness: if dice.is_in_range() { shear.min(0.9 * most_shear) } else { shear },
        bending_rigidity: dice.setting(0.0, 0.001),
        stretch_damping: dice.setting(0.0, 0.01),
        bend_damping: dice.setting(0.0, 0.1),
        damping: dice.setting(0.0, 2.0),
        friction: dice.setting(0.0, 1.0),
        drag: dice.setting(0.0, 1.5),
        lift: dice.setting(0.0, 1.0),
    }
}

pub fn springs(dice: &mut Dice) -> ClothSprings {
    ClothSprings {
        structural_stiffness: dice.setting(500.0, 20_000.0),
        shear_stiffness: dice.setting(0.0, 5000.0),
        bend_stiffness: dice.setting(0.0, 500.0),
        structural_damping: dice.setting(0.0, 0.1),
        shear_damping: dice.setting(0.0, 0.1),
        bend_damping: dice.setting(0.0, 0.1),
    }
}

pub fn grip(dice: &mut Dice) -> ClothGrip {
    ClothGrip {
        stiffness: dice.setting(100.0, 10_000.0),
        damping: dice.setting(0.0, 50.0),
        max_force: dice.setting(1.0, 100.0),
        max_speed: dice.setting(2.0, 6.0),
        mass: dice.setting(0.02, 0.2),
    }
}

pub fn wind(dice: &mut Dice) -> Wind {
    let speed = dice.setting(0.0, 30.0);
    let region = match dice.count(0..=5) {
        0 => WindShape::Sphere(Sphere { radius: dice.setting(0.1, 3.0) }),
        1 => WindShape::Cuboid(Cuboid { half_size: Vec3::splat(dice.setting(0.1, 3.0)) }),
        _ => WindShape::Everywhere,
    };
    Wind {
        velocity: dice.direction() * speed,
        region,
        edge: dice.setting(0.0, 1.0),
        gusts: dice.setting(0.0, 1.0),
        gust_period: dice.setting(2.0, 10.0),
        turbulence: dice.setting(0.0, 0.3),
        eddy_size: dice.setting(0.3, 5.0),
        seed: dice.count(0..=u32::MAX),
    }
}

pub fn gravity(dice: &mut Dice) -> ClothGravity {
    let strength = dice.setting(0.0, 25.0);
    let way = if dice.chance(0.7) { Vec3::NEG_Y } else { dice.direction() };
    ClothGravity(way * strength)
}
