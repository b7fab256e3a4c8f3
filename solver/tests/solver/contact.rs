//! Cloth and obstacles.

use bevy_math::{
    Dir3, Isometry3d, Quat, Vec3, Vec3A, ops,
    primitives::{Capsule3d, Cone, Cuboid, Cylinder, InfinitePlane3d, Sphere},
};
use drape_solver::{Ellipsoid, Material, Method, Obstacle, Shape, Solid, TaperedCapsule};
use proptest::prelude::*;

use crate::{
    bench_bed::{Bed, GRAVITY, STABLE, bits},
    fixtures::{
        hand::{Grip, hand},
        material::{Springs, springs},
    },
};

fn still(shape: Solid, place: Vec3) -> Obstacle {
    let pose = Isometry3d::from_translation(place);
    Obstacle::still(shape, pose)
}

fn cotton(friction: f32, thickness: f32) -> Material {
    Material { friction, thickness, ..springs(Springs::default()) }
}

/// How deep the deepest particle is below the surface that it should keep to, m.
fn depth(bed: &Bed) -> f32 {
    let depth_in = |obstacle: &Obstacle, p: Vec3A| {
        let Shape::Solid(solid) = obstacle.shape else { return 0.0 };
        bed.material.thickness - solid.surface(obstacle.end.inverse().transform_point(p)).distance
    };
    let particles = bed.particles.position.iter();
    particles.flat_map(|&p| bed.obstacles.iter().map(move |o| depth_in(o, p))).fold(0.0, f32::max)
}

/// A square metre as a game would run it.
fn sheet(method: Method, n: u32, material: Material) -> Bed {
    Bed::lying(n, material).like_a_game(method)
}

/// A cloth that lies on a slope of `slope` rad, and how far it has come after two seconds.
fn slid(method: Method, friction: f32, slope: f32) -> f32 {
    let turn = Quat::from_rotation_z(-slope);
    let mut bed = sheet(method, 8, cotton(friction, 0.0));
    for position in &mut bed.particles.position {
        *position = turn * *position;
    }
    let normal = Dir3::new(turn * Vec3::Y).unwrap();
    bed.obstacles = vec![still(Solid::HalfSpace(InfinitePlane3d { normal }), Vec3::ZERO)];
    bed.run(2.0);
    bed.centre().length()
}

#[test]
fn friction_holds_below_its_angle_and_lets_slide_above() {
    for (method, friction) in STABLE.into_iter().flat_map(|method| [0.2_f32, 0.5, 0.9].map(|f| (method, f))) {
        let angle = ops::atan(friction);
        let [below, above] = [0.98, 1.02].map(|share| slid(method, friction, share * angle));
        assert!(below < 0.002, "{method:?}, {friction}: {below} m");
        assert!(above > 0.02, "{method:?}, {friction}: {above} m");
    }
}

#[test]
fn a_cloth_slides_with_the_acceleration_that_friction_leaves() {
    let (friction, slope) = (0.3, 0.6);
    let expected = 0.5 * GRAVITY * (ops::sin(slope) - friction * ops::cos(slope)) * 4.0;
    for method in STABLE {
        let way = slid(method, friction, slope);
        assert!((way / expected - 1.0).abs() < 0.02, "{method:?}: {way} for {expected} m");
    }
}

#[test]
fn a_cloth_on_a_sphere_stays_on_it_outside_of_it_and_comes_to_rest() {
    for method in STABLE {
        let mut bed = sheet(method, 24, Material { damping: 1.0, ..cotton(0.5, 0.005) });
        for position in &mut bed.particles.position {
            position.y += 0.75;
        }
        bed.obstacles = vec![
            still(Solid::Sphere(Sphere::new(0.3)), Vec3::Y * 0.15),
            still(Solid::HalfSpace(InfinitePlane3d::default()), Vec3::ZERO),
        ];
        for _ in 0..300 {
            bed.step(1.0 / 60.0);
            assert!(depth(&bed) < 1e-5, "{method:?}: {} m", depth(&bed));
        }
        println!("{method:?}: centre {}, {} m/s", bed.centre(), bed.fastest());
        assert!(bed.centre().with_y(0.0).length() < 0.05, "{method:?} slid off: {}", bed.centre());
        assert!(bed.fastest() < 0.05, "{method:?}: still {} m/s", bed.fastest());
    }
}

