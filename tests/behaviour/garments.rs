//! Garments: one cloth made of several meshes, as a model with several materials is in Bevy.

use bevy::{
    asset::RenderAssetUsages,
    mesh::{
        Indices, PrimitiveTopology, VertexAttributeValues,
        skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    },
    prelude::*,
};
use bevy_drape::prelude::*;

use crate::{
    common::*,
    quiet::Quiet,
    worn::{SIDE, dress},
};

/// Cuts a mesh by its triangles: each goes to the part that `part_of` gives for the middle of its corners.
pub fn cut(mesh: &Mesh, count: usize, part_of: impl Fn(Vec3) -> usize) -> Vec<Mesh> {
    let places = points(mesh);
    let triangles: Vec<u32> = mesh.indices().expect("an indexed mesh").iter().map(|i| i as u32).collect();
    let mut parts = vec![Vec::new(); count];
    for triangle in triangles.chunks_exact(3) {
        let middle = triangle.iter().map(|&i| places[i as usize]).sum::<Vec3>() / 3.0;
        parts[part_of(middle)].extend_from_slice(triangle);
    }
    parts.into_iter().map(|triangles| part(mesh, &triangles)).collect()
}

/// Some triangles of a mesh with their vertices, in the order in which they come.
fn part(mesh: &Mesh, triangles: &[u32]) -> Mesh {
    let mut vertices: Vec<u32> = triangles.to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    let number = |vertex: &u32| vertices.binary_search(vertex).expect("a vertex of the part") as u32;
    let mut part = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default());
    for (attribute, values) in mesh.attributes() {
        let at = |vertex: &u32| *vertex as usize;
        let chosen = match values {
            VertexAttributeValues::Float32x2(values) => {
                vertices.iter().map(|v| values[at(v)]).collect::<Vec<_>>().into()
            }
            VertexAttributeValues::Float32x3(values) => {
                vertices.iter().map(|v| values[at(v)]).collect::<Vec<_>>().into()
            }
            VertexAttributeValues::Float32x4(values) => {
                vertices.iter().map(|v| values[at(v)]).collect::<Vec<_>>().into()
            }
            VertexAttributeValues::Uint16x4(values) => {
                VertexAttributeValues::Uint16x4(vertices.iter().map(|v| values[at(v)]).collect())
            }
            other => panic!("{other:?} isn't cut"),
        };
        part.insert_attribute(*attribute, chosen);
    }
    part.with_inserted_indices(Indices::U32(triangles.iter().map(number).collect()))
}

/// The parts as one mesh.
fn whole(parts: &[Mesh]) -> Mesh {
    let mut parts = parts.iter();
    let mut whole = parts.next().expect("a part").clone();
    parts.for_each(|part| whole.merge(part).expect("parts of one mesh"));
    whole
}

/// Three parts of a sheet of any triangles, of which no two are in rows.
fn three_parts() -> Vec<Mesh> {
    cut(&uneven(ClothGrid::new(1.0, 1.0, 13, 13), 0.3), 3, |middle| ((middle.x + 0.5) * 3.0) as usize)
}

/// Spawns a garment with a child for each part.
fn spawn_garment(app: &mut App, parts: Vec<Mesh>, more: impl Bundle) -> (Entity, Vec<Entity>) {
    let garment = app.world_mut().spawn((Cloth::default(), Transform::default())).insert(more).id();
    let spawn = |mesh: Mesh| {
        let mesh = add_mesh(app, mesh);
        app.world_mut().spawn((Mesh3d(mesh), Transform::default(), ChildOf(garment))).id()
    };
    let parts = parts.into_iter().map(spawn).collect();
    (garment, parts)
}

fn status(app: &App, entity: Entity) -> &ClothStatus {
    get(app, entity)
}

/// World positions at which a part is drawn.
pub fn seen(app: &App, part: Entity) -> Vec<Vec3> {
    let pose = get::<GlobalTransform>(app, part).affine();
    points(drawn(app, part)).into_iter().map(|place| pose.transform_point3(place)).collect()
}

