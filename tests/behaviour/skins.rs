//! Cloth made of a mesh with a skin or morph targets: what is on its entity is always what its mesh is made for.

use core::mem;

use bevy::{
    mesh::{
        VertexAttributeValues,
        morph::{MeshMorphWeights, MorphAttributes},
        skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    },
    prelude::*,
};
use bevy_drape::prelude::*;

use crate::{common::*, quiet::Quiet};

const GRID: ClothGrid = ClothGrid { size: Vec2::ONE, particles: UVec2::new(5, 5), lying: false };

fn skinned() -> Mesh {
    Mesh::from(GRID)
        .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, VertexAttributeValues::Uint16x4(vec![[0; 4]; 25]))
        .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, vec![[1.0, 0.0, 0.0, 0.0]; 25])
        .with_generated_skinned_mesh_bounds()
        .expect("it has a skin")
}

fn morphed(mesh: impl Into<Mesh>) -> Mesh {
    mesh.into().with_morph_targets(vec![MorphAttributes::new(Vec3::X, Vec3::ZERO, Vec3::ZERO); 25])
}

/// A skin of one joint, far from where the mesh is.
fn spawn_skin(app: &mut App) -> SkinnedMesh {
    let joint = app.world_mut().spawn(Transform::from_xyz(5.0, 0.0, 0.0)).id();
    let bindposes = SkinnedMeshInverseBindposes::from(vec![Mat4::IDENTITY]);
    let inverse_bindposes = app.world_mut().resource_mut::<Assets<SkinnedMeshInverseBindposes>>().add(bindposes);
    SkinnedMesh { joints: vec![joint], inverse_bindposes }
}

/// A cloth beside a skin; the mesh that it is made of; its joints.
fn spawn_skinned(app: &mut App) -> (Entity, Handle<Mesh>, Vec<Entity>) {
    let (mesh, skin) = (add_mesh(app, skinned()), spawn_skin(app));
    let joints = skin.joints.clone();
    (app.world_mut().spawn((Mesh3d(mesh.clone()), Cloth::default(), skin)).id(), mesh, joints)
}

/// Gives an entity another mesh, once.
fn swap(entity: Entity, mesh: Handle<Mesh>) -> impl FnMut(Local<bool>, Query<&mut Mesh3d>) {
    move |mut is_done, mut meshes| {
        if !mem::replace(&mut *is_done, true) {
            meshes.get_mut(entity).expect("it has a mesh").0 = mesh.clone();
        }
    }
}

fn joints(app: &App, entity: Entity) -> Option<&[Entity]> {
    app.world().get::<SkinnedMesh>(entity).map(|skin| &*skin.joints)
}

/// What the renderer needs: on the entity is what its mesh has, and nothing else.
#[track_caller]
fn assert_fits(app: &App, entity: Entity) {
    let (mesh, entity) = (drawn(app, entity), app.world().entity(entity));
    let has_joints = entity.contains::<SkinnedMesh>();
    for attribute in [Mesh::ATTRIBUTE_JOINT_INDEX, Mesh::ATTRIBUTE_JOINT_WEIGHT] {
        assert_eq!(mesh.contains_attribute(attribute), has_joints);
    }
    assert_eq!(mesh.has_morph_targets(), entity.contains::<MeshMorphWeights>());
}

#[test]
fn a_skinned_cloth_is_drawn_in_bind_space() {
    let mut app = headless();
    let (cloth, mesh, _) = spawn_skinned(&mut app);
    run(&mut app, 1);
    assert_fits(&app, cloth);
    assert_close(place(&app, cloth, 0), Vec3::new(4.5, 0.5, 0.0), 0.01);
    run(&mut app, 30);
    assert_fits(&app, cloth);
    assert!(drawn(&app, cloth).skinned_mesh_bounds().is_none(), "those of joints don't hold what hangs on them");
    let drawn_place = points(drawn(&app, cloth))[0] + Vec3::X * 5.0;
    assert!(drawn_place.y < -0.5, "it falls");
    let source = app.world().resource::<Assets<Mesh>>().get(&mesh).unwrap();
    assert!(source.contains_attribute(Mesh::ATTRIBUTE_JOINT_INDEX), "the mesh itself keeps its skin");
}

