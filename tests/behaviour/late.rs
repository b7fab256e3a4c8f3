//! Cloth that steps late is where the frame's animation has put what it hangs on and meets.

use bevy::{app::AnimationSystems, prelude::*};
use bevy_drape::prelude::*;

use crate::common::*;

const GRID: ClothGrid = ClothGrid { size: Vec2::new(0.6, 0.6), particles: UVec2::new(11, 11), lying: false };

/// Frames a second, with fixed steps 64 times a second beside them: none in a frame, one, two, three.
const RATES: [f64; 3] = [30.0, 60.0, 144.0];

/// Goes its way in `PostUpdate`, where Bevy animates, as a function of the time.
#[derive(Component)]
struct Animated(fn(f32) -> Transform);

/// The same in `Update`.
#[derive(Component)]
struct Moved(fn(f32) -> Transform);

fn app_at(rate: f64) -> App {
    with_rate(headless(), rate)
}

fn with_rate(mut app: App, rate: f64) -> App {
    set_rates(&mut app, 1.0 / rate, 1.0 / 64.0);
    let animate = |mut bones: Query<(&Animated, &mut Transform)>, time: Res<Time>| {
        bones.iter_mut().for_each(|(animated, mut at)| *at = animated.0(time.elapsed_secs()));
    };
    let lead = |mut moved: Query<(&Moved, &mut Transform)>, time: Res<Time>| {
        moved.iter_mut().for_each(|(moved, mut at)| *at = moved.0(time.elapsed_secs()));
    };
    app.add_systems(PostUpdate, animate.in_set(AnimationSystems).before(TransformSystems::Propagate))
        .add_systems(Update, lead);
    app
}

fn cloth_with(timing: ClothTiming) -> Cloth {
    Cloth { timing, ..default() }
}

fn late() -> Cloth {
    cloth_with(ClothTiming::Late)
}

/// The farthest that two places of the same number are apart, m.
fn apart(one: impl IntoIterator<Item = Vec3>, other: impl IntoIterator<Item = Vec3>) -> f32 {
    one.into_iter().zip(other).map(|(one, other)| one.distance(other)).fold(0.0, f32::max)
}

fn to_and_fro(time: f32) -> Transform {
    Transform::from_xyz(1.5 * ops::sin(3.0 * time), 0.3 * ops::cos(3.0 * time), 0.0)
        .with_rotation(Quat::from_rotation_y(0.5 * ops::sin(2.0 * time)))
}

/// How far a cloth's first vertex is from where a pin at `offset` on its target has it by now, m.
fn pin_error(app: &App, cloth: Entity, target: Entity, offset: Vec3) -> f32 {
    get::<GlobalTransform>(app, target).transform_point(offset).distance(place(app, cloth, 0))
}

fn pinned_offset(app: &App, cloth: Entity, target: Entity) -> Vec3 {
    get::<GlobalTransform>(app, target).affine().inverse().transform_point3(place(app, cloth, 0))
}

/// Spawns cloth that hangs on `target` by its upper edge, and lets it become ready with the target at rest.
fn hang_on(app: &mut App, target: Entity, settings: Cloth) -> (Entity, Vec3) {
    let cloth = spawn_cloth(app, GRID, (settings, Pins::edge(ClothEdge::Top).to_entity(target)));
    run(app, 1);
    let offset = pinned_offset(app, cloth, target);
    (cloth, offset)
}

#[test]
fn pins_are_at_their_animated_target_in_every_frame() {
    for rate in RATES {
        let plugins = [ClothPlugin::default(), ClothPlugin::new(Update), ClothPlugin::new(PostUpdate)];
        for (number, plugin) in plugins.into_iter().enumerate() {
            let mut app = with_rate(headless_with(plugin), rate);
            let target = app.world_mut().spawn(Transform::default()).id();
            let (late, late_offset) = hang_on(&mut app, target, late());
            let (fixed, fixed_offset) = hang_on(&mut app, target, Cloth::default());
            app.world_mut().entity_mut(target).insert(Animated(to_and_fro));
            let mut lag: f32 = 0.0;
            for _ in 0..(1.5 * rate) as usize {
                run(&mut app, 1);
                let error = pin_error(&app, late, target, late_offset);
                assert!(error < 1e-6, "{error} m at {rate} Hz, {plugin:?}");
                // And so is what is drawn, which nothing is added to: the cloth's entity stands at the origin.
                let places = (0..121).map(|vertex| place(&app, late, vertex));
                let off = apart(points(drawn(&app, late)), places);
                assert!(off < 1e-6, "drawn off by {off} m at {rate} Hz, {plugin:?}");
                lag = lag.max(pin_error(&app, fixed, target, fixed_offset));
            }
            // In `PostUpdate` it may come after animation by chance.
            assert!(lag > 0.02 || number == 2, "a fixed step lags: {lag} m at {rate} Hz, {plugin:?}");
        }
    }
}

