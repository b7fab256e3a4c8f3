//! Cloths in all that the solver knows, made of nothing but what is exact on any machine.
//!
//! Nothing here asks the platform for a sine or an exponential: nothing is turned by an angle, substeps are fixed, and no
//! velocity is damped, which is a factor of exp(-0). Sums, products, quotients and roots are exact everywhere. The one that is
//! otherwise says so.

use std::sync::Arc;

use bevy_math::{
    DVec3, Isometry3d, Mat3A, Quat, Vec3, Vec3A,
    primitives::{Cuboid, InfinitePlane3d, Sphere},
};
use drape_solver::{
    AttachedPin, Body, BodyAttachment, Elasticity, Gusts, Material, Member, MeshShape, Method, Obstacle, Shape, Solid,
    SourceMesh, TriangleMesh, WindRegion, WindSource,
};

use crate::{
    bench_bed::{Bed, together},
    fixtures::{
        hand::{Grip, hand},
        material::{Fabric, Springs, springs_in_air},
        mesh::{Grid, shaped},
    },
    lattices::{hexagons, strewn},
};

const STEP: f32 = 1.0 / 60.0;

/// Cloths that are stepped together, and what happens before each frame.
pub struct Stage {
    pub beds: Vec<Bed>,
    lead: Box<dyn FnMut(&mut [Bed], u32)>,
}

impl Stage {
    fn alone(bed: Bed) -> Self {
        Self::led([bed], |_, _| {})
    }

    fn led(beds: impl Into<Vec<Bed>>, lead: impl FnMut(&mut [Bed], u32) + 'static) -> Self {
        Self { beds: beds.into(), lead: Box::new(lead) }
    }

    /// Goes on to a frame, in which `act` is to step the cloths.
    pub fn frame<R>(&mut self, number: u32, act: impl FnOnce(&mut [Member]) -> R) -> R {
        (self.lead)(&mut self.beds, number);
        together(&mut self.beds, STEP, act)
    }
}

/// Springs that are damped, in air.
fn cotton() -> Material {
    let damped = Springs { structural_damping: 0.01, shear_damping: 0.01, bend_damping: 0.01, ..Springs::default() };
    Material { damping: 0.0, ..springs_in_air(damped) }
}

/// A sheet with all that moduli do, in air.
fn denim() -> Material {
    let sheet = Fabric { compression: 0.5, warp_stiffening: 2.0, weft_stiffening: 1.0, ..Fabric::DENIM };
    let sheet = Fabric { damping: 0.0, stretch_damping: 0.001, bend_damping: 0.01, ..sheet };
    sheet.material()
}

/// The same without what it resists bending with.
fn limp_denim() -> Material {
    let mut material = denim();
    if let Elasticity::Moduli(moduli) = &mut material.elasticity {
        moduli.bending = 0.0;
    }
    material
}

/// A cloth that hangs by two particles in a wind with gusts, with levels, and held by a hand.
fn hung(mesh: impl Into<SourceMesh>, pins: [u32; 2], method: Method, material: Material) -> Bed {
    let bed = Bed::new(mesh, material).pinned(pins).tethered(&pins).with_levels();
    let gusts = Gusts { strength: 0.5, period: 2.0, turbulence: 0.3, eddy_size: 0.5, seed: 7 };
    let (region, origin) = (WindRegion::Everywhere, Vec3A::ZERO);
    let velocity = Vec3A::new(1.0, 1.0, 4.0);
    let wind = WindSource { velocity, gusts, region, origin, travelled: DVec3::ZERO, gusts_passed: 0.0 };
    let grabs = vec![hand(&bed, 100, [0.25, 0.25, 0.5], Grip::default())];
    // The explicit method is softened where it would need more substeps.
    Bed { method, max_substeps: 64, winds: vec![wind], grabs, ..bed }
}

/// A grid in the wind.
pub fn grid(method: Method) -> Stage {
    Stage::alone(hung(Grid::new(1.0, 0.75, 21, 17), [0, 20], method, cotton()))
}

/// The same of a sheet.
pub fn sheet() -> Stage {
    Stage::alone(hung(Grid::new(1.0, 0.75, 21, 17), [0, 20], Method::Strands, denim()))
}

