//! What of an engine's colliders cloth doesn't meet.

use avian3d::prelude as avian;
use bevy::prelude::*;
use bevy_drape::prelude::*;
use bevy_rapier3d::prelude as rapier;

use crate::{
    common::*,
    engine::{BOTH, Engine, Form},
    places::patch,
};

/// Whether a patch lies on a box to which `more` was done, after half a second.
fn is_met(engine: Engine, more: impl FnOnce(&mut App, Entity)) -> bool {
    let mut app = engine.app();
    let solid = engine.fixed(&mut app, &Form::Cuboid(Vec3::splat(0.3)), Transform::default());
    more(&mut app, solid);
    let patch = patch(&mut app, Vec3::Y * 0.35);
    run(&mut app, 30);
    place(&app, patch, 12).y > 0.3
}

fn is_met_with(engine: Engine, bundle: impl Bundle) -> bool {
    is_met(engine, |app, solid| {
        app.world_mut().entity_mut(solid).insert(bundle);
    })
}

#[test]
fn sensors_and_what_is_disabled_are_no_obstacles() {
    assert!(is_met_with(Engine::Avian, ()));
    assert!(!is_met_with(Engine::Avian, avian::Sensor));
    assert!(!is_met_with(Engine::Avian, avian::ColliderDisabled));
    assert!(!is_met_with(Engine::Avian, avian::RigidBodyDisabled));
    assert!(is_met_with(Engine::Rapier, ()));
    assert!(!is_met_with(Engine::Rapier, rapier::Sensor));
    assert!(!is_met_with(Engine::Rapier, rapier::ColliderDisabled));
    assert!(!is_met_with(Engine::Rapier, rapier::RigidBodyDisabled));
}

#[test]
fn what_is_marked_is_no_obstacle() {
    for engine in BOTH {
        assert!(!is_met_with(engine, NotClothCollider), "{engine:?}");
        let child_of_a_marked_body = |app: &mut App, solid: Entity| {
            app.world_mut().entity_mut(solid).insert(NotClothCollider);
            let child = app.world_mut().spawn((Transform::default(), ChildOf(solid))).id();
            engine.insert(app, child, &Form::Cuboid(Vec3::splat(0.3)));
        };
        assert!(!is_met(engine, child_of_a_marked_body), "{engine:?}");
    }
}

#[test]
fn layers_and_groups_are_those_of_the_engine() {
    let avian = |cloth: CollisionLayers, solid: CollisionLayers| {
        is_met(Engine::Avian, |app, entity| {
            app.insert_resource(ClothAvianSettings { layers: cloth });
            app.world_mut().entity_mut(entity).insert(solid);
        })
    };
    use avian::CollisionLayers;
    let all = u32::MAX;
    assert!(avian(CollisionLayers::new(4, all), CollisionLayers::new(2, 4)));
    assert!(
        !avian(CollisionLayers::new(4, all), CollisionLayers::new(2, 8)),
        "the collider doesn't want to meet cloth"
    );
    assert!(
        !avian(CollisionLayers::new(4, 8), CollisionLayers::new(2, all)),
        "cloth doesn't want to meet the collider"
    );

    let rapier = |[cloth, cloths]: [u32; 2], [solid, solids]: [u32; 2]| {
        let groups = |own, met| rapier::CollisionGroups {
            memberships: rapier::Group::from_bits_truncate(own),
            filters: rapier::Group::from_bits_truncate(met),
        };
        is_met(Engine::Rapier, |app, entity| {
            app.insert_resource(ClothRapierSettings { groups: groups(cloth, cloths) });
            app.world_mut().entity_mut(entity).insert(groups(solid, solids));
        })
    };
    assert!(rapier([4, all], [2, 4]));
    assert!(!rapier([4, all], [2, 8]), "the collider doesn't want to meet cloth");
    assert!(!rapier([4, 8], [2, all]), "cloth doesn't want to meet the collider");
}

#[test]
fn a_cloths_mask_is_on_the_layers_that_a_collider_is_in() {
    let falls_through = |mask: u32| {
        let mut app = Engine::Avian.app();
        let solid = Engine::Avian.fixed(&mut app, &Form::Cuboid(Vec3::splat(0.3)), Transform::default());
        app.world_mut().entity_mut(solid).insert(avian::CollisionLayers::new(0b10, avian::LayerMask::ALL));
        let patch = patch(&mut app, Vec3::Y * 0.35);
        get_mut::<Cloth>(&mut app, patch).collision_mask = mask;
        run(&mut app, 30);
        place(&app, patch, 12).y < 0.0
    };
    assert!(falls_through(0b01));
    assert!(!falls_through(0b11));
}

#[test]
fn a_cloth_collider_of_its_own_counts_instead() {
    for engine in BOTH {
        let mut app = engine.app();
        let solid = engine.fixed(&mut app, &Form::Cuboid(Vec3::splat(0.3)), Transform::default());
        app.world_mut().entity_mut(solid).insert(ClothCollider::from(Cuboid::new(0.6, 0.2, 0.6)));
        let patch = patch(&mut app, Vec3::Y * 0.35);
        run(&mut app, 40);
        let height = place(&app, patch, 12).y;
        assert!((height - 0.106).abs() < 2e-3, "{engine:?}: {height}");
    }
}

#[test]
fn friction_of_the_collider_is_a_factor() {
    for engine in BOTH {
        let slid = |friction: f32| {
            let mut app = engine.app();
            let slope = Transform::from_rotation(Quat::from_rotation_z(-0.35));
            let solid = engine.fixed(&mut app, &Form::Cuboid(Vec3::new(2.0, 0.1, 0.5)), slope);
            let mut solid = app.world_mut().entity_mut(solid);
            match engine {
                Engine::Avian => solid.insert(avian::Friction::new(friction)),
                Engine::Rapier => solid.insert(rapier::Friction::new(friction)),
            };
            let patch = patch(&mut app, Vec3::Y * 0.2);
            run(&mut app, 45);
            place(&app, patch, 12).x
        };
        // The fabric's coefficient is 0.9 and the slope's tangent 0.37.
        assert!(slid(0.5) < 0.1, "{engine:?}: holds");
        assert!(slid(0.05) > 0.4, "{engine:?}: slides");
    }
}