#[test]
fn a_garment_of_three_meshes_has_the_bits_of_the_same_in_one() {
    let parts = three_parts();
    let place = Transform::from_xyz(1.0, 2.0, 3.0);
    let pins = || Pins::edge(ClothEdge::Top);
    let mut app = headless();
    let (garment, _) = spawn_garment(&mut app, parts.clone(), (pins(), place));
    let mut other = headless();
    let one = spawn_cloth(&mut other, whole(&parts), (pins(), place));
    for app in [&mut app, &mut other] {
        app.world_mut().spawn(Wind { velocity: Vec3::Z * 5.0, ..default() });
        run(app, 60);
    }
    assert_eq!(*status(&app, garment), ClothStatus::Ready);
    assert_eq!(state(&app, garment).particle_count(), 169, "seams are one");
    assert_eq!(positions(&app, garment), positions(&other, one));
    assert!(positions(&app, garment).iter().any(|place| place.z > 3.2), "the wind has blown");
}

#[test]
fn parts_are_drawn_without_a_gap_where_the_cloth_is() {
    let mut app = headless();
    let (garment, parts) = spawn_garment(&mut app, three_parts(), Pins::edge(ClothEdge::Top));
    app.world_mut().spawn(Wind { velocity: Vec3::Z * 5.0, ..default() });
    run(&mut app, 60);
    let mut vertex = 0;
    for &part in &parts {
        assert_eq!(get::<ClothPartOf>(&app, part).0, garment);
        for place in points(drawn(&app, part)) {
            let particle = state(&app, garment).particle_of_vertex(vertex).expect("each vertex is in a triangle");
            assert_close(place, state(&app, garment).position(particle).unwrap(), 0.02);
            vertex += 1;
        }
    }
    // Vertices of one particle are at the same place, and shaded alike.
    let vertices: Vec<_> = parts
        .iter()
        .flat_map(|&part| {
            let mesh = drawn(&app, part);
            points(mesh).into_iter().zip(normals(mesh))
        })
        .collect();
    let particle = |vertex| state(&app, garment).particle_of_vertex(vertex).unwrap();
    let mut seam = 0;
    for (i, first) in vertices.iter().enumerate() {
        for (j, second) in vertices.iter().enumerate().skip(i + 1).filter(|&(j, _)| particle(i) == particle(j)) {
            assert_eq!(first, second, "vertices {i} and {j}");
            seam += 1;
        }
    }
    assert_eq!(seam, 26, "two seams of 13 vertices");
}

#[test]
fn a_closed_body_of_six_meshes_is_one_closed_cloth() {
    let sphere: Mesh = Sphere::new(0.3).mesh().ico(4).unwrap();
    let side = |middle: Vec3| {
        let axis = middle.abs().max_position();
        2 * axis + usize::from(middle[axis] < 0.0)
    };
    let parts = cut(&sphere, 6, side);
    let mut app = headless();
    let (garment, _) = spawn_garment(&mut app, parts.clone(), undamped());
    run(&mut app, 2);
    let mut other = headless();
    let one = spawn_cloth(&mut other, sphere, undamped());
    run(&mut other, 2);
    let count = |app: &App, cloth| {
        let state = state(app, cloth);
        (state.particle_count(), state.triangles().len(), state.topology().springs.len())
    };
    assert_eq!(count(&app, garment), count(&other, one));
}

