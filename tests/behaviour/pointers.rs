//! Cloth that mouse and fingers take hold of: window events go in, as from a window.

use bevy::{
    camera::{CameraPlugin, ComputedCameraValues, RenderTargetInfo, ScalingMode, Viewport},
    input::{
        ButtonState, InputPlugin,
        mouse::{MouseButtonInput, MouseScrollUnit, MouseWheel},
        touch::{TouchInput, TouchPhase},
    },
    math::ops,
    picking::{
        DefaultPickingPlugins, PickingSystems,
        backend::{HitData, PointerHits},
        pointer::PointerId,
    },
    prelude::*,
    window::{CursorGrabMode, CursorMoved, CursorOptions, PrimaryWindow, WindowEvent, WindowPlugin},
};
use bevy_drape::prelude::*;

use crate::common::*;

const WINDOW: UVec2 = UVec2::new(800, 600);

/// An app with a window that nobody draws, and a camera 5 m in front of the world's origin that looks at it.
fn with_pointer() -> App {
    let mut app = headless_with((
        InputPlugin,
        WindowPlugin::default(),
        CameraPlugin,
        DefaultPickingPlugins,
        ClothPlugin::default(),
        ClothPickingPlugin,
    ));
    add_camera(&mut app, Projection::from(PerspectiveProjection::default()), None, 0);
    app
}

/// Adds a camera that sees what a renderer would give it, into all of the window or a part of it.
fn add_camera(app: &mut App, mut projection: Projection, part: Option<URect>, order: isize) -> Entity {
    let part = part.unwrap_or(URect::from_corners(UVec2::ZERO, WINDOW));
    projection.update(part.width() as f32, part.height() as f32);
    let target_info = Some(RenderTargetInfo { physical_size: WINDOW, scale_factor: 1.0 });
    let camera = Camera {
        computed: ComputedCameraValues { clip_from_view: projection.get_clip_from_view(), target_info, ..default() },
        viewport: Some(Viewport { physical_position: part.min, physical_size: part.size(), ..default() }),
        order,
        ..default()
    };
    app.world_mut().spawn((Camera3d::default(), camera, projection, Transform::from_xyz(0.0, 0.0, 5.0))).id()
}

fn window(app: &mut App) -> Entity {
    app.world_mut().query_filtered::<Entity, With<PrimaryWindow>>().single(app.world()).expect("a window")
}

/// A square metre around the origin that faces the camera and hangs by its upper corners, at rest.
fn curtain(app: &mut App) -> Entity {
    let grid = ClothGrid::new(1.0, 1.0, 24, 24);
    let cloth = spawn_cloth(app, grid, (Pins::edge_corners(ClothEdge::Top), Fabric { damping: 2.0, ..default() }));
    run(app, 60);
    cloth
}

/// Where the first camera sees a place of the world, pixels.
fn on_screen(app: &mut App, place: Vec3) -> Vec2 {
    let mut cameras = app.world_mut().query::<(&Camera, &GlobalTransform)>();
    let (camera, view) = cameras.iter(app.world()).next().expect("a camera");
    camera.world_to_viewport(view, place).expect("a place in front of the camera")
}

fn send(app: &mut App, event: impl Into<WindowEvent>) {
    app.world_mut().write_message(event.into());
}

fn move_mouse(app: &mut App, position: Vec2) {
    let window = window(app);
    send(app, CursorMoved { window, position, delta: None });
    app.update();
}

fn click(app: &mut App, button: MouseButton, state: ButtonState) {
    let window = window(app);
    send(app, MouseButtonInput { button, state, window });
    app.update();
}

fn press(app: &mut App) {
    click(app, MouseButton::Left, ButtonState::Pressed);
}

/// Presses where the first camera sees a place. Returns the pixel.
fn press_at(app: &mut App, place: Vec3) -> Vec2 {
    let at = on_screen(app, place);
    move_mouse(app, at);
    press(app);
    at
}

fn release(app: &mut App) {
    click(app, MouseButton::Left, ButtonState::Released);
}

