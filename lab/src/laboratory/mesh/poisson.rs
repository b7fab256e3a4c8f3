//! Points that keep their distance from each other.
//!
//! Bridson, "Fast Poisson Disk Sampling in Arbitrary Dimensions" (2007).

use bevy::math::DVec2;
use delaunator::Point;
use fastrand::Rng;

/// Points that are tried around one before it is given up: Bridson's k.
const TRIES: usize = 30;

/// The same points each time.
const SEED: u64 = 0;

/// The points of `first` and as many more as fit where `has_place`, all of them `distance` or more from each other. The
/// area begins at (0, 0) and ends at `size`.
pub fn sample(size: DVec2, distance: f64, first: Vec<DVec2>, has_place: impl Fn(DVec2) -> bool) -> Vec<DVec2> {
    let mut rng = Rng::with_seed(SEED);
    let mut points = Points::new(size, distance);
    first.into_iter().for_each(|place| points.add(place));
    let mut active: Vec<usize> = (0..points.places.len()).collect();
    while !active.is_empty() {
        let index = rng.usize(..active.len());
        let from = points.places[active[index]];
        let mut near = (0..TRIES).map(|_| from + distance * offset(&mut rng));
        if let Some(place) = near.find(|&place| points.has_room(place) && has_place(place)) {
            active.push(points.places.len());
            points.add(place);
        } else {
            active.swap_remove(index);
        }
    }
    points.places
}

/// Delaunay's triangulation, wound so that it faces up where X and Y become X and Z.
pub fn triangles(points: &[DVec2]) -> Vec<[u32; 3]> {
    let corners: Vec<Point> = points.iter().map(|p| Point { x: p.x, y: p.y }).collect();
    let triangles = delaunator::triangulate(&corners).triangles;
    triangles.as_chunks().0.iter().map(|triangle| triangle.map(|i| i as u32)).collect()
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
    size: DVec2,
    distance: f64,
    /// Bins along both sides.
    bins_along: [usize; 2],
    bins: Vec<Option<usize>>,
}

impl Points {
    fn new(size: DVec2, distance: f64) -> Self {
        let bins_along = (size / distance * 2.0_f64.sqrt()).to_array().map(|bins| bins.ceil() as usize);
        let bins = vec![None; bins_along[0] * bins_along[1]];
        Self { places: Vec::new(), size, distance, bins_along, bins }
    }

    fn add(&mut self, place: DVec2) {
        let [column, row] = self.bin(place);
        self.bins[row * self.bins_along[0] + column] = Some(self.places.len());
        self.places.push(place);
    }

    fn bin(&self, place: DVec2) -> [usize; 2] {
        let share = (place / self.size).to_array();
        // The far border belongs to the last bin.
        [0, 1].map(|axis| ((share[axis] * self.bins_along[axis] as f64) as usize).min(self.bins_along[axis] - 1))
    }

    /// Whether `place` is in the area and far enough from all points.
    fn has_room(&self, place: DVec2) -> bool {
        if place.min_element() < 0.0 || place.cmpgt(self.size).any() {
            return false;
        }
        let [column, row] = self.bin(place);
        let columns = column.saturating_sub(2)..(column + 3).min(self.bins_along[0]);
        let rows = row.saturating_sub(2)..(row + 3).min(self.bins_along[1]);
        let mut near = rows.flat_map(|row| &self.bins[row * self.bins_along[0]..][columns.clone()]).flatten();
        near.all(|&point| self.places[point].distance(place) >= self.distance)
    }
}