/// The deepest that a cloth has been within a ball of 0.2 m that is drawn at its present place, over two seconds in which the
/// ball goes to and fro through the cloth, m.
fn depth_in_moving_ball(rate: f64, timing: ClothTiming) -> f32 {
    let mut app = app_at(rate);
    let way = |time: f32| Transform::from_xyz(0.0, -0.1, 0.8 * ops::cos(2.0 * time));
    let ball = app.world_mut().spawn((ClothCollider::from(Sphere::new(0.2)), Moved(way), way(0.0))).id();
    let cloth = spawn_cloth(&mut app, GRID, (cloth_with(timing), Pins::edge(ClothEdge::Top)));
    let mut deepest: f32 = 0.0;
    for _ in 0..(2.0 * rate) as usize {
        run(&mut app, 1);
        let centre = get::<GlobalTransform>(&app, ball).translation();
        let nearest = positions(&app, cloth).iter().map(|place| place.distance(centre)).fold(1.0, f32::min);
        deepest = deepest.max(0.2 - nearest);
    }
    deepest
}

#[test]
fn cloth_meets_obstacles_where_they_are_drawn() {
    for rate in RATES {
        let late = depth_in_moving_ball(rate, ClothTiming::Late);
        assert!(late < 1e-4, "{late} m at {rate} Hz");
        let fixed = depth_in_moving_ball(rate, ClothTiming::Fixed);
        assert!(fixed > 5e-3, "a fixed step lags: {fixed} m at {rate} Hz");
    }
}

#[test]
fn cloth_rides_on_an_obstacle_that_moves_every_frame() {
    for rate in RATES {
        for beside in [ClothTiming::Fixed, ClothTiming::Late] {
            let mut app = app_at(rate);
            let way = |time: f32| Transform::from_xyz(1.2 * time, -0.1, 0.0);
            let slab = ClothCollider::from(Cuboid::new(3.0, 0.2, 3.0));
            let table = app.world_mut().spawn((slab, Moved(way), way(0.0))).id();
            let still =
                (Cloth { gravity_scale: 1.0, fluid_density: 0.0, ..late() }, Transform::from_xyz(0.0, 0.01, 0.8));
            let cloth = spawn_cloth(&mut app, GRID.lying(), still);
            spawn_cloth(&mut app, GRID.lying(), (cloth_with(beside), Transform::from_xyz(0.0, 0.01, -0.8)));
            run(&mut app, rate as usize);
            let relative = |app: &App| {
                let table = get::<GlobalTransform>(app, table).translation();
                positions(app, cloth).into_iter().map(|place| place - table).collect::<Vec<_>>()
            };
            let before = relative(&app);
            for _ in 0..rate as usize {
                run(&mut app, 1);
                for velocity in state(&app, cloth).velocities() {
                    assert_close(velocity, Vec3::X * 1.2, 0.02);
                }
            }
            let slipped = apart(before, relative(&app));
            assert!(slipped < 1e-3, "{slipped} m in a second at {rate} Hz beside {beside:?}");
        }
    }
}

