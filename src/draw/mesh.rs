//! The only place that writes a cloth's mesh: at most once per rendered frame, and not at all while nothing moves.

use core::ops::Range;
use std::sync::Arc;

use bevy::{
    ecs::system::NonSendMarker,
    math::{
        Affine3A, Vec3A,
        bounding::{Aabb3d, BoundingVolume},
    },
    mesh::{MeshVertexAttribute, VertexAttributeValues},
    prelude::*,
};

use super::{Binding, bind_space::BindSpace, carry::Carry, shading};
use crate::{
    frame::{self, ClothClock, is_invertible},
    mesh_input::{Span, transform},
    pins::PinTarget,
    solver::build::weld::NO_PARTICLE,
    state::{BoundSkin, ClothAttachments, ClothState, HeldPin, Requests, Skinning, StepInput},
};

/// The meshes of a cloth: the one that it was made from, and its own copy, which is drawn.
#[derive(Component, Clone, Debug)]
pub(crate) struct ClothMesh {
    /// The user's mesh, or that which the parts of a garment were joined to: never written, so its shape stays the rest shape.
    pub source: Handle<Mesh>,
    /// The cloth's own mesh; of a garment, one for each part.
    pub drawn: Vec<DrawnMesh>,
    /// From particles to vertices.
    pub binding: Arc<Binding>,
    /// What the vertices are to become.
    pub shape: Drawn,
}

/// A mesh that is drawn of a cloth.
#[derive(Clone, Debug)]
pub(crate) struct DrawnMesh {
    /// The entity whose `Mesh3d` it is.
    pub entity: Entity,
    /// The user's mesh that it is a copy of.
    pub source: Handle<Mesh>,
    pub mesh: Handle<Mesh>,
    /// Where it is in the mesh that the cloth was made from.
    pub span: Span,
    /// From the space of the cloth's entity to its own.
    pub from_cloth: Affine3A,
}

impl ClothMesh {
    /// What is drawn of it with a mesh.
    pub fn drawn_with(&self, mesh: AssetId<Mesh>) -> Option<&DrawnMesh> {
        self.drawn.iter().find(|drawn| drawn.mesh.id() == mesh)
    }

    /// What is drawn of it by an entity.
    pub fn drawn_by(&self, entity: Entity) -> Option<&DrawnMesh> {
        self.drawn.iter().find(|drawn| drawn.entity == entity)
    }
}

/// Vertex data of a deformed mesh, in its entity's own space.
#[derive(Clone, Debug, Default)]
pub(crate) struct Drawn {
    /// Position of each vertex. Those in no triangle keep the place that they have here.
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    tangents: Vec<[f32; 4]>,
    /// The box around all particles.
    pub bounds: Option<Aabb3d>,
    /// What the data was computed from; the same again needs no work.
    key: Option<(u64, f32, Affine3A)>,
    carry: Carry,
    /// What it is found in.
    next_carry: Carry,
    /// The mesh asset doesn't have the data yet.
    is_new: bool,
    /// Position of each particle; none before the first time.
    pub particles: Vec<Vec3A>,
    /// What takes them to the world.
    pub pose: Affine3A,
    sums: Vec<Vec3A>,
    /// For cloth on a skeleton.
    bind_space: BindSpace,
}

/// Computes what every cloth looks like at the moment that is drawn.
pub(crate) fn shape_cloths(
    mut cloths: Query<(
        &ClothState,
        &ClothAttachments,
        &Skinning,
        &Requests,
        &StepInput,
        &GlobalTransform,
        &mut ClothMesh,
    )>,
    poses: Query<&GlobalTransform>,
    clock: ClothClock,
    _main_thread: NonSendMarker,
) {
    let clock = &clock;
    frame::for_each(
        cloths.iter_mut(),
        clock.parallel(),
        |(state, attachments, skinning, requests, input, transform, mut mesh)| {
            let now = clock.overstep(input.pass);
            let ClothMesh { binding, shape, .. } = &mut *mesh;
            let parts = (state, attachments, skinning.0.as_deref(), requests);
            shape.update(parts, binding, transform.affine(), &poses, now);
        },
    );
}