#[test]
fn parts_that_stand_elsewhere_than_their_garment_are_sewn_and_drawn_in_the_right_place() {
    let mut app = headless();
    let parts = three_parts();
    let (garment, entities) =
        spawn_garment(&mut app, parts, (Pins::edge(ClothEdge::Top), Transform::from_xyz(0.0, 2.0, 0.0)));
    // The third is mirrored and stands aside, with a mesh that makes up for it.
    let aside = Transform::from_xyz(0.3, -0.2, 0.1)
        .with_rotation(Quat::from_rotation_y(0.4))
        .with_scale(Vec3::new(-2.0, 1.0, 0.5));
    let mesh = get::<Mesh3d>(&app, entities[2]).0.clone();
    let back = aside.compute_affine().inverse();
    let normal = back.matrix3.inverse().transpose();
    {
        let mut meshes = app.world_mut().resource_mut::<Assets<Mesh>>();
        let mut mesh = meshes.get_mut(&mesh).unwrap();
        let moved: Vec<_> = points(&mesh).into_iter().map(|place| back.transform_point3(place).to_array()).collect();
        let turned: Vec<_> = normals(&mesh).into_iter().map(|it| (normal * it).normalize().to_array()).collect();
        mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, moved);
        mesh.insert_attribute(Mesh::ATTRIBUTE_NORMAL, turned);
        let Some(Indices::U32(indices)) = mesh.indices_mut() else { panic!("long indices") };
        indices.chunks_exact_mut(3).for_each(|triangle| triangle.swap(1, 2));
    }
    app.world_mut().entity_mut(entities[2]).insert(aside);
    run(&mut app, 30);
    assert_eq!(*status(&app, garment), ClothStatus::Ready);
    let check = |app: &App| {
        let mut vertex = 0;
        for &part in &entities {
            for place in seen(app, part) {
                let particle = state(app, garment).particle_of_vertex(vertex).unwrap();
                assert_close(place, state(app, garment).position(particle).unwrap(), 0.02);
                vertex += 1;
            }
        }
    };
    assert_eq!(state(&app, garment).particle_count(), 169, "it is sewn to the second");
    check(&app);
    // It is cloth, and stays where the cloth is when its entity moves.
    get_mut::<Transform>(&mut app, entities[2]).translation = Vec3::new(5.0, 1.0, 0.0);
    run(&mut app, 1);
    check(&app);
}

/// A skeleton of two joints below an entity, for meshes like [`dress`].
pub fn spawn_skeleton(app: &mut App, root: Transform) -> SkinnedMesh {
    let first = app.world_mut().spawn(root).id();
    let second = app.world_mut().spawn((Transform::from_xyz(0.0, -0.5, 0.0), ChildOf(first))).id();
    let bindposes = vec![Mat4::IDENTITY, Mat4::from_translation(Vec3::Y * 0.5)];
    let bindposes = SkinnedMeshInverseBindposes::from(bindposes);
    let inverse_bindposes = app.world_mut().resource_mut::<Assets<SkinnedMeshInverseBindposes>>().add(bindposes);
    SkinnedMesh { inverse_bindposes, joints: vec![first, second] }
}

/// Joints and weights of each vertex.
pub fn skin(mesh: &Mesh) -> Vec<([u16; 4], [f32; 4])> {
    let attribute = |attribute| mesh.attribute(attribute).expect("it has a skin").clone();
    match [Mesh::ATTRIBUTE_JOINT_INDEX, Mesh::ATTRIBUTE_JOINT_WEIGHT].map(attribute) {
        [VertexAttributeValues::Uint16x4(joints), VertexAttributeValues::Float32x4(weights)] => {
            joints.into_iter().zip(weights).collect()
        }
        other => panic!("{other:?} is no skin"),
    }
}

