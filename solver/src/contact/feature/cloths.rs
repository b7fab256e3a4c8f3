//! The search for pairs of cloths, and of one cloth with itself.

use crate::{
    contact::feature::{
        ClothInStep, FeatureContacts, meet,
        narrow_phase::{self, ContactSide, Displacements, QueryMargin},
        tangle,
    },
    geometry::bvh::bounds::BvhBounds,
    input::SelfCollision,
};

impl FeatureContacts {
    /// Looks for pairs between cloths, and between parts of one.
    pub(crate) fn search_cloths(&mut self, cloths: &[impl ClothInStep]) {
        self.places.resize_with(cloths.len().max(self.places.len()), BvhBounds::default);
        for (i, cloth) in cloths.iter().enumerate() {
            let particles = self.first[i] as usize..self.first[i + 1] as usize;
            let (start, way) = (&self.start[particles.clone()], &self.way[particles]);
            // With a ball against a robust cloth, the larger distance counts.
            let distance = cloth.self_distance(cloth.ctx().settings.self_collision);
            let margin = 0.5 * distance + self.slack[i];
            let ways = Displacements { position: start, way };
            let corners = |triangle: [u32; 3]| triangle.map(|i| start[i as usize]);
            let bounds = |triangle| ways.bounds(triangle).grown(margin);
            self.places[i].follow(cloth.surface(), bounds, Some(corners));
        }
        for i in 0..cloths.len() {
            for j in i..cloths.len() {
                if !meet(cloths[i].ctx(), cloths[j].ctx()) {
                    continue;
                }
                if i != j && !self.places[i].whole().meets(&self.places[j].whole()) {
                    continue;
                }
                self.search_between(cloths, i, j);
            }
        }
    }

    fn search_between(&mut self, cloths: &[impl ClothInStep], i: usize, j: usize) {
        let Self { first, start, way, places, traversal, leaves, pairs, is_tangled, tangles, slack, .. } = self;
        let side = |i: usize| {
            let particles = first[i] as usize..first[i + 1] as usize;
            ContactSide {
                surface: cloths[i].surface(),
                places: &places[i],
                ways: Displacements { position: &start[particles.clone()], way: &way[particles] },
                first: first[i],
                sharper_than: 0.0,
                has_faces: true,
                radii: &[],
            }
        };
        let (a, b) = (side(i), side(j));
        leaves.clear();
        match i == j {
            true => traversal.within(a.surface, a.places, |p, q| leaves.push((p, q))),
            false => traversal.between((a.surface, a.places), (b.surface, b.places), |p, q| leaves.push((p, q))),
        }
        // The more careful of the two ways.
        let mode = cloths[i].ctx().settings.self_collision.max(cloths[j].ctx().settings.self_collision);
        let reach = QueryMargin {
            distance: 0.5 * (cloths[i].self_distance(mode) + cloths[j].self_distance(mode)),
            slack: slack[i] + slack[j],
            friction: 0.5 * (cloths[i].ctx().settings.self_friction + cloths[j].ctx().settings.self_friction),
            rest: (i == j).then_some(&*cloths[i].topology().rest),
        };
        for &(p, q) in &*leaves {
            if mode == SelfCollision::Particles {
                narrow_phase::balls_between((&a, p), (&b, q), &reach, |found| pairs.push(found.pair));
                continue;
            }
            for s in a.surface.of_leaf(p) {
                for t in b.surface.of_leaf(q) {
                    // Of a leaf with itself, each two triangles once.
                    if i == j && p == q && s >= t || !a.places.of_triangles[s].meets(&b.places.of_triangles[t]) {
                        continue;
                    }
                    let (one, other) = (a.surface.triangles[s], b.surface.triangles[t]);
                    if !(i == j && one.iter().any(|corner| other.contains(corner))) {
                        let numbers = [one.map(|k| k + a.first), other.map(|k| k + b.first)];
                        let known = tangles.len();
                        tangle::find(numbers, start, tangles);
                        if tangles.len() > known {
                            for &particle in numbers.as_flattened() {
                                is_tangled[particle as usize] = true;
                            }
                        }
                    }
                    narrow_phase::pairs_between((&a, s), (&b, t), &reach, |found| pairs.push(found.pair));
                }
            }
        }
        // What is tangled finds out by the tangle's own way.
        if !tangles.is_empty() {
            pairs.retain(|pair| pair.points.iter().filter(|&&i| is_tangled[i as usize]).count() < 2);
        }
    }
}
