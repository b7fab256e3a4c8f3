//! Pairs that will touch, for the implicit steps of cloths: their contact is solved along with the cloth.
//!
//! Only of pairs of cloths that all have implicit steps, and with obstacles that they don't push: what happens to another cloth, or
//! a body, isn't known meanwhile.

use core::ops::Range;

use bevy_math::Vec3A;

use crate::{
    constraint::implicit::{
        between::{ContactBetween, ContactsBetween},
        contact::PredictedContact,
    },
    contact::{
        feature::{
            ClothInStep, FeatureContacts,
            pair::{FeatureContact, FeaturePoints, Separation},
        },
        friction,
    },
    particles::contact_load::FeatureLoad,
};

/// A pair that will touch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PredictedPair {
    /// Numbers of the cloth and of the pair.
    cloth: u32,
    pair: u32,
    contact: PredictedContact,
}

/// In the key of a pair: a point of an obstacle, and by how many bits the number of that is shifted.
const OF_OBSTACLE: u32 = 1 << 31;
const OBSTACLE_SHIFT: u32 = 16;

impl FeatureContacts {
    /// Predicts which pairs will touch within the part `span` (0..=1) of the step, a substep of `h` seconds, and tells the cloths
    /// that have an implicit step.
    pub fn predict(&mut self, cloths: &mut [impl ClothInStep], span: Range<f32>, h: f32, dt: f32) {
        self.predicted.clear();
        self.between.predicted.clear();
        self.pairs_between.clear();
        self.is_searched = cloths.iter().any(ClothInStep::is_implicit);
        if !self.is_searched {
            return;
        }
        self.search(cloths, span.clone(), dt);
        self.lead_fixed(cloths, span);
        for (i, pair) in (0..).zip(&mut self.pairs) {
            pair.is_solved_by_cloth = false;
            let Some(number) = self.first[1..].iter().position(|&end| pair.points.iter().any(|&point| point < end))
            else {
                continue;
            };
            let (own, cloth) = (self.first[number]..self.first[number + 1], &cloths[number]);
            let count = self.start.len();
            let is_fixed = |point: u32| {
                let fixed = self.fixed.get((point as usize).wrapping_sub(count));
                fixed.is_some_and(|fixed| cloth.bodies().get(fixed.obstacle as usize).is_none())
            };
            if let Some(other) = (number + 1..cloths.len()).find(|&other| pair.is_of(&self.first[other..])) {
                if cloth.is_implicit() && cloths[other].is_implicit() {
                    pair.is_solved_by_cloth = true;
                    let ranges = [number, other].map(|i| self.first[i]..self.first[i + 1]);
                    if let Some(sides) = pair.predict_between(&self.points, ranges) {
                        self.between.predicted.push(ContactBetween { sheets: [number as u32, other as u32], sides });
                        self.pairs_between.push(i);
                    }
                }
                continue;
            }
            if !cloth.is_implicit() || !pair.points.iter().all(|&point| own.contains(&point) || is_fixed(point)) {
                continue;
            }
            let free_fall = cloth.ctx().gravity * (h * h);
            let contact = pair.predict(&self.points, own, free_fall);
            pair.is_solved_by_cloth =
                contact.is_none_or(|contact| !contact.is_tiny(&cloth.topology().areas, free_fall));
            if let Some(contact) = contact {
                self.predicted.push(PredictedPair { cloth: number as u32, pair: i, contact });
            }
        }
        for (number, cloth) in (0..).zip(cloths) {
            let of_cloth = self.predicted.iter().filter(|predicted| predicted.cloth == number);
            cloth.predicted_mut().extend(of_cloth.map(|predicted| predicted.contact));
        }
    }

    /// Reads the normal forces of the predicted pairs from the cloths that have been solved.
    pub(crate) fn read_loads(&mut self, cloths: &[impl ClothInStep]) {
        self.pairs.iter_mut().for_each(|pair| pair.load = 0.0);
        for (number, cloth) in (0..).zip(cloths) {
            let of_cloth = self.predicted.iter().filter(|predicted| predicted.cloth == number);
            for (predicted, solved) in of_cloth.zip(cloth.predicted()) {
                self.pairs[predicted.pair as usize].load = solved.load;
            }
        }
        for (&pair, solved) in self.pairs_between.iter().zip(&self.between.predicted) {
            self.pairs[pair as usize].load = solved.sides[0].load;
        }
    }

    /// The contacts between cloths that are solved as one system.
    pub fn between_mut(&mut self) -> &mut ContactsBetween {
        &mut self.between
    }

