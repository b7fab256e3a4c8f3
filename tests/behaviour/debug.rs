//! What is switched on is drawn, and nothing else.

use core::any::TypeId;

use bevy::{
    ecs::reflect::{AppTypeRegistry, ReflectComponent, ReflectResource},
    gizmos::{GizmoHandles, GizmoPlugin},
    prelude::*,
};
use bevy_drape::{debug::*, prelude::*, solver::SpringKind};

use crate::common::*;

mod diagnostics;
mod marks;
mod springs;
mod surroundings;

/// A line that is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Line {
    from: Vec3,
    to: Vec3,
    color: LinearRgba,
}

impl Line {
    fn way(self) -> Vec3 {
        self.to - self.from
    }
}

/// An app that draws cloth and its inside as the latest step left them.
fn inside() -> App {
    inside_with(ClothPlugin::new(Update))
}

fn inside_with(plugin: ClothPlugin) -> App {
    headless_with((plugin, GizmoPlugin, ClothDebugPlugin))
}

fn config(app: &mut App) -> Mut<'_, ClothDebugConfig> {
    app.world_mut().resource_mut()
}

/// All lines of the latest frame: single ones first, then those of strips.
fn lines(app: &App) -> Vec<Line> {
    let handles = app.world().resource::<GizmoHandles>().handles();
    let Some(Some(handle)) = handles.get(&TypeId::of::<ClothGizmos>()) else { return Vec::new() };
    let drawn = app.world().resource::<Assets<GizmoAsset>>().get(handle).expect("what is drawn is there").buffer();
    let single = drawn.list_positions.chunks(2).zip(drawn.list_colors.chunks(2));
    // Strips end with a place that isn't one.
    let strips = drawn.strip_positions.windows(2).zip(drawn.strip_colors.windows(2));
    let all = single.chain(strips.filter(|(ends, _)| ends[0].is_finite() && ends[1].is_finite()));
    all.map(|(ends, colors)| Line { from: ends[0], to: ends[1], color: colors[0] }).collect()
}

/// World positions of a cloth's particles as drawn, of a mesh that has one vertex for each.
fn shown(app: &App, cloth: Entity) -> Vec<Vec3> {
    let transform = get::<GlobalTransform>(app, cloth);
    points(drawn(app, cloth)).into_iter().map(|point| transform.transform_point(point)).collect()
}

fn spring_count(app: &App, cloth: Entity, kind: SpringKind) -> usize {
    state(app, cloth).topology().springs_of(kind).count()
}

fn spawn_sheet(app: &mut App, more: impl Bundle) -> Entity {
    spawn_cloth(app, ClothGrid::new(1.0, 1.0, 5, 5), more)
}

#[test]
fn nothing_is_drawn_unless_it_is_switched_on() {
    let mut app = inside();
    let cloth = spawn_sheet(&mut app, (Pins::corners(), ClothDebugView::default()));
    app.world_mut().spawn(ClothCollider::default());
    app.world_mut().spawn(Wind { velocity: Vec3::X, ..default() });
    run(&mut app, 3);
    assert_eq!(lines(&app), []);
    get_mut::<ClothDebugView>(&mut app, cloth).structural_springs = true;
    run(&mut app, 1);
    assert_eq!(lines(&app).len(), spring_count(&app, cloth, SpringKind::Structural));
    get_mut::<ClothDebugView>(&mut app, cloth).structural_springs = false;
    run(&mut app, 1);
    assert_eq!(lines(&app), []);
}

#[test]
fn a_cloth_shows_what_is_on_for_it_or_for_all() {
    let mut app = inside();
    let own = ClothDebugView { shear_springs: true, full_strain: 0.5, ..default() };
    let one = spawn_sheet(&mut app, (Pins::corners(), own));
    let _other = spawn_sheet(&mut app, Pins::corners());
    run(&mut app, 1);
    let sheared = spring_count(&app, one, SpringKind::Shear);
    assert_eq!(lines(&app).len(), sheared);
    config(&mut app).bend_springs = true;
    run(&mut app, 1);
    assert_eq!(lines(&app).len(), sheared + 2 * spring_count(&app, one, SpringKind::Bend));
}

#[test]
fn everything_is_everything() {
    let mut app = inside();
    *config(&mut app) = ClothDebugConfig::all();
    let cloth = spawn_sheet(&mut app, Pins::corners());
    run(&mut app, 1);
    let springs = state(&app, cloth).topology().springs.len();
    let tethers = tethers(&app, cloth).len();
    let (crosses, normals, bounds) = (4 * 3, 25, 12);
    assert_eq!(lines(&app).len(), springs + tethers + crosses + normals + bounds);
    assert!(springs > 0 && tethers > 0);
    assert_eq!(config(&mut app).view, ClothDebugView::all());
}