#[test]
fn a_cloth_dropped_flat_does_not_bounce() {
    for method in STABLE {
        let mut bed = sheet(method, 6, cotton(0.5, 0.01));
        bed.obstacles = vec![still(Solid::HalfSpace(InfinitePlane3d::default()), Vec3::NEG_Y * 0.5)];
        bed.run(0.5);
        for _ in 0..60 {
            bed.step(1.0 / 60.0);
            assert!((bed.centre().y + 0.49).abs() < 1e-4, "{method:?}: {}", bed.centre());
        }
    }
}

#[test]
fn a_cloth_is_lifted_off_by_an_upward_push_without_sticking() {
    for method in STABLE {
        let mut bed = sheet(method, 6, cotton(0.9, 0.01));
        bed.obstacles = vec![still(Solid::HalfSpace(InfinitePlane3d::default()), Vec3::ZERO)];
        bed.run(0.5);
        bed.gravity = Vec3A::Y * 2.0;
        let start = bed.centre().y;
        bed.run(0.5);
        let risen = bed.centre().y - start;
        assert!((risen - 0.25).abs() < 0.01, "{method:?}: {risen} m");
    }
}

/// A free cloth in the way of an obstacle that comes down at `speed` (m/s) for a fifth of a second.
fn struck(method: Method, shape: Solid, speed: f32) -> Bed {
    let mut bed = Bed { gravity: Vec3A::ZERO, ..sheet(method, 16, cotton(0.3, 0.005)) };
    for frame in 0..12 {
        let place = |frame: i32| Isometry3d::from_translation(Vec3::Y * (1.0 - frame as f32 * speed / 60.0));
        bed.obstacles = vec![Obstacle::moving(shape, place(frame), place(frame + 1))];
        bed.step(1.0 / 60.0);
        assert!(depth(&bed) < 1e-4, "{method:?}, frame {frame}: {} m", depth(&bed));
    }
    bed
}

#[test]
fn an_obstacle_at_thirty_metres_a_second_pushes_and_is_not_passed() {
    let shapes = [
        Solid::Sphere(Sphere::new(0.2)),
        Solid::Capsule(Capsule3d::new(0.2, 0.4)),
        Solid::TaperedCapsule(TaperedCapsule::new(0.1, 0.2, 0.4)),
        Solid::Ellipsoid(Ellipsoid { half_size: Vec3::new(0.3, 0.03, 0.6) }),
        Solid::Cylinder(Cylinder::new(0.8, 0.005)),
        Solid::Cone(Cone::new(0.8, 0.2)),
        Solid::Cuboid(Cuboid::new(1.5, 0.004, 1.5)),
    ];
    for (method, shape) in STABLE.into_iter().flat_map(|method| shapes.map(|shape| (method, shape))) {
        for speed in [10.0, 30.0] {
            let bed = struck(method, shape, speed);
            let bottom = 1.0 - 0.2 * speed - shape_reach(shape);
            let lowest = bed.particles.position.iter().map(|p| p.y).fold(0.0, f32::min);
            assert!(lowest <= bottom + 1e-3, "{shape:?} at {speed} m/s passed {method:?}: nothing below {lowest} m");
        }
    }
}

#[test]
fn an_ellipsoid_that_is_thinner_than_a_cell_lifts_a_cloth_and_does_not_come_through() {
    // A needle, and a disc on its edge, that rise in the middle of cells of 14 cm.
    for half_size in [Vec3::new(0.02, 0.3, 0.02), Vec3::new(0.02, 0.3, 0.3)] {
        let shape = Solid::Ellipsoid(Ellipsoid { half_size });
        let mut bed = Bed { gravity: Vec3A::ZERO, ..sheet(Method::Strands, 8, cotton(0.3, 0.005)) };
        let pose = |frame: i32| Isometry3d::from_translation(Vec3::Y * (frame as f32 / 60.0 - half_size.y - 0.01));
        for frame in 0..18 {
            bed.obstacles = vec![Obstacle::moving(shape, pose(frame), pose(frame + 1))];
            bed.step(1.0 / 60.0);
        }
        let risen = bed.centre().y;
        println!("{half_size}: {risen} m");
        assert!(risen > 0.2, "{half_size}: {risen} m, and its tip by 0.29 m");
    }
}

