//! The mannequin that tests and examples animate is what `examples/generate_mannequin` says it is.

use std::{collections::HashMap, path::Path, thread, time::Duration};

use bevy::{
    app::Plugins,
    asset::LoadState,
    gltf::GltfPlugin,
    math::Vec3A,
    mesh::{
        MeshPlugin,
        skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    },
    prelude::*,
    world_serialization::WorldSerializationPlugin,
};
use bevy_drape::solver::geometry::closest_point::place_on_triangle;
use gltf::{Document, Semantic, accessor::Iter};

const FILE: &str = "mannequin.glb";
const JOINTS: usize = 17;
const WHOLE: u32 = 65_535;

fn assets() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets")
}

/// The file, read without Bevy.
struct File {
    document: Document,
    bytes: Vec<u8>,
}

/// A vertex, bit by bit: position, joints and weights.
type Bits = ([u32; 3], [u8; 4], [u16; 4]);

impl File {
    fn open() -> Self {
        let mut file = gltf::Gltf::open(assets().join(FILE)).expect("a glTF file");
        Self { bytes: file.blob.take().expect("a binary chunk"), document: file.document }
    }

    fn primitives(&self, mesh: &str) -> Vec<gltf::Primitive<'_>> {
        let mesh = self.document.meshes().find(|other| other.name() == Some(mesh)).expect("a mesh of that name");
        mesh.primitives().collect()
    }

    fn read<T: gltf::accessor::Item>(&self, primitive: &gltf::Primitive, semantic: &Semantic) -> Vec<T> {
        let accessor = primitive.get(semantic).expect("an attribute");
        Iter::new(accessor, |_| Some(&self.bytes)).expect("numbers of that kind").collect()
    }

    fn positions(&self, primitive: &gltf::Primitive) -> Vec<Vec3A> {
        self.read::<[f32; 3]>(primitive, &Semantic::Positions).into_iter().map(Vec3A::from).collect()
    }

    fn triangles(&self, primitive: &gltf::Primitive) -> Vec<[usize; 3]> {
        let indices = Iter::<u16>::new(primitive.indices().expect("indices"), |_| Some(&self.bytes));
        let indices: Vec<usize> = indices.expect("short indices").map(usize::from).collect();
        indices.as_chunks().0.to_vec()
    }

    fn vertices(&self, primitive: &gltf::Primitive) -> Vec<Bits> {
        let positions = self.read::<[f32; 3]>(primitive, &Semantic::Positions);
        let joints = self.read(primitive, &Semantic::Joints(0));
        let weights = self.read(primitive, &Semantic::Weights(0));
        let skin = joints.into_iter().zip(weights);
        positions
            .into_iter()
            .zip(skin)
            .map(|(place, (joints, weights))| (place.map(f32::to_bits), joints, weights))
            .collect()
    }
}

/// An app that has spawned the mannequin, and its transforms.
fn spawned() -> App {
    spawned_with(|_: &mut App| {})
}

/// The same with more plugins.
pub fn spawned_with<M>(plugins: impl Plugins<M>) -> App {
    let mut app = App::new();
    app.add_plugins((
        MinimalPlugins,
        TransformPlugin,
        AssetPlugin { file_path: assets().to_string_lossy().into_owned(), ..default() },
        MeshPlugin,
        ImagePlugin::default(),
        WorldSerializationPlugin,
        GltfPlugin::default(),
    ));
    app.init_asset::<StandardMaterial>().add_plugins(plugins);
    app.finish();
    app.cleanup();
    let server = app.world().resource::<AssetServer>().clone();
    let scene = server.load(GltfAssetLabel::Scene(0).from_asset(FILE));
    app.world_mut().spawn(WorldAssetRoot(scene.clone()));
    for _ in 0..1000 {
        app.update();
        match server.load_state(&scene) {
            LoadState::Failed(error) => panic!("{error}"),
            LoadState::Loaded if app.world_mut().query::<&SkinnedMesh>().iter(app.world()).count() > 0 => break,
            _ => thread::sleep(Duration::from_millis(5)),
        }
    }
    app.update();
    app
}

#[test]
fn its_scene_has_each_mesh_on_all_joints() {
    let mut app = spawned();
    let mut skins = app.world_mut().query::<(&SkinnedMesh, &ChildOf)>();
    let mut parts: HashMap<String, usize> = HashMap::new();
    for (skin, parent) in skins.iter(app.world()) {
        assert_eq!(skin.joints.len(), JOINTS);
        let name = app.world().get::<Name>(parent.parent()).expect("a node's name");
        *parts.entry(name.to_string()).or_default() += 1;
    }
    let expected = [("Body", 1), ("Cape", 1), ("CapeFine", 1), ("Skirt", 1), ("Tunic", 2)];
    assert_eq!(parts, expected.into_iter().map(|(name, count)| (name.to_owned(), count)).collect());
}

