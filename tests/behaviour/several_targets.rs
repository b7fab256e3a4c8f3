//! A cloth that is pinned to several entities is drawn at all of them, wherever they are by now.

use bevy::prelude::*;
use bevy_drape::prelude::*;

use crate::common::*;

/// A cape that hangs on two bones, and what moves: their common parent, or each of them.
struct Hung {
    cape: Entity,
    bones: [Entity; 2],
    moved: Vec<Entity>,
}

fn grid() -> ClothGrid {
    ClothGrid::new(0.6, 1.0, 13, 21)
}

/// The ends of the top edge.
const ENDS: [u32; 2] = [0, 12];

fn hang(app: &mut App, mesh: impl Into<Mesh>, have_parent: bool) -> Hung {
    let root = app.world_mut().spawn(Transform::default()).id();
    let bones = [-0.3, 0.3].map(|x| {
        let bone = app.world_mut().spawn(Transform::from_xyz(x, 0.5, 0.0)).id();
        if have_parent {
            app.world_mut().entity_mut(root).add_child(bone);
        }
        bone
    });
    let pins = Pins::indices([ENDS[0]]).to_entity(bones[0]).and(Pins::indices([ENDS[1]]).to_entity(bones[1]));
    let cape = spawn_cloth(app, mesh, pins);
    if have_parent {
        app.world_mut().entity_mut(root).add_child(cape);
    }
    let moved = if have_parent { vec![root] } else { bones.to_vec() };
    Hung { cape, bones, moved }
}

/// Where something at `at` has gone after `time` s: at 6 m/s, turning by 2 rad/s.
fn moved(at: Transform, time: f32) -> Transform {
    let turned = Quat::from_rotation_y(2.0 * time);
    Transform { translation: at.translation + Vec3::X * 6.0 * time, rotation: turned * at.rotation, ..at }
}

/// How far pinned corners are drawn from their bones, and by how much the drawn cloth moves otherwise from one frame to the
/// next, as seen from the first bone, m, at so many frames a second; both at most.
fn gaps(mesh: Mesh, have_parent: bool, rate: f64) -> [f32; 2] {
    let mut app = headless();
    set_rates(&mut app, 1.0 / rate, 1.0 / 64.0);
    let Hung { cape, bones, moved: movers } = hang(&mut app, mesh, have_parent);
    let starts: Vec<Transform> = movers.iter().map(|&mover| *get::<Transform>(&app, mover)).collect();
    let seconds = |seconds: f64| (seconds * rate) as usize;
    run(&mut app, seconds(1.0));
    let offsets = [0, 1].map(|i| {
        let to_bone = get::<GlobalTransform>(&app, bones[i]).affine().inverse();
        to_bone.transform_point3(place(&app, cape, ENDS[i]))
    });
    let (mut gap, mut change) = (0.0_f32, 0.0_f32);
    let mut middles: Vec<Vec3> = Vec::new();
    for frame in 0..seconds(1.0) {
        for (&mover, &start) in movers.iter().zip(&starts) {
            *get_mut::<Transform>(&mut app, mover) = moved(start, frame as f32 / rate as f32);
        }
        run(&mut app, 1);
        let to_world = get::<GlobalTransform>(&app, cape).affine();
        let shown: Vec<Vec3> =
            points(drawn(&app, cape)).into_iter().map(|place| to_world.transform_point3(place)).collect();
        for i in [0, 1] {
            let wanted = get::<GlobalTransform>(&app, bones[i]).transform_point(offsets[i]);
            gap = gap.max(shown[ENDS[i] as usize].distance(wanted));
        }
        // The middle of the top edge.
        let to_bone = get::<GlobalTransform>(&app, bones[0]).affine().inverse();
        middles.push(to_bone.transform_point3(shown[6]));
        if let [.., before, middle, after] = middles[..] {
            change = change.max(before.distance(2.0 * middle - after));
        }
    }
    [gap, change]
}

#[test]
fn pinned_vertices_are_drawn_at_bones_of_one_body_at_every_frame_rate() {
    for rate in [30.0, 60.0, 144.0] {
        for mesh in [Mesh::from(grid()), uneven(grid(), 0.2)] {
            let [gap, _] = gaps(mesh, true, rate);
            assert!(gap < 1e-3, "{rate} Hz: {gap} m");
        }
    }
}

#[test]
fn pinned_vertices_are_drawn_at_entities_that_go_their_own_ways() {
    for rate in [30.0, 60.0, 144.0] {
        let [gap, _] = gaps(grid().into(), false, rate);
        assert!(gap < 1e-3, "{rate} Hz: {gap} m");
    }
}

#[test]
fn what_lies_between_follows_smoothly() {
    // In a frame of 1/144 s, 6 m/s are 42 mm: a cloth that isn't carried would stay behind by as much in some frames, and catch
    // up with its bones in others.
    let [_, change] = gaps(grid().into(), true, 144.0);
    assert!(change < 0.02, "{change} m");
}

#[test]
fn a_cloth_between_what_moves_and_the_world_is_drawn_at_both() {
    let mut app = headless();
    set_rates(&mut app, 1.0 / 150.0, 1.0 / 30.0);
    let pole = app.world_mut().spawn(Transform::default()).id();
    let pins = Pins::indices([ENDS[0]]).to_entity(pole).and(Pins::indices([ENDS[1]]).to_world());
    let cloth = spawn_cloth(&mut app, grid(), pins);
    run(&mut app, 20);
    let rest = points(&grid().into());
    for frame in 0..30 {
        let to = Vec3::new(0.2 * ops::sin(frame as f32 * 0.2), 0.0, 0.0);
        get_mut::<Transform>(&mut app, pole).translation = to;
        run(&mut app, 1);
        let shown = points(drawn(&app, cloth));
        assert_close(shown[ENDS[0] as usize], rest[ENDS[0] as usize] + to, 1e-5);
        assert_close(shown[ENDS[1] as usize], rest[ENDS[1] as usize], 1e-5);
    }
}
