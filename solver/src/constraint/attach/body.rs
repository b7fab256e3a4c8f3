//! Pins on bodies that give way: what pulls at them moves the body.
//!
//! ```text
//!      pin o~~~~~ cloth
//!       r /                K = 1/M - [r] I^-1 [r]     how far a push at the pin moves the body there
//!        x centre of mass
//! ```
//!
//! The cloth's own mass at the pins is part of the body. In a substep each of its n pins is a particle with a part of its
//! mass, `1 / (n |K|)`. What it then comes off its place by is momentum that the body gets, and it is put where the body has
//! it by now. However light the body is, it never goes farther than its pins did (Tonge, Benevolenski and Voroshilov,
//! "Mass Splitting for Jitter-Free Parallel Rigid Body Simulation", 2012), and what the cloth loses, it gains.

use core::ops::Range;

use bevy_math::{Quat, Vec3A};

use crate::{
    constraint::attach::body::combined::CombinedBody,
    input::{Body, BodyDisplacement, BodyImpulse, PinMotion, StepContext},
    layout::points::Points,
    particles::lanes::Lanes,
    topology::Topology,
};

pub(crate) mod combined;

/// Bodies that have come off their way within a step, and the pins on them.
#[derive(Clone, Debug, Default)]
pub(crate) struct BodyAttachments {
    bodies: Vec<AttachedBody>,
    pin_motions: Vec<PinOnBody>,
    /// What each body has been given, and how far it has come off its path by that.
    pub impulses: Vec<(BodyImpulse, BodyDisplacement)>,
}

/// How a body has come off its way.
#[derive(Clone, Copy, Debug)]
struct AttachedBody {
    load: CombinedBody,
    /// Where the body's centre of mass would be, m.
    centre: Vec3A,
    /// How far it is from there, m, and by how much the body has turned.
    shift: Vec3A,
    turn: Quat,
    /// Momentum that it has gained with its load, N s, and angular momentum about their centre of mass, N m s.
    linear: Vec3A,
    angular: Vec3A,
    /// Velocity that the body's centre of mass has gained, m/s, and angular velocity, rad/s.
    velocity: Vec3A,
    spin: Vec3A,
}

/// A pin on a body.
#[derive(Clone, Copy, Debug)]
struct PinOnBody {
    slot: usize,
    motion: PinMotion,
    /// Number of the body.
    body: usize,
    /// Mass of the cloth there, and the part that it has of the mass of the body and all that is fixed to it, kg.
    own: f32,
    mass: f32,
    /// From the body's centre of mass to where it would be, m.
    arm: Vec3A,
    /// Where the body has it, m, and how fast it came there, m/s.
    place: Vec3A,
    velocity: Vec3A,
}

impl AttachedBody {
    fn new(load: CombinedBody, centre: Vec3A) -> Self {
        Self {
            load,
            centre,
            shift: Vec3A::ZERO,
            turn: Quat::IDENTITY,
            linear: Vec3A::ZERO,
            angular: Vec3A::ZERO,
            velocity: Vec3A::ZERO,
            spin: Vec3A::ZERO,
        }
    }

    /// Takes momentum (N s) over at `arm` (m) from the body's centre of mass.
    fn take(&mut self, arm: Vec3A, momentum: Vec3A) {
        self.linear += momentum;
        self.angular += (arm - self.turn * self.load.offset).cross(momentum);
    }

    /// Works out the velocities from what has been taken, none of a pin's more than `most` (m/s): a body whose engine
    /// knows nothing of a load a thousand times its own is thrown about by it. Returns by how much they have changed.
    fn gain(&mut self, most: f32) -> [Vec3A; 2] {
        let before = [self.velocity, self.spin];
        self.spin = self.load.inverse_inertia * self.angular;
        self.velocity = self.linear * self.load.inverse_mass - self.spin.cross(self.turn * self.load.offset);
        let fastest = self.velocity.length() + self.spin.length() * self.load.reach;
        if fastest > most {
            let kept = most / fastest;
            for it in [&mut self.linear, &mut self.angular, &mut self.velocity, &mut self.spin] {
                *it *= kept;
            }
        }
        [self.velocity - before[0], self.spin - before[1]]
    }

    /// Goes on for `h` seconds.
    fn advance(&mut self, velocity: Vec3A, spin: Vec3A, h: f32) {
        self.shift += velocity * h;
        // To first order in the angle: no transcendental function, and exact enough within a substep.
        let half = spin * (0.5 * h);
        self.turn = (Quat::from_xyzw(half.x, half.y, half.z, 1.0) * self.turn).normalize();
    }

    fn place(&self, arm: Vec3A) -> Vec3A {
        self.centre + self.shift + self.turn * arm
    }

    /// What the body itself has been given.
    fn push(&self, body: &Body) -> BodyImpulse {
        BodyImpulse { linear: self.velocity / body.inverse_mass, angular: self.load.part * self.angular }
    }
}