#[test]
fn its_bind_pose_moves_nothing() {
    let mut app = spawned();
    let mut skins = app.world_mut().query::<&SkinnedMesh>();
    let skin = skins.iter(app.world()).next().expect("a skinned mesh").clone();
    let inverse = app.world().resource::<Assets<SkinnedMeshInverseBindposes>>().get(&skin.inverse_bindposes);
    for (&joint, inverse) in skin.joints.iter().zip(inverse.expect("inverse bind poses").iter()) {
        let pose = app.world().get::<GlobalTransform>(joint).expect("a joint").to_matrix();
        assert!((pose * *inverse).abs_diff_eq(Mat4::IDENTITY, 1e-6), "{}", pose * *inverse);
    }
}

#[test]
fn its_weights_sum_to_one() {
    let file = File::open();
    for mesh in file.document.meshes() {
        for primitive in mesh.primitives() {
            for (_, joints, weights) in file.vertices(&primitive) {
                assert_eq!(weights.map(u32::from).iter().sum::<u32>(), WHOLE, "{:?}", mesh.name());
                assert!(joints.iter().all(|&joint| usize::from(joint) < JOINTS));
            }
        }
    }
}

#[test]
fn its_body_is_closed_and_left_and_right_never_mix() {
    let file = File::open();
    let body = &file.primitives("Body")[0];
    let mut edges: HashMap<[usize; 2], i32> = HashMap::new();
    for [a, b, c] in file.triangles(body) {
        for edge in [[a, b], [b, c], [c, a]] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    assert!(edges.iter().all(|(&[a, b], &count)| count == 1 && edges.contains_key(&[b, a])));

    let skin = file.document.skins().next().expect("a skin");
    let names: Vec<_> = skin.joints().map(|joint| joint.name().expect("a name").to_owned()).collect();
    for (_, joints, weights) in file.vertices(body) {
        let is_on = |side: &str| {
            joints.iter().zip(weights).any(|(&joint, weight)| weight > 0 && names[usize::from(joint)].ends_with(side))
        };
        assert!(!(is_on(".L") && is_on(".R")));
    }
}

#[test]
fn its_tunics_materials_meet_in_vertices_of_the_same_bits() {
    let file = File::open();
    let [cloth, trim] = &file.primitives("Tunic")[..] else { panic!("two materials") };
    assert_ne!(cloth.material().index(), trim.material().index());
    let cloth: HashMap<_, _> = file.vertices(cloth).into_iter().map(|vertex| (vertex.0, vertex)).collect();
    let pairs = file.vertices(trim).into_iter().filter_map(|vertex| Some((*cloth.get(&vertex.0)?, vertex)));
    // The band all around, and both ends of both straps.
    assert_eq!(pairs.inspect(|(cloth, trim)| assert_eq!(cloth, trim)).count(), 41 + 4 * 4);
}

#[test]
fn its_garments_are_held_at_the_top_and_loose_below() {
    let file = File::open();
    for mesh in ["Cape", "CapeFine", "Skirt", "Tunic"] {
        for primitive in file.primitives(mesh) {
            let looseness = file.read::<f32>(&primitive, &Semantic::Extras("CLOTH".to_owned()));
            let uvs = file.read::<[f32; 2]>(&primitive, &Semantic::TexCoords(0));
            for ([_, down], looseness) in uvs.into_iter().zip(looseness) {
                assert!((0.0..=1.0).contains(&looseness));
                assert!(down > 0.0 || looseness == 0.0, "{mesh} at {down}: {looseness}");
                assert!(down < 0.3 || looseness == 1.0, "{mesh} at {down}: {looseness}");
            }
        }
    }
}

#[test]
fn its_cape_keeps_clear_of_the_body() {
    let file = File::open();
    let body = &file.primitives("Body")[0];
    let points = file.positions(body);
    let triangles: Vec<_> =
        file.triangles(body).into_iter().map(|corners| corners.map(|corner| points[corner])).collect();
    for place in file.positions(&file.primitives("Cape")[0]) {
        let nearest = triangles.iter().map(|&corners| place_on_triangle(place, corners).distance(place));
        assert!(nearest.fold(f32::INFINITY, f32::min) > 0.015, "at {place}");
    }
}

#[test]
fn its_clips_last_as_long_as_they_say() {
    let file = File::open();
    let duration = |clip: gltf::Animation| {
        let ends = clip.samplers().map(|sampler| {
            Iter::<f32>::new(sampler.input(), |_| Some(&file.bytes)).expect("times").last().expect("a key")
        });
        (clip.name().expect("a name").to_owned(), ends.fold(0.0, f32::max))
    };
    let durations: Vec<_> = file.document.animations().map(duration).collect();
    let expected = [("idle", 3.0), ("walk", 1.0), ("run", 20.0 / 30.0), ("jump", 1.4), ("turn", 0.25), ("sit", 4.0)];
    assert_eq!(durations.len(), expected.len());
    for ((name, duration), (expected_name, expected)) in durations.into_iter().zip(expected) {
        assert_eq!(name, expected_name);
        assert!((duration - expected).abs() < 1e-6, "{name}: {duration}");
    }
}
