//! Inspectors, scenes and serialisation see everything, without a line in the app.

use core::any::TypeId;

use bevy::{
    ecs::{
        entity::{EntityHashMap, MapEntities},
        reflect::{AppTypeRegistry, ReflectComponent, ReflectResource},
    },
    prelude::*,
    reflect::{TypeData, TypeRegistry},
    world_serialization::DynamicWorldBuilder,
};
use bevy_drape::prelude::*;

use crate::common::*;

fn has<Data: TypeData>(registry: &TypeRegistry, of: TypeId) -> bool {
    registry.get_type_data::<Data>(of).is_some()
}

#[test]
fn every_component_is_registered() {
    let app = headless();
    let registry = app.world().resource::<AppTypeRegistry>().read();
    let components = [
        TypeId::of::<Cloth>(),
        TypeId::of::<ClothStatus>(),
        TypeId::of::<Fabric>(),
        TypeId::of::<FabricHandle>(),
        TypeId::of::<ClothSprings>(),
        TypeId::of::<Pins>(),
        TypeId::of::<ClothCollider>(),
        TypeId::of::<Wind>(),
        #[cfg(feature = "debug")]
        TypeId::of::<bevy_drape::debug::ClothDebugView>(),
    ];
    for component in components {
        let name = registry.get(component).expect("a component is registered").type_info().type_path();
        assert!(has::<ReflectComponent>(&registry, component), "{name} is a component");
        assert!(has::<ReflectDefault>(&registry, component), "{name} has a default");
    }
    let resources = [
        TypeId::of::<ClothGravity>(),
        #[cfg(feature = "picking")]
        TypeId::of::<ClothPickingSettings>(),
        #[cfg(feature = "debug")]
        TypeId::of::<bevy_drape::debug::ClothDebugConfig>(),
    ];
    for resource in resources {
        assert!(has::<ReflectResource>(&registry, resource));
        assert!(has::<ReflectDefault>(&registry, resource));
    }
}

#[test]
fn reflection_changes_a_running_cloth() {
    let mut app = headless();
    let cloth = spawn_cloth(&mut app, ClothGrid::new(1.0, 1.0, 4, 4), undamped());
    run(&mut app, 1);
    let registry = app.world().resource::<AppTypeRegistry>().clone();
    let component = registry.read().get_type_data::<ReflectComponent>(TypeId::of::<Cloth>()).unwrap().clone();
    let mut reflected = component.reflect_mut(app.world_mut().entity_mut(cloth)).unwrap();
    *reflected.path_mut::<f32>("gravity_scale").unwrap() = -1.0;
    run(&mut app, 30);
    assert!(place(&app, cloth, 0).y > 1.0);
}

#[cfg(feature = "mesh_colliders")]
#[test]
fn a_collider_of_any_shape_goes_through_reflection() {
    use bevy::reflect::FromReflect;

    let mut app = headless();
    let registry = app.world().resource::<AppTypeRegistry>().clone();
    assert!(has::<ReflectDefault>(&registry.read(), TypeId::of::<HeightField>()));
    let mesh = add_mesh(&mut app, Cuboid::default());
    let colliders = [
        ClothCollider::mesh(),
        ClothCollider::mesh_of(mesh.clone()),
        ClothCollider::convex_hull(),
        ClothCollider::convex_hull_of(mesh),
        HeightField::default().into(),
    ];
    for collider in colliders {
        assert_eq!(ClothCollider::from_reflect(collider.to_dynamic().as_ref()), Some(collider.clone()));
        assert!(collider.reflect_partial_eq(collider.reflect_clone().unwrap().as_ref()).unwrap());
    }
    let terrain = app.world_mut().spawn(ClothCollider::from(HeightField::default())).id();
    let component = registry.read().get_type_data::<ReflectComponent>(TypeId::of::<ClothCollider>()).unwrap().clone();
    let mut reflected = component.reflect_mut(app.world_mut().entity_mut(terrain)).unwrap();
    *reflected.path_mut::<f32>("shape.0.heights[3]").unwrap() = 2.0;
    let ColliderShape::HeightField(field) = &get::<ClothCollider>(&app, terrain).shape else { panic!("a terrain") };
    assert_eq!(field.heights, [0.0, 0.0, 0.0, 2.0]);
}

#[test]
fn pins_to_entities_are_mapped() {
    let mut world = World::new();
    let [old, new] = [world.spawn_empty().id(), world.spawn_empty().id()];
    let mut pins = Pins::indices([1]).to_entity(old).and(Pins::indices([2]));
    pins.map_entities(&mut (old, new));
    assert_eq!([pins.groups[0].to, pins.groups[1].to], [PinTarget::Entity(Some(new)), PinTarget::Cloth]);
}

#[test]
fn a_cloth_goes_through_a_scene() {
    let mut app = headless();
    let mesh = add_mesh(&mut app, ClothGrid::new(1.0, 1.0, 4, 4));
    let pole = app.world_mut().spawn(Transform::from_xyz(0.0, 1.0, 0.0)).id();
    let fabric = Fabric { density: 0.7, ..default() };
    let pins = Pins::edge(ClothEdge::Top).to_entity(pole);
    let cloth = app.world_mut().spawn((Mesh3d(mesh), Cloth::default(), fabric.clone(), pins)).id();
    let registry = app.world().resource::<AppTypeRegistry>().clone();
    let scene = DynamicWorldBuilder::from_world(app.world(), &registry.read())
        .extract_entities([pole, cloth].into_iter())
        .build();
    let components = scene.entities.iter().flat_map(|entity| &entity.components);
    assert!(components.clone().any(|component| component.represents::<Fabric>()));
    assert!(
        !components.clone().any(|component| component.represents::<ClothState>()),
        "the running state stays behind"
    );
    let mut map = EntityHashMap::default();
    scene.write_to_world(app.world_mut(), &mut map).unwrap();

    let copy = map[&cloth];
    assert_eq!(get::<Pins>(&app, copy).groups[0].to, PinTarget::Entity(Some(map[&pole])));
    assert_eq!(*get::<Fabric>(&app, copy), fabric);
    run(&mut app, 2);
    get_mut::<Transform>(&mut app, map[&pole]).translation.x = 3.0;
    run(&mut app, 1);
    assert_eq!(*get::<ClothStatus>(&app, copy), ClothStatus::Ready);
    assert_close(place(&app, copy, 0), Vec3::new(2.5, 0.5, 0.0), 1e-5);
    assert_close(place(&app, cloth, 0), Vec3::new(-0.5, 0.5, 0.0), 1e-5);
}
