//! Every component can be seen and edited in bevy-inspector-egui.

use bevy::prelude::*;
use bevy_drape::prelude::*;
use bevy_egui::egui::{self, accesskit::Role};
use bevy_inspector_egui::{DefaultInspectorConfigPlugin, bevy_inspector};
use egui_kittest::{
    Harness,
    kittest::{NodeT, Queryable},
};

use crate::common::app_with;

type Inspector = Harness<'static, (App, Entity)>;

/// The inspector of an entity.
fn inspect(components: impl Bundle) -> Inspector {
    let mut app = app_with(DefaultInspectorConfigPlugin);
    let entity = app.world_mut().spawn(components).id();
    app.update();
    Harness::builder().with_size(egui::vec2(500.0, 3000.0)).with_max_steps(20).build_ui_state(
        |ui, (app, entity): &mut (App, Entity)| bevy_inspector::ui_for_entity(app.world_mut(), *entity, ui),
        (app, entity),
    )
}

/// Opens a component and gives all that is written then.
fn open(inspector: &mut Inspector, component: &str) -> Vec<String> {
    inspector.get_by_label(component).click();
    inspector.run();
    let texts = inspector.root().children_recursive().filter_map(|node| {
        let node = node.accesskit_node();
        node.label().or_else(|| node.value())
    });
    texts.collect()
}

#[track_caller]
fn assert_shown(components: impl Bundle, component: &str, fields: &[&str]) {
    let mut inspector = inspect(components);
    let texts = open(&mut inspector, component);
    for field in fields {
        assert!(texts.iter().any(|text| text == field), "{component} without {field}: {texts:?}");
    }
    let complaint = texts.iter().find(|text| text.contains("not registered") || text.contains("not implement"));
    // The inspector has none for the function of `PinPredicate` and the like, which reflection doesn't see.
    assert_eq!(complaint, None, "{component}");
}

#[test]
fn every_component_shows_its_fields() {
    assert_shown(
        Cloth::default(),
        "Cloth",
        &["solver", "timing", "max_strain", "substeps", "levels", "tether_slack", "max_velocity", "fluid_density"],
    );
    assert_shown(Fabric::default(), "Fabric", &["density", "warp_stiffness", "lift"]);
    assert_shown(ClothSprings::default(), "ClothSprings", &["structural_stiffness", "bend_damping"]);
    assert_shown(ClothSkin::default(), "ClothSkin", &["max_distance", "scale", "missing", "backstop", "pull"]);
    assert_shown(ClothInertia::default(), "ClothInertia", &["linear", "max_speed"]);
    assert_shown(ClothTeleport::default(), "ClothTeleport", &["mode", "distance"]);
    assert_shown(Pins::edge(ClothEdge::Top), "Pins", &["groups"]);
    assert_shown(Wind::default(), "Wind", &["velocity", "region", "gusts", "eddy_size"]);
    assert_shown(ClothCollider::from(Sphere::new(0.5)), "ClothCollider", &["shape", "layers"]);
    #[cfg(feature = "mesh_colliders")]
    for collider in [ClothCollider::mesh(), ClothCollider::convex_hull(), HeightField::default().into()] {
        assert_shown(collider, "ClothCollider", &["shape", "layers"]);
    }
    assert_shown(Cloth::default(), "ClothStatus", &[]);
    assert_shown(FabricHandle::default(), "FabricHandle", &["detached"]);
}

#[test]
fn an_edit_there_reaches_the_component() {
    let mut inspector = inspect(Cloth { substeps: Some(8), ..default() });
    open(&mut inspector, "Cloth");
    let substeps = inspector.root().children_recursive().find(|node| {
        let node = node.accesskit_node();
        node.role() == Role::SpinButton && node.value().as_deref() == Some("8")
    });
    substeps.expect("the number of substeps").click();
    inspector.run();
    inspector.event(egui::Event::Text("24".into()));
    inspector.key_press(egui::Key::Enter);
    inspector.run();
    let (app, entity) = inspector.state();
    assert_eq!(app.world().get::<Cloth>(*entity), Some(&Cloth { substeps: Some(24), ..default() }));
}
