//! Large meshes become plans in tasks, beside the frames.

use bevy::{
    math::Mat3A,
    mesh::MeshVertexAttributeId,
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, TaskPool, futures::check_ready},
};

use super::plan::{KnownPlans, Plan, bits};
use crate::error::ClothError;

/// Corners of the triangles of a mesh that is built at once, at most. A grid of 70 x 70 vertices has so many and takes
/// 3 to 5 ms, an irregular mesh twice that: the longest that a frame can spare.
const MOST_AT_ONCE: usize = 30_000;

/// Whether a mesh is too large to be built within a frame.
pub(super) fn is_large(mesh: &Mesh) -> bool {
    let vertices = || mesh.try_attribute(Mesh::ATTRIBUTE_POSITION).map_or(0, |positions| positions.len());
    mesh.try_indices().map_or_else(|_| vertices(), |indices| indices.len()) > MOST_AT_ONCE
}

/// The plans that are being made. Cloths of one mesh that wait at the same time wait for the same one.
#[derive(Debug, Default)]
pub(super) struct Jobs(Vec<Job>);

/// A plan that is being made.
#[derive(Debug)]
struct Job {
    mesh: AssetId<Mesh>,
    to_world: Mat3A,
    task: Task<Done>,
    /// What has come out of the task.
    done: Option<Done>,
    /// Whether a cloth has asked for it in this frame.
    is_wanted: bool,
}

/// A mesh as it was when its plan was begun, and the plan.
#[derive(Debug)]
struct Done {
    mesh: Mesh,
    plan: Result<Plan, ClothError>,
}

impl Jobs {
    /// Drops what nobody waits for any more and what a mesh that `has_changed` was begun from, and looks for what is
    /// done: once a frame, so that all who wait for the same plan see it in the same frame.
    pub fn update(&mut self, has_changed: impl Fn(AssetId<Mesh>) -> bool) {
        self.0.retain_mut(|job| core::mem::take(&mut job.is_wanted) && job.done.is_none() && !has_changed(job.mesh));
        for job in &mut self.0 {
            job.done = check_ready(&mut job.task);
        }
    }

    /// Whether the plan is being made and not done yet.
    pub fn is_making(&mut self, id: AssetId<Mesh>, to_world: Mat3A) -> bool {
        self.find(id, to_world).is_some_and(|job| {
            job.is_wanted = true;
            job.done.is_none()
        })
    }

    /// The plan for `mesh`, if it is done. Begun, if it isn't.
    pub fn ask(
        &mut self,
        id: AssetId<Mesh>,
        mesh: &Mesh,
        to_world: Mat3A,
        known: &KnownPlans,
    ) -> Option<Result<Plan, ClothError>> {
        let Some(job) = self.find(id, to_world) else {
            self.0.push(Job::begin(id, mesh.clone(), to_world, known.clone()));
            return None;
        };
        job.is_wanted = true;
        let done = job.done.as_ref()?;
        // A change of the mesh is announced a frame late.
        has_same_contents(&done.mesh, mesh).then(|| done.plan.clone())
    }

    fn find(&mut self, id: AssetId<Mesh>, to_world: Mat3A) -> Option<&mut Job> {
        self.0.iter_mut().find(|job| job.mesh == id && bits(job.to_world) == bits(to_world))
    }
}

impl Job {
    fn begin(id: AssetId<Mesh>, mesh: Mesh, to_world: Mat3A, known: KnownPlans) -> Self {
        let work = async move {
            let plan = Plan::make(&mesh, to_world, &known);
            Done { mesh, plan }
        };
        let task = AsyncComputeTaskPool::get_or_init(TaskPool::new).spawn(work);
        Self { mesh: id, to_world, task, done: None, is_wanted: true }
    }
}

/// Whether two meshes have the same attributes and triangles, bit for bit: not even a NaN differs from itself.
fn has_same_contents<'a>(one: &'a Mesh, other: &'a Mesh) -> bool {
    let contents = |mesh: &'a Mesh| -> Option<Vec<(MeshVertexAttributeId, &[u8])>> {
        Some(mesh.try_attributes().ok()?.map(|(attribute, values)| (attribute.id, values.get_bytes())).collect())
    };
    one.primitive_topology() == other.primitive_topology()
        && one.try_indices().ok() == other.try_indices().ok()
        && contents(one) == contents(other)
}