fn touch(app: &mut App, id: u64, phase: TouchPhase, position: Vec2) {
    let window = window(app);
    let touch = TouchInput { phase, position, window, force: None, id };
    app.world_mut().write_message(touch);
    send(app, touch);
    app.update();
}

/// Where the only hold of a cloth is, and where its pointer leads it.
#[track_caller]
fn held(app: &App, cloth: Entity) -> (Vec3, Vec3) {
    let (_, point, target) = get::<ClothGrabs>(app, cloth).iter().next().expect("the cloth is held");
    (state(app, cloth).point_position(point).expect("a point of the cloth"), target)
}

#[test]
fn a_pressed_cloth_follows_the_mouse_until_it_is_let_go() {
    let mut app = with_pointer();
    let cloth = curtain(&mut app);
    let start = Vec3::new(0.1, 0.02, 0.0);
    let at = press_at(&mut app, start);
    assert!(is_held(&app, cloth));
    assert_close(held(&app, cloth).0, start, 0.02);
    for step in 1..=20 {
        move_mouse(&mut app, at + Vec2::new(0.0, -3.0) * step as f32);
    }
    run(&mut app, 60);
    // Across the view at the same distance from the camera, and at the pointer to 2 cm.
    let (point, target) = held(&app, cloth);
    let pixel = on_screen(&mut app, point);
    assert!(pixel.distance(at - Vec2::Y * 60.0) < 2.0, "{pixel} {at} {point} {target}");
    assert_close(point, target, 0.02);
    assert!((point.z - start.z).abs() < 0.02, "{point}");
    release(&mut app);
    assert!(!is_held(&app, cloth));
    assert!(app.world().resource::<PointerGrabs>().is_empty());
}

#[test]
fn both_sides_of_a_cloth_can_be_grabbed() {
    let mut app = with_pointer();
    let grid = ClothGrid::new(1.0, 1.0, 8, 8);
    let turned = Transform::from_rotation(Quat::from_rotation_y(core::f32::consts::PI));
    let cloth = spawn_cloth(&mut app, grid, (Pins::edge(ClothEdge::Top), turned));
    run(&mut app, 2);
    press_at(&mut app, Vec3::ZERO);
    assert!(is_held(&app, cloth));
}

#[test]
fn the_nearest_of_two_cloths_is_grabbed_and_none_behind_something_else() {
    let mut app = with_pointer();
    let far = curtain(&mut app);
    let near = spawn_cloth(
        &mut app,
        ClothGrid::new(0.2, 0.2, 4, 4),
        (Pins::edge(ClothEdge::Top), Transform::from_xyz(0.2, 0.0, 1.0)),
    );
    let wall = add_mesh(&mut app, Cuboid::new(0.2, 0.2, 0.2));
    app.world_mut().spawn((Mesh3d(wall), Transform::from_xyz(-0.2, 0.0, 1.0)));
    run(&mut app, 2);
    for (x, expected) in [(0.2, Some(near)), (-0.2, None), (0.0, Some(far))] {
        press_at(&mut app, Vec3::new(x, 0.0, 1.0));
        let grabs = app.world().resource::<PointerGrabs>();
        assert_eq!(grabs.held_by(PointerId::Mouse), expected, "at {x}");
        release(&mut app);
    }
}

#[test]
fn a_panel_that_has_the_pointer_is_in_the_way() {
    let mut app = with_pointer();
    let panel = app.world_mut().spawn_empty().id();
    // As egui does: another backend, of which all hits are in front of the scene's.
    let hits = move |cameras: Query<Entity, With<Camera>>, mut hits: MessageWriter<PointerHits>| {
        let hit = HitData::new(cameras.single()?, 0.0, None, None);
        hits.write(PointerHits::new(PointerId::Mouse, vec![(panel, hit)], 1e6));
        Ok::<_, BevyError>(())
    };
    app.add_systems(PreUpdate, hits.in_set(PickingSystems::Backend));
    let cloth = curtain(&mut app);
    press_at(&mut app, Vec3::ZERO);
    assert!(!is_held(&app, cloth));
}

