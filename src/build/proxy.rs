//! Embeds fine meshes in the coarse cloth that they follow.

use std::sync::Arc;

use bevy::{
    ecs::query::QueryData,
    math::{Affine3A, Vec3A},
    mesh::skinning::SkinnedMesh,
    prelude::*,
};
use thiserror::Error;

use super::copies::{Wanted, make_copies, show_copies};
use crate::{
    cloth::Cloth,
    draw::{self, Binding, ClothMesh, Drawn, copy_with_skin, copy_without_skin},
    error::ClothError,
    frame::{PATIENCE, Skeletons, is_invertible},
    garment::{ClothParts, Garment},
    mesh_input::{self, Skin, is_skinned},
    proxy::{ClothProxy, Embedded, ProxyWait},
    solver::{SourceMesh, build::weld::weld, embedding::Embedding},
    state::{BoundSkin, ClothState, ClothStatus, Skinning},
};

/// Why a mesh can't follow its driver.
#[derive(Debug, Error)]
enum ProxyError {
    #[error("its driver {0} isn't cloth that runs, and it waits for that; insert Cloth there, next to a coarse mesh")]
    NoDriver(Entity),
    #[error(
        "it isn't on the same skeleton as its driver {0}; give both a SkinnedMesh of the same joints and bind poses, or neither"
    )]
    Skeleton(Entity),
    #[error(transparent)]
    Cloth(#[from] ClothError),
}

/// A mesh that follows a driver, or is to.
#[derive(QueryData)]
#[query_data(mutable)]
pub(crate) struct Fine {
    entity: Entity,
    proxy: Ref<'static, ClothProxy>,
    wait: &'static mut ProxyWait,
    mesh: Option<&'static mut Mesh3d>,
    garment: Option<&'static Garment>,
    skeleton: Option<&'static SkinnedMesh>,
    own: Option<&'static ClothMesh>,
    embedded: Option<&'static Embedded>,
    skinning: Option<&'static Skinning>,
}

/// A cloth that meshes follow.
#[derive(QueryData)]
pub(crate) struct Driver {
    mesh: &'static ClothMesh,
    state: &'static ClothState,
    status: &'static ClothStatus,
    skinning: &'static Skinning,
}

/// Embeds what is new, and what has changed or whose driver has.
pub(crate) fn build_proxies(
    mut commands: Commands,
    mut proxies: Query<Fine, Without<Cloth>>,
    drivers: Query<Driver, (With<Cloth>, Without<ClothProxy>)>,
    mut meshes: ResMut<Assets<Mesh>>,
    skeletons: Skeletons,
    time: Res<Time>,
) {
    for mut fine in &mut proxies {
        let driver = drivers.get(fine.proxy.driver).ok().filter(|driver| driver.status.is_running());
        let Some(driver) = driver else {
            fine.wait(time.delta_secs());
            continue;
        };
        fine.wait.waited = 0.0;
        let Some(source) = fine.source() else { continue };
        let built = match source {
            Ok(source) if fine.is_embedded(&source, &driver) => continue,
            Ok(source) => match meshes.get(&source) {
                None => continue,
                Some(mesh) => fine.embed(mesh, &driver, &meshes, &skeletons).map(|built| (source, built)),
            },
            Err(error) => Err(error.into()),
        };
        match built {
            Ok((source, Some(built))) => fine.accept(source, built, &driver, &mut meshes, &mut commands),
            // Bind poses may still load.
            Ok((_, None)) => {}
            Err(error) => fine.tell(&error),
        }
    }
}

/// A mesh that is ready to follow.
struct Built {
    embedding: Embedding,
    binding: Binding,
    skinning: Skinning,
    positions: Vec<[f32; 3]>,
}

impl FineItem<'_, '_> {
    /// Counts the time that it waits for its driver.
    fn wait(&mut self, dt: f32) {
        self.wait.waited += dt;
        if self.wait.waited > PATIENCE {
            self.tell(&ProxyError::NoDriver(self.proxy.driver));
        }
    }