/// How far a shape reaches down from its centre, m.
fn shape_reach(shape: Solid) -> f32 {
    -shape.surface(Vec3A::NEG_Y * 10.0).distance + 10.0
}

#[test]
fn a_turning_table_takes_a_cloth_along() {
    for method in STABLE {
        let mut bed = sheet(method, 8, cotton(0.9, 0.0));
        let speed = 1.0;
        for frame in 0..60 {
            let turn = |frame: i32| Quat::from_rotation_y(speed * frame as f32 / 60.0);
            let shape = Solid::Cylinder(Cylinder::new(2.0, 0.2));
            let lowered = |frame: i32| Isometry3d::new(Vec3::NEG_Y * 0.1, turn(frame));
            bed.obstacles = vec![Obstacle::moving(shape, lowered(frame), lowered(frame + 1))];
            bed.step(1.0 / 60.0);
        }
        let corner = bed.particles.position[0];
        let expected = Quat::from_rotation_y(speed) * Vec3A::from(bed.topology.rest[0]);
        assert!(corner.distance(expected) < 0.03, "{method:?}: {corner} for {expected}");
    }
}

#[test]
fn a_cloth_that_starts_inside_comes_out_without_being_thrown() {
    for method in STABLE {
        let mut bed = Bed { gravity: Vec3A::ZERO, ..sheet(method, 16, cotton(0.5, 0.0)) };
        bed.obstacles = vec![still(Solid::Sphere(Sphere::new(0.2)), Vec3::Y * 0.05)];
        bed.run(1.0);
        assert!(depth(&bed) < 1e-5);
        assert!(bed.fastest() < 5.0, "{method:?}: {} m/s", bed.fastest());
    }
}

#[test]
fn a_cloth_that_starts_deep_inside_comes_out_slowly_and_whole() {
    let shapes = [
        Solid::Sphere(Sphere::new(0.3)),
        Solid::Cuboid(Cuboid::new(0.6, 0.4, 0.6)),
        Solid::Capsule(Capsule3d::new(0.2, 0.4)),
        Solid::Ellipsoid(Ellipsoid { half_size: Vec3::new(0.35, 0.2, 0.3) }),
        Solid::Cone(Cone::new(0.4, 0.5)),
    ];
    for (method, shape) in STABLE.into_iter().flat_map(|method| shapes.map(|shape| (method, shape))) {
        let mut bed = Bed { gravity: Vec3A::ZERO, ..sheet(method, 24, cotton(0.5, 0.003)) };
        bed.obstacles = vec![still(shape, Vec3::new(0.02, -0.05, 0.03))];
        let start = depth(&bed);
        let mut frames = 0;
        while depth(&bed) > 1e-4 {
            let before = depth(&bed);
            bed.step(1.0 / 60.0);
            frames += 1;
            // Its springs pull as well.
            assert!(before - depth(&bed) < 3.0 / 60.0, "{method:?}, {shape:?}: {before} m to {} m", depth(&bed));
            // It is torn at, and what hangs out is jerked along.
            assert!(bed.fastest() < 40.0, "{method:?}, {shape:?}: {} m/s", bed.fastest());
            assert!(frames < 120, "{method:?}, {shape:?}: still {} m inside", depth(&bed));
        }
        println!("{method:?}, {shape:?}: {frames} frames for {start} m");
        // The deepest place may come to see a nearer side.
        assert!(frames as f32 > start * 40.0, "{method:?}, {shape:?}: {start} m in {frames} frames");
    }
}

#[test]
fn a_cloth_that_becomes_thicker_is_not_thrown() {
    for method in STABLE {
        let mut bed = sheet(method, 8, cotton(0.5, 0.001));
        bed.obstacles = vec![still(Solid::HalfSpace(InfinitePlane3d::default()), Vec3::ZERO)];
        bed.run(0.5);
        bed.material.thickness = 0.05;
        let mut fastest = 0.0_f32;
        for _ in 0..30 {
            bed.step(1.0 / 60.0);
            fastest = fastest.max(bed.fastest());
        }
        assert!(depth(&bed) < 1e-5 && fastest < 0.1, "{method:?}: {fastest} m/s");
    }
}