/// A grid that is large enough for threads to share it: no hand holds it, and nothing is near.
pub fn large() -> Stage {
    let bed = hung(Grid::new(1.0, 1.25, 101, 102).lying(), [0, 100], Method::Strands, cotton());
    Stage::alone(Bed { grabs: Vec::new(), ..bed }.with_substeps(2).with_levels())
}

/// Irregular triangles in the wind, of springs.
pub fn irregular(method: Method) -> Stage {
    Stage::alone(hung(strewn(16), [0, 1], method, cotton()))
}

/// Regular triangles in the wind, on threads.
pub fn threads() -> Stage {
    Stage::alone(hung(shaped(hexagons(16), |p| 0.0625 * p), [0, 15], Method::Strands, cotton()))
}

/// Irregular triangles of a sheet in the wind, which don't bend.
pub fn faces() -> Stage {
    Stage::alone(hung(strewn(16), [0, 1], Method::Strands, limp_denim()))
}

/// The same that bend: they begin with the platform's acosh, sinh and cosh.
pub fn bent() -> Stage {
    Stage::alone(hung(strewn(16), [0, 1], Method::Strands, denim()))
}

/// A pose that is turned about an axis along `axis`, by twice the angle whose tangent is its length.
fn turned(place: Vec3, axis: Vec3) -> Isometry3d {
    Isometry3d::new(place, Quat::from_xyzw(axis.x, axis.y, axis.z, 1.0).normalize())
}

/// A cloth that falls on a ball, a box that goes to and fro and turns, a wedge of triangles, and the ground.
fn fallen(mesh: impl Into<SourceMesh>, method: Method) -> Stage {
    let mut bed = Bed { method, max_substeps: 64, ..Bed::new(mesh, cotton()).with_substeps(16) };
    let centre = bed.centre();
    bed.particles.position.iter_mut().for_each(|place| *place += Vec3A::Y * 0.375 - centre);
    let ends = [Vec3A::ZERO, Vec3A::X, Vec3A::Y, Vec3A::Z].map(|p| (p - 0.25) * 0.5).to_vec();
    let wedge = Arc::new(TriangleMesh::new(ends, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], true));
    let wedge = Shape::Mesh(MeshShape { mesh: wedge, deformed: None });
    bed.obstacles = vec![
        Obstacle::still(Solid::Sphere(Sphere::new(0.25)), Isometry3d::from_xyz(-0.25, 0.0, -0.125)),
        Obstacle::still(Solid::Cuboid(Cuboid::new(0.25, 0.375, 0.5)), Isometry3d::IDENTITY),
        Obstacle::still(wedge, turned(Vec3::new(0.125, 0.0, -0.375), Vec3::new(0.25, 0.5, 0.125))),
        Obstacle::still(Solid::HalfSpace(InfinitePlane3d::default()), Isometry3d::from_xyz(0.0, -0.5, 0.0)),
    ];
    let pose = |frame: u32| {
        let way = (frame as i32 % 120 - 60).abs() as f32 / 60.0 - 0.5;
        turned(Vec3::new(0.25 + 0.25 * way, 0.0, 0.25), Vec3::new(0.0, way, 0.25))
    };
    Stage::led([bed], move |beds, frame| {
        let cuboid = &mut beds[0].obstacles[1];
        (cuboid.start, cuboid.end) = (pose(frame), pose(frame + 1));
    })
}

/// A grid that falls on obstacles.
pub fn fallen_grid(method: Method) -> Stage {
    fallen(Grid::new(1.0, 1.0, 14, 14).lying(), method)
}

/// Irregular triangles that fall on obstacles.
pub fn fallen_triangles() -> Stage {
    fallen(strewn(12), Method::Strands)
}

/// A cloth in three layers that falls to the ground.
pub fn folded(method: Method) -> Stage {
    let mut bed = Bed::lying(16, cotton()).with_substeps(16);
    // Each is beside the one below, and they open a little towards where they aren't joined.
    for place in &mut bed.particles.position {
        let (layer, along) = match place.x {
            x if x < -0.1875 => (0.0, x + 0.1875),
            x if x < 0.1875 => (1.0, -0.1875 - x),
            x => (2.0, x - 0.5625),
        };
        *place = Vec3A::new(along, 0.25 + 0.0625 * layer - 0.03125 * along, place.z + 0.0078125 * layer);
    }
    bed.obstacles = vec![Obstacle::still(Solid::HalfSpace(InfinitePlane3d::default()), Isometry3d::IDENTITY)];
    Stage::alone(Bed { method, self_collision: true, ..bed })
}