    /// Says what is wrong, unless that is known.
    fn tell(&mut self, error: &ProxyError) {
        let error = error.to_string();
        if self.wait.told.as_ref() != Some(&error) {
            warn!("cloth proxy {} follows no cloth: {error}", self.entity);
            self.wait.told = Some(error);
        }
    }

    /// The user's mesh, or that of all its parts. None while there is none.
    fn source(&self) -> Option<Result<Handle<Mesh>, ClothError>> {
        let Some(mesh) = &self.mesh else { return self.garment?.joined.clone() };
        let own = self.own.and_then(|own| own.drawn_with(mesh.id()));
        Some(Ok(own.map_or(&mesh.0, |drawn| &drawn.source).clone()))
    }

    fn skeleton(&self) -> Option<&SkinnedMesh> {
        match &self.mesh {
            Some(_) => self.skeleton,
            None => self.garment?.parts.first()?.skeleton.as_ref(),
        }
    }

    /// Whether it is embedded as it is by now.
    fn is_embedded(&self, source: &Handle<Mesh>, driver: &DriverItem) -> bool {
        let joints = self.skinning.and_then(|skinning| skinning.0.as_ref()).map(|bound| &bound.joints);
        let is_current = |embedded: &Embedded| {
            embedded.driver == self.proxy.driver && Arc::ptr_eq(&embedded.topology, &driver.state.topology)
        };
        self.embedded.is_some_and(is_current)
            && self.own.is_some_and(|own| own.source == *source)
            && !self.proxy.is_changed()
            && joints == self.skeleton().map(|skeleton| &skeleton.joints)
    }

    /// Embeds `mesh`. None while its bind poses may still load.
    fn embed(
        &self,
        mesh: &Mesh,
        driver: &DriverItem,
        meshes: &Assets<Mesh>,
        skeletons: &Skeletons,
    ) -> Result<Option<Built>, ProxyError> {
        self.proxy.validate()?;
        // First what takes no time: what fails is tried again in each frame.
        let other_skeleton = || ProxyError::Skeleton(self.proxy.driver);
        let skeleton = self.skeleton().filter(|_| is_skinned(mesh));
        let to_driver = match (skeleton, &driver.skinning.0) {
            (None, None) => self.to_driver(skeletons)?,
            (Some(skeleton), Some(bound)) => {
                let Some(bindposes) = skeletons.bindposes(skeleton) else { return Ok(None) };
                if bound.joints != skeleton.joints || bound.bindposes != bindposes {
                    return Err(other_skeleton());
                }
                Affine3A::IDENTITY
            }
            _ => return Err(other_skeleton()),
        };
        let source = mesh_input::read(mesh)?.wound_by_normals();
        let welded = weld(&source.positions, &source.triangles);
        let bind = |bound: &BoundSkin| bind(mesh, &source, &welded.vertex_of_particle, bound, skeletons);
        let skinning = match &driver.skinning.0 {
            None => Skinning(None),
            Some(bound) => Skinning(Some(Box::new(bind(bound).ok_or_else(other_skeleton)?))),
        };
        let place = |&vertex: &u32| to_driver.transform_point3a(source.positions[vertex as usize].into());
        let points: Vec<Vec3A> = welded.vertex_of_particle.iter().map(place).collect();
        let coarse = meshes.get(&driver.mesh.source).ok_or(ClothError::NotInMainWorld)?;
        let corners = rest(&mesh_input::read(coarse)?, driver.state);
        let embedding = Embedding::new(&points, &corners, &driver.state.topology.triangles);
        let positions = source.positions.iter().map(Vec3::to_array).collect();
        Ok(Some(Built { embedding, binding: Binding::new(&source, &welded), skinning, positions }))
    }