#[test]
fn a_garment_on_a_skeleton_is_pinned_bit_for_bit_and_drawn_as_one() {
    let mut app = headless();
    let skeleton = spawn_skeleton(&mut app, Transform::from_xyz(0.0, 2.0, 0.0));
    let parts = cut(&dress(true), 2, |middle| usize::from(middle.x > 0.0));
    let (garment, entities) = spawn_garment(&mut app, parts.clone(), Pins::edge(ClothEdge::Top));
    for &part in &entities {
        app.world_mut().entity_mut(part).insert(skeleton.clone());
    }
    for frame in 0..40 {
        let mut joint = get_mut::<Transform>(&mut app, skeleton.joints[0]);
        joint.translation.x = 0.05 * frame as f32;
        joint.rotation = Quat::from_rotation_y(ops::sin(0.1 * frame as f32));
        run(&mut app, 1);
    }
    assert_eq!(*status(&app, garment), ClothStatus::Ready);
    assert_eq!(state(&app, garment).particle_count(), SIDE * SIDE);
    let mut vertex = 0;
    for (&part, source) in entities.iter().zip(&parts) {
        assert!(app.world().get::<SkinnedMesh>(part).is_some(), "the renderer skins it");
        let mesh = drawn(&app, part);
        let matrices = [0, 1].map(|joint: usize| {
            let back = [Mat4::IDENTITY, Mat4::from_translation(Vec3::Y * 0.5)][joint];
            Mat4::from(get::<GlobalTransform>(&app, skeleton.joints[joint]).affine()) * back
        });
        let (own, body) = (skin(mesh), skin(source));
        for (i, place) in points(mesh).into_iter().enumerate() {
            let state = state(&app, garment);
            let particle = state.particle_of_vertex(vertex).unwrap();
            let (joints, weights) = own[i];
            let seen: Vec3 = (0..4).map(|k| matrices[joints[k] as usize].transform_point3(place) * weights[k]).sum();
            assert_close(seen, state.position(particle).unwrap(), 1e-4);
            if state.is_pinned(particle) {
                assert_eq!((place, own[i]), (points(source)[i], body[i]), "as the body beside it");
            }
            vertex += 1;
        }
    }
}

#[test]
fn meshes_of_two_skeletons_are_no_garment_and_one_of_them_on_its_own_is() {
    let mut quiet = Quiet::new();
    let app = &mut quiet.app;
    let (first, second) = (spawn_skeleton(app, Transform::default()), spawn_skeleton(app, Transform::default()));
    let parts = cut(&dress(true), 2, |middle| usize::from(middle.x > 0.0));
    let (garment, entities) = spawn_garment(app, parts, (Pins::edge(ClothEdge::Top), stiff()));
    app.world_mut().entity_mut(entities[0]).insert(first);
    app.world_mut().entity_mut(entities[1]).insert(second);
    let said = quiet.run(5);
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains("skeleton") && said[0].contains(&entities[1].to_string()), "{said:?}");
    assert!(matches!(status(&quiet.app, garment), ClothStatus::Failed(ClothError::Part { .. })));
    quiet.app.world_mut().entity_mut(entities[1]).despawn();
    assert_eq!(quiet.run(3), Vec::<String>::new());
    assert_eq!(*status(&quiet.app, garment), ClothStatus::Ready);
}

#[test]
fn a_part_that_goes_or_comes_makes_the_garment_anew() {
    let mut app = headless();
    let mut parts = three_parts();
    let last = parts.pop().unwrap();
    let (garment, entities) = spawn_garment(&mut app, parts, Pins::edge(ClothEdge::Top));
    run(&mut app, 2);
    let count = |app: &App| state(app, garment).particle_count();
    let of_two = count(&app);
    let mesh = add_mesh(&mut app, last);
    let third = app.world_mut().spawn((Mesh3d(mesh.clone()), Transform::default(), ChildOf(garment))).id();
    run(&mut app, 2);
    assert_eq!(count(&app), 169);
    app.world_mut().entity_mut(third).despawn();
    run(&mut app, 2);
    assert_eq!(count(&app), of_two);
    // One that is elsewhere, and says itself that it is a part.
    let third = app.world_mut().spawn((Mesh3d(mesh.clone()), Transform::default(), ClothPartOf(garment))).id();
    run(&mut app, 2);
    assert_eq!(count(&app), 169);
    app.world_mut().entity_mut(third).remove::<ClothPartOf>();
    run(&mut app, 2);
    assert_eq!(count(&app), of_two);
    // Another mesh for one of them.
    app.world_mut().entity_mut(entities[1]).insert(Mesh3d(mesh));
    run(&mut app, 2);
    assert_eq!(*status(&app, garment), ClothStatus::Ready);
    assert_ne!(count(&app), of_two);
}

