//! The meshes that are drawn: copies of the user's.

use bevy::{math::Affine3A, prelude::*};

use crate::{
    draw::{ClothMesh, DrawnMesh},
    garment::Garment,
    mesh_input::Span,
};

/// A mesh that is to be drawn by an entity, and where it is in the one that a cloth is made of.
pub(super) struct Wanted {
    entity: Entity,
    source: Handle<Mesh>,
    span: Span,
}

impl Wanted {
    /// What is to be drawn of a mesh that `entity` has itself, or of the parts of a garment.
    pub fn of(entity: Entity, source: &Handle<Mesh>, vertices: usize, garment: Option<&Garment>) -> Vec<Self> {
        match garment {
            None => {
                let span = Span { vertices: 0..vertices, first_triangle: 0 };
                vec![Self { entity, source: source.clone(), span }]
            }
            Some(garment) => {
                let parts = garment.parts.iter().cloned();
                parts.map(|part| Self { entity: part.entity, source: part.source, span: part.span }).collect()
            }
        }
    }
}

/// Makes what is to be drawn: each by `copy`, into the mesh that its entity has for that already, if `own` says so.
pub(super) fn make_copies(
    wanted: Vec<Wanted>,
    own: Option<&ClothMesh>,
    meshes: &mut Assets<Mesh>,
    mut copy: impl FnMut(&Mesh) -> Mesh,
) -> Vec<DrawnMesh> {
    let mut drawn = Vec::with_capacity(wanted.len());
    for Wanted { entity, source, span } in wanted {
        let Some(copied) = meshes.get(&source).map(&mut copy) else { continue };
        let own = own.and_then(|own| own.drawn_by(entity)).map(|own| own.mesh.clone());
        let mesh = match own.filter(|own| meshes.contains(own)) {
            Some(own) => {
                if let Some(mut mesh) = meshes.get_mut(&own) {
                    *mesh = copied;
                }
                own
            }
            None => meshes.add(copied),
        };
        drawn.push(DrawnMesh { entity, source, mesh, span, from_cloth: Affine3A::IDENTITY });
    }
    drawn
}

/// Has the entities draw what is made for them: `own` is the `Mesh3d` of a cloth that isn't a garment.
pub(super) fn show_copies(drawn: &[DrawnMesh], mut own: Option<&mut Mesh3d>, commands: &mut Commands) {
    for drawn in drawn {
        match &mut own {
            Some(mesh) if mesh.0 != drawn.mesh => mesh.0 = drawn.mesh.clone(),
            Some(_) => {}
            None => drop(commands.entity(drawn.entity).try_insert(Mesh3d(drawn.mesh.clone()))),
        }
    }
}
