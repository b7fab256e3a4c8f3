//! How a cloth hangs on the skeleton of its mesh.

use bevy::{
    math::{Affine3A, Vec3A},
    prelude::*,
};

use crate::{
    frame::{Jump, Skeletons, is_invertible, joint_matrices},
    mesh_input::Skin,
    pins::PinTarget,
    skin::ClothSkin,
    solver::{self, SkinLimit, SkinLimits, SkinPose, Topology},
    state::HeldPin,
};

/// The skeleton that a cloth is worn on, if its mesh is skinned. Comes with [`Cloth`](crate::prelude::Cloth).
#[derive(Component, Clone, Debug, Default)]
#[component(clone_behavior = Ignore)]
pub(crate) struct Skinning(pub Option<Box<BoundSkin>>);

impl Skinning {
    /// The entity that a cloth goes with: the joint that has most of it, or else the `cloth` itself.
    pub fn carrier(&self, cloth: Entity) -> Entity {
        self.0.as_ref().map_or(cloth, |bound| bound.main_joint())
    }
}

/// A cloth that is bound to a skeleton.
#[derive(Clone, Debug)]
pub(crate) struct BoundSkin {
    /// How particles follow the joints.
    pub skin: Skin,
    /// How vertices do.
    pub vertices: Skin,
    /// The joints that vertices follow most, each once.
    pub strongest: Vec<u16>,
    /// The joints, and their inverse bind poses.
    pub joints: Vec<Entity>,
    pub bindposes: Vec<Mat4>,
    /// The joint that the cloth as a whole goes with, by its number.
    main: usize,
    /// How far particles may be from the skin; none where only pins are held by it.
    limits: Option<SkinLimits>,
    /// Whether any particle has a backstop: nothing else asks for normals.
    has_backstop: bool,
    /// The settings in force: the latest that were valid.
    pub settings: ClothSkin,
    /// Where the skin has the particles at the start and the end of the latest step, relative to `origin`.
    start: SkinPose,
    end: SkinPose,
    origin: Vec3,
    /// What the joints do to the mesh by now, relative to `place`.
    matrices: Vec<Affine3A>,
    place: Vec3A,
    /// Whether all joints are there.
    is_whole: bool,
}

impl BoundSkin {
    /// Binds a cloth to a skeleton, with its joints as they are by now. Those of the particles that are `held` say with which it goes.
    /// None where a joint isn't there, or flat.
    pub fn new(
        (skin, vertices): (Skin, Skin),
        (joints, bindposes): (&[Entity], &[Mat4]),
        held: impl Fn(usize) -> bool,
        skeletons: &Skeletons,
    ) -> Option<Self> {
        let held: Vec<usize> = (0..skin.len()).filter(|&particle| held(particle)).collect();
        let main = if held.is_empty() { skin.main_joint(0..skin.len()) } else { skin.main_joint(held.into_iter()) };
        let mut strongest: Vec<u16> = vertices.points().iter().map(|point| point.strongest()).collect();
        strongest.sort_unstable();
        strongest.dedup();
        let mut bound = Self {
            strongest,
            skin,
            vertices,
            joints: joints.to_vec(),
            bindposes: bindposes.to_vec(),
            main: main.into(),
            limits: None,
            has_backstop: false,
            settings: ClothSkin::default(),
            start: SkinPose::default(),
            end: SkinPose::default(),
            origin: Vec3::ZERO,
            matrices: Vec::new(),
            place: Vec3A::ZERO,
            is_whole: false,
        };
        bound.read_joints(skeletons);
        bound.pose().is_some().then_some(bound)
    }

    /// The joint that the cloth as a whole goes with.
    pub fn main_joint(&self) -> Entity {
        self.joints[self.main]
    }

    /// Where that joint is by now, with the rotation and scale that it gives the mesh; none while a joint isn't there.
    pub fn pose(&self) -> Option<Affine3A> {
        let matrix = self.matrices.get(self.main).filter(|_| self.is_whole)?;
        // Its own place, about which it turns, and not that of the mesh's origin.
        let joint = Affine3A::from_mat4(self.bindposes[self.main]).inverse().translation;
        let pose = Affine3A { translation: matrix.transform_point3a(joint) + self.place, ..*matrix };
        is_invertible(&pose).then_some(pose)
    }