/// A block that cloths pull and push at, as a physics engine has it.
struct Block {
    mass: f32,
    /// Moment of inertia about any axis, kg m².
    inertia: f32,
    place: Vec3A,
    turn: Quat,
    velocity: Vec3A,
    spin: Vec3A,
    /// Anchors that go with it, of each bed: the first of them, and where they are in its frame.
    arms: Vec<(usize, Vec<Vec3A>)>,
}

impl Block {
    const SIZE: Vec3A = Vec3A::new(0.25, 0.25, 0.25);

    /// Takes what cloths have given to it, and falls on for a frame.
    fn lead(&mut self, beds: &mut [Bed]) {
        let of_contact = beds.iter().flat_map(|bed| bed.scratch.obstacle_impulses());
        let given = of_contact
            .chain(beds.iter().flat_map(|bed| bed.scratch.attachment_impulses().iter().map(|(push, _)| push)));
        for push in given {
            self.velocity += push.linear / self.mass;
            self.spin += push.angular / self.inertia;
        }
        self.velocity += Vec3A::NEG_Y * (9.81 * STEP);
        let start = Isometry3d { translation: self.place, rotation: self.turn };
        self.place += self.velocity * STEP;
        let half = self.spin * (0.5 * STEP);
        self.turn = (self.turn + Quat::from_xyzw(half.x, half.y, half.z, 0.0) * self.turn).normalize();
        let end = Isometry3d { translation: self.place, rotation: self.turn };
        for (bed, (first, arms)) in beds.iter_mut().zip(&self.arms) {
            let from = |pose: Isometry3d| Isometry3d { translation: pose.translation - bed.offset, ..pose };
            let (start, end) = (from(start), from(end));
            let inverse_inertia = Mat3A::from_diagonal(Vec3::splat(1.0 / self.inertia));
            let body = Body { inverse_mass: 1.0 / self.mass, inverse_inertia, centre: start.translation };
            let cuboid = Solid::Cuboid(Cuboid::from_size(Self::SIZE.into()));
            bed.obstacles = vec![Obstacle { body: Some(body), ..Obstacle::moving(cuboid, start, end) }];
            bed.body_attachments = vec![BodyAttachment { body, displacement: end.translation - start.translation }];
            for (anchor, &arm) in bed.pin_motions[*first..].iter_mut().zip(arms) {
                anchor.start = bed.particles.position[anchor.particle as usize];
                anchor.end = end.transform_point(arm);
            }
        }
    }
}

/// Two cloths on a block that swings: one hangs by two corners and holds it by its lower edge, the other hangs over it from
/// its middle.
pub fn swinging(method: Method) -> Stage {
    let above = Vec3A::Y * (0.5 * Block::SIZE.y + 0.03125);
    let hung = Bed::new(Grid::new(0.25, 0.5, 7, 13), cotton()).with_substeps(16).pinned([0, 6]);
    let over = Bed::new(Grid::new(0.375, 0.375, 10, 10).lying(), cotton()).with_substeps(16);
    let mut over = Bed { offset: Vec3A::new(0.0625, -0.25, 0.25), ..over };
    over.particles.position.iter_mut().for_each(|p| *p += Vec3A::new(0.0, 0.015625, 0.03125));
    let place = Vec3A::NEG_Y * 0.25 - above;
    let (mut beds, mut arms) = (Vec::new(), Vec::new());
    for (bed, fixed) in [(hung, 84..91_u32), (over, 0..10)] {
        let first = bed.pin_motions.len();
        let at = |i: u32| bed.particles.position[i as usize] + bed.offset - place;
        arms.push((first, fixed.clone().map(at).collect()));
        let attached_pins =
            (first..first + fixed.len()).map(|i| AttachedPin { pin_motion: i as u32, attachment: 0 }).collect();
        beds.push(Bed { method, attached_pins, self_collision: true, ..bed }.pinned(fixed));
    }
    let (turn, spin, velocity) = (Quat::IDENTITY, Vec3A::Y * 0.5, Vec3A::new(0.5, 0.0, 0.25));
    let mut block = Block { mass: 0.125, inertia: 0.0013, place, turn, velocity, spin, arms };
    Stage::led(beds, move |beds, _| block.lead(beds))
}