#[test]
fn the_skin_stays_with_any_mesh_of_the_cloth() {
    let mut app = headless();
    let (cloth, mesh, its_joints) = spawn_skinned(&mut app);
    run(&mut app, 5);
    app.add_systems(Update, swap(cloth, mesh.clone()));
    run(&mut app, 1);
    // The cloth is made anew in the next frame.
    assert_eq!(get::<Mesh3d>(&app, cloth).0, mesh);
    assert_eq!(joints(&app, cloth), Some(&*its_joints));
    assert_fits(&app, cloth);
    for _ in 0..3 {
        run(&mut app, 1);
        assert_ne!(get::<Mesh3d>(&app, cloth).0, mesh);
        assert_eq!(joints(&app, cloth), Some(&*its_joints));
        assert_fits(&app, cloth);
    }
}

#[test]
fn a_mesh_may_be_swapped_at_any_moment_of_a_frame() {
    let moments: [fn(&mut App, Entity, Handle<Mesh>); 4] = [
        |app, cloth, mesh| {
            app.add_systems(First, swap(cloth, mesh));
        },
        |app, cloth, mesh| {
            app.add_systems(PreUpdate, swap(cloth, mesh).after(ClothSystems::Prepare));
        },
        |app, cloth, mesh| {
            app.add_systems(PostUpdate, swap(cloth, mesh).before(ClothSystems::Draw));
        },
        |app, cloth, mesh| {
            app.add_systems(PostUpdate, swap(cloth, mesh).after(ClothSystems::Draw));
        },
    ];
    for moment in moments {
        let mut app = headless();
        let (cloth, mesh, its_joints) = spawn_skinned(&mut app);
        run(&mut app, 5);
        moment(&mut app, cloth, mesh.clone());
        for _ in 0..3 {
            run(&mut app, 1);
            assert_fits(&app, cloth);
        }
        app.world_mut().entity_mut(cloth).remove::<Cloth>();
        get_mut::<Mesh3d>(&mut app, cloth).0 = mesh;
        run(&mut app, 1);
        assert_eq!(joints(&app, cloth), Some(&*its_joints));
        assert_fits(&app, cloth);
    }
}

#[test]
fn what_is_left_of_a_cloth_goes_on_with_its_skeleton() {
    let mut app = headless();
    let (cloth, mesh, its_joints) = spawn_skinned(&mut app);
    run(&mut app, 5);
    app.world_mut().entity_mut(cloth).remove::<Cloth>();
    run(&mut app, 2);
    assert_eq!(joints(&app, cloth), Some(&*its_joints), "it is carried as it was drawn last");
    assert_fits(&app, cloth);
    app.world_mut().entity_mut(cloth).insert(Mesh3d(mesh));
    run(&mut app, 1);
    assert_eq!(joints(&app, cloth), Some(&*its_joints));
    run(&mut app, 3);
    assert_fits(&app, cloth);
}

#[test]
fn a_skeleton_that_comes_late_is_followed_from_then_on() {
    let mut app = headless();
    let mesh = add_mesh(&mut app, skinned());
    let cloth = app.world_mut().spawn((Mesh3d(mesh.clone()), Cloth::default())).id();
    run(&mut app, 3);
    let mut latest = Vec::new();
    for is_cloth in [true, true, false] {
        if !is_cloth {
            app.world_mut().entity_mut(cloth).remove::<Cloth>();
        }
        let skin = spawn_skin(&mut app);
        latest.clone_from(&skin.joints);
        app.world_mut().entity_mut(cloth).insert(skin);
        run(&mut app, 2);
        assert_eq!(joints(&app, cloth), Some(&*latest));
        assert_fits(&app, cloth);
    }
    get_mut::<Mesh3d>(&mut app, cloth).0 = mesh;
    run(&mut app, 1);
    assert_eq!(joints(&app, cloth), Some(&*latest));
}

