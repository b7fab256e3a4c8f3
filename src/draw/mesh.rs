//! The only place that writes a cloth's mesh: at most once per rendered frame, and not at all while nothing moves.

use std::sync::Arc;

use bevy::{
    ecs::system::NonSendMarker,
    math::{Affine3A, Vec3A, bounding::Aabb3d},
    mesh::{MeshVertexAttribute, VertexAttributeValues},
    prelude::*,
};

use super::{Binding, bind_space::BindSpace, carry::Carry, shading};
use crate::{
    frame::{self, ClothClock, is_invertible},
    solver::build::weld::NO_PARTICLE,
    state::{BoundSkin, ClothAttachments, ClothState, Requests, Skinning, StepInput},
};

/// The meshes of a cloth: the one that it was made from, and its own copy, which is drawn.
#[derive(Component, Clone, Debug)]
pub(crate) struct ClothMesh {
    /// The user's mesh: never written, so its shape stays the rest shape.
    pub source: Handle<Mesh>,
    /// The cloth's own mesh, in the entity's `Mesh3d`.
    pub drawn: Handle<Mesh>,
    /// From particles to vertices.
    pub binding: Arc<Binding>,
    /// What the vertices are to become.
    pub shape: Drawn,
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
pub(crate) fn write_meshes(mut cloths: Query<(&mut ClothMesh, &Skinning)>, mut meshes: ResMut<Assets<Mesh>>) {
    for (mut cloth, skinning) in &mut cloths {
        if cloth.shape.is_new
            && let Some(mesh) = meshes.get_mut(&cloth.drawn)
        {
            let ClothMesh { binding, shape, .. } = &mut *cloth;
            shape.is_new = false;
            shape.write(mesh.into_inner(), skinning.0.as_deref(), binding);
        }
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
        // In bind space, what moves with its skeleton stays the same.
        let key = (state.steps, now, if bound.is_some() { Affine3A::IDENTITY } else { pose });
        // A teleport that is asked for takes bind space along.
        if bound.is_some_and(|bound| requests.teleport || !self.bind_space.read_joints(bound, poses)) {
            return;
        }
        let place = if bound.is_some() { self.bind_space.place } else { pose.translation };
        self.next_carry.update(state.origin.into(), anchors, now, place, poses);
        // What lies still while its skeleton moves is written anew.
        let is_left_behind = bound.is_some() && state.is_still && self.bind_space.has_moved;
        let is_known = self.key == Some(key) && self.carry == self.next_carry && !is_left_behind;
        if state.particles.is_empty() || is_known || !is_invertible(&pose) {
            return;
        }
        core::mem::swap(&mut self.carry, &mut self.next_carry);
        self.key = Some(key);
        self.is_new = true;
        let to_local = Affine3A { matrix3: pose.matrix3, translation: pose.translation - place }.inverse();
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
        if let Some(bound) = bound {
            self.bind_space.note_pins(&attachments.pins, self.particles.len());
            self.bind_space.positions.resize(self.positions.len(), [0.0; 3]);
            place_vertices(&self.particles, binding, &mut self.bind_space.positions);
            self.shade(binding, true);
            self.bind_space.write_positions(&bound.vertices, &binding.particle_of_vertex, &mut self.positions);
            let (normals, tangents) = (&mut self.normals, &mut self.tangents);
            self.bind_space.write_directions(&bound.vertices, &binding.particle_of_vertex, normals, tangents);
        }
        self.particles.iter_mut().for_each(|particle| *particle = to_local.transform_point3a(*particle));
        // What doesn't fit into an f32, far away or under a huge scale, leaves what was drawn.
        if !self.particles.iter().all(|place| place.is_finite()) {
            self.is_new = false;
            return;
        }
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

    fn write(&mut self, mesh: &mut Mesh, bound: Option<&BoundSkin>, binding: &Binding) {
        if let Some(bound) = bound
            && core::mem::take(&mut self.bind_space.is_new)
        {
            let influences = || self.bind_space.influences(&bound.vertices, &binding.particle_of_vertex);
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
            values.clone_from(&self.positions);
        }
        if let Some(VertexAttributeValues::Float32x3(values)) = values(mesh, Mesh::ATTRIBUTE_NORMAL)
            && !self.normals.is_empty()
        {
            values.clone_from(&self.normals);
        }
        if let Some(VertexAttributeValues::Float32x4(values)) = values(mesh, Mesh::ATTRIBUTE_TANGENT)
            && !self.tangents.is_empty()
        {
            values.clone_from(&self.tangents);
        }
        // Spares Bevy two scans of all positions, and keeps the cloth from being culled by where it was.
        mesh.final_aabb = self.bounds;
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

/// The box around `points`; none around no point.
fn bounds(points: &[Vec3A]) -> Option<Aabb3d> {
    let low = points.iter().copied().reduce(Vec3A::min)?;
    let high = points.iter().copied().reduce(Vec3A::max)?;
    Some(Aabb3d::from_min_max(low, high))
}