/// Writes what has changed into the mesh assets.
pub(crate) fn write_meshes(
    mut cloths: Query<(Entity, &mut ClothMesh, &Skinning)>,
    mut meshes: ResMut<Assets<Mesh>>,
    poses: Query<&GlobalTransform>,
) {
    for (entity, mut cloth, skinning) in &mut cloths {
        let ClothMesh { drawn, binding, shape, .. } = &mut *cloth;
        let bound = skinning.0.as_deref();
        for drawn in drawn {
            let Some(from_cloth) = from_cloth(entity, drawn.entity, &poses) else { continue };
            let has_moved = drawn.from_cloth != from_cloth && !shape.particles.is_empty();
            if (shape.is_new || has_moved)
                && let Some(mesh) = meshes.get_mut(&drawn.mesh)
            {
                drawn.from_cloth = from_cloth;
                shape.write(mesh.into_inner(), drawn, bound, binding);
            }
        }
        shape.is_new = false;
        shape.bind_space.is_new = false;
    }
}

/// What takes the space of a cloth's entity to that of a part of it. None where either isn't there, or is flat.
fn from_cloth(cloth: Entity, part: Entity, poses: &Query<&GlobalTransform>) -> Option<Affine3A> {
    if cloth == part {
        return Some(Affine3A::IDENTITY);
    }
    let [cloth, part] = poses.get_many([cloth, part]).ok()?.map(GlobalTransform::affine);
    match cloth == part {
        true => Some(Affine3A::IDENTITY),
        false => is_invertible(&part).then(|| part.inverse() * cloth),
    }
}

/// Lets go of a mesh whose entity is no longer cloth: from now on its bounds follow from its positions again. Nothing
/// that is drawn changes by that, so nobody is told.
pub(crate) fn release(mesh: &Handle<Mesh>, meshes: &mut Assets<Mesh>) {
    if let Some(mesh) = meshes.get_mut_untracked(mesh) {
        mesh.final_aabb = None;
    }
}

impl Drawn {
    /// The vertices of a mesh before the first step.
    pub fn new(positions: Vec<[f32; 3]>) -> Self {
        Self { positions, ..default() }
    }

    /// Interpolates the latest step at `now` (0..=1) and shades it. `pose` takes the mesh to the world, and `poses` are those
    /// of all entities by now.
    fn update(
        &mut self,
        (state, attachments, bound, requests): (&ClothState, &ClothAttachments, Option<&BoundSkin>, &Requests),
        binding: &Binding,
        pose: Affine3A,
        poses: &Query<&GlobalTransform>,
        now: f32,
    ) {
        // Until the next step does a teleport, the cloth is drawn as if it had been done.
        let (pose, anchors) = if requests.teleport { (state.pose, &[][..]) } else { (pose, &*attachments.anchors) };
        // Where nothing has moved, each moment of the step looks the same.
        let now = if state.is_still { 1.0 } else { now };
        // A teleport that is asked for takes bind space along.
        if bound.is_some() && requests.teleport {
            return;
        }
        let Some(place) = self.place(bound, pose, poses) else { return };
        // In bind space, what moves with its skeleton stays the same.
        let key = (state.steps, now, if bound.is_some() { Affine3A::IDENTITY } else { pose });
        self.next_carry.update(state.origin.into(), anchors, now, place, poses);
        // What lies still while its skeleton moves is written anew.
        let is_left_behind = bound.is_some() && state.is_still && self.bind_space.has_moved;
        let is_known = self.key == Some(key) && self.carry == self.next_carry && !is_left_behind;
        if state.particles.is_empty() || is_known {
            return;
        }
        core::mem::swap(&mut self.carry, &mut self.next_carry);
        self.key = Some(key);
        let places = state.step_start.iter().zip(&state.particles.position).map(|(start, &end)| start.lerp(end, now));
        self.particles.clear();
        match self.carry.weights(attachments) {
            Some(weights) => {
                let carried = places.enumerate().map(|(i, place)| self.carry.blend(place, weights.of(i)));
                self.particles.extend(carried);
            }
            None => {
                let carry = self.carry.whole();
                self.particles.extend(places.map(|place| carry.transform_point3a(place)));
            }
        }
        if bound.is_some() {
            let is_on_skin = |pin: &&HeldPin| pin.target == PinTarget::Cloth;
            let on_skin = attachments.pins.iter().filter(is_on_skin).map(|pin| pin.particle as usize);
            self.note_pins(on_skin, self.particles.len());
        }
        self.show(binding, bound, pose, place);
    }

