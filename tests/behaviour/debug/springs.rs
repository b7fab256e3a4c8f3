//! Springs and tethers lie on the cloth as it is drawn, in the colour of what the solver knows.

use bevy::prelude::*;
use bevy_drape::{debug::*, prelude::*, solver::SpringKind};

use super::*;

fn only(kind: SpringKind) -> ClothDebugView {
    match kind {
        SpringKind::Structural => ClothDebugView { structural_springs: true, ..default() },
        SpringKind::Shear => ClothDebugView { shear_springs: true, ..default() },
        SpringKind::Bend => ClothDebugView { bend_springs: true, ..default() },
    }
}

/// A sheet whose every particle is pinned to a pole, with the pole drawn out along its axes.
fn drawn_out(app: &mut App, scale: Vec3, view: ClothDebugView) -> Entity {
    let pole = app.world_mut().spawn(Transform::default()).id();
    let all = Pins::region(Vec3::splat(-1.0), Vec3::splat(1.0)).to_entity(pole);
    let cloth = spawn_sheet(app, (all, view));
    run(app, 1);
    get_mut::<Transform>(app, pole).scale = scale;
    run(app, 1);
    cloth
}

fn colors_along(app: &App, axis: Vec3) -> Vec<LinearRgba> {
    lines(app).into_iter().filter(|line| line.way().dot(axis).abs() > 0.1).map(|line| line.color).collect()
}

#[test]
fn each_spring_of_a_kind_is_a_line() {
    let mut app = inside();
    let cloth = spawn_sheet(&mut app, ());
    run(&mut app, 1);
    for kind in SpringKind::ALL {
        app.world_mut().entity_mut(cloth).insert(only(kind));
        run(&mut app, 1);
        let (lines, places) = (lines(&app), shown(&app, cloth));
        assert_eq!(lines.len(), spring_count(&app, cloth, kind), "{kind:?}");
        let springs: Vec<_> = state(&app, cloth).topology().springs_of(kind).copied().collect();
        for (line, spring) in lines.iter().zip(springs) {
            assert_close(line.from, places[spring.a as usize], 1e-6);
            assert_close(line.to, places[spring.b as usize], 1e-6);
        }
    }
}

#[test]
fn lines_are_where_the_cloth_is_drawn_between_steps_and_on_its_carrier() {
    let mut app = inside_with(ClothPlugin::default());
    set_rates(&mut app, 1.0 / 64.0, 1.0 / 20.0);
    let turned = Transform::from_rotation(Quat::from_rotation_y(0.7)).with_scale(Vec3::new(1.5, 0.8, -1.0));
    let view = only(SpringKind::Structural);
    let cloth = spawn_sheet(&mut app, (Pins::edge(ClothEdge::Top), turned, view));
    let mut farthest_from_step = 0.0_f32;
    run(&mut app, 5);
    for _ in 0..20 {
        get_mut::<Transform>(&mut app, cloth).translation.x += 0.1;
        run(&mut app, 1);
        let places = shown(&app, cloth);
        let springs: Vec<_> = state(&app, cloth).topology().springs_of(SpringKind::Structural).copied().collect();
        for (line, spring) in lines(&app).into_iter().zip(springs) {
            assert_close(line.from, places[spring.a as usize], 1e-5);
            let in_step = state(&app, cloth).position(spring.a as usize).unwrap();
            farthest_from_step = farthest_from_step.max(line.from.distance(in_step));
        }
    }
    assert!(farthest_from_step > 0.1, "the latest step is elsewhere");
}

