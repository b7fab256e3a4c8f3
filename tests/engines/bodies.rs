//! Bodies that forces move, and cloth: what one gives the other loses.

use bevy::{math::primitives::InfinitePlane3d, prelude::*};
use bevy_drape::prelude::*;

use crate::{
    common::*,
    engine::{BOTH, Engine, Form},
};

const MASS: f32 = 0.1;

/// An app without gravity, with a free sheet of a square metre that lies at height 0, and a ball that flies at it.
fn ball_at_sheet(engine: Engine, form: &Form, velocity: Vec3) -> (App, Entity, Entity) {
    let mut app = engine.app();
    engine.set_gravity(&mut app, Vec3::ZERO);
    let cloth = Cloth { gravity_scale: 0.0, substeps: Some(16), ..default() };
    let sheet = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 17, 17).lying(), (cloth, undamped()));
    let body = engine.dynamic(&mut app, form, MASS, Transform::from_xyz(0.1, 0.3, -0.05));
    run(&mut app, 2);
    engine.set_velocity(&mut app, body, velocity);
    (app, sheet, body)
}

/// Momentum of a sheet, N s.
fn momentum(app: &App, sheet: Entity) -> Vec3 {
    let state = state(app, sheet);
    let density = get::<Fabric>(app, sheet).density;
    state.velocities().zip(&state.topology().areas).map(|(velocity, area)| velocity * (density * area)).sum()
}

#[test]
fn a_body_that_flies_into_a_free_cloth_keeps_the_momentum_of_both() {
    let forms = [Form::Ball(0.1), Form::Cuboid(Vec3::new(0.15, 0.05, 0.1))];
    for (engine, form) in BOTH.into_iter().flat_map(|engine| forms.clone().map(|form| (engine, form))) {
        let velocity = Vec3::new(0.3, -2.0, 0.1);
        let (mut app, sheet, body) = ball_at_sheet(engine, &form, velocity);
        let mut given = 0.0_f32;
        for frame in 0..60 {
            run(&mut app, 1);
            let own = engine.velocity(&app, body) * MASS;
            given = given.max(velocity.distance(own / MASS) * MASS);
            // What cloth gives within a step, the engine has by the next one's start.
            let lost = own + momentum(&app, sheet) - velocity * MASS;
            assert!(
                lost.length() < 0.002 * MASS * velocity.length() || frame < 2,
                "{engine:?}, {form:?}, frame {frame}: {lost} N s"
            );
        }
        assert!(given > 0.2 * MASS * velocity.length(), "{engine:?}, {form:?}: {given} N s");
    }
}

#[test]
fn late_cloth_meets_bodies_and_gives_them_nothing() {
    for engine in BOTH {
        let velocity = Vec3::new(0.0, -1.0, 0.0);
        let (mut app, sheet, body) = ball_at_sheet(engine, &Form::Ball(0.1), velocity);
        get_mut::<Cloth>(&mut app, sheet).timing = ClothTiming::Late;
        let mut nearest = f32::MAX;
        for _ in 0..30 {
            run(&mut app, 1);
            let centre = get::<Transform>(&app, body).translation;
            let distances = positions(&app, sheet).into_iter().map(|place| place.distance(centre));
            nearest = distances.fold(nearest, f32::min);
        }
        assert!((0.09..0.12).contains(&nearest), "{engine:?}: {nearest} m");
        let own = engine.velocity(&app, body);
        assert!(own.distance(velocity) < 1e-4, "{engine:?}: {own} m/s");
    }
}

