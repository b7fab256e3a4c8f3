//! When to look for pairs, and for how much of the step.

use core::ops::Range;

use bevy_math::Vec3A;

use crate::{
    contact::feature::{ClothInStep, FeatureContacts, narrow_phase::Displacements, obstacle::ClothMotion},
    particles::lanes::Lanes,
};

/// How far a particle may come off its way towards other cloth: this much (m), or this share of the mean edge, and a share of the way by
/// which it goes past the others until the search ends; a share of the mean edge at most. The less, the fewer features are near each
/// other.
const SLACK: f32 = 0.0005;
const LEAST_SLACK_OF_EDGE: f32 = 0.04;
const SLACK_OF_WAY: f32 = 0.1;
const SLACK_OF_EDGE: f32 = 0.2;

/// The same towards obstacles, and where contact is solved along with the cloth, for all its particles: a share of the fastest one's
/// way, and of what is taken of the fall.
const SLACK_OF_FASTEST: f32 = 0.25;

/// Share of the fall that is taken to happen: nobody knows what is held up, and so neither that comes off its way, nor what
/// falls.
const FALL: f32 = 0.5;

/// How much farther they may come off before there is another search, as a share of the distance between layers.
///
/// Pairs that a search leaves out are farther apart than both their slack and the distance that they keep, 0.8 of that for edges: even
/// so they don't meet.
const LATE: f32 = 0.25;

/// Share of a step for which the ways out of tangles are taken to be the same. They change as these part; but a search in each
/// substep costs up to ten times as much, and parts no more of them. With more than a quarter, implicit skirts fall more slowly.
const TANGLES_LAST: f32 = 0.2;

impl FeatureContacts {
    /// Looks for pairs in what is left of a step of `dt` seconds, of which the part `span` (0..=1) is going on, if it is time to.
    pub(super) fn search(&mut self, cloths: &mut [impl ClothInStep], span: Range<f32>, dt: f32) {
        self.take_places(cloths);
        if self.is_begun && !self.is_outdated(cloths, &span) {
            return;
        }
        if core::mem::replace(&mut self.is_begun, true) {
            self.keep_loads(cloths);
        }
        self.take_velocities(cloths);
        let now = span.start;
        self.searched = now..self.horizon(cloths, span, dt);
        self.take_slack(cloths, dt);
        self.take_ways(cloths, dt);
        self.forget();
        self.fixed.clear();
        self.body_ways.clear();
        self.is_tangled.clear();
        self.is_tangled.resize(self.start.len(), false);
        if self.collides {
            self.search_cloths(cloths);
        }
        for (number, cloth) in cloths.iter().enumerate() {
            self.note_bodies(number, cloth, dt);
            if cloth.is_near() {
                self.search_obstacles(number, cloth, dt);
            }
        }
        let count = self.start.len() + self.fixed.len();
        for points in [&mut self.points.position, &mut self.points.previous] {
            points.resize(count, Vec3A::ZERO);
        }
        self.points.inverse_mass.resize(count, 0.0);
        self.recall_loads(cloths);
    }

    /// Looks for pairs of a cloth with its obstacles.
    fn search_obstacles(&mut self, number: usize, cloth: &impl ClothInStep, dt: f32) {
        let slack = self.obstacle_slack[number];
        let particles = self.particles(number);
        let ways = Displacements { position: &self.start[particles.clone()], way: &self.way[particles], slack: &[] };
        let (first, total) = (self.first[number], self.start.len());
        let at = ClothMotion { cloth, number, first, total, ways, slack, span: self.searched.clone(), dt };
        for i in 0..cloth.ctx().obstacles.len() {
            self.at_obstacle.search(&at, i, &mut self.traversal, (&mut self.fixed, &mut self.pairs));
        }
    }

    /// Whether there should be another search before the part `span` of the step goes on.
    fn is_outdated(&self, cloths: &[impl ClothInStep], span: &Range<f32>) -> bool {
        span.end > self.searched.end
            || !self.tangles.is_empty() && span.start - self.searched.start >= TANGLES_LAST
            || self.collides && !self.is_solved_along && self.has_come_off_to_cloth(cloths, span.end)
            || (self.is_sharp || self.is_solved_along) && self.has_come_off(span.start)
            || self.has_body_come_off(cloths, span.start)
    }

    /// Keeps where particles were when the substep began, for a search, and reads their velocities, as ways.
    fn take_velocities(&mut self, cloths: &[impl ClothInStep]) {
        let count = self.particle_count();
        self.start.clear();
        self.start.extend_from_slice(&self.points.previous[..count]);
        self.way.resize(count, Vec3A::ZERO);
        self.points.inverse_mass.clear();
        for (i, cloth) in cloths.iter().enumerate() {
            let particles = self.particles(i);
            let Lanes { order, velocity, .. } = &cloth.lanes();
            velocity.store(*order, &mut self.way[particles.clone()], cloth.simd_level());
            let masses = (0..particles.len() as u32).map(|particle| cloth.lanes().inverse_mass(order.slot(particle)));
            self.points.inverse_mass.extend(masses);
        }
    }

