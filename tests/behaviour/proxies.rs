//! Fine meshes that follow a coarse cloth.

use bevy::{mesh::skinning::SkinnedMesh, prelude::*};
use bevy_drape::prelude::*;

use crate::{
    common::*,
    garments::{cut, seen, skin, spawn_skeleton},
    quiet::Quiet,
    worn::{SIDE, dress},
};

/// A sheet of 1 m x 1 m of any triangles, so many vertices along each side, before a sheet at z = 0.
fn fine(count: u32, z: f32) -> Mesh {
    uneven(ClothGrid::new(1.0, 1.0, count, count), 0.3).translated_by(Vec3::Z * z)
}

fn coarse() -> Mesh {
    uneven(ClothGrid::new(1.0, 1.0, 9, 9), 0.3)
}

/// Spawns a fine mesh that follows `driver`.
fn spawn_proxy(app: &mut App, driver: Entity, mesh: Mesh, more: impl Bundle) -> Entity {
    let mesh = add_mesh(app, mesh);
    app.world_mut().spawn((Mesh3d(mesh), ClothProxy::new(driver))).insert(more).id()
}

/// How far each point is from the triangles of a cloth, m.
fn distances(app: &App, cloth: Entity, points: &[Vec3]) -> Vec<f32> {
    let state = state(app, cloth);
    let distance = |&point: &Vec3| {
        let nearest = state.nearest_point(point).expect("it has triangles");
        state.point_position(nearest).expect("its own").distance(point)
    };
    points.iter().map(distance).collect()
}

#[test]
fn a_fine_mesh_is_exactly_as_modelled_while_its_driver_is_at_rest() {
    let mut app = headless();
    let free = Cloth { gravity_scale: 0.0, ..default() };
    let place =
        Transform::from_xyz(3.0, 1.0, -2.0).with_rotation(Quat::from_rotation_y(1.0)).with_scale(Vec3::splat(0.5));
    let driver = spawn_cloth(&mut app, coarse(), (free, undamped(), place));
    let mesh = fine(41, 0.01);
    let proxy = spawn_proxy(&mut app, driver, mesh.clone(), place);
    // Elsewhere than its driver, and of another size.
    let [own, other] = [place, Transform::from_xyz(2.0, 1.5, -1.0).with_scale(Vec3::splat(2.0))];
    let to_other = other.compute_affine().inverse() * own.compute_affine();
    let moved = {
        let places: Vec<_> = points(&mesh).into_iter().map(|p| to_other.transform_point3(p).to_array()).collect();
        mesh.clone().with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, places)
    };
    let beside = spawn_proxy(&mut app, driver, moved.clone(), other);
    run(&mut app, 3);
    for (proxy, mesh) in [(proxy, &mesh), (beside, &moved)] {
        for (seen, modelled) in points(drawn(&app, proxy)).into_iter().zip(points(mesh)) {
            assert_close(seen, modelled, 1e-6);
        }
    }
}

#[test]
fn a_fine_mesh_goes_with_its_driver_and_is_shaded_by_its_own_triangles() {
    let mut app = headless();
    let driver = spawn_cloth(&mut app, coarse(), Pins::edge(ClothEdge::Top));
    let proxy = spawn_proxy(&mut app, driver, fine(41, 0.01), ());
    app.world_mut().spawn(Wind { velocity: Vec3::Z * 6.0, ..default() });
    run(&mut app, 90);
    let places = points(drawn(&app, proxy));
    assert!(places.iter().any(|place| place.z > 0.2), "it blows with the driver");
    // Drawing is a step behind.
    let far = distances(&app, driver, &places).into_iter().fold(0.0, f32::max);
    assert!(far < 0.05, "{far}");
    let mesh = drawn(&app, proxy);
    let shown = normals(mesh);
    let mut expected = vec![Vec3::ZERO; places.len()];
    for triangle in mesh.indices().unwrap().iter().collect::<Vec<_>>().chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|i| places[triangle[i]]);
        triangle.iter().for_each(|&i| expected[i] += (b - a).cross(c - a));
    }
    for (shown, expected) in shown.into_iter().zip(expected) {
        assert_close(shown, expected.normalize(), 1e-3);
    }
}

#[test]
fn parts_of_a_fine_garment_have_no_gap() {
    let mut app = headless();
    let driver = spawn_cloth(&mut app, coarse(), Pins::edge(ClothEdge::Top));
    let proxy = app.world_mut().spawn((ClothProxy::new(driver), Transform::default())).id();
    let whole = fine(31, 0.01);
    let parts: Vec<Entity> = cut(&whole, 2, |middle| usize::from(middle.x > 0.0))
        .into_iter()
        .map(|part| {
            let mesh = add_mesh(&mut app, part);
            app.world_mut().spawn((Mesh3d(mesh), Transform::default(), ChildOf(proxy))).id()
        })
        .collect();
    app.world_mut().spawn(Wind { velocity: Vec3::Z * 6.0, ..default() });
    run(&mut app, 60);
    let [left, right] = [0, 1].map(|part: usize| seen(&app, parts[part]));
    let shared = left.iter().filter(|place| right.contains(place)).count();
    assert_eq!(shared, 31, "the seam");
    assert!(left.iter().any(|place| place.z > 0.1));
}