    /// Whether all joints were there in the latest step.
    pub fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// Reads where the joints are by now.
    pub fn read_joints(&mut self, skeletons: &Skeletons) {
        let pose = |joint| skeletons.pose(joint);
        let place = joint_matrices(&self.joints, &self.bindposes, pose, &mut self.matrices);
        self.is_whole = place.is_some_and(|place| place.is_finite())
            && self.matrices.len() >= self.skin.joint_count.max(self.vertices.joint_count)
            && self.matrices.iter().all(|matrix| matrix.is_finite());
        self.place = place.unwrap_or(self.place);
    }

    /// Sets how far particles may be from the skin, as its settings have it.
    pub fn limit(&mut self, limits: &[SkinLimit], topology: &Topology) {
        let is_free = |limit: &SkinLimit| limit.max_distance == f32::INFINITY && limit.backstop.is_none();
        let limits_any = self.settings.pull > 0.0 || !limits.iter().all(is_free);
        self.limits = limits_any.then(|| SkinLimits::new(limits, topology));
        self.has_backstop = limits.iter().any(|limit| limit.backstop.is_some());
        // They were of another moment, where there were none since.
        self.end.normal.clear();
    }

    /// Whether the skin moves in the coming step.
    pub fn moves(&self) -> bool {
        self.start.place != self.end.place
    }

    /// Takes the step from where the skin was to where it is by now, relative to the cloth's `origin`. One that `has_jumped` comes from
    /// where it is.
    pub fn advance(&mut self, topology: &Topology, origin: Vec3, has_jumped: bool) {
        core::mem::swap(&mut self.start, &mut self.end);
        let shift = Vec3A::from(self.origin - origin);
        self.origin = origin;
        let is_first = self.start.place.len() != self.skin.len();
        if shift != Vec3A::ZERO {
            self.start.place.iter_mut().for_each(|place| *place += shift);
        }
        if self.is_whole {
            self.end.place.resize(self.skin.len(), Vec3A::ZERO);
            self.skin.pose(&self.matrices, &mut self.end.place);
            let offset = self.place - Vec3A::from(origin);
            self.end.place.iter_mut().for_each(|place| *place += offset);
            if self.has_backstop {
                normals(topology, &self.end.place, &mut self.end.normal);
            }
        } else {
            self.end.clone_from(&self.start);
        }
        if has_jumped || is_first || self.start.normal.len() != self.end.normal.len() {
            self.start.clone_from(&self.end);
        }
    }

    /// Has the latest skin come along with a rigid motion that its cloth isn't to feel.
    pub fn take_along(&mut self, motion: &Jump) {
        let origin = Vec3A::from(self.origin);
        self.end.place.iter_mut().for_each(|place| *place = motion.place(*place, origin));
        self.end.normal.iter_mut().for_each(|normal| *normal = motion.direction(*normal));
        self.origin = motion.end().into();
    }

    /// Where the skin has the particles at the end of the coming step, relative to the cloth's origin, m.
    pub fn places(&self) -> &[Vec3A] {
        &self.end.place
    }

    /// What holds the cloth in the coming step besides its pins.
    pub fn as_constraint(&self) -> Option<solver::Skin<'_>> {
        let ClothSkin { pull, pull_damping, .. } = self.settings;
        let limits = self.limits.as_ref()?;
        Some(solver::Skin { pull, pull_damping, ..solver::Skin::new(limits, &self.start, &self.end) })
    }

    /// Where the skin holds a pinned particle; none where something else does.
    pub fn holds(&self, pin: &HeldPin) -> Option<Vec3A> {
        let place = self.end.place.get(pin.particle as usize).filter(|_| pin.target == PinTarget::Cloth);
        place.copied().filter(|place| place.is_finite())
    }

    /// The world has been shifted, and the skeleton with it.
    pub fn shift(&mut self, by: Vec3) {
        self.origin += by;
        self.place += Vec3A::from(by);
    }
}

/// Writes the normal of each particle's surroundings, not of length 1.
fn normals(topology: &Topology, places: &[Vec3A], normals: &mut Vec<Vec3A>) {
    normals.clear();
    normals.resize(places.len(), Vec3A::ZERO);
    for triangle in &topology.triangles {
        let [a, b, c] = triangle.map(|i| places[i as usize]);
        let normal = (b - a).cross(c - a);
        triangle.iter().for_each(|&i| normals[i as usize] += normal);
    }
}