#[test]
fn without_cloth_the_parts_stay_as_they_were_drawn() {
    let mut app = headless();
    let (garment, parts) = spawn_garment(&mut app, three_parts(), Pins::edge(ClothEdge::Top));
    app.world_mut().spawn(Wind { velocity: Vec3::Z * 5.0, ..default() });
    run(&mut app, 30);
    let before: Vec<_> = parts.iter().map(|&part| points(drawn(&app, part))).collect();
    app.world_mut().entity_mut(garment).remove::<Cloth>();
    run(&mut app, 3);
    for (&part, before) in parts.iter().zip(&before) {
        assert!(app.world().get::<ClothPartOf>(part).is_none());
        assert_eq!(&points(drawn(&app, part)), before);
        assert!(drawn(&app, part).final_aabb.is_none(), "its bounds are its own again");
    }
}

#[test]
fn a_cloth_below_a_garment_is_one_of_its_own() {
    let mut app = headless();
    let (garment, parts) = spawn_garment(&mut app, three_parts(), Pins::edge(ClothEdge::Top));
    app.world_mut().entity_mut(parts[2]).insert((Cloth::default(), Pins::edge(ClothEdge::Top)));
    run(&mut app, 2);
    assert_eq!([garment, parts[2]].map(|cloth| status(&app, cloth).is_running()), [true; 2]);
    assert!(app.world().get::<ClothPartOf>(parts[2]).is_none());
    assert_eq!(get::<ClothParts>(&app, garment).collection(), &parts[..2]);
}

#[test]
fn a_garment_waits_for_all_of_its_meshes() {
    let mut app = headless();
    let mut parts = three_parts();
    let last = parts.pop().unwrap();
    let (garment, _) = spawn_garment(&mut app, parts, Pins::edge(ClothEdge::Top));
    let late = app.world().resource::<Assets<Mesh>>().reserve_handle();
    app.world_mut().spawn((Mesh3d(late.clone()), Transform::default(), ChildOf(garment)));
    run(&mut app, 3);
    assert_eq!(*status(&app, garment), ClothStatus::Waiting);
    app.world_mut().resource_mut::<Assets<Mesh>>().insert(&late, last).unwrap();
    run(&mut app, 2);
    assert_eq!((status(&app, garment), state(&app, garment).particle_count()), (&ClothStatus::Ready, 169));
}

#[test]
fn cloth_without_any_mesh_is_told_of_once_and_not_before_a_scene_could_have_come() {
    let mut quiet = Quiet::new();
    quiet.app.world_mut().spawn(Cloth::default());
    assert_eq!(quiet.run(240), Vec::<String>::new());
    let said = quiet.run(240);
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains("no Mesh3d"), "{said:?}");
}

#[test]
fn attributes_that_only_some_parts_have_are_left_out_and_told_of_once() {
    let mut quiet = Quiet::new();
    let mut parts = three_parts();
    let count = parts[1].count_vertices();
    parts[1].insert_attribute(ATTRIBUTE_PIN, vec![1.0; count]);
    let (garment, _) = spawn_garment(&mut quiet.app, parts, (Pins::edge(ClothEdge::Top), stiff()));
    let said = quiet.run(5);
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains("Pin") && said[0].contains(&garment.to_string()), "{said:?}");
    assert_eq!(*status(&quiet.app, garment), ClothStatus::Ready);
}

#[test]
fn a_part_that_is_no_surface_is_named() {
    let mut quiet = Quiet::new();
    let mut parts = three_parts();
    parts[1] = Mesh::new(PrimitiveTopology::LineList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, vec![[0.0; 3]; 2]);
    let (garment, entities) = spawn_garment(&mut quiet.app, parts, ());
    let said = quiet.run(5);
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains(&entities[1].to_string()) && said[0].contains("LineList"), "{said:?}");
    assert!(matches!(status(&quiet.app, garment), ClothStatus::Failed(_)));
}
