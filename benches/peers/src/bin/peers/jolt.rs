//! Jolt's soft bodies: XPBD with small steps, one pass over the edges in each.

use bevy_drape_peers::{
    line::Line,
    measure::{self, Name, Peer},
    scene::{BEND, Cloth, FRAME, GRAVITY, SHEAR, STRUCTURAL},
};
use oxijolt::{
    BodyId, LongRangeAttachment, PhysicsWorld, SoftBodyBendType, SoftBodyEdge, SoftBodySettings,
    SoftBodySharedSettings, SoftBodyVertex, SoftBodyVertexAttributes, Vec3, WorldSettings,
};

/// Factor on all masses and stiffnesses. The interface refuses vertices of less than 1 g, and only the ratio of the
/// two matters to the motion: with a power of two the positions are the same bits.
const SCALE: f32 = 128.0;

/// What is swept first: substeps a frame, which Jolt calls iterations.
const ITERATIONS: [u32; 4] = [5, 10, 20, 40];

/// What else differs, with a name.
const VARIANTS: [(&str, Variant); 3] = [
    ("", Variant { attachments: LongRangeAttachment::None, shuffled: false }),
    (", attachments", Variant { attachments: ATTACHMENTS, shuffled: false }),
    (", attachments, shuffled", Variant { attachments: ATTACHMENTS, shuffled: true }),
];

/// Flat cloth is as long along the threads as through the air: the straight distance is the true one.
const ATTACHMENTS: LongRangeAttachment = LongRangeAttachment::EuclideanDistance;

/// How the cloth is set up.
#[derive(Clone, Copy)]
struct Variant {
    /// What holds a particle to its nearest pin.
    attachments: LongRangeAttachment,
    /// Whether Jolt gets the particles in a scattered order. Among edges that are equally far from a pin it goes by
    /// the numbers of the particles, and row by row 20 iterations stretch a cloth of 64 x 64 more than 10 do.
    shuffled: bool,
}

/// Runs all settings.
pub fn sweep(cloth: &Cloth, each: fn(&Line)) {
    for (suffix, variant) in VARIANTS {
        for iterations in ITERATIONS {
            let setting = format!("{iterations} iterations{suffix}");
            let name = Name { system: "Jolt", version: "5.6.0", setting: &setting };
            each(&measure::run(&name, cloth, &mut Jolt::new(cloth, iterations, variant, SCALE)));
        }
    }
}

/// A world with nothing in it but the cloth.
struct Jolt {
    world: PhysicsWorld,
    body: BodyId,
    /// Jolt's number of each particle.
    vertex_of: Vec<usize>,
}

impl Jolt {
    fn new(cloth: &Cloth, iterations: u32, variant: Variant, scale: f32) -> Self {
        let settings = WorldSettings::default().single_threaded().gravity(Vec3::new(0.0, -GRAVITY, 0.0));
        let mut world = PhysicsWorld::new(settings).expect("the settings are in range");
        let settings = SoftBodySettings::default()
            .num_iterations(iterations)
            .linear_damping(0.0)
            .allow_sleeping(false)
            // As Jolt advises for a body that is attached to the world.
            .update_position(false);
        let vertex_of = numbering(cloth, variant.shuffled);
        let shared = shared(cloth, &vertex_of, variant.attachments, scale);
        let body = world.create_soft_body(&shared, &settings).expect("there is room for it");
        Self { world, body, vertex_of }
    }
}

/// Jolt's number of each particle.
fn numbering(cloth: &Cloth, shuffled: bool) -> Vec<usize> {
    let mut order: Vec<usize> = (0..cloth.rest.len()).collect();
    if shuffled {
        // Multiples of the golden ratio scatter evenly.
        order.sort_by_key(|&particle| (particle as u32).wrapping_mul(0x9E37_79B9));
    }
    order
}

/// The particles and what ties them.
fn shared(cloth: &Cloth, vertex_of: &[usize], attachments: LongRangeAttachment, scale: f32) -> SoftBodySharedSettings {
    let mut vertices = vec![SoftBodyVertex::new(Vec3::ZERO); cloth.start.len()];
    for (particle, &[x, y, z]) in cloth.start.iter().enumerate() {
        let pinned = cloth.pins.contains(&particle);
        let inverse_mass = if pinned { 0.0 } else { 1.0 / (cloth.particle_mass() * scale) };
        vertices[vertex_of[particle]] = SoftBodyVertex { inverse_mass, ..SoftBodyVertex::new(Vec3::new(x, y, z)) };
    }
    let faces = cloth.faces().into_iter().map(|face| face.map(|particle| vertex_of[particle as usize] as u32));
    let compliance = |stiffness: f32| 1.0 / (stiffness * scale);
    let attributes = SoftBodyVertexAttributes::default()
        .compliance(compliance(STRUCTURAL))
        .shear_compliance(compliance(SHEAR))
        .long_range_attachment(attachments, 1.0);
    let builder = SoftBodySharedSettings::builder(vertices, faces.collect())
        .create_constraints(SoftBodyBendType::None, attributes);
    // Jolt's own distance bends join the far corners of two triangles; ours go along the threads.
    let bend = |pair: [usize; 2]| SoftBodyEdge {
        vertices: pair.map(|particle| vertex_of[particle] as u32),
        compliance: compliance(BEND),
    };
    cloth.pairs(2).fold(builder, |builder, pair| builder.edge(bend(pair))).build().expect("a grid makes a soft body")
}

impl Peer for Jolt {
    fn step(&mut self) {
        let report = self.world.step(FRAME).expect("a frame is a valid time step");
        assert!(report.is_complete(), "there is nothing to collide with");
    }

    fn positions(&self) -> Vec<[f32; 3]> {
        let vertices = self.world.soft_body(self.body).expect("nobody takes it away").vertices();
        let positions = self.vertex_of.iter().map(|&vertex| vertices[vertex].position);
        positions.map(|position| [position.x, position.y, position.z]).collect()
    }
}

#[cfg(test)]
mod tests;
