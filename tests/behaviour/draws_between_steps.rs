//! Between steps, what is drawn lies between them; and nothing is written while nothing moves.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

/// Meshes that were written, and how often the app has updated.
#[derive(Resource, Default)]
struct Written(Vec<AssetId<Mesh>>);

fn watch(app: &mut App) {
    let note = |mut events: MessageReader<AssetEvent<Mesh>>, mut written: ResMut<Written>| {
        written.0.extend(events.read().filter_map(|event| match event {
            AssetEvent::Modified { id } => Some(*id),
            _ => None,
        }));
    };
    app.init_resource::<Written>().add_systems(Last, note);
}

/// How often an entity's mesh was written within `frames` updates.
fn writes(app: &mut App, cloth: Entity, frames: usize) -> usize {
    app.world_mut().resource_mut::<Written>().0.clear();
    run(app, frames);
    let id = get::<Mesh3d>(app, cloth).0.id();
    app.world().resource::<Written>().0.iter().filter(|&&written| written == id).count()
}

fn pause(app: &mut App) {
    app.world_mut().resource_mut::<Time<Virtual>>().pause();
}

#[test]
fn half_a_step_later_the_cloth_is_drawn_half_way() {
    let mut app = headless();
    set_rates(&mut app, 1.0 / 64.0, 1.0 / 32.0);
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 5, 5), Pins::indices([0]));
    let (mut between, mut at_start) = (0, 0);
    let mut start = points(&ClothGrid::new(1.0, 1.0, 5, 5).into());
    let mut end = start.clone();
    for _ in 0..40 {
        run(&mut app, 1);
        let overstep = app.world().resource::<Time<Fixed>>().overstep_fraction();
        if positions(&app, cloth) != end {
            start = core::mem::replace(&mut end, positions(&app, cloth));
        }
        for ((shown, start), end) in points(drawn(&app, cloth)).into_iter().zip(&start).zip(&end) {
            assert_close(shown, start.lerp(*end, overstep), 1e-6);
        }
        between += usize::from((overstep - 0.5).abs() < 1e-3 && start[12].distance(end[12]) > 1e-3);
        at_start += usize::from(overstep < 1e-3);
    }
    assert!(between >= 10 && at_start >= 10, "{between} frames between steps, {at_start} on them");
}

#[test]
fn a_cloth_is_written_once_a_frame() {
    let mut app = headless();
    watch(&mut app);
    let more = (Pins::corners(), ClothSleepingDisabled);
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 5, 5), more);
    run(&mut app, 2);
    assert_eq!(writes(&mut app, cloth, 20), 20);
    set_rates(&mut app, 1.0 / 20.0, 1.0 / 60.0);
    assert_eq!(writes(&mut app, cloth, 20), 20, "three steps a frame");
}

#[test]
fn a_cloth_is_not_written_while_time_stands_still() {
    for plugin in [ClothPlugin::default(), ClothPlugin::new(Update)] {
        let mut app = headless_with(plugin);
        watch(&mut app);
        let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 5, 5), Pins::corners());
        run(&mut app, 10);
        pause(&mut app);
        run(&mut app, 1);
        assert_eq!(writes(&mut app, cloth, 10), 0, "{plugin:?}");
    }
}

#[test]
fn a_paused_cloth_that_nothing_carries_stays_in_the_world_when_its_entity_moves() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 5, 5), Pins::corners().to_world());
    run(&mut app, 10);
    pause(&mut app);
    run(&mut app, 1);
    let before = points(drawn(&app, cloth));
    get_mut::<Transform>(&mut app, cloth).translation.x = 2.0;
    run(&mut app, 1);
    for (now, before) in points(drawn(&app, cloth)).into_iter().zip(before) {
        assert_close(now, before - Vec3::X * 2.0, 1e-6);
    }
}

/// How far pinned corners are drawn from where they are on an entity that moves and turns in every update.
fn farthest_from_carrier(pins: impl Fn(Entity) -> Pins, carrier_is_cloth: bool) -> f32 {
    let mut app = headless();
    set_rates(&mut app, 1.0 / 64.0, 1.0 / 20.0);
    let grid = ClothGrid::new(1.0, 1.0, 5, 5);
    let pole = app.world_mut().spawn(Transform::default()).id();
    let cloth = spawn_cloth(&mut app, grid, pins(pole));
    let carrier = if carrier_is_cloth { cloth } else { pole };
    run(&mut app, 5);
    let mut farthest = 0.0_f32;
    for _ in 0..60 {
        let mut transform = app.world_mut().get_mut::<Transform>(carrier).unwrap();
        transform.translation.x += 5.0 / 64.0;
        transform.rotate_y(0.02);
        run(&mut app, 1);
        let shown = points(drawn(&app, cloth));
        let (of_cloth, of_carrier) = (get::<GlobalTransform>(&app, cloth), get::<GlobalTransform>(&app, carrier));
        let wanted = of_carrier.transform_point(points(&grid.into())[0]);
        farthest = farthest.max(of_cloth.transform_point(shown[0]).distance(wanted));
    }
    farthest
}

#[test]
fn a_cloth_is_drawn_on_the_entity_that_carries_it_wherever_that_is_by_now() {
    let on_itself = farthest_from_carrier(|_| Pins::edge(ClothEdge::Top), true);
    assert!(on_itself < 1e-4, "{on_itself} m");
    let on_a_pole = farthest_from_carrier(|pole| Pins::edge(ClothEdge::Top).to_entity(pole), false);
    assert!(on_a_pole < 1e-4, "{on_a_pole} m");
}

#[test]
fn a_cloth_that_has_come_to_rest_is_not_written() {
    let mut app = headless();
    watch(&mut app);
    let all = Pins::region(Vec3::splat(-1.0), Vec3::splat(1.0));
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 5, 5), all);
    run(&mut app, 5);
    assert_eq!(writes(&mut app, cloth, 20), 0);
}
