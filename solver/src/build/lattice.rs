//! Finds rows and columns: whether the cells of a mesh form one rectangle, or a tube that can be cut open into one.
//!
//! ```text
//!   p --- along --- .       the first row of cells, walked across its upright sides
//!   |       |       |
//!  down --- . ----- .       and down from there, row after row, across the level ones
//! ```

use bevy_math::Vec3;

use super::{
    cells::Cells,
    grouped::Grouped,
    plate::{ENDS, Plate},
};
use crate::{Bend, Grain, Lattice, Spring, SpringKind, topology::lattice::Link};

/// Particles row after row, as they stand in the mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Rectangle {
    pub columns: usize,
    /// Whether the last column is joined to the first: it is a tube, cut open.
    pub closed: bool,
    /// Particles of all rows.
    pub particles: Vec<u32>,
}

impl Rectangle {
    /// Whether the particles are numbered row by row.
    pub fn is_in_order(&self) -> bool {
        (0..).zip(&self.particles).all(|(i, &particle)| i == particle)
    }

    /// How far rows and columns zigzag, rad: half of what they turn within the surface at one particle other than at the next, on average.
    /// Those of a flare turn everywhere alike. Chains that zigzag are longer than where they lead, and give way.
    pub fn zigzag(&self, rest: &[Vec3]) -> f32 {
        let (columns, rows) = (self.columns, self.particles.len() / self.columns.max(1));
        let place = |row: usize, column: usize| rest[self.particles[row * columns + column] as usize];
        let (mut sum, mut count) = (0.0, 0);
        let mut add = |turns: &[f32]| {
            sum += turns.windows(2).map(|pair| (pair[1] - pair[0]).abs() / 2.0).sum::<f32>();
            count += turns.len().saturating_sub(1);
        };
        let turn = |before: Vec3, at: Vec3, after: Vec3, across: Vec3| {
            let (to, from) = ((at - before).normalize_or_zero(), (after - at).normalize_or_zero());
            let normal = (to + from).cross(across).normalize_or_zero();
            to.cross(from).dot(normal)
        };
        for row in 1..rows.saturating_sub(1) {
            let at = |column: usize| {
                let across = place(row + 1, column) - place(row - 1, column);
                turn(place(row, column - 1), place(row, column), place(row, column + 1), across)
            };
            add(&(1..columns - 1).map(at).collect::<Vec<_>>());
        }
        for column in 1..columns.saturating_sub(1) {
            let at = |row: usize| {
                let across = place(row, column + 1) - place(row, column - 1);
                turn(place(row - 1, column), place(row, column), place(row + 1, column), across)
            };
            add(&(1..rows - 1).map(at).collect::<Vec<_>>());
        }
        sum / count.max(1) as f32
    }
}

/// The rectangle that all `count` particles of a mesh are in, if they are in one.
///
/// It begins at the lowest particle that may be a corner and goes on towards its lowest neighbour: a grid that is
/// numbered row by row keeps its numbers.
pub(super) fn find(cells: &Cells, count: usize) -> Option<Rectangle> {
    let mesh = CellMesh::new(cells, count)?;
    mesh.starts().into_iter().find_map(|start| mesh.rectangle_from(start, count))
}

/// A side of a cell.
type Side = (u32, u32);

/// Cells and those beside them.
struct CellMesh<'a> {
    corners: &'a [[u32; 4]],
    /// The cell across each side of each cell, if there is one: the first side goes from the first corner to the second.
    neighbours: Vec<[Option<u32>; 4]>,
}