    /// The world position that particles are placed relative to: the mesh's own, which `pose` takes to the world, or the first joint's of its
    /// skeleton. None where it can't be drawn: its transform is flat, or a joint is missing.
    pub(super) fn place(
        &mut self,
        bound: Option<&BoundSkin>,
        pose: Affine3A,
        poses: &Query<&GlobalTransform>,
    ) -> Option<Vec3A> {
        match bound {
            Some(bound) => self.bind_space.read_joints(bound, poses).then_some(self.bind_space.place),
            None => is_invertible(&pose).then_some(pose.translation),
        }
    }

    /// Takes note of which of so many particles are pinned to the skin.
    pub(super) fn note_pins(&mut self, on_skin: impl Iterator<Item = usize> + Clone, count: usize) {
        self.bind_space.note_pins(on_skin, count);
    }

    /// Whether the skin alone draws a particle.
    pub(super) fn is_pinned(&self, particle: u32) -> bool {
        self.bind_space.is_pinned(particle)
    }

    /// Whether there is data that isn't written yet.
    pub(super) fn is_new(&self) -> bool {
        self.is_new
    }

    /// Whether it was drawn elsewhere than at `pose`, or its skeleton has moved since.
    pub(super) fn has_moved(&self, pose: Affine3A, bound: Option<&BoundSkin>) -> bool {
        self.particles.is_empty() || if bound.is_some() { self.bind_space.has_moved } else { self.pose != pose }
    }

    /// Takes the particles, which are relative to `place` in the axes of the world, to vertices in the mesh's own space, and shades them.
    pub(super) fn show(&mut self, binding: &Binding, bound: Option<&BoundSkin>, pose: Affine3A, place: Vec3A) {
        // Of cloth on a skeleton, the entity's own transform has no say, be it flat.
        let pose = if is_invertible(&pose) { pose } else { Affine3A::from_translation(place.into()) };
        let to_local = Affine3A { matrix3: pose.matrix3, translation: pose.translation - place }.inverse();
        if let Some(bound) = bound {
            self.bind_space.positions.resize(self.positions.len(), [0.0; 3]);
            place_vertices(&self.particles, binding, &mut self.bind_space.positions);
            self.shade(binding, true);
            self.bind_space.write_positions(&bound.vertices, &binding.particle_of_vertex, &mut self.positions);
            let (normals, tangents) = (&mut self.normals, &mut self.tangents);
            self.bind_space.write_directions(&bound.vertices, &binding.particle_of_vertex, normals, tangents);
        }
        self.particles.iter_mut().for_each(|particle| *particle = to_local.transform_point3a(*particle));
        // What doesn't fit into an f32, far away or under a huge scale, leaves what was drawn.
        self.is_new = self.particles.iter().all(|place| place.is_finite());
        if !self.is_new {
            return;
        }
        self.pose = pose;
        self.bounds = bounds(&self.particles);
        if bound.is_none() {
            place_vertices(&self.particles, binding, &mut self.positions);
            self.shade(binding, false);
        }
    }