#[test]
fn the_motion_is_alike_at_any_frame_rate() {
    let shapes = RATES.map(|rate| {
        let mut app = app_at(rate);
        let target = app.world_mut().spawn(Transform::default()).id();
        let (cloth, _) = hang_on(&mut app, target, late());
        // From rest to 1.5 m/s within half a second.
        let way = |time: f32| {
            let begun = time.min(0.5);
            Transform::from_xyz(0.0, 0.0, 1.5 * begun * begun + 1.5 * (time - begun))
        };
        app.world_mut().entity_mut(target).insert(Animated(way));
        while app.world().resource::<Time>().elapsed_secs() < 2.0 - 1e-4 {
            run(&mut app, 1);
        }
        let carrier = get::<GlobalTransform>(&app, target).translation();
        positions(&app, cloth).into_iter().map(|place| place - carrier).collect::<Vec<_>>()
    });
    let leans = shapes[0].iter().map(|place| -place.z).fold(0.0, f32::max);
    assert!(leans > 0.05, "the air holds it back by {leans} m");
    for shape in &shapes[1..] {
        let off = apart(shapes[0].iter().copied(), shape.iter().copied());
        assert!(off < 0.01, "{off} m");
    }
}

/// A gust on a flag, which hangs on what moves, with a ball that moves past and a teleport; places of its cloth in each frame.
fn run_with(rate: f64, timing: ClothTiming, beside: Option<ClothTiming>) -> Vec<Vec<Vec3>> {
    let mut app = app_at(rate);
    let target = app.world_mut().spawn(Animated(to_and_fro)).insert(Transform::default()).id();
    app.world_mut().spawn(Wind { velocity: Vec3::Z * 5.0, gusts: 0.8, gust_period: 0.5, ..default() });
    // It follows the flag, and goes through it.
    let way = |time: f32| to_and_fro(time) * Transform::from_xyz(0.0, -0.1, 0.1 + 0.4 * ops::cos(5.0 * time));
    let ball = app.world_mut().spawn((ClothCollider::from(Sphere::new(0.15)), Moved(way), way(0.0))).id();
    let settings = |timing| Cloth { self_collision: true, ..cloth_with(timing) };
    let pins = || Pins::edge(ClothEdge::Top).to_entity(target);
    let cloth = spawn_cloth(&mut app, GRID, (settings(timing), pins()));
    if let Some(beside) = beside {
        spawn_cloth(&mut app, GRID, (settings(beside), pins(), Transform::from_xyz(0.0, 0.0, 0.01)));
    }
    let frames = (1.5 * rate) as usize;
    let run = |frame| {
        if frame == frames / 2 {
            command(&mut app, target, |entity| entity.teleport_cloth(Transform::from_xyz(3.0, 0.0, 0.0)));
            command(&mut app, ball, |entity| entity.teleport_collider(Transform::from_xyz(3.0, 0.0, 1.0)));
        }
        run(&mut app, 1);
        positions(&app, cloth)
    };
    (0..frames).map(run).collect()
}

#[test]
fn cloth_has_the_same_bits_whether_there_is_cloth_of_the_other_timing_or_not() {
    for rate in [30.0, 144.0] {
        for (timing, other) in [(ClothTiming::Fixed, ClothTiming::Late), (ClothTiming::Late, ClothTiming::Fixed)] {
            let alone = run_with(rate, timing, None);
            assert!(alone == run_with(rate, timing, Some(other)), "{timing:?} at {rate} Hz");
        }
    }
}

#[test]
fn frames_as_long_as_fixed_steps_give_the_same_bits_in_wind() {
    let [fixed, late] = [ClothTiming::Auto, ClothTiming::Late].map(|timing| {
        let mut app = headless();
        app.world_mut().spawn(Wind { velocity: Vec3::Z * 5.0, gusts: 0.8, gust_period: 0.5, ..default() });
        let cloth = spawn_cloth(&mut app, GRID, (cloth_with(timing), Pins::edge(ClothEdge::Top)));
        spawn_cloth(&mut app, GRID, (late(), Transform::from_xyz(9.0, 0.0, 0.0)));
        run(&mut app, 90);
        positions(&app, cloth)
    });
    assert!(fixed == late);
}