#[test]
fn a_cloth_that_goes_takes_its_lines_along() {
    let mut app = inside();
    *config(&mut app) = ClothDebugConfig::all();
    let pole = app.world_mut().spawn(Transform::default()).id();
    let [first, second, third] = [(); 3].map(|()| spawn_sheet(&mut app, Pins::corners().to_entity(pole)));
    run(&mut app, 2);
    let all = lines(&app).len();
    // Within the frame, after it has stepped.
    let despawn = move |mut commands: Commands| commands.entity(first).try_despawn();
    app.add_systems(PostUpdate, despawn.before(ClothSystems::Draw));
    run(&mut app, 1);
    assert_eq!(lines(&app).len(), all / 3 * 2);
    app.world_mut().entity_mut(second).remove::<Cloth>();
    app.world_mut().despawn(pole);
    run(&mut app, 1);
    assert_eq!(lines(&app).len(), all / 3);
    app.world_mut().despawn(third);
    run(&mut app, 1);
    assert_eq!(lines(&app), []);
}

#[test]
fn a_cloth_that_was_never_drawn_shows_nothing() {
    let mut app = inside();
    *config(&mut app) = ClothDebugConfig::all();
    app.world_mut().spawn(Wind { velocity: Vec3::X, ..default() });
    // Flat from the moment on at which it is ready.
    app.add_systems(Update, |mut cloths: Query<&mut Transform, With<Cloth>>| {
        cloths.iter_mut().for_each(|mut transform| transform.scale = Vec3::ZERO);
    });
    let cloth = spawn_sheet(&mut app, Pins::corners());
    let waiting = app.world_mut().spawn((Mesh3d::default(), Cloth::default(), ClothDebugView::all())).id();
    run(&mut app, 3);
    let status = |entity| get::<ClothStatus>(&app, entity);
    assert_eq!((status(cloth), status(waiting)), (&ClothStatus::Ready, &ClothStatus::Waiting));
    assert_eq!(lines(&app), []);
}

#[test]
fn without_what_it_needs_nothing_panics() {
    for cloth in [false, true] {
        for gizmos in [false, true] {
            let mut app = App::new();
            app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), bevy::mesh::MeshPlugin));
            app.add_plugins((ClothDebugPlugin, ClothDiagnosticsPlugin));
            if cloth {
                app.add_plugins(ClothPlugin::new(Update));
            }
            if gizmos {
                app.add_plugins(GizmoPlugin);
            }
            app.finish();
            app.cleanup();
            *config(&mut app) = ClothDebugConfig::all();
            spawn_sheet(&mut app, (Pins::corners(), ClothDebugView::all()));
            run(&mut app, 3);
            assert_eq!(gizmos && !lines(&app).is_empty(), cloth && gizmos);
        }
    }
    App::new().add_plugins((ClothDebugPlugin, ClothDiagnosticsPlugin)).update();
}

#[test]
fn the_gizmos_obey_bevys_settings() {
    let mut app = inside();
    config(&mut app).view = ClothDebugView::springs();
    spawn_sheet(&mut app, ());
    run(&mut app, 1);
    assert!(!lines(&app).is_empty());
    app.world_mut().resource_mut::<GizmoConfigStore>().config_mut::<ClothGizmos>().0.enabled = false;
    run(&mut app, 1);
    assert_eq!(lines(&app), []);
}

#[test]
fn settings_of_the_gizmos_that_were_made_before_are_kept() {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, AssetPlugin::default(), bevy::mesh::MeshPlugin, GizmoPlugin));
    app.insert_gizmo_config(ClothGizmos, GizmoConfig { depth_bias: -1.0, ..default() });
    app.add_plugins((TransformPlugin, ClothPlugin::default(), ClothDebugPlugin));
    app.finish();
    assert_eq!(app.world().resource::<GizmoConfigStore>().config::<ClothGizmos>().0.depth_bias, -1.0);
}

#[test]
fn inspectors_see_the_switches() {
    let app = inside();
    let registry = app.world().resource::<AppTypeRegistry>().read();
    assert!(registry.get_type_data::<ReflectComponent>(TypeId::of::<ClothDebugView>()).is_some());
    assert!(registry.get_type_data::<ReflectResource>(TypeId::of::<ClothDebugConfig>()).is_some());
}
