//! Obstacles: entities that cloth drapes over.

use bevy::{
    math::{Affine3A, Isometry3d, Vec3A},
    prelude::*,
};

use crate::{
    frame::{FromLatestStep, Jump, JumpDetection, Pass, PastPose, PerPass, Poses, Steps},
    solver::{Body, CollisionFilter, Obstacle, Shape, Solid, StepReach},
    surroundings::body::{BodyGroups, ClothBodyPart},
};
use error::ColliderError;
use scale_mismatch::ScaleMismatchWarning;

pub(crate) mod changes;
pub(crate) mod error;
#[cfg(feature = "mesh_colliders")]
pub(crate) mod mesh;
mod scale_mismatch;
mod solid;

/// An obstacle for cloth, moved by its `Transform`.
///
/// Move it in `FixedUpdate` or any schedule that runs once a step: its way since the latest step is what pushes the
/// cloth, and one that moves once a frame comes in jolts where a frame has several steps or none. For cloth that steps
/// [late](crate::prelude::ClothTiming::Late) it may move once a frame, before transforms are propagated. It jumps without sweeping
/// what is between by [`teleport_collider`](crate::prelude::ClothCommands::teleport_collider); beyond the
/// [`ColliderTeleportThreshold`](crate::prelude::ColliderTeleportThreshold), by itself. While it is `Disabled` it is no
/// obstacle, and comes out of nowhere afterwards.
///
/// Made from one of Bevy's primitives: `ClothCollider::from(Sphere::new(0.3))`; also from an
/// [`Ellipsoid`](crate::prelude::Ellipsoid), a `Cuboid`, a `Capsule3d`, a
/// [`TaperedCapsule`](crate::prelude::TaperedCapsule), a `Cylinder`, a `Cone` and, for a ground, an `InfinitePlane3d`,
/// behind which all is solid.
///
/// The transform's scale applies, and a ball becomes an [`Ellipsoid`](crate::prelude::Ellipsoid) where it isn't uniform.
/// What is round about an axis stays so: it takes the larger of the factors across that, and its round ends stay balls. One
/// warning tells of it, and of a transform that is sheared, by which only a plane and triangles are.
#[cfg_attr(
    feature = "mesh_colliders",
    doc = "
Anything else is made of triangles: `ClothCollider::mesh()` of those of the entity's own `Mesh3d`,
`ClothCollider::convex_hull()` of those around it, and a [`HeightField`](crate::prelude::HeightField) of those of a
terrain. Any scale applies to them exactly.

```
# use bevy::prelude::*;
# use bevy_drape::prelude::*;
fn setup(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, assets: Res<AssetServer>) {
    commands.spawn((Mesh3d(meshes.add(Torus::new(0.2, 0.5))), ClothCollider::mesh()));
    commands.spawn((Mesh3d(assets.load(\"rock.glb#Mesh0/Primitive0\")), ClothCollider::convex_hull()));
    let hills = |x: f32, z: f32| 0.2 * ops::sin(x) * ops::cos(z);
    commands.spawn(ClothCollider::from(HeightField::new(Vec2::splat(10.0), 64, 64, hills)));
}
```
"
)]
///
/// A collider of no size, or with a transform that isn't finite, is left out, with one warning.
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
#[require(Transform, ColliderMemory)]
pub struct ClothCollider {
    /// Its shape, m, in the entity's own space.
    pub shape: ColliderShape,
    /// Factor on the friction of the cloth that touches it, no unit. 1 by default, 0 for ice.
    pub friction: f32,
    /// Layers that it is in, one a bit. Cloth meets it where this has a bit in common with the cloth's mask.
    pub layers: u32,
}

/// What a collider is like.
#[derive(Clone, Debug, PartialEq, Reflect)]
#[reflect(Debug, Clone, PartialEq)]
pub enum ColliderShape {
    /// A primitive.
    Solid(Solid),
    /// The triangles of a mesh: of this one, or of the entity's `Mesh3d`.
    ///
    /// Where they enclose a volume, each edge between two of them that face the same way, it is solid. Else they are a thin
    /// surface, which cloth doesn't pass from either side. It follows a `SkinnedMesh` on the entity; the mesh of a
    /// [`Cloth`](crate::prelude::Cloth) can't be used.
    #[cfg(feature = "mesh_colliders")]
    Mesh(Option<Handle<Mesh>>),
    /// The convex hull of a mesh: of this one, or of the entity's `Mesh3d`. Faster than its triangles, and solid always.
    #[cfg(feature = "mesh_colliders")]
    ConvexHull(Option<Handle<Mesh>>),
    /// A terrain.
    #[cfg(feature = "mesh_colliders")]
    HeightField(mesh::HeightField),
}

impl Default for ClothCollider {
    /// A ball of half a metre radius.
    fn default() -> Self {
        Sphere::default().into()
    }
}

impl From<ColliderShape> for ClothCollider {
    fn from(shape: ColliderShape) -> Self {
        Self { shape, friction: 1.0, layers: 1 }
    }
}

