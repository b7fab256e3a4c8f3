//! A report says why a step took as many substeps as it did.

use std::sync::Arc;

use bevy_math::{
    Isometry3d, Mat3A, Quat, Vec3, Vec3A,
    primitives::{Capsule3d, Cone, Cuboid, Sphere},
};
use drape_solver::{
    Body, DeformedPoints, Elasticity, Material, MeshShape, Method, Moduli, Obstacle, Shape, Solid, SubstepReason,
    step_together,
};

use crate::{
    bench_bed::{Bed, together},
    fixtures::{
        hand::{Grip, hand},
        material::{Springs, springs},
        mesh::{Grid, icosphere, uneven},
    },
    meshes::ball,
};

const STEP: f32 = 1.0 / 60.0;

/// Held and tethered by two corners, with as many substeps as a game takes.
fn hung() -> Bed {
    Bed::lying(12, springs(Springs::default())).pinned([0, 11]).tethered(&[0, 11]).like_a_game(Method::Strands)
}

/// That of the second step: what is sharp counts only once something moves.
fn reason_of(mut bed: Bed) -> SubstepReason {
    bed.step(STEP);
    bed.step(STEP).reason
}

/// The cloth with its middle a millimetre above something that reaches up by `height` (m) from its own middle.
fn above(solid: Solid, height: f32) -> Bed {
    let below = Isometry3d::from_translation(Vec3::NEG_Y * (height + 0.001));
    Bed { obstacles: vec![Obstacle::still(solid, below)], ..hung() }
}

#[test]
fn what_raises_the_number_is_the_reason() {
    assert_eq!(reason_of(hung()), SubstepReason::Strain);
    assert_eq!(reason_of(hung().with_substeps(5)), SubstepReason::Fixed);
    assert_eq!(reason_of(Bed { tethers: None, ..hung() }), SubstepReason::Untethered);
    let held = Bed { grabs: vec![hand(&hung(), 30, [0.3, 0.3, 0.4], Grip::default())], ..hung() };
    assert_eq!(reason_of(held), SubstepReason::Grabbed);
    assert_eq!(reason_of(Bed { self_collision: true, ..hung() }), SubstepReason::SelfCollision);
    assert_eq!(reason_of(above(Solid::Sphere(Sphere::new(5.0)), 5.0)), SubstepReason::Obstacle);
    assert_eq!(reason_of(above(Solid::Cuboid(Cuboid::from_length(0.4)), 0.2)), SubstepReason::SharpEdge);
    assert_eq!(reason_of(above(Solid::Cone(Cone { radius: 0.1, height: 0.4 }), 0.2)), SubstepReason::SharpTip);
    assert_eq!(reason_of(hung().like_a_game(Method::Explicit)), SubstepReason::Stability);
}

#[test]
fn limbs_raise_the_number_less_than_other_obstacles_where_there_are_rows_and_columns() {
    // A thin one, as an arm.
    let arm = |is_rough: bool| {
        let capsule = Solid::Capsule(Capsule3d::new(0.04, 0.3));
        Obstacle { is_rough, ..Obstacle::still(capsule, Isometry3d::from_translation(Vec3::NEG_Y * 0.2)) }
    };
    let ball = Obstacle::still(Solid::Sphere(Sphere::new(5.0)), Isometry3d::from_translation(Vec3::NEG_Y * 5.001));
    let steps = |bed: Bed, obstacles: Vec<Obstacle>| {
        let mut bed = Bed { obstacles, ..bed };
        bed.step(STEP);
        let report = bed.step(STEP);
        (report.substeps, report.reason)
    };
    assert_eq!(steps(hung(), vec![arm(true)]), (6, SubstepReason::Obstacle));
    let shove = |speed: f32| {
        let mut arm = arm(true);
        arm.start.translation -= Vec3A::X * speed * STEP;
        let mut bed = Bed { obstacles: vec![arm], ..hung() };
        bed.step(STEP).substeps
    };
    assert_eq!([0.2, 1.0].map(shove), [6, 8], "it sweeps past");
    assert_eq!(steps(hung(), vec![arm(true), ball]), (8, SubstepReason::Obstacle));
    assert_eq!(steps(hung(), vec![arm(false)]).1, SubstepReason::SharpTip, "a cell is larger than it");
    let untethered = Bed { tethers: None, ..hung() };
    assert_eq!(steps(untethered, vec![arm(true)]), (8, SubstepReason::Obstacle));
    let cotton = Moduli::from_strips([4000.0; 2], 50.0, [0.0; 2], 1.0).expect("a sheet");
    let material = Material::bare(0.15, Elasticity::Moduli(cotton));
    let implicit = Bed::new(uneven(Grid::new(1.0, 1.0, 12, 12).lying(), 0.25), material).like_a_game(Method::Strands);
    assert_eq!(steps(implicit, vec![arm(true)]), (8, SubstepReason::Obstacle));
}