#[cfg(feature = "panel")]
#[test]
fn a_finger_that_comes_down_on_an_egui_window_grabs_nothing_behind_it() {
    use bevy_egui::{EguiContext, egui};

    let mut app = with_pointer();
    let cloth = curtain(&mut app);
    let [covered, free] = [Vec3::ZERO, Vec3::new(0.3, -0.3, 0.0)].map(|place| on_screen(&mut app, place));
    let mut context = EguiContext::default();
    // An area is measured in its first pass and is there from the second on.
    for _ in 0..2 {
        let screen = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(800.0, 600.0));
        context.get_mut().begin_pass(egui::RawInput { screen_rect: Some(screen), ..default() });
        egui::Area::new(egui::Id::new("cover"))
            .fixed_pos(egui::pos2(covered.x - 20.0, covered.y - 20.0))
            .show(context.get_mut(), |ui| ui.allocate_space(egui::vec2(40.0, 40.0)));
        let _ = context.get_mut().end_pass();
    }
    app.world_mut().spawn(context);
    touch(&mut app, 1, TouchPhase::Started, covered);
    assert!(!is_held(&app, cloth));
    touch(&mut app, 2, TouchPhase::Started, free);
    assert!(is_held(&app, cloth), "beside it");
}

#[test]
fn the_wheel_moves_what_is_held_away_and_back() {
    let mut app = with_pointer();
    let cloth = curtain(&mut app);
    press_at(&mut app, Vec3::new(0.0, -0.3, 0.0));
    let depth = |app: &App| 5.0 - held(app, cloth).1.z;
    let before = depth(&app);
    let window = window(&mut app);
    for (unit, y) in [(MouseScrollUnit::Line, 1.0), (MouseScrollUnit::Pixel, -40.0)] {
        let scroll = MouseWheel { unit, x: 0.0, y, window, phase: TouchPhase::Moved };
        send(&mut app, scroll);
        app.update();
        let expected = if y > 0.0 { before * ops::exp(0.1) } else { before };
        assert!((depth(&app) - expected).abs() < 1e-3, "{} m after {y}", depth(&app));
    }
}

#[test]
fn two_fingers_hold_two_places() {
    let mut app = with_pointer();
    let cloth = curtain(&mut app);
    let places = [Vec3::new(-0.3, -0.2, 0.0), Vec3::new(0.3, -0.2, 0.0)];
    for (id, place) in (1..).zip(places) {
        let at = on_screen(&mut app, place);
        touch(&mut app, id, TouchPhase::Started, at);
    }
    assert_eq!(get::<ClothGrabs>(&app, cloth).len(), 2);
    let up = places.map(|place| place + Vec3::new(0.0, 0.2, 0.0));
    for (id, place) in (1..).zip(up) {
        let at = on_screen(&mut app, place);
        touch(&mut app, id, TouchPhase::Moved, at);
    }
    run(&mut app, 90);
    for (_, point, target) in get::<ClothGrabs>(&app, cloth).iter() {
        let point = state(&app, cloth).point_position(point).unwrap();
        assert_close(point, target, 0.02);
        assert!(up.iter().any(|place| place.distance(point) < 0.05), "{point}");
    }
    let at = on_screen(&mut app, up[0]);
    touch(&mut app, 1, TouchPhase::Ended, at);
    assert_eq!(get::<ClothGrabs>(&app, cloth).len(), 1);
    touch(&mut app, 2, TouchPhase::Canceled, at);
    assert!(!is_held(&app, cloth));
}

#[test]
fn a_second_finger_beside_the_cloth_pinches_it_nearer_and_farther() {
    let mut app = with_pointer();
    let cloth = curtain(&mut app);
    let at = on_screen(&mut app, Vec3::new(0.0, -0.2, 0.0));
    touch(&mut app, 1, TouchPhase::Started, at);
    let before = 5.0 - held(&app, cloth).1.z;
    touch(&mut app, 2, TouchPhase::Started, at + Vec2::X * 200.0);
    touch(&mut app, 2, TouchPhase::Moved, at + Vec2::X * 250.0);
    assert_eq!(get::<ClothGrabs>(&app, cloth).len(), 1);
    let after = 5.0 - held(&app, cloth).1.z;
    assert!((after / before - 200.0 / 250.0).abs() < 0.01, "from {before} m to {after} m");
}