impl BodyAttachments {
    /// Begins a step. From now on pins on bodies can be moved, until they [`rest`](Self::rest).
    pub fn begin(&mut self, lanes: &mut Lanes, topology: &Topology, ctx: &StepContext) {
        let Self { bodies, pin_motions, impulses } = self;
        impulses.clear();
        impulses.resize(ctx.body_attachments.len(), (BodyImpulse::default(), BodyDisplacement::default()));
        pin_motions.clear();
        pin_motions.extend(ctx.attached_pins.iter().map(|it| {
            let (motion, body) = (ctx.pin_motions[it.pin_motion as usize], it.attachment as usize);
            let own = ctx.material.density * topology.areas[motion.particle as usize];
            let slot = lanes.order.slot(motion.particle);
            let arm = motion.start - ctx.body_attachments[body].body.centre;
            PinOnBody {
                slot,
                motion,
                body,
                own,
                mass: 0.0,
                arm,
                place: motion.start,
                velocity: lanes.velocity.get(slot),
            }
        }));
        bodies.clear();
        bodies.extend(ctx.body_attachments.iter().enumerate().map(|(number, it)| {
            let on_it = || pin_motions.iter().filter(|held| held.body == number).map(|held| (held.arm, held.own));
            AttachedBody::new(CombinedBody::new(&it.body, on_it), it.body.centre)
        }));
        for held in &mut *pin_motions {
            let load = &bodies[held.body].load;
            held.mass = 1.0 / (load.pin_count * load.effective_inverse_mass(held.arm));
        }
        // What nothing moves is fixed as any other pin is.
        pin_motions.retain(|held| held.mass.is_finite());
        self.loosen(lanes);
    }

    fn loosen(&self, lanes: &mut Lanes) {
        for held in &self.pin_motions {
            lanes.set_inverse_mass(held.slot, 1.0 / held.mass);
        }
    }

    /// To all that comes now, pins on bodies are fixed.
    pub fn rest(&self, lanes: &mut Lanes) {
        for held in &self.pin_motions {
            lanes.set_inverse_mass(held.slot, 0.0);
        }
    }

    /// Brings the bodies to the end of the part `span` (0..=1) of a step of `dt` seconds, with the cloth's own mass at their
    /// pins and the `force` (N) there, and the pins to where they then are.
    pub fn advance(&mut self, lanes: &mut Lanes, ctx: &StepContext, span: Range<f32>, dt: f32, force: Option<&Points>) {
        let h = (span.end - span.start) * dt;
        for held in &self.pin_motions {
            let body = &mut self.bodies[held.body];
            let arm = body.turn * held.arm;
            // What is fixed to the body goes on as before, and falls, while the body is led.
            let led = (held.motion.end - held.motion.start) / dt + body.velocity + body.spin.cross(arm);
            let left = (held.velocity - led + ctx.gravity * h) * held.own;
            let blown = force.map_or(Vec3A::ZERO, |force| force.get(held.slot) * h);
            body.take(arm, left + blown);
        }
        for (body, attachment) in self.bodies.iter_mut().zip(ctx.body_attachments) {
            body.centre = attachment.body.centre + attachment.displacement * span.end;
            body.gain(ctx.settings.max_velocity);
            body.advance(body.velocity, body.spin, h);
        }
        for held in &mut self.pin_motions {
            let body = &self.bodies[held.body];
            held.arm = held.motion.start.lerp(held.motion.end, span.end) - body.centre;
            held.place = body.place(held.arm);
            lanes.position.set(held.slot, held.place);
        }
        self.loosen(lanes);
    }

    /// Gives the bodies what has pulled at their pins for `h` seconds, puts these where the bodies have them, and has
    /// them rest.
    pub fn settle(&mut self, lanes: &mut Lanes, ctx: &StepContext, h: f32) {
        let Self { bodies, pin_motions, impulses } = self;
        for held in &*pin_motions {
            let pull = (lanes.position.get(held.slot) - held.place) * (held.mass / h);
            let body = &mut bodies[held.body];
            body.take(body.turn * held.arm, pull);
        }
        for ((body, attachment), impulse) in bodies.iter_mut().zip(ctx.body_attachments).zip(&mut *impulses) {
            let [velocity, spin] = body.gain(ctx.settings.max_velocity);
            body.advance(velocity, spin, h);
            *impulse = (body.push(&attachment.body), BodyDisplacement { shift: body.shift, turn: body.turn });
        }
        for held in pin_motions {
            held.place = bodies[held.body].place(held.arm);
            held.velocity = (held.place - lanes.previous.get(held.slot)) / h;
            lanes.position.set(held.slot, held.place);
            lanes.velocity.set(held.slot, held.velocity);
        }
        self.rest(lanes);
    }
}

#[cfg(test)]
mod tests {
    use bevy_math::Mat3A;

    use super::*;

    #[test]
    fn small_turns_add_up() {
        let body = Body { inverse_mass: 1.0, inverse_inertia: Mat3A::IDENTITY, centre: Vec3A::ZERO };
        let mut body = AttachedBody::new(CombinedBody::new(&body, || [].into_iter()), Vec3A::ZERO);
        for _ in 0..100 {
            body.advance(Vec3A::X, Vec3A::Z, 0.01);
        }
        assert!(body.turn.angle_between(Quat::from_rotation_z(1.0)) < 1e-3, "{}", body.turn);
        assert!((body.shift - Vec3A::X).length() < 1e-5);
    }

    #[test]
    fn a_push_is_what_the_body_has_of_all_that_was_taken() {
        let body = Body { inverse_mass: 0.5, inverse_inertia: Mat3A::IDENTITY * 4.0, centre: Vec3A::ZERO };
        let mut loaded = AttachedBody::new(CombinedBody::new(&body, || [(Vec3A::Y, 1.0)].into_iter()), Vec3A::ZERO);
        loaded.take(Vec3A::Y, Vec3A::Z);
        loaded.gain(f32::INFINITY);
        let push = loaded.push(&body);
        let at_load = loaded.velocity + loaded.spin.cross(Vec3A::Y);
        assert!((push.linear + at_load - Vec3A::Z).length() < 1e-6, "1 kg and the body have it all");
        assert!((push.angular - loaded.spin / 4.0).length() < 1e-6, "{push:?}");
    }
}