#[test]
fn a_skin_that_comes_with_the_mesh_replaces_the_one_that_was_kept() {
    let mut app = headless();
    let (cloth, mesh, _) = spawn_skinned(&mut app);
    run(&mut app, 3);
    let skin = spawn_skin(&mut app);
    app.world_mut().entity_mut(cloth).remove::<Cloth>().insert((Mesh3d(mesh), skin.clone()));
    run(&mut app, 2);
    assert_eq!(joints(&app, cloth), Some(&*skin.joints));
    assert_fits(&app, cloth);
}

#[test]
fn joints_may_go_while_their_mesh_is_cloth() {
    let mut app = headless();
    let (cloth, mesh, its_joints) = spawn_skinned(&mut app);
    run(&mut app, 3);
    app.world_mut().despawn(its_joints[0]);
    run(&mut app, 3);
    assert_eq!(*get::<ClothStatus>(&app, cloth), ClothStatus::Ready);
    app.world_mut().entity_mut(cloth).remove::<Cloth>();
    get_mut::<Mesh3d>(&mut app, cloth).0 = mesh;
    run(&mut app, 1);
    assert_fits(&app, cloth);
}

#[test]
fn a_cloth_that_loses_its_own_mesh_keeps_its_skin() {
    let mut app = headless();
    let (cloth, mesh, its_joints) = spawn_skinned(&mut app);
    run(&mut app, 3);
    let own = get::<Mesh3d>(&app, cloth).0.clone();
    app.world_mut().resource_mut::<Assets<Mesh>>().remove(&own);
    command(&mut app, cloth, |cloth| cloth.reset_cloth());
    run(&mut app, 2);
    assert_ne!(get::<Mesh3d>(&app, cloth).0, own);
    assert_fits(&app, cloth);
    app.world_mut().entity_mut(cloth).remove::<Cloth>();
    // Touched, and not changed.
    get_mut::<Mesh3d>(&mut app, cloth).set_changed();
    run(&mut app, 2);
    assert_fits(&app, cloth);
    get_mut::<Mesh3d>(&mut app, cloth).0 = mesh;
    run(&mut app, 1);
    assert_eq!(joints(&app, cloth), Some(&*its_joints));
}

#[test]
fn the_skin_of_a_copied_character_follows_the_copys_joints() {
    let mut app = headless();
    let (cloth, mesh, its_joints) = spawn_skinned(&mut app);
    let root = app.world_mut().spawn(Transform::default()).id();
    app.world_mut().entity_mut(root).add_children(&[cloth, its_joints[0]]);
    run(&mut app, 3);
    let copy = app.world_mut().entity_mut(root).clone_and_spawn_with_opt_out(|copy| {
        copy.linked_cloning(true);
    });
    let [copied, joint] = **get::<Children>(&app, copy) else { panic!("it has two children") };
    for _ in 0..3 {
        run(&mut app, 1);
        assert_fits(&app, copied);
    }
    assert_eq!(*get::<ClothStatus>(&app, copied), ClothStatus::Ready);
    app.world_mut().entity_mut(copied).remove::<Cloth>().insert(Mesh3d(mesh));
    run(&mut app, 1);
    assert_eq!(joints(&app, copied), Some(&[joint][..]));
}

#[test]
fn a_cloth_that_cannot_be_built_keeps_its_skin() {
    let mut app = headless();
    let (cloth, _, its_joints) = spawn_skinned(&mut app);
    get_mut::<Cloth>(&mut app, cloth).max_strain = f32::NAN;
    run(&mut app, 3);
    assert!(matches!(get::<ClothStatus>(&app, cloth), ClothStatus::Failed(_)));
    assert_eq!(joints(&app, cloth), Some(&*its_joints));
    assert_fits(&app, cloth);
}

