//! Bodies that are put elsewhere by intention keep no memory of their way.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::{
    common::*,
    engine::{BOTH, Engine, Form},
};

/// How far a curtain is moved by a ball that goes from before it to behind it as `go` says, m.
fn thrown(engine: Engine, go: impl Fn(&mut App, Entity, Transform)) -> f32 {
    let mut app = engine.app();
    let curtain = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 17, 17), Pins::edge(ClothEdge::Top));
    let ball = engine.fixed(&mut app, &Form::Ball(0.1), Transform::from_xyz(0.0, 0.0, 0.4));
    run(&mut app, 60);
    let before = positions(&app, curtain);
    go(&mut app, ball, Transform::from_xyz(0.0, 0.0, -0.4));
    let mut farthest = 0.0_f32;
    for _ in 0..30 {
        run(&mut app, 1);
        let ways = positions(&app, curtain).into_iter().zip(&before).map(|(now, before)| now.distance(*before));
        farthest = ways.fold(farthest, f32::max);
    }
    farthest
}

#[test]
fn a_teleported_body_hits_nothing_on_its_way() {
    for engine in BOTH {
        let swept = thrown(engine, |app, ball, to| *get_mut::<Transform>(app, ball) = to);
        assert!(swept > 0.2, "{engine:?}: one that moves does: {swept} m");
        let thrown = thrown(engine, |app, ball, to| command(app, ball, |ball| ball.teleport_collider(to)));
        assert!(thrown < 0.01, "{engine:?}: {thrown} m");
    }
}

#[test]
fn bodies_go_along_with_a_shifted_world() {
    for engine in BOTH {
        let mut app = engine.app();
        engine.fixed(&mut app, &Form::Ball(0.25), Transform::from_xyz(0.0, -0.3, 0.0));
        let cloth = spawn_cloth(&mut app, ClothGrid::new(0.6, 0.6, 13, 13).lying(), Transform::default());
        run(&mut app, 60);
        let before = positions(&app, cloth);
        let by = Vec3::new(512.0, 0.0, -256.0);
        app.world_mut().commands().shift_world(by);
        app.world_mut().flush();
        run(&mut app, 3);
        for (now, before) in positions(&app, cloth).into_iter().zip(before) {
            assert_close(now - by, before, 0.01);
        }
    }
}