#[cfg(feature = "mesh_colliders")]
impl ClothCollider {
    /// The triangles of the entity's own `Mesh3d`, as they are or as its skeleton moves them.
    pub fn mesh() -> Self {
        ColliderShape::Mesh(None).into()
    }

    /// The triangles of another mesh than the one that is drawn: a coarse one for a character, say, on the same skeleton.
    pub fn mesh_of(mesh: Handle<Mesh>) -> Self {
        ColliderShape::Mesh(Some(mesh)).into()
    }

    /// The convex hull of the entity's own `Mesh3d`.
    pub fn convex_hull() -> Self {
        ColliderShape::ConvexHull(None).into()
    }

    /// The convex hull of another mesh than the one that is drawn.
    pub fn convex_hull_of(mesh: Handle<Mesh>) -> Self {
        ColliderShape::ConvexHull(Some(mesh)).into()
    }
}

impl ClothCollider {
    /// Puts the obstacle into other layers, one a bit.
    pub fn in_layers(mut self, layers: u32) -> Self {
        self.layers = layers;
        self
    }
}

/// What is remembered of a collider from step to step. A copy of the collider has nothing to remember.
#[derive(Component, Clone, Debug, Default)]
#[component(clone_behavior = Ignore)]
pub(crate) struct ColliderMemory {
    /// World pose at the end of the latest step of each pass.
    pose: PerPass<FromLatestStep<Isometry3d>>,
    /// A message has told that it jumped.
    told_of_jump: bool,
    /// Why the collider was left out, of which a warning has told.
    said: Option<ColliderError>,
    /// Whether it is what is seen.
    scale_mismatch: ScaleMismatchWarning,
    /// What it is made of, where it is no primitive.
    #[cfg(feature = "mesh_colliders")]
    triangles: mesh::Triangles,
}

/// Forgets where a collider was: if it comes back, it comes out of nowhere and not from there.
pub(crate) fn on_collider_removed(removed: On<Remove, ClothCollider>, mut commands: Commands) {
    commands.entity(removed.entity).try_remove::<ColliderMemory>();
}

/// All obstacles of the latest step, in world space: what cloth has met, whatever it came from. To look at only.
#[derive(Resource, Debug, Default)]
pub struct Obstacles {
    /// With their entity and layers: colliders of this crate's own in the order of their entities, and then those of engines.
    pub(crate) list: Vec<(Entity, u32, Obstacle)>,
    /// How many of them are of this crate's own.
    own: usize,
    /// Which of them are parts of which bodies.
    bodies: BodyGroups,
}

impl Obstacles {
    /// Begins to gather for a step of a pass, and hands out the obstacles of engines that count in it.
    ///
    /// Engines tell of their colliders in the plugin's schedule only: for cloth that steps late they stand where they were then,
    /// and can't be pushed.
    fn begin(&mut self, pass: Pass) -> Vec<(Entity, u32, Obstacle)> {
        let mut of_engines = Vec::new();
        if pass == Pass::Late {
            of_engines = self.list.split_off(self.own);
            for (_, _, obstacle) in &mut of_engines {
                (obstacle.start, obstacle.body) = (obstacle.end, None);
            }
        }
        self.list.clear();
        of_engines
    }

    /// Takes those `of_engines` behind what has been gathered.
    fn end(&mut self, of_engines: Vec<(Entity, u32, Obstacle)>) {
        // Contact comes out the same whatever order the world keeps its entities in.
        self.list.sort_unstable_by_key(|&(entity, ..)| entity);
        self.own = self.list.len();
        self.list.extend(of_engines);
    }

    /// The world has been shifted, and all of them with it.
    pub(crate) fn shift(&mut self, by: Vec3) {
        self.list.iter_mut().for_each(|(_, _, obstacle)| obstacle.shift(by.into()));
        self.bodies.shift(by);
    }

    /// All of them, with their entity and their layers.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (Entity, u32, &Obstacle)> {
        self.list.iter().map(|(entity, layers, obstacle)| (*entity, *layers, obstacle))
    }

    /// Writes the obstacles that `filter` selects and a cloth may `reach` into `near`, relative to its `origin`, and whose they are
    /// into `owners`. For a cloth that has made a `jump`. Of all bodies it meets its `own` only, if it has one.
    pub(crate) fn around(
        &self,
        reach: impl FnOnce() -> StepReach,
        origin: Vec3,
        filter: CollisionFilter,
        jump: Option<Jump>,
        own: Option<Entity>,
        (near, owners): (&mut Vec<Obstacle>, &mut Vec<Entity>),
    ) {
        near.clear();
        owners.clear();
        if self.list.is_empty() {
            return;
        }
        let reach = reach();
        let origin = Vec3A::from(origin);
        let start = |start: Isometry3d, end| jump.map_or(start, |jump| jump.start_of(start, end));
        let relative = |pose: Isometry3d| Isometry3d::new(pose.translation - origin, pose.rotation);
        let rounding = Vec3A::splat(1e-6 * origin.abs().max_element());
        // What has jumped isn't where it is for others.
        let is_near = |[low, high]: [Vec3A; 2]| {
            jump.is_some() || reach.meets([low - origin - rounding, high - origin + rounding])
        };
        let numbers = self
            .bodies
            .numbers(self.list.len(), |group| own.is_none_or(|own| own == group.body) && is_near(group.bounds));
        let candidates = numbers.map(|number| &self.list[number]);
        for (entity, _, obstacle) in candidates.filter(|(_, layers, _)| filter.selects(*layers)) {
            let start = relative(start(obstacle.start, &obstacle.end));
            let end = relative(obstacle.end);
            if reach.includes(&obstacle.shape, [&start, &end], obstacle.rounding) {
                let body = obstacle.body.map(|body| Body { centre: body.centre - origin, ..body });
                near.push(Obstacle { start, end, body, ..obstacle.clone() });
                owners.push(*entity);
            }
        }
    }
}