#[test]
fn paused_time_stops_it_and_forgets_nothing() {
    let mut app = app_at(144.0);
    let target = app.world_mut().spawn(Transform::default()).id();
    let (cloth, offset) = hang_on(&mut app, target, late());
    app.world_mut().entity_mut(target).insert(Animated(to_and_fro));
    run(&mut app, 100);
    app.world_mut().resource_mut::<Time<Virtual>>().pause();
    run(&mut app, 1);
    let before = (positions(&app, cloth), state(&app, cloth).velocities().collect::<Vec<_>>());
    get_mut::<ClothState>(&mut app, cloth).add_force(60, Vec3::Z * 0.5);
    run(&mut app, 30);
    assert_eq!((positions(&app, cloth), state(&app, cloth).velocities().collect::<Vec<_>>()), before);
    app.world_mut().resource_mut::<Time<Virtual>>().unpause();
    let mut frames = 0;
    while positions(&app, cloth) == before.0 {
        run(&mut app, 1);
        frames += 1;
    }
    assert!(frames <= 2 && pin_error(&app, cloth, target, offset) < 1e-6);
    // It goes on as it was, and isn't put beside its target as what was gone.
    let pinned = state(&app, cloth).velocity(0).unwrap();
    assert!(pinned.distance(before.1[0]) < 0.5, "{pinned} after {}", before.1[0]);
    assert!(state(&app, cloth).velocity(60).unwrap().z > before.1[60].z + 0.1, "the force has been kept");
}

#[test]
fn forces_of_fixed_steps_and_of_the_frame_count() {
    #[derive(Resource)]
    struct Cloths([Entity; 2]);
    let mut app = app_at(144.0);
    let cloths = [0.0, 5.0].map(|x| {
        let settings = Cloth { gravity_scale: 0.0, fluid_density: 0.0, ..late() };
        spawn_cloth(&mut app, GRID, (settings, undamped(), Transform::from_xyz(x, 0.0, 0.0)))
    });
    run(&mut app, 3);
    app.insert_resource(Cloths(cloths));
    let push = |which: usize| {
        move |mut states: Query<&mut ClothState>, cloths: Res<Cloths>, mut done: Local<bool>| {
            if !core::mem::replace(&mut *done, true) {
                states.get_mut(cloths.0[which]).unwrap().add_impulse(60, Vec3::Z * 1e-3);
            }
        }
    };
    app.add_systems(FixedUpdate, push(0)).add_systems(PostUpdate, push(1).before(ClothSystems::Late));
    run(&mut app, 1);
    assert!(state(&app, cloths[1]).velocity(60).unwrap().z > 0.1, "in the same frame");
    run(&mut app, 4);
    assert!(state(&app, cloths[0]).velocities().any(|velocity| velocity.z > 0.01), "in the next late step");
}

#[test]
fn it_sleeps_and_wakes() {
    for timing in [ClothTiming::Fixed, ClothTiming::Late] {
        let mut app = app_at(144.0);
        let near = Transform::from_xyz(0.0, -0.1, 0.3);
        let ball = app.world_mut().spawn((ClothCollider::from(Sphere::new(0.2)), near)).id();
        let far = (ClothCollider::from(Sphere::new(0.2)), Moved(to_and_fro_far), to_and_fro_far(0.0));
        app.world_mut().spawn(far);
        let cloths = [timing, ClothTiming::Late]
            .map(|timing| spawn_cloth(&mut app, GRID, (cloth_with(timing), Pins::edge(ClothEdge::Top))));
        let is_asleep = |app: &App| cloths.map(|cloth| *get::<ClothStatus>(app, cloth) == ClothStatus::Asleep);
        for _ in 0..4000 {
            run(&mut app, 1);
        }
        assert_eq!(is_asleep(&app), [true; 2], "{timing:?}");
        get_mut::<Transform>(&mut app, ball).translation.z = 0.18;
        run(&mut app, 1);
        assert!(!is_asleep(&app)[1], "at once");
        run(&mut app, 3);
        assert_eq!(is_asleep(&app), [false; 2], "{timing:?}, within a step");
    }
}

fn to_and_fro_far(time: f32) -> Transform {
    to_and_fro(time) * Transform::from_xyz(50.0, 0.0, 0.0)
}

