//! bevy_silk's solver, called as its own system calls it, without an `App`.

use bevy::{
    math::{Mat4, Vec3},
    platform::collections::HashMap,
    transform::components::GlobalTransform,
};
use bevy_drape_peers::{
    line::Line,
    measure::{self, Name, Peer},
    scene::{Cloth as Scene, FRAME, GRAVITY},
};
use bevy_silk::{
    components::cloth::Cloth,
    prelude::{ClothConfig, StickGeneration, StickLen, StickMode, VertexAnchor, rectangle_mesh},
};

/// What is swept: passes over the sticks in a frame.
const DEPTHS: [u8; 4] = [5, 10, 20, 50];

/// How the cloth is set up.
#[derive(Clone, Copy)]
struct Variant {
    /// Share of the velocity, and of the acceleration, that is lost in a frame.
    friction: f32,
    sticks: StickGeneration,
}

/// As it comes.
const DEFAULT: Variant = Variant { friction: 0.01, sticks: StickGeneration::Quads };

/// As near to the scene as it gets: without damping and with sticks along a diagonal of each cell.
const LIKE_THE_SCENE: Variant = Variant { friction: 0.0, sticks: StickGeneration::Triangles };

/// Runs all settings.
pub fn sweep(scene: &Scene, each: fn(&Line)) {
    let run = |setting: &str, depth, variant| {
        let name = Name { system: "bevy_silk", version: "0.10.0", setting };
        each(&measure::run(&name, scene, &mut Silk::new(scene, depth, variant)));
    };
    run("depth 5, its defaults", 5, DEFAULT);
    for depth in DEPTHS {
        run(&format!("depth {depth}"), depth, LIKE_THE_SCENE);
    }
}

/// The cloth in bevy_silk.
struct Silk {
    cloth: Cloth,
    config: ClothConfig,
}

impl Silk {
    fn new(scene: &Scene, depth: u8, variant: Variant) -> Self {
        // Its own grid, because its sticks follow from the order of a triangle's corners.
        let steps = (Vec3::X * scene.spacing(), Vec3::Z * scene.spacing());
        let mesh = rectangle_mesh((scene.n, scene.n), steps, Vec3::Y);
        let indices: Vec<u32> = mesh.indices().expect("it has been given some").iter().map(|i| i as u32).collect();
        let rest: Vec<Vec3> = scene.rest.iter().map(|&p| p.into()).collect();
        let pins: HashMap<usize, VertexAnchor> = scene.pins.iter().map(|&pin| (pin, VertexAnchor::default())).collect();
        let mut cloth = Cloth::new(
            &rest,
            &indices,
            pins,
            variant.sticks,
            StickLen::default(),
            StickMode::default(),
            &Mat4::IDENTITY,
        );
        cloth.current_point_positions = scene.start.iter().map(|&p| p.into()).collect();
        cloth.previous_point_positions = cloth.current_point_positions.clone();
        let config = ClothConfig {
            gravity: Vec3::NEG_Y * GRAVITY,
            friction: variant.friction,
            sticks_computation_depth: depth,
            ..ClothConfig::default()
        };
        Self { cloth, config }
    }
}

impl Peer for Silk {
    /// What its system `update` does with a cloth, with no wind.
    fn step(&mut self) {
        let Self { cloth, config } = self;
        cloth.update_points(1.0 - config.friction, config.smoothed_acceleration(config.gravity, FRAME));
        cloth.update_anchored_points(&GlobalTransform::IDENTITY, |_| None);
        cloth.update_sticks(config.sticks_computation_depth);
    }

    fn positions(&self) -> Vec<[f32; 3]> {
        self.cloth.current_point_positions.iter().map(Vec3::to_array).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_sticks_are_the_structural_springs_and_a_diagonal_a_cell() {
        let scene = Scene::hanging(7);
        let sticks = |variant| Silk::new(&scene, 5, variant).cloth.stick_lengths;
        let structural = scene.pairs(1).count();
        assert_eq!(sticks(DEFAULT).len(), structural);
        assert_eq!(sticks(LIKE_THE_SCENE).len(), structural + 6 * 6);
        let sticks = sticks(LIKE_THE_SCENE);
        assert!(scene.pairs(1).all(|[a, b]| sticks.contains_key(&[a, b]) || sticks.contains_key(&[b, a])));
    }

    #[test]
    fn its_defaults_are_those_that_are_named_so() {
        let config = ClothConfig::default();
        assert_eq!((config.friction, config.sticks_computation_depth), (DEFAULT.friction, 5));
        assert_eq!(StickGeneration::default(), DEFAULT.sticks);
    }

    #[test]
    fn free_cloth_falls_as_a_stone() {
        let scene = Scene::free(8);
        let mut silk = Silk::new(&scene, 5, LIKE_THE_SCENE);
        for _ in 0..30 {
            silk.step();
        }
        let fall = -0.5 * GRAVITY * 0.5 * (0.5 + FRAME);
        assert!((measure::mean_height(&silk.positions()) - fall).abs() < 1e-3);
    }
}
