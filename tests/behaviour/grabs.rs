//! Cloth that code takes hold of.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

/// What grabs have announced: cloth, hold, world position.
#[derive(Resource, Default)]
struct Told {
    grabbed: Vec<ClothGrabbed>,
    released: Vec<ClothReleased>,
}

fn with_ears() -> App {
    let mut app = headless();
    app.init_resource::<Told>()
        .add_observer(|event: On<ClothGrabbed>, mut told: ResMut<Told>| told.grabbed.push(*event))
        .add_observer(|event: On<ClothReleased>, mut told: ResMut<Told>| told.released.push(*event));
    app
}

/// A square metre that hangs by its upper corners, ready.
fn curtain(app: &mut App, more: impl Bundle) -> Entity {
    let grid = ClothGrid::new(1.0, 1.0, 16, 16);
    let cloth = spawn_cloth(app, grid, (Pins::edge_corners(ClothEdge::Top), more));
    app.update();
    cloth
}

/// Takes hold of the point of a cloth that is nearest to `place`.
fn grab(app: &mut App, cloth: Entity, place: Vec3) -> (GrabId, ClothPoint) {
    let point = state(app, cloth).nearest_point(place).expect("a cloth");
    (take_hold(app, cloth, point, ClothGrip::default()).expect("a point of the cloth"), point)
}

#[test]
fn the_nearest_point_of_a_cloth_is_on_it() {
    let mut app = headless();
    let cloth = curtain(&mut app, Transform::from_xyz(0.0, 5.0, 0.0));
    let state = state(&app, cloth);
    let place = |position| state.point_position(state.nearest_point(position).unwrap()).unwrap();
    // Gravity has moved it by one step's way at most.
    assert_close(place(Vec3::new(0.123, 5.2, 0.4)), Vec3::new(0.123, 5.2, 0.0), 0.01);
    assert_close(place(Vec3::new(3.0, 8.0, 1.0)), Vec3::new(0.5, 5.5, 0.0), 1e-3);
    assert_eq!(state.nearest_point(Vec3::NAN), None);
    assert_eq!(state.point_position(ClothPoint { triangle: u32::MAX, ..default() }), None);
}

#[test]
fn a_grabbed_point_follows_the_hand_and_is_let_go() {
    let mut app = headless();
    let cloth = curtain(&mut app, ());
    let (hand, point) = grab(&mut app, cloth, Vec3::new(0.1, -0.3, 0.0));
    let target = Vec3::new(0.2, 0.0, 0.5);
    assert!(lead(&mut app, cloth, hand, target));
    run(&mut app, 120);
    assert_close(state(&app, cloth).point_position(point).unwrap(), target, 0.005);
    assert!(is_held(&app, cloth));
    assert!(let_go(&mut app, cloth, hand));
    assert!(!let_go(&mut app, cloth, hand) && !lead(&mut app, cloth, hand, Vec3::ZERO), "the hold has ended");
    run(&mut app, 240);
    assert!(!is_held(&app, cloth));
    assert!(state(&app, cloth).point_position(point).unwrap().y < -0.2, "it hangs again");
}

#[test]
fn two_hands_hold_a_free_cloth() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 16, 16), ());
    app.update();
    let hands = [Vec3::new(-0.5, 0.5, 0.0), Vec3::new(0.5, 0.5, 0.0)].map(|corner| grab(&mut app, cloth, corner));
    run(&mut app, 120);
    for ((_, point), x) in hands.into_iter().zip([-0.5, 0.5]) {
        assert_close(state(&app, cloth).point_position(point).unwrap(), Vec3::new(x, 0.5, 0.0), 0.02);
    }
}

#[test]
fn what_is_pinned_stays_pinned_in_a_hand() {
    let mut app = headless();
    let cloth = curtain(&mut app, ());
    let before = place(&app, cloth, 0);
    let (hand, _) = grab(&mut app, cloth, before);
    lead(&mut app, cloth, hand, Vec3::splat(3.0));
    run(&mut app, 30);
    assert_eq!(place(&app, cloth, 0), before);
}

#[test]
fn grabbing_and_letting_go_are_told_with_place_and_triangle() {
    let mut app = with_ears();
    let cloth = curtain(&mut app, Transform::from_xyz(0.0, 0.0, 2.0));
    let (hand, point) = grab(&mut app, cloth, Vec3::new(0.0, 0.0, 2.0));
    run(&mut app, 2);
    let_go(&mut app, cloth, hand);
    run(&mut app, 2);
    let told = app.world().resource::<Told>();
    let [grabbed] = told.grabbed[..] else { panic!("told once, not {}", told.grabbed.len()) };
    let [released] = told.released[..] else { panic!("told once, not {}", told.released.len()) };
    assert_eq!((grabbed.entity, grabbed.grab, grabbed.point), (cloth, hand, point));
    assert_eq!((released.entity, released.grab, released.point), (cloth, hand, point));
    assert_close(grabbed.position, Vec3::new(0.0, 0.0, 2.0), 0.02);
    assert_close(released.position, Vec3::new(0.0, 0.0, 2.0), 0.05);
}