#[test]
fn morph_targets_do_not_move_a_cloth() {
    let mut app = headless();
    let plain = Mesh::from(GRID).with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, vec![[1.0, 0.0, 0.0, 1.0]; 25]);
    let mesh = add_mesh(&mut app, morphed(plain.clone()));
    let weights = MeshMorphWeights::Value { weights: vec![0.5] };
    let still = Cloth { gravity_scale: 0.0, fluid_density: 0.0, ..default() };
    let cloth = app.world_mut().spawn((Mesh3d(mesh.clone()), still, weights)).id();
    run(&mut app, 3);
    assert_fits(&app, cloth);
    assert!(!drawn(&app, cloth).has_morph_targets());
    let all =
        |mesh: &Mesh| mesh.attributes().map(|(attribute, values)| (attribute.id, values.clone())).collect::<Vec<_>>();
    assert_eq!(all(drawn(&app, cloth)), all(&plain), "all else is there");
    assert_eq!(drawn(&app, cloth).indices(), plain.indices());
    get_mut::<Mesh3d>(&mut app, cloth).0 = mesh.clone();
    run(&mut app, 2);
    assert_fits(&app, cloth);
    app.world_mut().entity_mut(cloth).remove::<Cloth>().insert(Mesh3d(mesh));
    run(&mut app, 1);
    let MeshMorphWeights::Value { weights } = get(&app, cloth) else { panic!("they were values") };
    assert_eq!(*weights, [0.5]);
    assert_fits(&app, cloth);
}

#[test]
fn a_skin_waits_for_a_mesh_that_has_joints() {
    let mut app = headless();
    let (cloth, mesh, its_joints) = spawn_skinned(&mut app);
    run(&mut app, 3);
    let plain = add_mesh(&mut app, GRID);
    app.add_systems(Update, swap(cloth, plain.clone()));
    run(&mut app, 1);
    assert_eq!(get::<Mesh3d>(&app, cloth).0, plain);
    assert_fits(&app, cloth);
    run(&mut app, 2);
    app.world_mut().entity_mut(cloth).remove::<Cloth>().insert(Mesh3d(plain));
    run(&mut app, 2);
    assert_fits(&app, cloth);
    let loading = app.world().resource::<Assets<Mesh>>().reserve_handle();
    get_mut::<Mesh3d>(&mut app, cloth).0 = loading.clone();
    run(&mut app, 2);
    assert_eq!(joints(&app, cloth), None);
    let loaded = app.world().resource::<Assets<Mesh>>().get(&mesh).unwrap().clone();
    app.world_mut().resource_mut::<Assets<Mesh>>().insert(&loading, loaded).unwrap();
    run(&mut app, 1);
    assert_eq!(joints(&app, cloth), Some(&*its_joints));
    assert_fits(&app, cloth);
}

#[test]
fn what_a_cloth_does_not_follow_is_said_once() {
    fn said(quiet: &mut Quiet) -> Vec<String> {
        quiet.run(3).into_iter().filter(|line| line.contains("followed")).collect()
    }
    let mut quiet = Quiet::new();
    let mesh = add_mesh(&mut quiet.app, morphed(skinned()));
    let cloth = quiet.app.world_mut().spawn((Mesh3d(mesh.clone()), Cloth::default())).id();
    let first = said(&mut quiet);
    assert_eq!(first.len(), 2, "{first:?}");
    assert!(first[0].contains("no SkinnedMesh") && first[1].contains("morph targets"), "{first:?}");
    command(&mut quiet.app, cloth, |cloth| cloth.reset_cloth());
    let mut again = said(&mut quiet);
    get_mut::<Mesh3d>(&mut quiet.app, cloth).0 = mesh.clone();
    again.extend(said(&mut quiet));
    let mut meshes = quiet.app.world_mut().resource_mut::<Assets<Mesh>>();
    *meshes.get_mut(&mesh).unwrap().into_inner() = skinned();
    again.extend(said(&mut quiet));
    assert!(again.is_empty(), "{again:?}");
    assert_eq!(quiet.app.world().resource::<Heard>().reset.len(), 3);
}
