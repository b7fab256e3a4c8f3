//! Triangles of colliders, made once for all that share them.

use core::hash::{BuildHasher, Hash};
use std::sync::Arc;

use bevy::{
    asset::RenderAssetUsages,
    math::Mat3A,
    platform::{collections::HashMap, hash::FixedHasher},
    prelude::*,
};

use super::{
    height_field::HeightField,
    hull::hull_of,
    triangles::{self, Made},
};
use crate::{
    error::ClothError,
    mesh_input::{self, Jobs, Skin},
    solver::{SourceMesh, TriangleMesh},
    surroundings::collider::error::ColliderError,
};

/// Corners of triangles that are worked on within a step at most: those of 8000 triangles take some 10 ms, the longest
/// that a frame can spare.
const MOST_AT_ONCE: usize = 24_000;

/// What the triangles of a collider are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Source {
    Mesh(AssetId<Mesh>),
    ConvexHull(AssetId<Mesh>),
    /// A height field with these contents.
    HeightField(u64),
}

impl Source {
    /// Identifies a height field by its contents.
    pub fn of(field: &HeightField) -> Self {
        let HeightField { size, columns, heights } = field;
        let numbers = size.to_array().into_iter().chain(heights.iter().copied());
        let bits: Vec<u32> = numbers.map(f32::to_bits).collect();
        Self::HeightField(FixedHasher.hash_one((columns, bits)))
    }

    /// The mesh that it is made of.
    pub fn mesh(self) -> Option<AssetId<Mesh>> {
        match self {
            Self::Mesh(mesh) | Self::ConvexHull(mesh) => Some(mesh),
            Self::HeightField(_) => None,
        }
    }
}

/// What the triangles of a collider are made of, and the scale that is worked into them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Recipe {
    pub source: Source,
    pub scale: Mat3A,
}

/// A recipe, to be compared bit by bit.
type Key = (Source, [u32; 9]);

impl Recipe {
    fn key(&self) -> Key {
        (self.source, self.scale.to_cols_array().map(f32::to_bits))
    }

    /// What it takes to make it, in corners of plain triangles.
    fn effort(&self, contents: Contents) -> usize {
        let corners = contents.corner_count();
        if matches!(self.source, Source::ConvexHull(_)) { 2 * corners } else { corners }
    }
}

/// The contents that a recipe names.
#[derive(Clone, Copy, Debug)]
pub(super) enum Contents<'a> {
    Mesh(&'a Mesh),
    HeightField(&'a HeightField),
}

/// The triangles of a collider.
#[derive(Clone, Debug)]
pub(super) struct Prepared {
    pub mesh: Arc<TriangleMesh>,
    /// How its points follow joints, if they can.
    pub skin: Option<Arc<Skin>>,
}

/// What has come of a recipe.
type Outcome = Result<Prepared, ColliderError>;

/// The triangles of all colliders that have some, and what tasks work on.
#[derive(Resource, Debug, Default)]
pub(crate) struct PreparedMeshes {
    done: HashMap<Key, Done>,
    jobs: Jobs<Key, Outcome>,
}

#[derive(Debug)]
struct Done {
    outcome: Outcome,
    /// Whether a collider has asked for it in this step.
    is_wanted: bool,
}

impl PreparedMeshes {
    /// Drops what nobody has asked for in the latest step and what is made from a mesh that `has_changed`, and looks for
    /// what tasks have done.
    pub(super) fn update(&mut self, has_changed: impl Fn(AssetId<Mesh>) -> bool) {
        let is_stale = |&(source, _): &Key| source.mesh().is_some_and(&has_changed);
        self.done.retain(|key, done| core::mem::take(&mut done.is_wanted) && !is_stale(key));
        self.jobs.update(is_stale);
    }

    /// What comes of a recipe. None for large `contents` while a task works on them: ask in each step.
    pub(super) fn get_or_make(&mut self, recipe: &Recipe, contents: Contents) -> Option<Outcome> {
        let key = recipe.key();
        if let Some(done) = self.done.get_mut(&key) {
            done.is_wanted = true;
            return Some(done.outcome.clone());
        }
        let recipe = *recipe;
        let outcome = if recipe.effort(contents) <= MOST_AT_ONCE {
            contents.make(&recipe)
        } else {
            let begun = self.jobs.get_or_begin(key, || {
                let contents = contents.to_owned();
                async move { contents.borrow().make(&recipe) }
            });
            let outcome = begun?.clone();
            self.jobs.forget(&key);
            outcome
        };
        self.done.insert(key, Done { outcome: outcome.clone(), is_wanted: true });
        Some(outcome)
    }
}

impl Contents<'_> {
    /// Number of corners of triangles, about.
    fn corner_count(self) -> usize {
        match self {
            Self::Mesh(mesh) => {
                let vertices = || mesh.try_attribute(Mesh::ATTRIBUTE_POSITION).map_or(0, |positions| positions.len());
                mesh.try_indices().map_or_else(|_| vertices(), |indices| indices.len())
            }
            Self::HeightField(field) => 6 * field.heights.len(),
        }
    }

    fn make(self, recipe: &Recipe) -> Outcome {
        match self {
            Self::Mesh(mesh) => make_from_mesh(mesh, recipe),
            Self::HeightField(field) => {
                let (points, corners) = field.triangles()?;
                Ok(Prepared { mesh: Arc::new(triangles::sheet(&points, &corners, recipe.scale)?.mesh), skin: None })
            }
        }
    }
}

fn make_from_mesh(mesh: &Mesh, recipe: &Recipe) -> Outcome {
    // Later it would be gone.
    if !mesh.asset_usage.contains(RenderAssetUsages::MAIN_WORLD) {
        return Err(ClothError::NotInMainWorld.into());
    }
    let SourceMesh { positions, triangles, .. } = mesh_input::read(mesh)?;
    let make = if matches!(recipe.source, Source::ConvexHull(_)) { hull_of } else { triangles::surface };
    let Made { mesh: made, origin } = make(&positions, &triangles, recipe.scale)?;
    Ok(Prepared { mesh: Arc::new(made), skin: Skin::read(mesh, &positions, &origin).map(Arc::new) })
}

/// Contents of their own, for a task.
enum OwnedContents {
    Mesh(Box<Mesh>),
    HeightField(HeightField),
}

impl Contents<'_> {
    fn to_owned(self) -> OwnedContents {
        match self {
            Self::Mesh(mesh) => OwnedContents::Mesh(Box::new(mesh.clone())),
            Self::HeightField(field) => OwnedContents::HeightField(field.clone()),
        }
    }
}

impl OwnedContents {
    fn borrow(&self) -> Contents<'_> {
        match self {
            Self::Mesh(mesh) => Contents::Mesh(mesh),
            Self::HeightField(field) => Contents::HeightField(field),
        }
    }
}
