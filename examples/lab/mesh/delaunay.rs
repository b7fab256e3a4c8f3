//! An irregular square metre: points that keep their distance, joined by Delaunay's triangulation.
//!
//! Bridson, "Fast Poisson Disk Sampling in Arbitrary Dimensions" (2007). Points as far from each other as those of the
//! border leave no narrow triangle there: whatever is close to the border is part of it.

use bevy::{math::DVec2, prelude::*};
use delaunator::Point;
use fastrand::Rng;

use super::Sheet;

/// Points that are tried around one before it is given up: Bridson's k.
const TRIES: usize = 30;

/// The same points each time.
const SEED: u64 = 0;

/// About `n` x `n` vertices, the border first, then in the order of sampling: neighbours in the cloth are strewn over
/// memory as in no other mesh here.
pub fn sheet(n: u32) -> Sheet {
    // Fitted: so many steps along each side give n² vertices in all, up to 5 % more or less at n = 16, 1 % at 64.
    let along_side = (1.2745 * n as f32 - 1.85).round().max(1.0) as u32;
    let points = sample(along_side);
    let corners: Vec<Point> = points.iter().map(|p| Point { x: p.x, y: p.y }).collect();
    let triangles: Vec<[u32; 3]> = delaunator::triangulate(&corners)
        .triangles
        .as_chunks()
        .0
        .iter()
        // Wound as they come they face up.
        .map(|triangle| triangle.map(|i| i as u32))
        .collect();
    super::square(points.iter().map(|p| p.as_vec2()).collect(), &triangles)
}

/// Points of the unit square, `along_side` steps of the border apart from each other or more.
fn sample(along_side: u32) -> Vec<DVec2> {
    let mut rng = Rng::with_seed(SEED);
    let mut points = Points::new(along_side);
    let mut active: Vec<usize> = (0..points.places.len()).collect();
    while !active.is_empty() {
        let index = rng.usize(..active.len());
        let from = points.places[active[index]];
        let near = (0..TRIES).map(|_| from + points.distance * offset(&mut rng)).find(|&place| points.has_room(place));
        if let Some(place) = near {
            active.push(points.places.len());
            points.add(place);
        } else {
            active.swap_remove(index);
        }
    }
    points.places
}

/// A vector of length 1 to 2 in any direction.
fn offset(rng: &mut Rng) -> DVec2 {
    loop {
        let offset = DVec2::new(4.0 * rng.f64() - 2.0, 4.0 * rng.f64() - 2.0);
        if (1.0..4.0).contains(&offset.length_squared()) {
            return offset;
        }
    }
}

/// Points that keep their distance, in bins that hold one at most.
struct Points {
    places: Vec<DVec2>,
    /// Least distance.
    distance: f64,
    /// Bins along a side.
    side: usize,
    bins: Vec<Option<usize>>,
}

impl Points {
    /// Those of the border, the four corners among them.
    fn new(along_side: u32) -> Self {
        let side = (f64::from(along_side) * 2.0_f64.sqrt()).ceil() as usize;
        let distance = 1.0 / f64::from(along_side);
        let mut points = Self { places: Vec::new(), distance, side, bins: vec![None; side * side] };
        for step in 0..along_side {
            let along = f64::from(step) / f64::from(along_side);
            for place in [(along, 0.0), (1.0, along), (1.0 - along, 1.0), (0.0, 1.0 - along)] {
                points.add(place.into());
            }
        }
        points
    }

    fn add(&mut self, place: DVec2) {
        let [column, row] = self.bin(place);
        self.bins[row * self.side + column] = Some(self.places.len());
        self.places.push(place);
    }

    fn bin(&self, place: DVec2) -> [usize; 2] {
        // The far border belongs to the last bin.
        place.to_array().map(|along| ((along * self.side as f64) as usize).min(self.side - 1))
    }

    /// Whether `place` is in the square and far enough from all points.
    fn has_room(&self, place: DVec2) -> bool {
        if place.min_element() < 0.0 || place.max_element() > 1.0 {
            return false;
        }
        let [columns, rows] = self.bin(place).map(|bin| bin.saturating_sub(2)..(bin + 3).min(self.side));
        let mut near = rows.flat_map(|row| &self.bins[row * self.side..][columns.clone()]).flatten();
        near.all(|&point| self.places[point].distance(place) >= self.distance)
    }
}