    /// What takes its space into that of its driver.
    fn to_driver(&self, skeletons: &Skeletons) -> Result<Affine3A, ClothError> {
        let pose = |entity| skeletons.pose(entity).filter(is_invertible).ok_or(ClothError::FlatTransform);
        let (own, driver) = (pose(self.entity)?, pose(self.proxy.driver)?);
        Ok(if own == driver { Affine3A::IDENTITY } else { driver.inverse() * own })
    }

    /// Lets what was built take its place.
    fn accept(
        &mut self,
        source: Handle<Mesh>,
        built: Built,
        driver: &DriverItem,
        meshes: &mut Assets<Mesh>,
        commands: &mut Commands,
    ) {
        self.warn_of_reach(&built.embedding, driver);
        self.wait.told = None;
        let garment = self.garment.filter(|_| self.mesh.is_none());
        let wanted = Wanted::of(self.entity, &source, built.positions.len(), garment);
        let is_worn = built.skinning.0.is_some();
        let drawn = make_copies(wanted, self.own, meshes, |mesh| {
            if is_worn { copy_with_skin(mesh).0 } else { copy_without_skin(mesh).0 }
        });
        show_copies(&drawn, self.mesh.as_deref_mut(), commands);
        let shape = Drawn::new(built.positions);
        let embedded = Embedded {
            driver: self.proxy.driver,
            topology: driver.state.topology.clone(),
            embedding: Arc::new(built.embedding),
            scratch: default(),
        };
        let mesh = ClothMesh { source, drawn, binding: Arc::new(built.binding), shape };
        commands.entity(self.entity).try_insert((mesh, embedded, built.skinning));
    }

    /// Warns of vertices that are far from the driver.
    fn warn_of_reach(&self, embedding: &Embedding, driver: &DriverItem) {
        let scale = driver.state.pose.matrix3.determinant().abs().cbrt();
        let is_far = |&distance: &f32| distance * scale > self.proxy.reach;
        let far = embedding.distances().filter(is_far).count();
        if far > 0 {
            let farthest = embedding.distances().fold(0.0, f32::max) * scale;
            warn!(
                "cloth proxy {}: {far} of its {} points are farther than {} m from its driver {}, by up to {farthest} m, and follow it \
                 all the same; put the meshes where they belong together, or set a larger ClothProxy::reach",
                self.entity,
                embedding.len(),
                self.proxy.reach,
                self.proxy.driver,
            );
        }
    }
}

/// Binds the vertices of a fine mesh to the skeleton that its driver is bound to.
fn bind(
    mesh: &Mesh,
    source: &SourceMesh,
    first_vertices: &[u32],
    driver: &BoundSkin,
    skeletons: &Skeletons,
) -> Option<BoundSkin> {
    let all: Vec<u32> = (0..source.positions.len() as u32).collect();
    let read = |vertices: &[u32]| Skin::read(mesh, &source.positions, vertices);
    BoundSkin::new((read(first_vertices)?, read(&all)?), (&driver.joints, &driver.bindposes), |_| false, skeletons)
}

/// Where the particles of a cloth are in the mesh that it was made of.
fn rest(source: &SourceMesh, state: &ClothState) -> Vec<Vec3A> {
    let mut places = vec![Vec3A::ZERO; state.particle_count()];
    for (vertex, place) in source.positions.iter().enumerate().rev() {
        if let Some(particle) = state.particle_of_vertex(vertex) {
            places[particle] = (*place).into();
        }
    }
    places
}

/// Leaves a plain mesh behind where [`ClothProxy`] is removed, as it was drawn last.
pub(crate) fn on_proxy_removed(
    removed: On<Remove, ClothProxy>,
    mut commands: Commands,
    proxies: Query<&ClothMesh, Without<Cloth>>,
    meshes: Option<ResMut<Assets<Mesh>>>,
) {
    if let (Ok(proxy), Some(mut meshes)) = (proxies.get(removed.entity), meshes) {
        proxy.drawn.iter().for_each(|drawn| draw::release(&drawn.mesh, &mut meshes));
        commands.entity(removed.entity).try_remove::<(ClothMesh, Embedded, Skinning, Garment, ClothParts)>();
    }
}