#[test]
fn grabs_are_told_while_time_stands_still() {
    let mut app = with_ears();
    let cloth = curtain(&mut app, ());
    app.world_mut().resource_mut::<Time<Virtual>>().pause();
    let (hand, _) = grab(&mut app, cloth, Vec3::ZERO);
    app.update();
    assert_eq!(app.world().resource::<Told>().grabbed.len(), 1);
    let_go(&mut app, cloth, hand);
    app.update();
    assert_eq!(app.world().resource::<Told>().released.len(), 1);
}

#[test]
fn reset_rebuild_and_teleport_end_all_holds() {
    let acts: [(&str, fn(&mut App, Entity)); 3] = [
        ("reset", |app, cloth| command(app, cloth, |cloth| cloth.reset_cloth())),
        ("rebuild", |app, cloth| {
            let mesh = add_mesh(app, ClothGrid::new(1.0, 1.0, 8, 8));
            get_mut::<Mesh3d>(app, cloth).0 = mesh;
        }),
        ("teleport", |app, cloth| {
            command(app, cloth, |cloth| cloth.teleport_cloth(Transform::from_xyz(50.0, 0.0, 0.0)));
        }),
    ];
    for (name, act) in acts {
        let mut app = with_ears();
        let cloth = curtain(&mut app, ());
        let (hand, _) = grab(&mut app, cloth, Vec3::ZERO);
        app.update();
        act(&mut app, cloth);
        run(&mut app, 3);
        assert!(!is_held(&app, cloth), "{name}");
        assert_eq!(app.world().resource::<Told>().released.len(), 1, "{name}");
        assert!(!lead(&mut app, cloth, hand, Vec3::ZERO), "{name}");
        let (next, _) = grab(&mut app, cloth, Vec3::ZERO);
        assert_ne!(hand, next, "{name}: an old hold isn't taken for a new one");
    }
}

#[test]
fn a_held_cloth_can_be_despawned_and_lose_its_component() {
    let mut app = with_ears();
    let (gone, plain) = (curtain(&mut app, ()), curtain(&mut app, ()));
    grab(&mut app, gone, Vec3::ZERO);
    grab(&mut app, plain, Vec3::ZERO);
    app.update();
    app.world_mut().entity_mut(gone).despawn();
    app.world_mut().entity_mut(plain).remove::<Cloth>();
    run(&mut app, 3);
    assert_eq!(app.world().resource::<Told>().released, []);
}

#[test]
fn odd_grips_and_targets_do_no_harm() {
    let odd = [f32::NAN, f32::INFINITY, -1.0, 0.0, f32::MAX];
    for value in odd {
        let mut app = headless();
        let cloth = curtain(&mut app, ());
        let grip = ClothGrip { stiffness: value, damping: value, max_force: value, max_speed: value, mass: value };
        let point = state(&app, cloth).nearest_point(Vec3::ZERO).unwrap();
        let hand = take_hold(&mut app, cloth, point, grip).unwrap();
        assert!(!lead(&mut app, cloth, hand, Vec3::splat(value)) || value.is_finite());
        lead(&mut app, cloth, hand, Vec3::Z);
        run(&mut app, 30);
        assert!(positions(&app, cloth).iter().all(|p| p.is_finite() && p.length() < 10.0), "{value}");
        assert_eq!(app.world().resource::<Heard>().reset, [], "{value}");
    }
}

#[test]
fn weights_that_are_no_point_of_the_triangle_are_refused() {
    let mut app = headless();
    let cloth = curtain(&mut app, ());
    for weights in [Vec3::NAN, Vec3::ZERO, Vec3::splat(5.0), Vec3::new(-1.0, 1.0, 1.0)] {
        let point = ClothPoint { triangle: 0, weights };
        assert_eq!(take_hold(&mut app, cloth, point, ClothGrip::default()), None, "{weights}");
    }
}

#[test]
fn a_hand_leads_a_cloth_far_from_where_it_was() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 8, 8), undamped());
    app.update();
    let point = state(&app, cloth).nearest_point(Vec3::ZERO).unwrap();
    let hand = take_hold(&mut app, cloth, point, ClothGrip { max_speed: 60.0, ..default() }).unwrap();
    // Beyond the distance at which the cloth's origin follows it.
    for frame in 0..=600 {
        lead(&mut app, cloth, hand, Vec3::X * 0.8 * frame as f32);
        app.update();
    }
    run(&mut app, 300);
    assert_close(state(&app, cloth).point_position(point).unwrap(), Vec3::X * 480.0, 0.02);
    assert!(state(&app, cloth).origin().x > 200.0);
}
