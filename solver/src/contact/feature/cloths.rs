//! The search for pairs of cloths, and of one cloth with itself.

use crate::{
    contact::feature::{
        ClothInStep, FeatureContacts, meet,
        narrow_phase::{self, ContactSide, Displacements, QueryMargin},
        tangle,
        triangle_pack::LeafPacks,
    },
    geometry::bvh::bounds::BvhBounds,
};

/// Distance that edges of cloth keep from each other, as a share of that of corners from faces: these hold layers apart, and the edges
/// of layers that lie on each other are far more pairs.
const EDGE_SHARE: f32 = 0.8;

/// By how much boxes around a cloth's ways are larger than what is in them, m.
fn margin(cloth: &impl ClothInStep) -> f32 {
    0.5 * cloth.self_distance()
}

impl FeatureContacts {
    /// Looks for pairs between cloths, and between parts of one.
    pub(crate) fn search_cloths(&mut self, cloths: &[impl ClothInStep]) {
        self.places.resize_with(cloths.len().max(self.places.len()), BvhBounds::default);
        self.packs.resize_with(cloths.len().max(self.packs.len()), LeafPacks::default);
        for (i, cloth) in cloths.iter().enumerate() {
            let particles = self.first[i] as usize..self.first[i + 1] as usize;
            let (start, way) = (&self.start[particles.clone()], &self.way[particles.clone()]);
            let ways = Displacements { position: start, way, slack: &self.slack[particles] };
            let corners = |triangle: [u32; 3]| triangle.map(|i| start[i as usize]);
            let margin = margin(cloth);
            let bounds = |triangle| ways.bounds(triangle).grown(margin);
            self.places[i].follow(cloth.surface(), bounds, Some(corners));
            self.packs[i].clear(cloth.surface());
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
        let Self {
            first,
            start,
            way,
            places,
            packs,
            traversal,
            leaves,
            pairs,
            is_tangled,
            tangles,
            slack,
            is_solved_along,
            ..
        } = self;
        let side = |i: usize| {
            let particles = first[i] as usize..first[i + 1] as usize;
            ContactSide {
                surface: cloths[i].surface(),
                places: &places[i],
                margin: margin(&cloths[i]),
                ways: Displacements {
                    position: &start[particles.clone()],
                    way: &way[particles.clone()],
                    slack: &slack[particles],
                },
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
        let distance = 0.5 * (cloths[i].self_distance() + cloths[j].self_distance());
        let reach = QueryMargin {
            distance,
            edge_distance: if *is_solved_along { distance } else { EDGE_SHARE * distance },
            slack: 0.0,
            // What is solved along with the cloth may go elsewhere.
            goes_straight: !*is_solved_along,
            friction: 0.5 * (cloths[i].ctx().settings.self_friction + cloths[j].ctx().settings.self_friction),
            rest: (i == j).then_some(&*cloths[i].topology().rest),
        };
        for &(p, q) in &*leaves {
            let (leaf, other_leaf) = (a.surface.of_leaf(p).start, b.surface.of_leaf(q).start);
            packs[i].make(a.surface, p, &a.ways, &a.places.of_triangles);
            packs[j].make(b.surface, q, &b.ways, &b.places.of_triangles);
            let (pack, other_pack) = (packs[i].of_leaf(a.surface, p), packs[j].of_leaf(b.surface, q));
            let planes = if reach.goes_straight { [reach.distance, reach.edge_distance] } else { [f32::INFINITY; 2] };
            pack.near(other_pack, planes, i == j && p == q, cloths[i].simd_level(), |s, t, mask| {
                let (s, t) = (leaf + s, other_leaf + t);
                let (one, other) = (a.surface.triangles[s], b.surface.triangles[t]);
                if mask.may_pierce && !(i == j && one.iter().any(|corner| other.contains(corner))) {
                    let numbers = [one.map(|k| k + a.first), other.map(|k| k + b.first)];
                    let known = tangles.len();
                    tangle::find(numbers, start, tangles);
                    if tangles.len() > known {
                        for &particle in numbers.as_flattened() {
                            is_tangled[particle as usize] = true;
                        }
                    }
                }
                narrow_phase::pairs_between((&a, s), (&b, t), mask, &reach, |found| pairs.push(found.pair));
            });
        }
        // What is tangled finds out by the tangle's own way.
        if !tangles.is_empty() {
            pairs.retain(|pair| pair.points.iter().filter(|&&i| is_tangled[i as usize]).count() < 2);
        }
    }
}