impl<'a> CellMesh<'a> {
    /// None where a triangle isn't in a cell or a side has more than two cells.
    fn new(cells: &'a Cells, count: usize) -> Option<Self> {
        if cells.of_triangle.iter().any(Option::is_none) {
            return None;
        }
        let sides = (0..).zip(&cells.corners).flat_map(|(cell, corners)| {
            (0..4).map(move |i| {
                let (low, high) = sorted((corners[i], corners[(i + 1) % 4]));
                (low, (high, cell, i))
            })
        });
        let mut sides: Grouped<(u32, u32, usize)> = Grouped::new(count, sides);
        let mut neighbours = vec![[None; 4]; cells.corners.len()];
        for sides in sides.iter_mut() {
            sides.sort_unstable();
            for side in sides.chunk_by(|(p, ..), (q, ..)| p == q) {
                match *side {
                    [_] => {}
                    [(_, one, i), (_, other, j)] => {
                        neighbours[one as usize][i] = Some(other);
                        neighbours[other as usize][j] = Some(one);
                    }
                    _ => return None,
                }
            }
        }
        Some(Self { corners: &cells.corners, neighbours })
    }

    /// Cells and their sides to start from: at a corner of the whole if it has one, else at its border, else anywhere,
    /// and there at the lowest particle.
    fn starts(&self) -> Vec<(u32, Side)> {
        let corners = || (0..).zip(self.corners).flat_map(|(cell, c)| (0..4).map(move |i| (cell, c[i], i)));
        // How many of the two sides at a corner of a cell are inside, and the particle there.
        let rank = |(cell, p, i): (u32, u32, usize)| {
            let neighbours = &self.neighbours[cell as usize];
            let inside = [neighbours[i], neighbours[(i + 3) % 4]];
            (inside.iter().flatten().count(), p)
        };
        let best = corners().map(rank).min();
        let equal = corners().filter(|&corner| Some(rank(corner)) == best);
        let mut starts: Vec<(Side, u32)> = equal
            .flat_map(|(cell, p, i)| {
                let c = &self.corners[cell as usize];
                [((p, c[(i + 1) % 4]), cell), ((p, c[(i + 3) % 4]), cell)]
            })
            .collect();
        starts.sort_unstable();
        starts.into_iter().map(|(side, cell)| (cell, side)).collect()
    }

    fn rectangle_from(&self, (cell, (p, along)): (u32, Side), count: usize) -> Option<Rectangle> {
        let below = self.opposite(cell, (p, along))?;
        let (mut above, mut row, mut cells) = (vec![p, along], vec![below.0, below.1], vec![cell]);
        let (mut cell, mut side) = (cell, (along, below.1));
        let mut closed = false;
        while let Some(next) = self.across(cell, side)
            && let Some((p, q)) = self.opposite(next, side)
        {
            // A tube is cut open where the row comes back to its first particle.
            closed = p == above[0];
            if closed {
                break;
            }
            above.push(p);
            row.push(q);
            cells.push(next);
            (cell, side) = (next, (p, q));
        }
        let columns = row.len();
        let mut particles = [above, row.clone()].concat();
        while particles.len() < count {
            row = self.next_row(&row, &mut cells)?;
            particles.extend(&row);
        }
        let mut seen = vec![false; count];
        let is_new = |&particle: &u32| !core::mem::replace(&mut seen[particle as usize], true);
        (particles.len() == count && particles.iter().all(is_new)).then_some(Rectangle { columns, closed, particles })
    }

    /// The particles below a row, given the `cells` above it, which become those below it.
    fn next_row(&self, row: &[u32], cells: &mut [u32]) -> Option<Vec<u32>> {
        let mut next = Vec::with_capacity(row.len());
        for (cell, side) in cells.iter_mut().zip(row.windows(2)) {
            let side = (side[0], side[1]);
            *cell = self.across(*cell, side)?;
            let (p, q) = self.opposite(*cell, side)?;
            match next.last() {
                None => next.extend([p, q]),
                Some(&last) if last == p => next.push(q),
                Some(_) => return None,
            }
        }
        Some(next)
    }

    /// The cell on the other side of a cell's side.
    fn across(&self, cell: u32, (p, q): Side) -> Option<u32> {
        let c = self.corners[cell as usize];
        let side = (0..4).find(|&i| sorted((c[i], c[(i + 1) % 4])) == sorted((p, q)))?;
        self.neighbours[cell as usize][side]
    }

