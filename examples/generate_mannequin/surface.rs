//! The surface of a field as one closed mesh (Gibson's surface nets): a vertex in each cell that the surface crosses,
//! then even spacing over the surface.

use bevy::math::{IVec3, Vec3};

use super::field::{gradient, project};

/// How often vertices move to the middle of their neighbours and back onto the surface.
const RELAXATIONS: usize = 10;

pub struct Surface {
    pub points: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub triangles: Vec<[usize; 3]>,
    pub neighbours: Vec<Vec<usize>>,
}

/// Cells of a side `cell`, from -`corner` to `corner` in x and z, and from below the ground up to its y.
struct Cells {
    cell: f32,
    counts: IVec3,
    corner: Vec3,
    values: Vec<f32>,
}

impl Cells {
    fn new(field: &impl Fn(Vec3) -> f32, cell: f32, reach: Vec3) -> Self {
        let halves = (reach / cell).ceil().as_ivec3();
        let counts = IVec3::new(2 * halves.x + 1, halves.y + 3, 2 * halves.z + 1);
        // The lowest row lies under the soles.
        let corner = Vec3::new(-halves.x as f32, -1.5, -halves.z as f32) * cell;
        let mut cells = Self { cell, counts, corner, values: Vec::new() };
        let places = (0..counts.z).flat_map(|z| (0..counts.y).flat_map(move |y| (0..counts.x).map(move |x| (x, y, z))));
        cells.values = places.map(|(x, y, z)| field(cells.place(IVec3::new(x, y, z)))).collect();
        cells
    }

    fn place(&self, corner: IVec3) -> Vec3 {
        self.corner + corner.as_vec3() * self.cell
    }

    fn index(&self, corner: IVec3) -> usize {
        (corner.x + self.counts.x * (corner.y + self.counts.y * corner.z)) as usize
    }

    fn value(&self, corner: IVec3) -> f32 {
        self.values[self.index(corner)]
    }

    fn all(&self) -> impl Iterator<Item = IVec3> {
        let IVec3 { x, y, z } = self.counts - 1;
        (0..z).flat_map(move |k| (0..y).flat_map(move |j| (0..x).map(move |i| IVec3::new(i, j, k))))
    }

    /// The mean of the places where the surface crosses the cell's edges.
    fn crossing(&self, cell: IVec3) -> Option<Vec3> {
        let (mut sum, mut count) = (Vec3::ZERO, 0.0);
        for start in 0..8 {
            let from = cell + IVec3::new(start & 1, start >> 1 & 1, start >> 2 & 1);
            for axis in IVec3::AXES {
                let to = from + axis;
                if (to - cell).max_element() > 1 {
                    continue;
                }
                let (a, b) = (self.value(from), self.value(to));
                if (a < 0.0) != (b < 0.0) {
                    sum += self.place(from).lerp(self.place(to), a / (a - b));
                    count += 1.0;
                }
            }
        }
        (count > 0.0).then(|| sum / count)
    }
}

/// The surface where `field` is 0, within `reach` of the model's axis.
pub fn surface(field: impl Fn(Vec3) -> f32, cell: f32, reach: Vec3) -> Surface {
    let cells = Cells::new(&field, cell, reach);
    let mut points = Vec::new();
    let mut vertices = vec![usize::MAX; cells.values.len()];
    for place in cells.all() {
        if let Some(point) = cells.crossing(place) {
            vertices[cells.index(place)] = points.len();
            points.push(point);
        }
    }
    let triangles = triangles(&cells, &vertices, &points);
    let neighbours = neighbours(points.len(), &triangles);
    relax(&field, &mut points, &neighbours);
    smooth(&mut points, &neighbours);
    let normals = points.iter().map(|&point| gradient(&field, point).normalize()).collect();
    Surface { points, normals, triangles, neighbours }
}

/// Around each edge of the grid that the surface crosses, the vertices of its four cells make two triangles.
fn triangles(cells: &Cells, vertices: &[usize], points: &[Vec3]) -> Vec<[usize; 3]> {
    let mut triangles = Vec::new();
    for place in cells.all().filter(|place| place.min_element() > 0) {
        for (axis, across, up) in
            [(IVec3::X, IVec3::Y, IVec3::Z), (IVec3::Y, IVec3::Z, IVec3::X), (IVec3::Z, IVec3::X, IVec3::Y)]
        {
            let is_inside = cells.value(place) < 0.0;
            if is_inside == (cells.value(place + axis) < 0.0) {
                continue;
            }
            let mut quad =
                [place - across - up, place - up, place, place - across].map(|cell| vertices[cells.index(cell)]);
            if !is_inside {
                quad.reverse();
            }
            let [a, b, c, d] = quad;
            let is_shorter = points[a].distance_squared(points[c]) < points[b].distance_squared(points[d]);
            triangles.extend(if is_shorter { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
        }
    }
    triangles
}

fn neighbours(count: usize, triangles: &[[usize; 3]]) -> Vec<Vec<usize>> {
    let mut neighbours = vec![Vec::new(); count];
    for &[a, b, c] in triangles {
        // The surface is closed: each edge comes once in each direction.
        for (from, to) in [(a, b), (b, c), (c, a)] {
            neighbours[from].push(to);
        }
    }
    neighbours
}

/// Takes the teeth off edges that are sharper than a cell, without shrinking the rest (Taubin).
fn smooth(points: &mut [Vec3], neighbours: &[Vec<usize>]) {
    for share in [0.5, -0.53].repeat(3) {
        let old = points.to_vec();
        for (point, around) in points.iter_mut().zip(neighbours) {
            *point += (mean(&old, around) - *point) * share;
        }
    }
}

fn mean(points: &[Vec3], around: &[usize]) -> Vec3 {
    around.iter().map(|&other| points[other]).sum::<Vec3>() / around.len() as f32
}

fn relax(field: &impl Fn(Vec3) -> f32, points: &mut [Vec3], neighbours: &[Vec<usize>]) {
    for point in points.iter_mut() {
        *point = project(field, *point, 0.0);
    }
    for _ in 0..RELAXATIONS {
        let old = points.to_vec();
        for (point, around) in points.iter_mut().zip(neighbours) {
            *point = project(field, point.lerp(mean(&old, around), 0.5), 0.0);
        }
    }
}