    /// Works out normals and tangents of the vertices: of those in the axes of the world, or of the mesh's own.
    fn shade(&mut self, binding: &Binding, in_world: bool) {
        let Some(groups) = &binding.normals else { return };
        let positions = if in_world { &self.bind_space.positions } else { &self.positions };
        shading::normals(binding, groups, positions, &mut self.sums);
        self.normals.clear();
        self.normals.extend(groups.of_vertex.iter().map(|&g| self.sums[g as usize].to_array()));
        if let Some(tangents) = &binding.tangents {
            let Self { normals, sums, tangents: shown, .. } = self;
            shading::tangents(binding, tangents, positions, normals, sums, shown);
        }
    }

    /// Writes what is drawn of it with a mesh.
    fn write(&self, mesh: &mut Mesh, drawn: &DrawnMesh, bound: Option<&BoundSkin>, binding: &Binding) {
        let (span, from_cloth) = (&drawn.span.vertices, drawn.from_cloth);
        if let Some(bound) = bound
            && self.bind_space.is_new
        {
            let influences = || self.bind_space.influences(&bound.vertices, &binding.particle_of_vertex, span);
            if let Some(VertexAttributeValues::Uint16x4(joints)) = values(mesh, Mesh::ATTRIBUTE_JOINT_INDEX) {
                joints.clear();
                joints.extend(influences().map(|(joints, _)| joints));
            }
            if let Some(VertexAttributeValues::Float32x4(weights)) = values(mesh, Mesh::ATTRIBUTE_JOINT_WEIGHT) {
                weights.clear();
                weights.extend(influences().map(|(_, weights)| weights));
            }
        }
        if let Some(VertexAttributeValues::Float32x3(values)) = values(mesh, Mesh::ATTRIBUTE_POSITION) {
            copy(&self.positions, span, values);
        }
        if let Some(VertexAttributeValues::Float32x3(values)) = values(mesh, Mesh::ATTRIBUTE_NORMAL) {
            copy(&self.normals, span, values);
        }
        if let Some(VertexAttributeValues::Float32x4(values)) = values(mesh, Mesh::ATTRIBUTE_TANGENT) {
            copy(&self.tangents, span, values);
        }
        // Spares Bevy two scans of all positions, and keeps the cloth from being culled by where it was.
        mesh.final_aabb = self.bounds;
        if from_cloth != Affine3A::IDENTITY {
            mesh.final_aabb = self.bounds.map(|bounds| around(&bounds, &from_cloth));
            // What is drawn in bind space has the space of the joints already.
            if bound.is_none() {
                transform(mesh, from_cloth);
            }
        }
    }
}

/// Copies the values of some vertices, if there are any.
fn copy<T: Copy>(from: &[T], span: &Range<usize>, values: &mut Vec<T>) {
    if let Some(from) = from.get(span.clone()) {
        values.clear();
        values.extend_from_slice(from);
    }
}

/// Puts vertices where their particles are. Those in no triangle stay.
fn place_vertices(particles: &[Vec3A], binding: &Binding, positions: &mut [[f32; 3]]) {
    for (place, &particle) in positions.iter_mut().zip(&*binding.particle_of_vertex) {
        if particle != NO_PARTICLE {
            *place = particles[particle as usize].to_array();
        }
    }
}

fn values(mesh: &mut Mesh, attribute: MeshVertexAttribute) -> Option<&mut VertexAttributeValues> {
    mesh.try_attribute_mut(attribute).ok()
}

/// The box around a box in another space.
fn around(bounds: &Aabb3d, to: &Affine3A) -> Aabb3d {
    let half = bounds.half_size();
    let [x, y, z] = [to.matrix3.x_axis, to.matrix3.y_axis, to.matrix3.z_axis].map(Vec3A::abs);
    Aabb3d::new(to.transform_point3a(bounds.center()), x * half.x + y * half.y + z * half.z)
}

/// The box around `points`; none around no point.
fn bounds(points: &[Vec3A]) -> Option<Aabb3d> {
    let low = points.iter().copied().reduce(Vec3A::min)?;
    let high = points.iter().copied().reduce(Vec3A::max)?;
    Some(Aabb3d::from_min_max(low, high))
}