#[test]
fn implicit_steps_take_more_near_what_is_sharp_only_where_that_is_fast() {
    let uneven_sheet = || {
        let mesh = uneven(Grid::new(1.0, 1.0, 12, 12).lying(), 0.25);
        let sheet = Moduli::from_strips([4000.0; 2], 50.0, [0.0; 2], 1.0).expect("a sheet");
        Bed::new(mesh, Material::bare(0.15, Elasticity::Moduli(sheet))).like_a_game(Method::Strands)
    };
    let corner = Quat::from_rotation_arc(Vec3::ONE.normalize(), Vec3::Y);
    let at = |y: f32| Isometry3d::new(Vec3::Y * y, corner);
    let cuboid = Solid::Cuboid(Cuboid::from_length(0.4));
    let steps = |obstacle: Obstacle| {
        let mut bed = Bed { obstacles: vec![obstacle], ..uneven_sheet() };
        bed.step(STEP);
        let report = bed.step(STEP);
        (report.substeps, report.reason)
    };
    assert_eq!(steps(Obstacle::still(cuboid, at(-0.36))), (8, SubstepReason::Obstacle));
    // 1 m in a step, and half an edge is some 5 cm.
    let (substeps, reason) = steps(Obstacle::moving(cuboid, at(-1.36), at(-0.36)));
    assert!((18..32).contains(&substeps) && reason == SubstepReason::SharpEdge, "{substeps}, {reason}");
    // What the cloth pushes isn't solved along with it.
    let body = Body { inverse_mass: 1.0, inverse_inertia: Mat3A::IDENTITY, centre: Vec3A::NEG_Y * 0.36 };
    let pushed = Obstacle { body: Some(body), ..Obstacle::still(cuboid, at(-0.36)) };
    assert_eq!(steps(pushed), (32, SubstepReason::SharpEdge));
}

#[test]
fn a_mesh_that_changes_its_shape_counts_only_where_it_is_near() {
    let mesh = Arc::new(ball(0.3, 2));
    let moved = |way: Vec3A| -> Arc<[Vec3A]> { mesh.points.iter().map(|point| *point + way).collect() };
    // Its frame stays where it is, as with a character whose limbs move: far below the cloth, or up to it.
    for (up, reason) in [(0.0, SubstepReason::Strain), (2.0, SubstepReason::Obstacle)] {
        let ends = [Vec3A::ZERO, Vec3A::Y * up].map(moved);
        let shape = MeshShape { mesh: mesh.clone(), deformed: Some(DeformedPoints::new(ends)) };
        let below = Isometry3d::from_translation(Vec3::NEG_Y * 2.3);
        let bed = Bed { obstacles: vec![Obstacle::still(Shape::Mesh(shape), below)], ..hung() };
        assert_eq!(reason_of(bed), reason, "{up}");
    }
}

#[test]
fn a_limit_is_kept_and_is_the_reason() {
    for method in [Method::Strands, Method::Xpbd] {
        let bed = || Bed { self_collision: true, ..hung() }.like_a_game(method);
        let report = Bed { substep_limit: 3, ..bed() }.step(STEP);
        let asked = bed().step(STEP).substeps;
        assert_eq!((report.substeps, report.needed_substeps), (3, asked));
        assert_eq!(report.reason, SubstepReason::Budget);
        assert_eq!(Bed { substep_limit: 0, ..bed() }.step(STEP).substeps, 1, "none would be no step");
        assert_eq!(Bed { substep_limit: asked, ..bed() }.step(STEP), bed().step(STEP));
    }
}

#[test]
fn a_closed_mesh_and_a_step_without_time_have_their_reasons() {
    let mut closed = Bed::new(icosphere(0.2, 4), springs(Springs::default())).like_a_game(Method::Strands);
    // Its triangles ask for as many by themselves.
    assert_eq!(closed.step(STEP).reason, SubstepReason::Strain);
    assert_eq!(closed.step(0.0).reason, SubstepReason::Nothing);
}

#[test]
fn the_one_that_needs_fewer_names_the_other_cloth() {
    let mut beds = [Bed { self_collision: true, ..hung() }, Bed { self_collision: true, ..hung().with_substeps(3) }];
    let reasons = together(&mut beds, STEP, |members| {
        step_together(members);
        members.iter().map(|member| member.report.expect("it was stepped").reason).collect::<Vec<_>>()
    });
    assert_eq!(reasons, [SubstepReason::SelfCollision, SubstepReason::OtherCloth]);
}
