//! A headless app whose every update runs exactly one step, and ways to look into it.

use std::time::Duration;

use bevy::{
    app::Plugins,
    asset::RenderAssetUsages,
    ecs::component::Mutable,
    mesh::{Indices, MeshPlugin, MeshVertexAttribute, PrimitiveTopology, VertexAttributeValues},
    prelude::*,
    time::TimeUpdateStrategy,
};
use bevy_drape::{
    prelude::*,
    solver::{StepReport, Tether},
};

/// Duration of a step of [`headless`] apps, s.
pub const STEP: f32 = 1.0 / 60.0;

/// Everything that cloths have announced, in its order.
#[derive(Resource, Default, Debug, PartialEq)]
pub struct Heard {
    pub ready: Vec<Entity>,
    pub failed: Vec<(Entity, ClothError)>,
    pub reset: Vec<(Entity, ResetCause)>,
}

/// An app with cloth at 60 Hz: each update runs one step and, with no time left over, draws where that began.
pub fn headless() -> App {
    headless_with(ClothPlugin::default())
}

/// The same with a plugin that is set up otherwise, or more of them.
pub fn headless_with<M>(plugins: impl Plugins<M>) -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), MeshPlugin, plugins))
        .init_resource::<Heard>()
        .add_observer(|event: On<ClothReady>, mut heard: ResMut<Heard>| heard.ready.push(event.entity))
        .add_observer(|event: On<ClothFailed>, mut heard: ResMut<Heard>| {
            heard.failed.push((event.entity, event.error.clone()));
        })
        .add_observer(|event: On<ClothReset>, mut heard: ResMut<Heard>| heard.reset.push((event.entity, event.cause)));
    let step = Time::<Fixed>::from_hz(60.0);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(step.timestep())).insert_resource(step);
    app.finish();
    app.cleanup();
    // Bevy's clock starts with the first update, which therefore runs no step.
    app.update();
    app
}

/// Makes each update last `update` s and each step `step` s.
pub fn set_rates(app: &mut App, update: f64, step: f64) {
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(update)));
    app.world_mut().resource_mut::<Time<Fixed>>().set_timestep(Duration::from_secs_f64(step));
}

/// Updates the app `frames` times.
pub fn run(app: &mut App, frames: usize) {
    for _ in 0..frames {
        app.update();
    }
}

/// Spawns a mesh with a [`Cloth`] and, over it, `more` components. It is ready after one update.
pub fn spawn_cloth(app: &mut App, mesh: impl Into<Mesh>, more: impl Bundle) -> Entity {
    let mesh = add_mesh(app, mesh);
    app.world_mut().spawn((Mesh3d(mesh), Cloth::default())).insert(more).id()
}

pub fn add_mesh(app: &mut App, mesh: impl Into<Mesh>) -> Handle<Mesh> {
    app.world_mut().resource_mut::<Assets<Mesh>>().add(mesh)
}

/// Applies commands to an entity at once.
pub fn command<F>(app: &mut App, entity: Entity, ask: F)
where
    F: for<'a, 'w> FnOnce(&'a mut EntityCommands<'w>) -> &'a mut EntityCommands<'w>,
{
    ask(&mut app.world_mut().commands().entity(entity));
    app.world_mut().flush();
}

/// A fabric that neither the air nor its own damping slows down.
pub fn undamped() -> Fabric {
    Fabric { damping: 0.0, drag: 0.0, lift: 0.0, ..default() }
}

/// A fabric whose folds show on cells of 15 cm: nothing is said of those.
pub fn stiff() -> Fabric {
    Fabric { bending_rigidity: 2e-3, ..default() }
}

pub fn get<C: Component>(app: &App, entity: Entity) -> &C {
    app.world().get::<C>(entity).unwrap_or_else(|| panic!("{entity} has no {}", core::any::type_name::<C>()))
}

pub fn get_mut<C: Component<Mutability = Mutable>>(app: &mut App, entity: Entity) -> Mut<'_, C> {
    app.world_mut().get_mut::<C>(entity).unwrap_or_else(|| panic!("{entity} has no {}", core::any::type_name::<C>()))
}

pub fn state(app: &App, entity: Entity) -> &ClothState {
    get(app, entity)
}

pub fn report(app: &App, entity: Entity) -> StepReport {
    get::<ClothReport>(app, entity).latest().expect("the cloth has been stepped")
}

pub fn tethers(app: &App, entity: Entity) -> Vec<Tether> {
    get::<ClothAttachments>(app, entity).tethers().collect()
}

/// Takes hold of a point of a cloth.
pub fn take_hold(app: &mut App, cloth: Entity, point: ClothPoint, grip: ClothGrip) -> Option<GrabId> {
    let mut cloths = app.world_mut().query::<(&ClothState, &mut ClothGrabs)>();
    let (state, mut grabs) = cloths.get_mut(app.world_mut(), cloth).expect("a cloth");
    grabs.grab(state, point, grip)
}

/// Leads a held point of a cloth. False where the hold has ended.
pub fn lead(app: &mut App, cloth: Entity, grab: GrabId, target: Vec3) -> bool {
    get_mut::<ClothGrabs>(app, cloth).move_grab(grab, target)
}