/// Reads all colliders and how they have moved since the latest step of this pass.
pub(crate) fn gather_obstacles(
    mut colliders: Query<(Entity, &ClothCollider, &mut ColliderMemory)>,
    mut obstacles: ResMut<Obstacles>,
    parts: Query<&ClothBodyPart>,
    poses: Poses,
    jumps: JumpDetection,
) {
    let of_engines = obstacles.begin(jumps.pass());
    for (entity, collider, mut memory) in &mut colliders {
        let pose = || poses.compute_global_transform(entity).map(|pose| pose.affine()).ok();
        match memory.placed(collider, pose) {
            Ok(Some((shape, end))) => {
                let start = memory.come_to(entity, end, &jumps);
                memory.said = None;
                memory.scale_mismatch.tell(entity);
                let friction = collider.friction;
                let is_rough = parts.contains(entity);
                let obstacle = Obstacle { friction, is_rough, ..Obstacle::moving(shape, start, end) };
                obstacles.list.push((entity, collider.layers, obstacle));
            }
            Ok(None) => memory.pose[jumps.pass()].forget(),
            Err(error) => {
                memory.pose[jumps.pass()].forget();
                if memory.said.as_ref() != Some(&error) {
                    warn!("collider {entity} is left out: {error}");
                    memory.said = Some(error);
                }
            }
        }
    }
    obstacles.end(of_engines);
    let Obstacles { list, bodies, .. } = &mut *obstacles;
    bodies.group(list, |entity| parts.get(entity).ok());
}

/// Lets the late pass begin with what the fixed one remembers, when the first cloth steps there: until now, it has met the
/// obstacles there. Never the other way round: what steps in the plugin's schedule doesn't depend on late cloth.
pub(crate) fn begin_late_memory(mut colliders: Query<&mut ColliderMemory>, steps: Res<Steps>) {
    for mut memory in &mut colliders {
        match memory.pose[Pass::Fixed].get_since(steps.latest_of(Pass::Fixed)) {
            Some(pose) => memory.pose[Pass::Late].set(steps.present(), pose),
            None => memory.pose[Pass::Late].forget(),
        }
        #[cfg(feature = "mesh_colliders")]
        memory.triangles.begin_late();
    }
}

impl ColliderMemory {
    /// Remembers a pose, and returns the one before it. What has jumped comes from where it is.
    fn come_to(&mut self, entity: Entity, pose: Isometry3d, jumps: &JumpDetection) -> Isometry3d {
        let past = jumps.past_pose(entity, &self.pose, &pose);
        self.pose[jumps.pass()].set(jumps.step(), pose);
        if past == PastPose::TooFar && !core::mem::replace(&mut self.told_of_jump, true) {
            debug!(
                "collider {entity} has moved so far within a step that it is taken for a teleport: ask for teleport_collider, \
                 or raise ColliderTeleportThreshold if it is that fast"
            );
        }
        match past {
            PastPose::Known(past) => past,
            PastPose::Unknown | PastPose::TooFar => pose,
        }
    }

    /// The world has been shifted, and the collider with it.
    pub fn shift(&mut self, by: Vec3) {
        for pose in self.pose.iter_mut().filter_map(FromLatestStep::as_mut) {
            pose.translation += Vec3A::from(by);
        }
    }

    /// Shape and world pose of the collider at the end of the coming step. None while its shape is waited for.
    fn placed(
        &mut self,
        collider: &ClothCollider,
        pose: impl Fn() -> Option<Affine3A>,
    ) -> Result<Option<(Shape, Isometry3d)>, ColliderError> {
        let placed = match &collider.shape {
            ColliderShape::Solid(solid) => {
                let pose = pose().ok_or(ColliderError::NoSize)?;
                self.scale_mismatch.look(solid, &pose);
                let (solid, pose) = solid::placed(*solid, pose)?;
                Some((Shape::Solid(solid), pose))
            }
            #[cfg(feature = "mesh_colliders")]
            _ => self.triangles.placed()?,
        };
        let is_finite = |pose: &Isometry3d| pose.translation.is_finite() && pose.rotation.is_finite();
        let is_sound = placed.as_ref().is_none_or(|(_, pose)| is_finite(pose))
            && collider.friction.is_finite()
            && collider.friction >= 0.0;
        if is_sound { Ok(placed) } else { Err(ColliderError::NoSize) }
    }
}
