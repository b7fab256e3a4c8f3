//! Finds the meshes of garments, and joins them.

use bevy::{
    asset::LoadState, ecs::system::SystemParam, math::Affine3A, mesh::skinning::SkinnedMesh,
    platform::collections::HashSet, prelude::*,
};

use crate::{
    cloth::Cloth,
    draw::ClothMesh,
    error::ClothError,
    frame::{PATIENCE, Skeletons, is_invertible},
    garment::{ClothPartOf, ClothParts, Garment, GarmentPart},
    mesh_input::{Joined, Span, join},
    proxy::ClothProxy,
};

/// The meshes of a garment, and where they are.
#[derive(SystemParam)]
pub(crate) struct Wardrobe<'w, 's> {
    meshes: Query<'w, 's, (&'static Mesh3d, Option<&'static SkinnedMesh>), (Without<Cloth>, Without<ClothProxy>)>,
    cloths: Query<'w, 's, (), Or<(With<Cloth>, With<ClothProxy>)>>,
    part_of: Query<'w, 's, &'static ClothPartOf>,
    drawn: Query<'w, 's, &'static ClothMesh>,
    children: Query<'w, 's, &'static Children>,
    parents: Query<'w, 's, (&'static ChildOf, &'static Transform)>,
    skeletons: Skeletons<'w, 's>,
    assets: Option<Res<'w, AssetServer>>,
}

/// Gathers the meshes of cloths that have none of their own, and joins them where they have changed.
pub(crate) fn join_garments(
    mut commands: Commands,
    mut cloths: Query<
        (Entity, Option<&mut Garment>, Option<&ClothParts>),
        (Or<(With<Cloth>, With<ClothProxy>)>, Without<Mesh3d>),
    >,
    plain: Query<Entity, (With<Garment>, With<Mesh3d>)>,
    wardrobe: Wardrobe,
    mut meshes: ResMut<Assets<Mesh>>,
    mut events: MessageReader<AssetEvent<Mesh>>,
    time: Res<Time>,
) {
    let modified = events.read().filter_map(|event| match event {
        AssetEvent::Modified { id } => Some(*id),
        _ => None,
    });
    let modified: HashSet<AssetId<Mesh>> = modified.collect();
    // It was given a mesh of its own.
    for entity in &plain {
        commands.entity(entity).try_remove::<(Garment, ClothParts)>();
    }
    for (entity, garment, parts) in &mut cloths {
        let parts = wardrobe.parts(entity, parts);
        let mut sew = |garment: &mut Garment| wardrobe.sew(entity, garment, &parts, &mut meshes, &mut commands);
        match garment {
            None => {
                let mut new = Garment::default();
                sew(&mut new);
                commands.entity(entity).try_insert(new);
            }
            Some(mut garment) if parts.is_empty() && garment.parts.is_empty() => {
                garment.bypass_change_detection().wait(entity, time.delta_secs());
            }
            Some(mut garment) => {
                let is_modified = || garment.parts.iter().any(|part| modified.contains(&part.source.id()));
                // What failed may be mended by what isn't looked at here, as a transform that was flat.
                let is_sewn = matches!(garment.joined, Some(Ok(_)));
                if !is_sewn || !garment.is_made_of(&parts) || is_modified() {
                    sew(&mut garment);
                }
            }
        }
    }
}

/// A mesh of a garment, as it is by now.
struct Part<'a> {
    entity: Entity,
    source: &'a Handle<Mesh>,
    skeleton: Option<&'a SkinnedMesh>,
}

impl Garment {
    /// Counts the time that it waits for meshes, and says so once where that is long.
    fn wait(&mut self, entity: Entity, dt: f32) {
        let waited = self.waited;
        self.waited += dt;
        if waited <= PATIENCE && self.waited > PATIENCE {
            warn!(
                "cloth {entity} has no Mesh3d, neither has anything below it, and it waits for one; insert Cloth next to a Mesh3d, or \
                 on an entity that has some below it, which become one cloth"
            );
        }
    }

    /// Whether it was sewn of these parts.
    fn is_made_of(&self, parts: &[Part]) -> bool {
        let is_same = |(own, part): (&GarmentPart, &Part)| {
            own.entity == part.entity
                && own.source == *part.source
                && is_same_skeleton(own.skeleton.as_ref(), part.skeleton)
        };
        self.parts.len() == parts.len() && self.parts.iter().zip(parts).all(is_same)
    }
}

fn is_same_skeleton(one: Option<&SkinnedMesh>, other: Option<&SkinnedMesh>) -> bool {
    let key = |skeleton: &SkinnedMesh| skeleton.inverse_bindposes.id();
    let joints = |skeleton| Option::map_or(skeleton, &[][..], |skeleton: &SkinnedMesh| &skeleton.joints);
    one.map(key) == other.map(key) && joints(one) == joints(other)
}