    /// The corners opposite a side's ends, in their order.
    fn opposite(&self, cell: u32, (p, q): Side) -> Option<Side> {
        let c = self.corners[cell as usize];
        let i = c.iter().position(|&corner| corner == p)?;
        let (after, across, before) = (c[(i + 1) % 4], c[(i + 2) % 4], c[(i + 3) % 4]);
        match q {
            q if q == after => Some((before, across)),
            q if q == before => Some((after, across)),
            _ => None,
        }
    }
}

fn sorted((p, q): Side) -> Side {
    (p.min(q), p.max(q))
}

/// Ways from a particle to those that the springs of a lattice join it with.
const WAYS: [(SpringKind, (isize, isize)); 6] = [
    (SpringKind::Structural, (0, 1)),
    (SpringKind::Structural, (1, 0)),
    (SpringKind::Shear, (1, 1)),
    (SpringKind::Shear, (1, -1)),
    (SpringKind::Bend, (0, 2)),
    (SpringKind::Bend, (2, 0)),
];

/// No spring.
const NONE: u32 = u32::MAX;

/// The lattice of the particles of a rectangle, numbered row by row, which bend as a `plate`, and whether each of `springs`
/// is on it.
pub(super) fn of_rectangle(
    rectangle: &Rectangle,
    plate: &Plate,
    springs: &[(SpringKind, Spring)],
) -> (Lattice, Vec<bool>) {
    let Rectangle { columns, closed, particles } = rectangle;
    let (columns, closed) = (*columns, *closed);
    let place = |particle: u32| (particle as usize / columns, particle as usize % columns);
    let mut numbers = vec![[NONE; WAYS.len()]; particles.len()];
    let mut put = |(number, &(kind, Spring { a, b, rest, .. })): (u32, &(SpringKind, Spring))| {
        let (first, second) = (a.min(b), a.max(b));
        let (from, to) = (place(first), place(second));
        let way = (to.0 as isize - from.0 as isize, to.1 as isize - from.1 as isize);
        let closes = closed && columns > 2 && way == (0, columns as isize - 1);
        let (from, way) = if closes { (second, (0, 1)) } else { (first, way) };
        let known = WAYS.iter().position(|&known| known == (kind, way));
        known.is_some_and(|known| {
            let known = &mut numbers[from as usize][known];
            let is_new = *known == NONE && rest > 0.0;
            if is_new {
                *known = number;
            }
            is_new
        })
    };
    let on_lattice = (0..).zip(springs).map(&mut put).collect();
    let spring = |(row, column): (usize, usize), way| {
        let known = WAYS.iter().position(|&(_, known)| known == way)?;
        springs.get(numbers[row * columns + column][known] as usize).map(|(_, spring)| *spring)
    };
    let rows = particles.len() / columns;
    let grain = grain_of_columns((0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))), spring);
    let link = |at: (usize, usize), way: (isize, isize)| {
        let Spring { rest, share: [warp, weft, shear], .. } = spring(at, way).unwrap_or_default();
        let (row, column) = at;
        let ends = |bend: Option<Bend>| bend.map_or([0.0; 2], |bend| ENDS.map(|end| bend.weights[end]));
        let (shares, weights) = match way {
            (0, 2) => ([0.0; 2], ends(plate.along_row((row, column + 1)))),
            (2, 0) => ([0.0; 2], ends(plate.along_column((row + 1, column)))),
            (1, 1) => ([shear, 0.0], ends(plate.twist(at))),
            (1, -1) => ([shear, 0.0], [0.0; 2]),
            _ => ([warp + weft, -shear], [0.0; 2]),
        };
        Link { rest, shares, weights }
    };
    let curl = plate.curl().map(Box::new);
    (Lattice { curl, ..Lattice::new(rows, columns, closed, grain, link) }, on_lattice)
}

/// The direction that columns are along, rather than the other.
fn grain_of_columns(
    places: impl Iterator<Item = (usize, usize)>,
    spring: impl Fn((usize, usize), (isize, isize)) -> Option<Spring>,
) -> Grain {
    let shares = places.filter_map(|at| spring(at, (1, 0))).map(|spring| spring.share[0] - spring.share[1]);
    if shares.sum::<f32>() >= 0.0 { Grain::Warp } else { Grain::Weft }
}