#[test]
fn teleports_take_it_along_once() {
    for rate in RATES {
        let mut app = app_at(rate);
        let root = app.world_mut().spawn(Transform::default()).id();
        let capsule =
            (ClothCollider::from(Capsule3d::new(0.1, 0.5)), Transform::from_xyz(0.0, 0.0, -0.12), ChildOf(root));
        app.world_mut().spawn(capsule);
        let cloths = [ClothTiming::Late, ClothTiming::Fixed].map(|timing| {
            let pins = Pins::edge(ClothEdge::Top).to_entity(root);
            spawn_cloth(&mut app, GRID, (cloth_with(timing), pins, ChildOf(root), Transform::default()))
        });
        run(&mut app, (3.0 * rate) as usize);
        let hung = cloths.map(|cloth| positions(&app, cloth));
        // Steps of either pass may come first, or none of the fixed.
        for jump in 1..12 {
            let there = Vec3::new(8.0 * jump as f32, 0.0, 0.0);
            command(&mut app, root, |entity| entity.teleport_cloth(Transform::from_translation(there)));
            for frame in 0..5 {
                run(&mut app, 1);
                for (cloth, hung) in cloths.iter().zip(&hung).take(if frame < 4 { 1 } else { 2 }) {
                    let off = apart(positions(&app, *cloth).iter().map(|place| place - there), hung.iter().copied());
                    assert!(off < 2e-3, "{off} m at {rate} Hz, jump {jump}, frame {frame}");
                }
            }
        }
    }
}

#[test]
fn a_teleported_collider_sweeps_nothing() {
    for rate in RATES {
        let mut app = app_at(rate);
        let ball = (ClothCollider::from(Sphere::new(0.2)), Transform::from_xyz(0.0, 0.0, 0.4));
        let ball = app.world_mut().spawn(ball).id();
        let cloths = [ClothTiming::Late, ClothTiming::Fixed]
            .map(|timing| spawn_cloth(&mut app, GRID, (cloth_with(timing), Pins::edge(ClothEdge::Top))));
        run(&mut app, (3.0 * rate) as usize);
        for jump in 0..6 {
            let z = if jump % 2 == 0 { -0.4 } else { 0.4 };
            command(&mut app, ball, |entity| entity.teleport_collider(Transform::from_xyz(0.0, 0.0, z)));
            for _ in 0..5 {
                run(&mut app, 1);
                for cloth in cloths {
                    let moved = positions(&app, cloth).iter().map(|place| place.z.abs()).fold(0.0, f32::max);
                    assert!(moved < 5e-3, "{moved} m at {rate} Hz");
                }
            }
        }
    }
}

#[test]
fn a_reset_puts_it_back() {
    let mut app = app_at(60.0);
    let cloth = spawn_cloth(&mut app, GRID, (late(), Pins::indices([0])));
    run(&mut app, 1);
    let start = positions(&app, cloth);
    run(&mut app, 60);
    command(&mut app, cloth, |entity| entity.reset_cloth());
    run(&mut app, 1);
    let off = apart(positions(&app, cloth), start);
    assert!(off < 1e-5, "{off} m");
    assert_eq!(app.world().resource::<Heard>().reset, [(cloth, ResetCause::Requested)]);
}

#[test]
fn a_shifted_world_changes_nothing() {
    let run_one = |is_shifted: bool| {
        let mut app = app_at(144.0);
        app.world_mut().spawn(Wind { velocity: Vec3::Z * 5.0, ..default() });
        let ball = (ClothCollider::from(Sphere::new(0.25)), Transform::from_xyz(0.0, -0.125, 0.25));
        let mut all = vec![app.world_mut().spawn(ball).id()];
        let cloth = spawn_cloth(&mut app, GRID, (late(), Pins::edge(ClothEdge::Top)));
        all.push(cloth);
        for frame in 0..144 {
            if is_shifted && frame % 10 == 9 {
                app.world_mut().commands().shift_world(Vec3::X * 64.0);
                app.world_mut().flush();
            }
            run(&mut app, 1);
        }
        let origin = get::<GlobalTransform>(&app, cloth).translation();
        let state = state(&app, cloth);
        state.positions_from_origin().map(|place| place + (state.origin() - origin)).collect::<Vec<_>>()
    };
    let (stayed, shifted) = (run_one(false), run_one(true));
    let off = apart(stayed, shifted);
    assert!(off < 1e-4, "{off} m");
}