impl Wardrobe<'_, '_> {
    /// The meshes of a garment: those below it that aren't another cloth's, depth first, and then those that are said to be its parts.
    fn parts(&self, garment: Entity, known: Option<&ClothParts>) -> Vec<Part<'_>> {
        let mut parts = Vec::new();
        let mut next = vec![garment];
        while let Some(entity) = next.pop() {
            let is_other = entity != garment && self.cloths.contains(entity);
            if is_other || self.part_of.get(entity).is_ok_and(|part| part.0 != garment) {
                continue;
            }
            parts.extend(self.part(entity, garment));
            next.extend(self.children.get(entity).into_iter().flatten().rev());
        }
        for &entity in known.into_iter().flat_map(|parts| parts.collection()) {
            if parts.iter().all(|part| part.entity != entity) {
                parts.extend(self.part(entity, garment));
            }
        }
        parts
    }

    fn part(&self, entity: Entity, garment: Entity) -> Option<Part<'_>> {
        let (mesh, skeleton) = self.meshes.get(entity).ok()?;
        // One that is drawn already, be it of a cloth that this is a copy of.
        let own = self.drawn.get(garment).ok().and_then(|own| own.drawn_with(mesh.id()));
        let drawn = own.or_else(|| self.drawn.iter().find_map(|cloth| cloth.drawn_with(mesh.id())));
        Some(Part { entity, source: drawn.map_or(&mesh.0, |drawn| &drawn.source), skeleton })
    }

    /// Joins the parts of a garment, once their meshes are there.
    fn sew(
        &self,
        cloth: Entity,
        garment: &mut Garment,
        parts: &[Part],
        meshes: &mut Assets<Mesh>,
        commands: &mut Commands,
    ) {
        if parts.is_empty() && garment.parts.is_empty() {
            return;
        }
        let joined = match self.join(cloth, parts, meshes) {
            // Meanwhile there is what there was.
            Ok(None) => return,
            Ok(Some(joined)) => Ok(joined),
            Err(error) => Err(error),
        };
        let spans = joined.as_ref().map_or(&[][..], |joined| &joined.spans).iter().cloned();
        let spans = spans.chain(core::iter::repeat(Span::default()));
        let part = |(part, span): (&Part, Span)| GarmentPart {
            entity: part.entity,
            source: part.source.clone(),
            skeleton: part.skeleton.cloned(),
            span,
        };
        garment.parts = parts.iter().zip(spans).map(part).collect();
        for part in parts.iter().filter(|part| !self.part_of.contains(part.entity)) {
            commands.entity(part.entity).try_insert(ClothPartOf(cloth));
        }
        garment.joined = Some(joined.map(|joined| {
            if !joined.left_out.is_empty() && core::mem::replace(&mut garment.told_of, parts.len()) != parts.len() {
                warn!(
                    "cloth {cloth} is made without {}: not all of its {} meshes have the same; give it to all of them, or to none",
                    joined.left_out.join(", "),
                    parts.len()
                );
            }
            meshes.add(joined.mesh)
        }));
    }

    /// The mesh of all parts. None while some of their meshes may still load.
    fn join(&self, cloth: Entity, parts: &[Part], meshes: &Assets<Mesh>) -> Result<Option<Joined>, ClothError> {
        let mut pieces = Vec::with_capacity(parts.len());
        let first = parts.first().and_then(|part| part.skeleton);
        for part in parts {
            let refused = |reason: &str| ClothError::Part { part: part.entity, reason: reason.into() };
            let Some(mesh) = meshes.get(part.source) else {
                return match self.assets.as_ref().map(|assets| assets.load_state(part.source)) {
                    Some(LoadState::Failed(error)) => Err(ClothError::NotLoaded { reason: error.to_string() }),
                    _ => Ok(None),
                };
            };
            if !is_same_skeleton(first, part.skeleton) {
                return Err(refused("it isn't on the same skeleton; give all of them the same SkinnedMesh, or none"));
            }
            let place = match part.skeleton {
                // Where the skeleton has them counts, and not where their entities are.
                Some(_) => Affine3A::IDENTITY,
                None => self.place(part.entity, cloth).filter(is_invertible).ok_or(ClothError::FlatTransform)?,
            };
            pieces.push((mesh, place));
        }
        if pieces.is_empty() {
            return Err(ClothError::NoPositions);
        }
        join(&pieces).map(Some).map_err(|(part, reason)| ClothError::Part { part: parts[part].entity, reason })
    }

    /// What takes the space of a part into that of its garment.
    fn place(&self, part: Entity, garment: Entity) -> Option<Affine3A> {
        // By the transforms between them: those of the world are rounded.
        let (mut place, mut entity) = (Affine3A::IDENTITY, part);
        while entity != garment {
            let Ok((parent, transform)) = self.parents.get(entity) else {
                let pose = |entity| self.skeletons.pose(entity).filter(is_invertible);
                return Some(pose(garment)?.inverse() * pose(part)?);
            };
            if *transform != Transform::IDENTITY {
                place = transform.compute_affine() * place;
            }
            entity = parent.parent();
        }
        Some(place)
    }
}