    /// Hands normal forces over to the cloths, for pairs that another search finds, or another step.
    pub fn keep_loads(&mut self, cloths: &mut [impl ClothInStep]) {
        for (number, cloth) in cloths.iter_mut().enumerate() {
            let own = self.first.get(number).copied().unwrap_or(0)..self.first.get(number + 1).copied().unwrap_or(0);
            let pairs = self.pairs.iter().filter(|pair| pair.load > 0.0);
            let of_cloth = pairs.filter(|pair| pair.points.iter().any(|point| own.contains(point)));
            let loads = cloth.feature_loads_mut();
            loads.clear();
            loads.extend(of_cloth.map(|pair| FeatureLoad { key: self.key(pair, own.start), force: pair.load }));
            loads.sort_unstable_by_key(|load| load.key);
        }
    }

    /// Takes normal forces back from the cloths, after a search.
    pub(crate) fn recall_loads(&mut self, cloths: &[impl ClothInStep]) {
        for (number, cloth) in cloths.iter().enumerate() {
            let loads = cloth.feature_loads();
            if loads.is_empty() {
                continue;
            }
            let own = self.first[number]..self.first[number + 1];
            for i in 0..self.pairs.len() {
                let pair = &self.pairs[i];
                if !pair.points.iter().any(|point| own.contains(point)) {
                    continue;
                }
                let key = self.key(pair, own.start);
                if let Ok(known) = loads.binary_search_by_key(&key, |load| load.key) {
                    self.pairs[i].load = loads[known].force;
                }
            }
        }
    }

    /// What a pair is of, whatever search has found it: particles by their numbers in the cloth whose `first` that is. Points of
    /// meshes beyond 65,536 may share a key: then friction begins with the force of another pair.
    fn key(&self, pair: &FeatureContact, first: u32) -> [u32; 4] {
        pair.points.map(|point| match self.fixed.get((point as usize).wrapping_sub(self.start.len())) {
            Some(fixed) => OF_OBSTACLE | fixed.obstacle << OBSTACLE_SHIFT | fixed.point,
            None => point.wrapping_sub(first),
        })
    }
}

impl FeatureContact {
    /// Whether it has a point of the cloth whose points begin with the first of these numbers, and end with the next.
    fn is_of(&self, ends: &[u32]) -> bool {
        self.points.iter().any(|point| (ends[0]..ends[1]).contains(point))
    }

    /// The contact that the features will come to within a substep, if the points of their cloth, those of the numbers `own`, go on
    /// as they do and have a `free_fall`, m.
    fn predict(&self, points: &FeaturePoints, own: Range<u32>, free_fall: Vec3A) -> Option<PredictedContact> {
        if self.is_beyond(points, self.distance + self.taper.max(0.0) + free_fall.length()) {
            return None;
        }
        let apart = self.separation(points);
        let side = self.side(&apart, points, own.clone())?;
        let fall = apart.normal.dot(free_fall) * side.weights.iter().sum::<f32>();
        if apart.gap + fall.min(0.0) >= apart.distance {
            return None;
        }
        let of_others = self.points.into_iter().zip(apart.weights).filter(|(point, _)| !own.contains(point));
        let moved = |i: usize| points.position[i] - points.previous[i];
        // Their weights are negative.
        let way = -of_others.map(|(point, weight)| moved(point as usize) * weight).sum::<Vec3A>();
        Some(PredictedContact { way, ..side })
    }

    /// The same of two cloths, whose points are those of the numbers `ranges`: the part of each. They fall alike.
    fn predict_between(&self, points: &FeaturePoints, ranges: [Range<u32>; 2]) -> Option<[PredictedContact; 2]> {
        if self.is_beyond(points, self.distance + self.taper.max(0.0)) {
            return None;
        }
        let apart = self.separation(points);
        let [one, other] = ranges.map(|range| self.side(&apart, points, range));
        (apart.gap < apart.distance).then_some([one?, other?])
    }

    /// The part that the points of the numbers `own` have in a contact.
    fn side(&self, apart: &Separation, points: &FeaturePoints, own: Range<u32>) -> Option<PredictedContact> {
        let some = self.points.into_iter().find(|point| own.contains(point))?;
        let is_own = self.points.map(|point| own.contains(&point));
        let inverse_masses = self.points.map(|i| points.inverse_mass[i as usize]);
        Some(PredictedContact {
            inverse_mass: friction::effective_inverse_mass(apart.weights, inverse_masses),
            particles: self.points.map(|point| if own.contains(&point) { point } else { some } - own.start),
            count: 4,
            weights: core::array::from_fn(|k| if is_own[k] { apart.weights[k] } else { 0.0 }),
            normal: apart.normal,
            way: Vec3A::ZERO,
            friction: self.friction,
            load: self.load,
        })
    }
}