#[test]
fn what_the_driver_has_pinned_to_its_skeleton_is_drawn_by_that_alone() {
    let mut app = headless();
    let skeleton = spawn_skeleton(&mut app, Transform::from_xyz(0.0, 2.0, 0.0));
    let driver = spawn_cloth(&mut app, dress(true), (skeleton.clone(), Pins::edge(ClothEdge::Top)));
    // The driver's own mesh as the fine one: its first row is pinned.
    let mesh = dress(true);
    let proxy = spawn_proxy(&mut app, driver, mesh.clone(), skeleton.clone());
    for frame in 0..30 {
        let mut joint = get_mut::<Transform>(&mut app, skeleton.joints[0]);
        joint.translation.x = 0.05 * frame as f32;
        joint.rotation = Quat::from_rotation_y(ops::sin(0.1 * frame as f32));
        run(&mut app, 1);
    }
    let (own, body) = (drawn(&app, proxy), points(&mesh));
    assert!(app.world().get::<SkinnedMesh>(proxy).is_some(), "the renderer skins it");
    assert_eq!(points(own)[..SIDE], body[..SIDE]);
    assert_eq!(skin(own)[..SIDE], skin(&mesh)[..SIDE]);
    assert_ne!(skin(own)[SIDE..], skin(&mesh)[SIDE..]);
    // The rest is where the driver is drawn: the same vertices in the same bind space.
    for (own, driver) in points(own).into_iter().zip(points(drawn(&app, driver))) {
        assert_close(own, driver, 1e-5);
    }
}

#[test]
fn a_proxy_without_a_driver_that_runs_is_told_of_once() {
    let mut quiet = Quiet::new();
    let nobody = quiet.app.world_mut().spawn(Transform::default()).id();
    let lost = spawn_proxy(&mut quiet.app, nobody, coarse(), ());
    let first = spawn_proxy(&mut quiet.app, lost, coarse(), ());
    // Two that follow each other.
    let second = spawn_proxy(&mut quiet.app, first, coarse(), ());
    quiet.app.world_mut().entity_mut(first).insert(ClothProxy::new(second));
    assert_eq!(quiet.run(240), Vec::<String>::new(), "scenes may still come");
    let said = quiet.run(300);
    assert_eq!(said.len(), 3, "{said:?}");
    for proxy in [lost, first, second] {
        assert!(said.iter().any(|line| line.contains(&format!("cloth proxy {proxy}"))), "{said:?}");
    }
    // There is one by now.
    let mesh = add_mesh(&mut quiet.app, coarse());
    quiet.app.world_mut().entity_mut(nobody).insert((Mesh3d(mesh), Cloth::default(), stiff()));
    assert_eq!(quiet.run(5), Vec::<String>::new());
    assert!(points(drawn(&quiet.app, lost)).iter().any(|place| place.y < -0.501), "it falls with its driver");
}

#[test]
fn a_proxy_on_another_skeleton_is_refused() {
    let mut quiet = Quiet::new();
    let skeletons = [0, 1].map(|_| spawn_skeleton(&mut quiet.app, Transform::default()));
    let driver = spawn_cloth(&mut quiet.app, dress(true), (skeletons[0].clone(), stiff(), Pins::edge(ClothEdge::Top)));
    spawn_proxy(&mut quiet.app, driver, dress(true), skeletons[1].clone());
    spawn_proxy(&mut quiet.app, driver, coarse(), ());
    let said = quiet.run(10);
    assert_eq!(said.len(), 2, "{said:?}");
    assert!(said.iter().all(|line| line.contains("skeleton")), "{said:?}");
}

#[test]
fn vertices_beyond_reach_are_told_of_and_follow_all_the_same() {
    let mut quiet = Quiet::new();
    let driver = spawn_cloth(&mut quiet.app, coarse(), (stiff(), Pins::edge(ClothEdge::Top)));
    let proxy = spawn_proxy(&mut quiet.app, driver, fine(5, 0.2), ());
    let said = quiet.run(10);
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains("25 of its 25 points"), "{said:?}");
    assert!(quiet.app.world().get::<Mesh3d>(proxy).is_some());
    quiet.app.world_mut().entity_mut(proxy).insert(ClothProxy { reach: 0.3, ..ClothProxy::new(driver) });
    assert_eq!(quiet.run(5), Vec::<String>::new());
    quiet.app.world_mut().entity_mut(proxy).insert(ClothProxy { reach: f32::NAN, ..ClothProxy::new(driver) });
    let said = quiet.run(5);
    assert_eq!(said.len(), 1, "{said:?}");
}

#[test]
fn a_proxy_follows_a_driver_that_is_made_anew_and_stays_as_drawn_without() {
    let mut app = headless();
    let driver = spawn_cloth(&mut app, coarse(), Pins::edge(ClothEdge::Top));
    let proxy = spawn_proxy(&mut app, driver, fine(21, 0.0), ());
    run(&mut app, 10);
    let mesh = add_mesh(&mut app, uneven(ClothGrid::new(1.0, 1.0, 12, 7), 0.2));
    app.world_mut().entity_mut(driver).insert(Mesh3d(mesh));
    app.world_mut().spawn(Wind { velocity: Vec3::Z * 6.0, ..default() });
    run(&mut app, 60);
    let far = distances(&app, driver, &points(drawn(&app, proxy))).into_iter().fold(0.0, f32::max);
    assert!(far < 0.05, "{far}");
    app.world_mut().entity_mut(proxy).remove::<ClothProxy>();
    let before = points(drawn(&app, proxy));
    run(&mut app, 10);
    assert_eq!(points(drawn(&app, proxy)), before);
    assert!(drawn(&app, proxy).final_aabb.is_none(), "its bounds are its own again");
}
