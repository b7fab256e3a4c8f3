//! What is remembered of a body from frame to frame.

use bevy::{mesh::skinning::SkinnedMeshInverseBindposes, prelude::*};

use super::error::BodyError;

/// What a body was made of. A copy of it has nothing to remember.
#[derive(Component, Clone, Debug, Default)]
#[component(clone_behavior = Ignore)]
pub(crate) struct BodyMemory {
    /// The meshes; none while they are waited for.
    pub(super) made_of: Option<Vec<Source>>,
    /// For how long there has been no mesh, s.
    pub(super) waited: f32,
    /// Of what a warning has told, by its words: an error that carries a NaN doesn't equal itself.
    said: Option<String>,
}

/// A mesh of a body.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Source {
    pub entity: Entity,
    pub mesh: AssetId<Mesh>,
    pub bindposes: AssetId<SkinnedMeshInverseBindposes>,
    pub joints: Vec<Entity>,
}

impl BodyMemory {
    /// Warns of an error, if that isn't what it has warned of last.
    pub(super) fn tell(&mut self, body: Entity, error: &BodyError) {
        let words = error.to_string();
        if self.said.as_ref() != Some(&words) {
            warn!("cloth body {body}: {words}");
            self.said = Some(words);
        }
    }

    /// All is well.
    pub(super) fn forget_warning(&mut self) {
        self.said = None;
    }
}