#[test]
fn a_key_or_a_setting_turns_a_release_into_a_pin() {
    for by_key in [true, false] {
        let mut app = with_pointer();
        let cloth = curtain(&mut app);
        let pins = pinned(&app, cloth).len();
        let at = press_at(&mut app, Vec3::new(0.01, -0.1, 0.0));
        move_mouse(&mut app, at + Vec2::new(20.0, -60.0));
        run(&mut app, 60);
        let (point, _) = held(&app, cloth);
        if by_key {
            app.world_mut().resource_mut::<ButtonInput<KeyCode>>().press(KeyCode::ShiftLeft);
        } else {
            app.world_mut().resource_mut::<ClothPickingSettings>().pin_on_release = true;
        }
        release(&mut app);
        run(&mut app, 60);
        assert!(!is_held(&app, cloth));
        assert_eq!(pinned(&app, cloth).len(), pins + 3, "the triangle's particles");
        let state = state(&app, cloth);
        let stays = state.point_position(state.nearest_point(point).unwrap()).unwrap();
        assert_close(stays, point, 0.01);
    }
}

#[test]
fn each_camera_of_a_split_screen_grabs_in_its_own_view() {
    for projection in [
        Projection::from(PerspectiveProjection::default()),
        Projection::from(OrthographicProjection {
            scaling_mode: ScalingMode::FixedVertical { viewport_height: 3.0 },
            ..OrthographicProjection::default_3d()
        }),
    ] {
        let mut app = with_pointer();
        let half = URect::new(WINDOW.x / 2, 0, WINDOW.x, WINDOW.y);
        let camera = add_camera(&mut app, projection, Some(half), 1);
        let cloth = curtain(&mut app);
        let (camera, view) = {
            let mut cameras = app.world_mut().query::<(&Camera, &GlobalTransform)>();
            let (camera, view) = cameras.get(app.world(), camera).unwrap();
            (camera.clone(), *view)
        };
        let at = |place| camera.world_to_viewport(&view, place).unwrap();
        let start = Vec3::new(0.1, -0.2, 0.0);
        move_mouse(&mut app, at(start));
        press(&mut app);
        let target = start + Vec3::new(0.1, 0.1, 0.0);
        move_mouse(&mut app, at(target));
        run(&mut app, 60);
        assert_close(held(&app, cloth).1, target, 0.02);
        assert_close(held(&app, cloth).0, target, 0.03);
        // Beyond its own view, the pointer still leads.
        let beyond = start - Vec3::X * 0.05;
        move_mouse(&mut app, at(beyond) - Vec2::X * at(beyond).x + Vec2::X * 380.0);
        assert!(held(&app, cloth).1.x < start.x, "{}", held(&app, cloth).1);
    }
}

#[test]
fn a_pointer_that_turns_the_camera_does_not_grab() {
    let mut app = with_pointer();
    let cloth = curtain(&mut app);
    let at = on_screen(&mut app, Vec3::ZERO);
    move_mouse(&mut app, at);
    click(&mut app, MouseButton::Right, ButtonState::Pressed);
    press(&mut app);
    assert!(!is_held(&app, cloth), "the right button is down");
    release(&mut app);
    click(&mut app, MouseButton::Right, ButtonState::Released);
    let window = window(&mut app);
    get_mut::<CursorOptions>(&mut app, window).grab_mode = CursorGrabMode::Locked;
    press(&mut app);
    assert!(!is_held(&app, cloth), "the cursor is locked");
    release(&mut app);
    get_mut::<CursorOptions>(&mut app, window).grab_mode = CursorGrabMode::None;
    press(&mut app);
    assert!(is_held(&app, cloth));
}