#[test]
fn late_cloth_on_a_body_follows_it_and_pulls_nothing() {
    for engine in BOTH {
        let mut app = engine.app();
        engine.set_gravity(&mut app, Vec3::ZERO);
        let body = engine.dynamic(&mut app, &Form::Ball(0.1), MASS, Transform::from_xyz(0.0, 0.3, 0.0));
        let settings = Cloth { timing: ClothTiming::Late, collision_mask: 0, ..default() };
        let pins = Pins::indices([0]).to_entity(body);
        let cloth = spawn_cloth(&mut app, ClothGrid::new(0.5, 0.5, 9, 9), (settings, pins));
        run(&mut app, 2);
        let offset = place(&app, cloth, 0) - get::<Transform>(&app, body).translation;
        let velocity = Vec3::new(0.5, 0.0, 0.2);
        engine.set_velocity(&mut app, body, velocity);
        for _ in 0..60 {
            run(&mut app, 1);
            let pinned = place(&app, cloth, 0) - get::<GlobalTransform>(&app, body).translation();
            assert_close(pinned, offset, 1e-4);
        }
        assert_close(engine.velocity(&app, body), velocity, 1e-3);
        assert!(tethers(&app, cloth).len() > 20, "{engine:?}: it hangs on its tethers");
    }
}

#[test]
fn a_body_falls_onto_a_held_cloth_and_stays_there() {
    for engine in BOTH {
        let mut app = engine.app();
        let corners = Pins::indices([0, 16, 16 * 17, 17 * 17 - 1]);
        let cloth = Cloth { substeps: Some(16), ..default() };
        spawn_cloth(
            &mut app,
            ClothGrid::new(1.0, 1.0, 17, 17).lying(),
            (cloth, Fabric { damping: 2.0, ..undamped() }, corners),
        );
        let ball = engine.dynamic(&mut app, &Form::Ball(0.12), MASS, Transform::from_xyz(0.02, 0.4, 0.03));
        run(&mut app, 300);
        let (place, velocity) = (get::<Transform>(&app, ball).translation, engine.velocity(&app, ball));
        assert!(place.y > -0.4 && place.with_y(0.0).length() < 0.4, "{engine:?}: at {place}");
        assert!(velocity.length() < 0.2, "{engine:?}: still {velocity} m/s");
    }
}

#[test]
fn a_cloth_that_holds_a_body_never_sleeps() {
    for engine in BOTH {
        let mut app = engine.app();
        let corners = Pins::indices([0, 8, 8 * 9, 9 * 9 - 1]);
        let grid = ClothGrid::new(1.0, 1.0, 9, 9).lying();
        let holding = spawn_cloth(&mut app, grid, (Fabric { damping: 4.0, ..default() }, corners.clone()));
        let away = Transform::from_xyz(5.0, 0.0, 0.0);
        let empty = spawn_cloth(&mut app, grid, (Fabric { damping: 4.0, ..default() }, corners, away));
        let ball = engine.dynamic(&mut app, &Form::Ball(0.12), MASS, Transform::from_xyz(0.02, 0.2, 0.03));
        run(&mut app, 1200);
        assert_eq!(*get::<ClothStatus>(&app, empty), ClothStatus::Asleep, "{engine:?}");
        assert_eq!(*get::<ClothStatus>(&app, holding), ClothStatus::Ready, "{engine:?}");
        assert!(get::<Transform>(&app, ball).translation.y > -0.4, "{engine:?}: it is held");
    }
}

#[test]
fn a_heavy_body_between_cloth_and_ground_stays_out_of_the_ground() {
    for engine in BOTH {
        let mut app = engine.app();
        engine.fixed(&mut app, &Form::HalfSpace(Vec3::Y), Transform::default());
        app.world_mut().spawn((ClothCollider::from(InfinitePlane3d::default()), Transform::default()));
        let ball = engine.dynamic(&mut app, &Form::Ball(0.1), 1.0, Transform::from_xyz(0.0, 0.1, 0.0));
        let grid = ClothGrid::new(0.6, 0.6, 13, 13).lying();
        let sheet = spawn_cloth(&mut app, grid, (undamped(), Transform::from_xyz(0.0, 0.4, 0.0)));
        run(&mut app, 120);
        let place = get::<Transform>(&app, ball).translation;
        assert!((place.y - 0.1).abs() < 0.01 && place.is_finite(), "{engine:?}: {place}");
        let depth = positions(&app, sheet).iter().map(|p| 0.1 - p.distance(place)).fold(f32::MIN, f32::max);
        assert!(depth < 1e-3, "{engine:?}: {depth} m inside");
    }
}
