//! Whatever a mesh carries, its cloth is drawn: while it runs, after it was put back, and when it is cloth no longer.

use bevy::prelude::*;
use bevy_drape::prelude::*;
use image::RgbImage;

use crate::{
    cases::{Case, cases, everything, spawn_skin, weights},
    cells::{CELLS, SIZE, place, region, spawn_surroundings},
    colours::{Colour, share},
    studio::{Studio, path},
};

/// All cloths, in a grid of cells.
struct Wall {
    studio: Studio,
    cloths: Vec<Hung>,
}

/// A cloth in its cell.
struct Hung {
    case: Case,
    /// Its middle.
    place: Vec3,
    entity: Entity,
    /// What it is made of.
    mesh: Handle<Mesh>,
    hue: f32,
}

/// Meshes that are to be drawn for a frame before they become cloth again.
#[derive(Resource, Default)]
struct Swaps(Vec<(Entity, Handle<Mesh>)>);

#[test]
fn cloth_of_any_mesh_is_drawn() {
    let mut wall = Wall::new();
    wall.studio.start();
    let before = wall.hems();
    let hung = wall.assert_drawn_in_place("meshes_1_hung");
    wall.studio.run(4);
    for ((before, after), cloth) in before.iter().zip(wall.hems()).zip(&wall.cloths) {
        assert!(before.distance(after) > 0.005, "{}: it hasn't moved", cloth.case.name);
    }
    let running = wall.assert_drawn_in_place("meshes_2_running");
    assert_ne!(hung, running);

    // A character's skin may come after its clothes.
    wall.insert_skins();
    wall.each(|world, cloth| {
        world.commands().entity(cloth.entity).reset_cloth();
    });
    wall.assert_drawn_in_place("meshes_3_reset");

    wall.swap_back();
    wall.assert_drawn("meshes_4_swapped", |case| case.skin);
    wall.assert_drawn_in_place("meshes_5_rebuilt");

    let other = wall.studio.app.world_mut().resource_mut::<Assets<Mesh>>().add(everything());
    wall.swap(|_| other.clone());
    // It has no skin, and stands where its entity does.
    wall.assert_drawn("meshes_6_other", |_| Vec3::ZERO);
    wall.swap_back();
    wall.studio.run(4);

    wall.each(|world, cloth| {
        world.entity_mut(cloth.entity).remove::<Cloth>();
    });
    wall.assert_drawn_in_place("meshes_7_removed");
    wall.swap_back();
    wall.studio.run(2);
    // Bevy follows morph targets from the next change of the entity on, whoever gave it the mesh.
    wall.each(|world, cloth| world.get_mut::<Mesh3d>(cloth.entity).expect("all have a mesh").set_changed());
    wall.assert_drawn("meshes_8_meshes", |case| case.skin + case.morph);
}

impl Wall {
    fn new() -> Self {
        let mut studio = Studio::new(SIZE);
        studio.app.add_plugins(ClothPlugin::default()).init_resource::<Swaps>().add_systems(
            Update,
            |mut swaps: ResMut<Swaps>, mut meshes: Query<&mut Mesh3d>| {
                for (entity, mesh) in swaps.0.drain(..) {
                    meshes.get_mut(entity).expect("all have a mesh").0 = mesh;
                }
            },
        );
        let target = studio.target.clone();
        let world = studio.app.world_mut();
        spawn_surroundings(world, target);
        let cases = cases(&mut world.resource_mut::<Assets<Image>>());
        assert_eq!(cases.len(), CELLS);
        let cases = cases.into_iter().enumerate().filter_map(|(cell, case)| Some((cell, case?)));
        let cloths = cases.map(|(cell, case)| Hung::spawn(world, cell, case)).collect();
        Self { studio, cloths }
    }

    fn each(&mut self, act: impl Fn(&mut World, &Hung)) {
        let world = self.studio.app.world_mut();
        self.cloths.iter().for_each(|cloth| act(world, cloth));
        world.flush();
    }