    /// The moment of the step (0..=1) up to which a search is worth while: the farther things move past each other, the
    /// more is near their ways, and within the length of an edge that is little.
    fn horizon(&self, cloths: &[impl ClothInStep], span: Range<f32>, dt: f32) -> f32 {
        let edge = cloths.iter().map(|cloth| cloth.surface().mean_edge).fold(f32::INFINITY, f32::min);
        let share = edge / (self.fastest(cloths, dt) * dt).max(f32::MIN_POSITIVE);
        (span.start + share).clamp(span.end, 1.0)
    }

    fn mean_velocity(&self) -> Vec3A {
        self.way.iter().sum::<Vec3A>() / self.way.len().max(1) as f32
    }

    /// Speed of what moves past the others fastest, obstacles too, m/s.
    fn fastest(&self, cloths: &[impl ClothInStep], dt: f32) -> f32 {
        let mean = self.mean_velocity();
        let fastest = self.way.iter().map(|velocity| velocity.distance_squared(mean)).fold(0.0, f32::max).sqrt();
        let obstacles = cloths.iter().flat_map(|cloth| cloth.ctx().obstacles);
        let speeds = obstacles.map(|it| ((it.end.translation - it.start.translation) / dt).distance(mean));
        speeds.fold(fastest, f32::max)
    }

    /// Sets by how much particles may come off their ways, from their velocities.
    fn take_slack(&mut self, cloths: &[impl ClothInStep], dt: f32) {
        let left = (self.searched.end - self.searched.start) * dt;
        let (mean, fastest) = (self.mean_velocity(), self.fastest(cloths, dt));
        self.slack.clear();
        self.obstacle_slack.clear();
        for (number, cloth) in cloths.iter().enumerate() {
            let edge = cloth.surface().mean_edge;
            let (least, most) = (SLACK.max(LEAST_SLACK_OF_EDGE * edge), SLACK_OF_EDGE * edge);
            let fall = 0.5 * cloth.ctx().gravity.length() * left * left;
            let of_all = (SLACK + SLACK_OF_FASTEST * fastest * left + FALL * fall).min(most);
            self.obstacle_slack.push(of_all);
            let slack = |velocity: &Vec3A| match self.is_solved_along {
                true => of_all,
                false => (least + SLACK_OF_WAY * left * velocity.distance(mean)).min(most),
            };
            let velocities = &self.way[self.particles(number)];
            self.slack.extend(velocities.iter().map(slack));
        }
    }

    /// Works out how far all particles will come within the time that the search is for.
    fn take_ways(&mut self, cloths: &[impl ClothInStep], dt: f32) {
        let share = self.searched.end - self.searched.start;
        let left = share * dt;
        // Where contact comes after the step, what lies is on its way again in each substep.
        let fall = if self.is_sharp || self.is_solved_along { FALL } else { 0.0 };
        for (number, cloth) in cloths.iter().enumerate() {
            let particles = self.particles(number);
            let fall = cloth.ctx().gravity * (0.5 * fall * left * left);
            let way = &mut self.way[particles];
            way.iter_mut().for_each(|way| *way = *way * left + fall);
            for anchor in cloth.ctx().pin_motions {
                way[anchor.particle as usize] = (anchor.end - anchor.start) * share;
            }
        }
    }

    /// Whether a particle was too far off its way towards what is sharp when a substep began, at the moment `now` (0..=1) of the step.
    fn has_come_off(&self, now: f32) -> bool {
        let most = |number: usize, _| self.obstacle_slack[number];
        self.is_any_off(&self.points.previous, now, most)
    }

    /// Whether a particle is too far off its way towards other cloth at the moment `now` (0..=1) of the step, before pairs are solved.
    fn has_come_off_to_cloth(&self, cloths: &[impl ClothInStep], now: f32) -> bool {
        let late = |cloth: usize| LATE * cloths[cloth].self_distance();
        self.is_any_off(&self.points.position, now, |cloth, particle| self.slack[particle] + late(cloth))
    }

    /// Whether one of the `places` is farther off its way at the moment `now` (0..=1) of the step than is allowed to it.
    fn is_any_off(&self, places: &[Vec3A], now: f32, allowed: impl Fn(usize, usize) -> f32) -> bool {
        let share = (now - self.searched.start) / (self.searched.end - self.searched.start);
        (0..self.first.len() - 1).any(|number| {
            self.particles(number).any(|i| {
                let far = allowed(number, i);
                places[i].distance_squared(self.start[i] + self.way[i] * share) > far * far
            })
        })
    }
}