#[test]
fn what_is_switched_off_or_ignored_is_not_grabbed() {
    let mut app = with_pointer();
    let cloth = curtain(&mut app);
    let at = on_screen(&mut app, Vec3::ZERO);
    move_mouse(&mut app, at);
    app.world_mut().resource_mut::<ClothPickingSettings>().enabled = false;
    press(&mut app);
    assert!(!is_held(&app, cloth));
    release(&mut app);
    app.world_mut().resource_mut::<ClothPickingSettings>().enabled = true;
    app.world_mut().entity_mut(cloth).insert(Pickable::IGNORE);
    app.update();
    press(&mut app);
    assert!(!is_held(&app, cloth));
}

#[test]
fn a_cloth_that_goes_while_it_is_held_ends_the_hold_quietly() {
    let ends: [(&str, fn(&mut App, Entity)); 4] = [
        ("despawn", |app, cloth| app.world_mut().entity_mut(cloth).despawn()),
        ("remove", |app, cloth| {
            app.world_mut().entity_mut(cloth).remove::<Cloth>();
        }),
        ("reset", |app, cloth| command(app, cloth, |cloth| cloth.reset_cloth())),
        ("mesh gone", |app, cloth| {
            app.world_mut().entity_mut(cloth).remove::<Mesh3d>();
        }),
    ];
    for (name, end) in ends {
        let mut app = with_pointer();
        let cloth = curtain(&mut app);
        let at = press_at(&mut app, Vec3::ZERO);
        assert!(is_held(&app, cloth), "{name}");
        end(&mut app, cloth);
        run(&mut app, 2);
        move_mouse(&mut app, at + Vec2::X);
        release(&mut app);
        assert!(app.world().resource::<PointerGrabs>().is_empty(), "{name}");
    }
}

#[test]
fn a_camera_that_goes_leaves_the_hold_where_it_is() {
    let mut app = with_pointer();
    let cloth = curtain(&mut app);
    let at = press_at(&mut app, Vec3::ZERO);
    let camera = app.world_mut().query_filtered::<Entity, With<Camera>>().single(app.world()).unwrap();
    app.world_mut().entity_mut(camera).despawn();
    let (_, target) = held(&app, cloth);
    move_mouse(&mut app, at + Vec2::X * 100.0);
    assert_eq!(held(&app, cloth).1, target);
    release(&mut app);
    assert!(!is_held(&app, cloth));
}

#[test]
fn a_jerk_of_the_mouse_keeps_the_cloth_in_one_piece() {
    let mut app = with_pointer();
    // A cloth that is flat to the last bit and pulled within its plane couldn't fold.
    app.world_mut().spawn(Wind { velocity: Vec3::Z * 0.5, ..default() });
    let cloth = curtain(&mut app);
    let at = press_at(&mut app, Vec3::new(0.0, -0.4, 0.0));
    for side in [-1.0, 1.0, -1.0, 1.0] {
        move_mouse(&mut app, at + Vec2::new(side * 390.0, -250.0));
        run(&mut app, 5);
        assert!(positions(&app, cloth).iter().all(|p| p.distance(Vec3::Y * 0.5) < 1.3));
    }
    release(&mut app);
    run(&mut app, 240);
    let strain = state(&app, cloth).strain();
    assert!(strain.mean < 0.005 && strain.largest < 0.1, "{strain:?}");
    assert_eq!(app.world().resource::<Heard>().reset, []);
}

#[test]
fn without_picking_plugins_the_app_runs_on() {
    let mut app = headless_with((ClothPlugin::default(), ClothPickingPlugin));
    spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 4, 4), ());
    run(&mut app, 3);
}

#[test]
fn an_app_may_add_mesh_picking_itself() {
    let mut app = headless_with((
        InputPlugin,
        WindowPlugin::default(),
        CameraPlugin,
        DefaultPickingPlugins,
        ClothPlugin::default(),
        ClothPickingPlugin,
        MeshPickingPlugin,
    ));
    add_camera(&mut app, Projection::from(PerspectiveProjection::default()), None, 0);
    let cloth = curtain(&mut app);
    press_at(&mut app, Vec3::ZERO);
    assert_eq!(get::<ClothGrabs>(&app, cloth).len(), 1);
}
