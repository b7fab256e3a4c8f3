//! Which particles are fixed, and to what.

use bevy::{
    ecs::{
        entity::{EntityMapper, MapEntities},
        reflect::ReflectMapEntities,
    },
    math::Rect,
    mesh::{MeshVertexAttribute, VertexFormat},
    prelude::*,
};

mod select;

pub(crate) use select::targets_by_particle;
pub use select::{PinPredicate, PinVertex};

/// The vertex attribute that says which vertices of a model are pinned: those with 0.5 or more.
///
/// In glTF files its name is `_PIN`, in any format. Without the feature `gltf`, register it with Bevy's plugin, which drops the
/// underscore: `GltfPlugin::default().add_custom_vertex_attribute("PIN", ATTRIBUTE_PIN)`.
pub const ATTRIBUTE_PIN: MeshVertexAttribute = MeshVertexAttribute::new("Pin", 0x6472_6170_6550, VertexFormat::Float32);

/// The pins of a cloth: groups of vertices and what they are fixed to. Change them at any time.
///
/// Groups are read in order, and a later one overrides an earlier one where both choose a vertex. A vertex that is
/// newly pinned is held where it is at that moment, and from then on follows its target's movement and rotation.
/// Vertices at one place are one particle: pinning one of them pins all.
///
/// Targets move the cloth best in `FixedUpdate` or any schedule that runs once a step; moved once a frame they pull in
/// jolts where a frame has several steps or none. What is drawn stays at all targets, whenever they move; what lies between
/// several of them goes along by its distances along the cloth.
///
/// ```
/// # use bevy_drape::prelude::*;
/// # use bevy::prelude::*;
/// let curtain = Pins::edge(ClothEdge::Top);
/// let flag = |pole: Entity| Pins::edge(ClothEdge::Left).to_entity(pole);
/// let mixed = Pins::indices([0, 31]).to_world().and(Pins::region(Vec3::ZERO, Vec3::ONE));
/// ```
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[component(map_entities)]
#[reflect(Component, Default, Debug, Clone, MapEntities)]
pub struct Pins {
    /// The groups, in the order in which they are read.
    pub groups: Vec<PinGroup>,
}

/// Some vertices and what they are fixed to.
#[derive(Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(Default, Debug, Clone)]
pub struct PinGroup {
    /// Which vertices.
    pub select: PinSelector,
    /// Fixed to what.
    pub to: PinTarget,
}

/// Chooses vertices of a mesh.
#[derive(Clone, Debug, PartialEq, Reflect)]
#[reflect(Default, Debug, Clone)]
#[non_exhaustive]
pub enum PinSelector {
    /// By the mesh's own vertex index.
    Indices(Vec<u32>),
    /// By rest position: all within a box in the mesh's own space, m.
    Region {
        /// Lowest corner.
        min: Vec3,
        /// Highest corner.
        max: Vec3,
    },
    /// By the first UV coordinates: all within a rectangle.
    UvRegion(Rect),
    /// By vertex colour: all that have this one (to 1 in 255 per channel).
    VertexColor(LinearRgba),
    /// By a vertex attribute of format `Float32`, given by its name: all with 0.5 or more.
    Attribute(String),
    /// The corners of a sheet of quads.
    Corners,
    /// An edge of a sheet, by its UVs.
    Edge(ClothEdge),
    /// The two ends of an edge of a sheet of quads, by its UVs.
    EdgeCorners(ClothEdge),
    /// All that a function accepts. Reflection and scenes see it without the function.
    Predicate(PinPredicate),
}

impl Default for PinSelector {
    /// No vertex.
    fn default() -> Self {
        Self::Indices(Vec::new())
    }
}

/// An edge of a sheet, by its first UVs: (0, 0) is the top left, as in Bevy's own meshes and glTF.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[reflect(Debug, Clone, PartialEq)]
pub enum ClothEdge {
    /// Smallest v.
    Top,
    /// Largest v.
    Bottom,
    /// Smallest u.
    Left,
    /// Largest u.
    Right,
}

/// What a pinned vertex is fixed to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub enum PinTarget {
    /// The cloth's own entity: it follows its transform.
    #[default]
    Cloth,
    /// Its place in the world.
    World,
    /// Another entity: it follows its transform. Without one, or once it is gone, the vertex stays where it is.
    Entity(Option<Entity>),
    /// Nothing: this unpins what an earlier group has pinned.
    Free,
}

impl MapEntities for Pins {
    fn map_entities<M: EntityMapper>(&mut self, mapper: &mut M) {
        for group in &mut self.groups {
            if let PinTarget::Entity(entity) = &mut group.to {
                entity.map_entities(mapper);
            }
        }
    }
}

impl From<PinSelector> for Pins {
    fn from(select: PinSelector) -> Self {
        Self { groups: vec![PinGroup { select, to: PinTarget::Cloth }] }
    }
}

impl Pins {
    /// No pins: the cloth falls.
    pub fn none() -> Self {
        Self::default()
    }

    /// Vertices by the mesh's own index.
    pub fn indices(indices: impl IntoIterator<Item = u32>) -> Self {
        PinSelector::Indices(indices.into_iter().collect()).into()
    }

    /// Vertices whose rest position lies in the box from `min` to `max`, m, in the mesh's own space.
    pub fn region(min: Vec3, max: Vec3) -> Self {
        PinSelector::Region { min, max }.into()
    }

    /// Vertices whose first UV lies in `region`.
    pub fn uv_region(region: Rect) -> Self {
        PinSelector::UvRegion(region).into()
    }

    /// Vertices of one vertex colour.
    pub fn vertex_color(color: impl Into<LinearRgba>) -> Self {
        PinSelector::VertexColor(color.into()).into()
    }

    /// Vertices where an attribute of format `Float32`, such as [`ATTRIBUTE_PIN`], is 0.5 or more.
    pub fn attribute(attribute: MeshVertexAttribute) -> Self {
        PinSelector::Attribute(attribute.name.into()).into()
    }

    /// The corners of a sheet of quads, such as a [`ClothGrid`](crate::prelude::ClothGrid).
    pub fn corners() -> Self {
        PinSelector::Corners.into()
    }

    /// An edge of a sheet, by its UVs.
    pub fn edge(edge: ClothEdge) -> Self {
        PinSelector::Edge(edge).into()
    }

    /// The two ends of an edge of a sheet of quads, by its UVs.
    pub fn edge_corners(edge: ClothEdge) -> Self {
        PinSelector::EdgeCorners(edge).into()
    }

    /// All vertices that `predicate` accepts.
    pub fn predicate(predicate: impl Fn(&PinVertex) -> bool + Send + Sync + 'static) -> Self {
        PinSelector::Predicate(PinPredicate::new(predicate)).into()
    }

    /// Fixes all groups so far to their place in the world.
    pub fn to_world(self) -> Self {
        self.to(PinTarget::World)
    }

    /// Fixes all groups so far to another entity, which they follow.
    pub fn to_entity(self, entity: Entity) -> Self {
        self.to(PinTarget::Entity(Some(entity)))
    }

    /// Fixes all groups so far to `target`.
    pub fn to(mut self, target: PinTarget) -> Self {
        for group in &mut self.groups {
            group.to = target;
        }
        self
    }

    /// These pins, and `more` after them.
    pub fn and(mut self, more: Self) -> Self {
        self.groups.extend(more.groups);
        self
    }
}