    /// Sets all meshes within the next frame, too late for it to make cloth of them.
    fn swap(&mut self, mesh: impl Fn(&Hung) -> Handle<Mesh>) {
        self.each(|world, cloth| world.resource_mut::<Swaps>().0.push((cloth.entity, mesh(cloth))));
    }

    /// The same with the meshes that the cloths were made of at first.
    fn swap_back(&mut self) {
        self.swap(|cloth| cloth.mesh.clone());
    }

    fn insert_skins(&mut self) {
        self.each(|world, cloth| {
            if cloth.case.skin != Vec3::ZERO {
                let skin = spawn_skin(world, cloth.place + cloth.case.skin);
                world.entity_mut(cloth.entity).insert(skin);
            }
        });
    }

    /// World place of each cloth's last particle, which is at its lower edge.
    fn hems(&self) -> Vec<Vec3> {
        let world = self.studio.app.world();
        let states = self.cloths.iter().map(|cloth| world.get::<ClothState>(cloth.entity).expect("it is cloth"));
        states.map(|state| state.positions().last().expect("it is ready")).collect()
    }

    /// Each cloth is seen where it is simulated: on its skeleton, where it has one.
    fn assert_drawn_in_place(&mut self, name: &str) -> RgbImage {
        self.assert_drawn(name, |case| case.skin)
    }

    /// Each is seen this way off its place, and nowhere else.
    #[track_caller]
    fn assert_drawn(&mut self, name: &str, way: impl Fn(&Case) -> Vec3) -> RgbImage {
        let picture = self.studio.picture(name);
        for cloth in &self.cloths {
            let (case, way) = (&cloth.case, way(&cloth.case));
            let share = cloth.share(&picture, way);
            let file = path(name);
            assert!(share >= case.share, "{}: {share} of its place is of it; see {}", case.name, file.display());
            for other in [Vec3::ZERO, case.skin + case.morph].into_iter().filter(|&other| other != way) {
                let share = cloth.share(&picture, other);
                assert!(share < 0.3, "{}: it is elsewhere as well; see {}", case.name, file.display());
            }
        }
        picture
    }
}

impl Hung {
    fn spawn(world: &mut World, cell: usize, mut case: Case) -> Self {
        let place = place(cell);
        // Neighbours have hues that are far from each other.
        let hue = (cell * 7 % CELLS) as f32 * 360.0 / CELLS as f32;
        let alpha = if case.material.alpha_mode == AlphaMode::Blend { 0.7 } else { 1.0 };
        case.material.base_color = Color::hsva(hue, 0.85, 0.8, alpha);
        case.material.double_sided = true;
        case.material.cull_mode = None;
        case.material.perceptual_roughness = 0.9;
        let mesh = world.resource_mut::<Assets<Mesh>>().add(case.mesh.clone());
        let material = world.resource_mut::<Assets<StandardMaterial>>().add(case.material.clone());
        let entity = world
            .spawn((
                Mesh3d(mesh.clone()),
                MeshMaterial3d(material),
                Transform::from_translation(place),
                Cloth::default(),
                Fabric { density: 0.1, ..default() },
                Pins::edge(ClothEdge::Top),
            ))
            .id();
        if case.skin != Vec3::ZERO {
            let skin = spawn_skin(world, place + case.skin);
            world.entity_mut(entity).insert(skin);
        }
        if case.morph != Vec3::ZERO {
            world.entity_mut(entity).insert(weights());
        }
        Self { case, place, entity, mesh, hue }
    }

    /// Share of a place in the picture, this way off its own, that is of it.
    fn share(&self, picture: &RgbImage, way: Vec3) -> f32 {
        const TOLERANCE: f32 = 9.0;
        let hue = [-TOLERANCE, TOLERANCE].map(|by| (self.hue + by).rem_euclid(360.0));
        share(picture, region(self.place + way), Colour { hue, saturation: [0.3, 1.0] })
    }
}