/// Changes the timing ten times, after 7, 8, 9 ... frames; `look` is told of each frame after a change.
fn change_timing(app: &mut App, cloth: Entity, mut look: impl FnMut(&App, ClothTiming, usize)) {
    for change in 0..10 {
        let timing = if change % 2 == 0 { ClothTiming::Late } else { ClothTiming::Auto };
        get_mut::<Cloth>(app, cloth).timing = timing;
        for frame in 0..(7 + change) {
            run(app, 1);
            look(app, timing, frame);
        }
    }
}

#[test]
fn a_change_of_timing_makes_no_jump() {
    for rate in RATES {
        let mut app = app_at(rate);
        // It swings down about its edge, and takes a second for that in thick air.
        let settings = Cloth { fluid_density: 5.0, ..default() };
        let cloth = spawn_cloth(&mut app, GRID.lying(), (settings, Pins::edge(ClothEdge::Top)));
        run(&mut app, 4);
        let (dt, step) = (1.0 / rate as f32, 1.0 / 64.0);
        let mut shown = points(drawn(&app, cloth));
        change_timing(&mut app, cloth, |app, timing, frame| {
            let now = points(drawn(app, cloth));
            for (vertex, (then, now)) in shown.iter().zip(&now).enumerate() {
                let velocity = state(app, cloth).velocity(vertex).unwrap();
                // A step at most comes on top of a frame, or is missing; and speeds change by some 10 m/s².
                let (way, slack) = (now - then, 20.0 * (dt + step) * (dt + step));
                let context = format!("{way} of {velocity} m/s at {rate} Hz, {timing:?}, frame {frame}");
                assert!(way.length() < velocity.length() * (dt + step) + slack, "{context}");
                let is_fast = velocity.length() > 0.5;
                assert!(!is_fast || way.dot(velocity.normalize()) > -5e-4, "back: {context}");
            }
            shown = now;
        });
    }
}

#[test]
fn a_change_of_timing_takes_pins_on_as_they_go() {
    for rate in RATES {
        let mut app = app_at(rate);
        let target = app.world_mut().spawn(Transform::default()).id();
        let (cloth, offset) = hang_on(&mut app, target, Cloth::default());
        let way = |time: f32| Transform::from_xyz(0.0, 0.0, 2.0 * time);
        app.world_mut().entity_mut(target).insert(Animated(way));
        run(&mut app, (2.0 * rate) as usize);
        change_timing(&mut app, cloth, |app, timing, frame| {
            if timing == ClothTiming::Late {
                assert!(pin_error(app, cloth, target, offset) < 1e-5);
                let pinned = state(app, cloth).velocity(0).unwrap().z;
                // The first late step makes up for what fixed ones were behind: up to a frame and a step.
                let most = if frame == 0 { 2.0 * (2.0 + rate as f32 / 64.0) } else { 2.05 };
                assert!(pinned > 1.95 && pinned < most, "{pinned} m/s at {rate} Hz, frame {frame}");
            }
        });
    }
}

#[test]
fn a_change_of_timing_takes_obstacles_on_as_they_go() {
    for rate in RATES {
        let mut app = app_at(rate);
        let way = |time: f32| Transform::from_xyz(0.0, 0.0, 2.0 * time - 0.12);
        let wall = app.world_mut().spawn((ClothCollider::from(Cuboid::new(2.0, 2.0, 0.2)), Moved(way), way(0.0))).id();
        let settings = Cloth { gravity_scale: 0.0, fluid_density: 5.0, ..default() };
        let cloth = spawn_cloth(&mut app, GRID, settings);
        run(&mut app, rate as usize);
        get_mut::<Cloth>(&mut app, cloth).timing = ClothTiming::Late;
        for frame in 0..5 {
            run(&mut app, 1);
            let face = get::<GlobalTransform>(&app, wall).translation().z + 0.1;
            let behind = positions(&app, cloth).iter().map(|place| face - place.z).fold(0.0, f32::max);
            assert!(behind < 1e-4, "{behind} m within the wall at {rate} Hz, frame {frame}");
        }
    }
}