#[test]
fn a_hundred_obstacles_of_which_three_are_near_are_as_three() {
    for method in STABLE {
        let mut bed = sheet(method, 24, cotton(0.5, 0.005));
        let near = [
            still(Solid::Sphere(Sphere::new(0.2)), Vec3::NEG_Y * 0.3),
            still(Solid::HalfSpace(InfinitePlane3d::default()), Vec3::NEG_Y * 0.5),
            still(Solid::Cuboid(Cuboid::new(0.1, 0.4, 0.1)), Vec3::new(0.4, -0.3, 0.4)),
        ];
        bed.obstacles = near.to_vec();
        let mut other = bed.clone();
        // Around them, and as far as the cloth will never come.
        other.obstacles = (0..97)
            .map(|i| {
                let angle = i as f32;
                let place = Vec3::new(4.0 * ops::cos(angle), 0.02 * i as f32, 4.0 * ops::sin(angle));
                still(Solid::Capsule(Capsule3d::new(0.3, 0.5)), place)
            })
            .collect();
        other.obstacles.splice(50..50, near);
        bed.run(1.0);
        other.run(1.0);
        assert!(bits(&bed.particles) == bits(&other.particles), "{method:?}");
    }
}

#[test]
fn a_hand_takes_no_resting_cloth_through_a_board_in_one_step() {
    for method in STABLE {
        let mut bed = Bed { gravity: Vec3A::ZERO, ..sheet(method, 16, cotton(0.5, 0.0)) };
        bed.obstacles = vec![still(Solid::Cuboid(Cuboid::new(4.0, 0.02, 4.0)), Vec3::NEG_Y * 0.05)];
        let grip = Grip { max_force: 1000.0, ..Grip::default() };
        bed.grabs = vec![hand(&bed, 200, [0.4, 0.3, 0.3], grip)];
        // As fast as a pointer leads it.
        bed.grabs[0].end += Vec3A::NEG_Y * (grip.max_speed / 60.0);
        bed.step(1.0 / 60.0);
        let lowest = bed.particles.position.iter().map(|p| p.y).fold(f32::MAX, f32::min);
        assert!(lowest > -0.0401, "{method:?}: {lowest} m");
        bed.grabs[0].start = bed.grabs[0].end;
        bed.run(0.5);
        let lowest = bed.particles.position.iter().map(|p| p.y).fold(f32::MAX, f32::min);
        assert!(lowest > -0.0401, "{method:?}: {lowest} m after a while");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 80, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_particle_ends_a_step_inside_an_obstacle(
        method in prop::sample::select(STABLE.to_vec()),
        kind in 0..8,
        size in prop::array::uniform3(0.05_f32..0.5),
        start in prop::array::uniform3(-1.0_f32..1.0),
        way in prop::array::uniform3(-0.5_f32..0.5),
        turn in -0.3_f32..0.3,
        friction in 0.0_f32..1.0,
    ) {
        let shape = match kind {
            0 => Solid::Sphere(Sphere::new(size[0])),
            1 => Solid::Cuboid(Cuboid::new(size[0], size[1], size[2])),
            2 => Solid::Capsule(Capsule3d::new(size[0], size[1])),
            3 => Solid::Cylinder(Cylinder::new(size[0], size[1])),
            4 => Solid::Cone(Cone::new(size[0], size[1])),
            5 => Solid::TaperedCapsule(TaperedCapsule::new(size[0], size[1], size[2])),
            6 => Solid::Ellipsoid(Ellipsoid { half_size: size.into() }),
            _ => Solid::HalfSpace(InfinitePlane3d::default()),
        };
        let mut bed = sheet(method, 16, cotton(friction, 0.003));
        let pose = |frame: i32| Isometry3d::new(
            Vec3::from(start) - Vec3::Y * 1.5 + Vec3::from(way) * frame as f32,
            Quat::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), turn * frame as f32),
        );
        bed.obstacles = vec![Obstacle::moving(shape, pose(0), pose(0))];
        // What starts inside leaves slowly.
        prop_assume!(depth(&bed) <= 0.0);
        for frame in 0..20 {
            bed.obstacles = vec![Obstacle::moving(shape, pose(frame), pose(frame + 1))];
            bed.step(1.0 / 60.0);
            prop_assert!(bed.particles.is_finite());
            prop_assert!(depth(&bed) < 1e-4, "frame {}: {} m inside", frame, depth(&bed));
        }
    }
}