#[test]
fn springs_have_the_colour_of_their_strain() {
    let mut app = inside();
    let cloth = drawn_out(&mut app, Vec3::new(1.1, 0.9, 1.0), only(SpringKind::Structural));
    let (stretched, pressed) = (colors_along(&app, Vec3::X), colors_along(&app, Vec3::Y));
    assert_eq!(stretched.len() + pressed.len(), lines(&app).len());
    assert!(stretched.iter().all(|c| c.red > 0.9 && c.green < 0.1 && c.blue < 0.1), "{:?}", stretched[0]);
    assert!(pressed.iter().all(|c| c.blue > 0.9 && c.red < 0.1), "{:?}", pressed[0]);
    // At a tenth of the full strain there is little colour.
    get_mut::<ClothDebugView>(&mut app, cloth).full_strain = 1.0;
    run(&mut app, 1);
    for color in colors_along(&app, Vec3::X) {
        assert!(color.red > color.blue && color.red < 0.6 && color.green > 0.4, "{color:?}");
    }
}

#[test]
fn springs_at_rest_are_grey_however_far_away() {
    for distance in [0.0, 10_000.0] {
        let mut app = inside();
        let view = ClothDebugView { full_strain: 0.001, ..ClothDebugView::springs() };
        let floating = Cloth { gravity_scale: 0.0, ..default() };
        // Turned, so that no particle is where floats are exact.
        let place = Transform::from_xyz(distance, 0.3, -distance).with_rotation(Quat::from_rotation_z(0.4));
        let cloth = spawn_sheet(&mut app, (floating, view, place));
        run(&mut app, 1);
        let drawn = lines(&app);
        assert_eq!(drawn.len(), state(&app, cloth).topology().springs.len());
        for Line { color, .. } in drawn {
            assert!((color.red - color.blue).abs() < 0.01 && (color.red - color.green).abs() < 0.01, "{color:?}");
        }
    }
}

#[test]
fn kinds_of_springs_are_told_apart_at_rest() {
    let mut app = inside();
    let cloth = spawn_sheet(&mut app, Cloth { gravity_scale: 0.0, ..default() });
    run(&mut app, 1);
    let [structural, shear, bend] = SpringKind::ALL.map(|kind| {
        app.world_mut().entity_mut(cloth).insert(only(kind));
        run(&mut app, 1);
        lines(&app)[0].color.alpha
    });
    assert!(structural > 1.5 * shear && shear > 1.5 * bend && bend > 0.1, "{structural} {shear} {bend}");
}

#[test]
fn tethers_are_told_apart_by_whether_they_are_taut() {
    let mut app = inside();
    let view = ClothDebugView { tethers: true, ..default() };
    // As good as without stiffness of its own, it hangs by its tethers.
    let limp = ClothSprings { structural_stiffness: 1.0, shear_stiffness: 1.0, ..default() };
    let floating = Cloth { gravity_scale: 0.0, ..default() };
    let cloth = spawn_sheet(&mut app, (Pins::edge(ClothEdge::Top), floating, limp, view));
    run(&mut app, 1);
    let count = tethers(&app, cloth).len();
    let is_taut = |line: &Line| line.color.alpha == 1.0;
    assert_eq!(lines(&app).len(), count);
    assert!(count >= 20);
    assert_eq!(lines(&app).into_iter().filter(is_taut).count(), 0, "at rest");
    get_mut::<Cloth>(&mut app, cloth).gravity_scale = 1.0;
    run(&mut app, 120);
    assert!(lines(&app).into_iter().filter(is_taut).count() >= 15);
    let pins: Vec<Vec3> = shown(&app, cloth)[..5].to_vec();
    assert!(lines(&app).iter().all(|line| pins.iter().any(|pin| pin.distance(line.to) < 1e-5)));
}

#[test]
fn a_cloth_without_tethers_shows_none() {
    let mut app = inside();
    config(&mut app).tethers = true;
    spawn_sheet(&mut app, (Pins::corners(), Cloth { tether_slack: None, ..default() }));
    spawn_sheet(&mut app, (Pins::corners(), Cloth { solver: ClothSolver::Explicit, ..default() }));
    spawn_sheet(&mut app, ());
    run(&mut app, 2);
    assert_eq!(lines(&app), []);
}