/// Lets go of a point of a cloth. False where the hold has ended.
pub fn let_go(app: &mut App, cloth: Entity, grab: GrabId) -> bool {
    get_mut::<ClothGrabs>(app, cloth).release(grab)
}

pub fn is_held(app: &App, cloth: Entity) -> bool {
    !get::<ClothGrabs>(app, cloth).is_empty()
}

pub fn positions(app: &App, entity: Entity) -> Vec<Vec3> {
    state(app, entity).positions().collect()
}

/// World position of one of the mesh's vertices.
pub fn place(app: &App, entity: Entity, vertex: u32) -> Vec3 {
    let state = state(app, entity);
    let particle = state.particle_of_vertex(vertex as usize).expect("the vertex is in a triangle");
    state.position(particle).expect("the cloth is ready")
}

/// The mesh's vertices that are pinned.
pub fn pinned(app: &App, entity: Entity) -> Vec<usize> {
    let state = state(app, entity);
    let vertices = drawn(app, entity).count_vertices();
    (0..vertices).filter(|&vertex| state.particle_of_vertex(vertex).is_some_and(|p| state.is_pinned(p))).collect()
}

/// By how much a side of a cloth's triangles is longer or shorter than at rest at most, no unit.
pub fn largest_strain(app: &App, entity: Entity) -> f32 {
    strains(app, entity).into_iter().fold(0.0, f32::max)
}

/// By how much each side of each of a cloth's triangles is longer or shorter than at rest, no unit.
pub fn strains(app: &App, entity: Entity) -> Vec<f32> {
    let state = state(app, entity);
    let (places, rest): (Vec<Vec3>, _) = (state.positions_from_origin().collect(), &state.topology().rest);
    let sides = state.triangles().iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
    let strain = |(a, b): (u32, u32)| {
        let length = |places: &[Vec3]| places[a as usize].distance(places[b as usize]);
        (length(&places) / length(rest) - 1.0).abs()
    };
    sides.map(strain).collect()
}

/// Moves inner vertices of a flat grid in its own plane by up to this share of a cell: triangles that form no rows and
/// columns.
pub fn uneven(grid: ClothGrid, share: f32) -> Mesh {
    let (size, UVec2 { x: columns, y: rows }) = (grid.size, grid.particles);
    let cell = size / (grid.particles - 1).as_vec2();
    let mut mesh = Mesh::from(grid);
    let Some(VertexAttributeValues::Float32x3(places)) = mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION) else {
        panic!("a grid has positions");
    };
    let down = if grid.lying { 2 } else { 1 };
    for (k, place) in places.iter_mut().enumerate() {
        let (column, row) = (k as u32 % columns, k as u32 / columns);
        if (1..columns - 1).contains(&column) && (1..rows - 1).contains(&row) {
            place[0] += share * cell.x * ops::sin(12.9 * k as f32);
            place[down] += share * cell.y * ops::sin(78.2 * k as f32);
        }
    }
    mesh
}

/// The mesh that is drawn for an entity.
pub fn drawn(app: &App, entity: Entity) -> &Mesh {
    app.world().resource::<Assets<Mesh>>().get(&get::<Mesh3d>(app, entity).0).expect("the mesh exists")
}

pub fn vec3s(mesh: &Mesh, attribute: MeshVertexAttribute) -> Vec<Vec3> {
    match mesh.attribute(attribute) {
        Some(VertexAttributeValues::Float32x3(values)) => values.iter().copied().map(Vec3::from).collect(),
        other => panic!("no vectors but {other:?}"),
    }
}

pub fn points(mesh: &Mesh) -> Vec<Vec3> {
    vec3s(mesh, Mesh::ATTRIBUTE_POSITION)
}

pub fn normals(mesh: &Mesh) -> Vec<Vec3> {
    vec3s(mesh, Mesh::ATTRIBUTE_NORMAL)
}

#[track_caller]
pub fn assert_close(a: Vec3, b: Vec3, tolerance: f32) {
    assert!(a.distance(b) <= tolerance, "{a} and {b} are {} apart", a.distance(b));
}

/// A strip of two quads in the XY plane, 2 m long, whose vertices are doubled where they meet:
///
/// ```text
///  0 --- 1 4 --- 6
///  |     | |     |
///  2 --- 3 5 --- 7
/// ```
pub fn seamed_strip() -> Mesh {
    let place = [[-1, 1], [0, 1], [-1, 0], [0, 0], [0, 1], [0, 0], [1, 1], [1, 0]];
    let uv = [[0, 0], [1, 0], [0, 1], [1, 1], [0, 0], [0, 1], [1, 0], [1, 1]];
    let positions = place.map(|[x, y]| [x as f32, y as f32, 0.0]).to_vec();
    let uvs = uv.map(|[u, v]| [u as f32, v as f32]).to_vec();
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 0.0, 1.0]; 8])
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
        .with_inserted_indices(Indices::U32(vec![0, 2, 1, 1, 2, 3, 4, 5, 6, 6, 5, 7]))
}
