//! Puts springs, triangles and areas of a rest shape together.

use std::sync::OnceLock;

use bevy_math::{Vec2, Vec3};

use super::{
    bends,
    cells::{self, CellBounds, Cells},
    chart, coloring,
    edges::Edges,
    faces,
    grouped::Grouped,
    hinges,
    lattice::{self, Rectangle},
    levels,
    plate::Plate,
    rate, shares, springs, strand_packs, strands, two_grid,
};
use crate::{
    build::MeshError,
    topology::{BendBatch, Spring, Topology, bend_pack::BendPack, face_pack::FacePack},
};

/// A triangle with less area than this share of its longest side squared is a sliver.
const SLIVER: f32 = 1e-6;

/// Rows and columns of uneven cells that zigzag by more than this, rad, aren't taken for such: with 0.1, a flag of 24 x 24 vertices
/// strains by 4 % under its own weight.
const MOST_ZIGZAG: f32 = 0.05;

/// What the triangles of a mesh form.
#[derive(Debug)]
pub(super) struct Shape {
    triangles: Vec<[u32; 3]>,
    /// The mesh's number of each triangle.
    numbers: Vec<usize>,
    slivers: Vec<[u32; 3]>,
    pub edges: Edges,
    cells: Cells,
    pub rectangle: Option<Rectangle>,
}

impl Shape {
    /// Looks at particles at `rest` (m) joined by `triangles`.
    ///
    /// Triangles that repeat others, as the back of a sheet modelled with two sides does, count once. Triangles without
    /// area keep their edges as springs, and neither weigh nor catch wind.
    pub fn find(rest: &[Vec3], triangles: &[[u32; 3]]) -> Result<Self, MeshError> {
        let (kept, slivers) = sort_out(rest, triangles);
        let (numbers, triangles): (Vec<usize>, Vec<[u32; 3]>) = kept.into_iter().unzip();
        if triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        let edges = Edges::new(rest.len(), &triangles);
        let even = cells::find(rest, &triangles, &edges, CellBounds::EVEN);
        let rectangle = lattice::find(&even, rest.len());
        let uneven = || {
            let cells = cells::find(rest, &triangles, &edges, CellBounds::UNEVEN);
            let is_even_on_the_whole = cells.mean_skew(rest) <= CellBounds::MOST_ON_AVERAGE;
            let goes_straight_on = |rectangle: &Rectangle| rectangle.zigzag(rest) <= MOST_ZIGZAG;
            Some((lattice::find(&cells, rest.len()).filter(|_| is_even_on_the_whole).filter(goes_straight_on)?, cells))
        };
        let is_in_question = rectangle.is_none() && even.hold(CellBounds::LEAST_EVEN);
        let (rectangle, cells) = match is_in_question.then(uneven).flatten() {
            Some((rectangle, cells)) => (Some(rectangle), cells),
            None => (rectangle, even),
        };
        Ok(Self { triangles, numbers, slivers, edges, cells, rectangle })
    }
}

/// The topology of the particles at `rest` (m) that form a `shape`. `uvs` are those of the particles, where they have
/// one each, and `warp` is the direction of the warp in each of the mesh's triangles.
pub(super) fn build(rest: Vec<Vec3>, shape: Shape, uvs: Option<Vec<Vec2>>, warp: &[Vec3]) -> Topology {
    let Shape { triangles, numbers, slivers, edges, cells, rectangle } = shape;
    let warp: Vec<Vec3> = numbers.into_iter().map(|number| warp[number]).collect();
    let links = springs::find(&rest, &triangles, &slivers, &edges, &cells);
    let with_length = |&(kind, a, b): &springs::Link| {
        let length = rest[a as usize].distance(rest[b as usize]);
        (kind, Spring { a, b, rest: length, ..Spring::default() })
    };
    let mut all: Vec<_> = links.iter().map(with_length).collect();
    let rectangle = rectangle.filter(Rectangle::is_in_order);
    // Where there are no rows and columns, triangles carry by themselves.
    let carrying = if rectangle.is_some() { cells.clone() } else { cells.without_all() };
    shares::share_out(&rest, &carrying, &slivers, &warp, &mut all);
    let plate = rectangle.as_ref().map(|rectangle| Plate::new(&rest, rectangle));
    let on_strands =
        rectangle.as_ref().zip(plate.as_ref()).map(|(rectangle, plate)| lattice::of_rectangle(rectangle, plate, &all));
    let (lattice, strand_packs, on_strands) = match on_strands {
        Some((lattice, on_strands)) => (Some(lattice), Vec::new(), on_strands),
        None => {
            let strands = strands::find(&rest, &edges, &all);
            let (strand_packs, on_strands) = strand_packs::pack(rest.len(), &strands, &all);
            (None, strand_packs, on_strands)
        }
    };
    let levels = match &lattice {
        Some(lattice) => levels::of_lattice(lattice),
        None => chart::find(&rest, &triangles, uvs)
            .map(|chart| levels::of_chart(&rest, &triangles, &chart))
            .unwrap_or_default(),
    };
    let (springs, batches) = coloring::batches(rest.len(), &all, &on_strands);
    let triangle_areas: Vec<f32> = triangles.iter().map(|triangle| triangle_area(&rest, triangle)).collect();
    let areas = particle_areas(rest.len(), &triangles, &triangle_areas);
    let (faces, face_batches) = faces::find(&rest, &triangles, &carrying, &warp);
    let (bends, bend_batches) = match &plate {
        Some(plate) => bends::of_plate(plate, rest.len()),
        None => bends::of_hinges(hinges::find(&rest, &edges, &areas, &triangle_areas, &warp)),
    };
    let nobody = rest.len() as u32;
    let face_packs = face_batches.iter().map(|run| FacePack::new(&faces[run.clone()], nobody)).collect();
    let bend_pack = |batch: &BendBatch| BendPack::new(&bends[batch.range.clone()], nobody);
    let bend_packs = if lattice.is_none() { bend_batches.iter().map(bend_pack).collect() } else { Vec::new() };
    let two_grid = lattice.is_none().then(|| {
        let carrying: Vec<Spring> = springs.iter().copied().filter(|spring| spring.share != [0.0; 3]).collect();
        two_grid::find(&areas, &faces, &carrying, &bends)
    });
    // Those of a lattice are seldom solved one by one: what takes less time to find is good enough.
    let bend_rate = if lattice.is_some() { rate::bound(&bends, &areas) } else { rate::of_bends(&bends, &areas) };
    Topology {
        rest,
        springs,
        batches,
        triangles,
        triangle_areas,
        areas,
        cells: cells.corners,
        lattice,
        strand_packs,
        levels,
        faces,
        face_batches,
        face_packs,
        two_grid,
        is_curved: bends.iter().any(|bend| bend.rest != [0.0; 3]),
        bend_rate,
        bends,
        bend_batches,
        bend_packs,
        surface: OnceLock::new(),
    }
}

/// Splits triangles with distinct corners into those with an area, with their numbers, and slivers, and drops repetitions.
fn sort_out(rest: &[Vec3], triangles: &[[u32; 3]]) -> (Vec<(usize, [u32; 3])>, Vec<[u32; 3]>) {
    let repeats = repetitions(rest.len(), triangles);
    let (kept, slivers): (Vec<_>, Vec<_>) = triangles
        .iter()
        .copied()
        .enumerate()
        .zip(repeats)
        .filter(|&((_, [i, j, k]), repeats)| !repeats && i != j && j != k && k != i)
        .map(|(triangle, _)| triangle)
        .partition(|(_, triangle)| {
            let [a, b, c] = triangle.map(|i| rest[i as usize]);
            let sides = [b - a, c - b, a - c];
            let longest = sides.map(Vec3::length_squared).into_iter().fold(0.0, f32::max);
            triangle_area(rest, triangle) > SLIVER * longest
        });
    (kept, slivers.into_iter().map(|(_, triangle)| triangle).collect())
}

/// Whether each triangle has the same corners as one before it.
fn repetitions(count: usize, triangles: &[[u32; 3]]) -> Vec<bool> {
    let corners = (0..).zip(triangles).map(|(number, &triangle): (u32, _)| {
        let mut corners = triangle;
        corners.sort_unstable();
        (corners[0], (corners[1], corners[2], number))
    });
    let mut at_lowest = Grouped::new(count, corners);
    let mut repeats = vec![false; triangles.len()];
    for at_lowest in at_lowest.iter_mut() {
        at_lowest.sort_unstable();
        for [(p, q, _), (r, s, number)] in at_lowest.array_windows() {
            repeats[*number as usize] = (p, q) == (r, s);
        }
    }
    repeats
}

/// Area that each particle stands for, m². One without a triangle's area gets the mean, so that it isn't weightless.
fn particle_areas(count: usize, triangles: &[[u32; 3]], triangle_areas: &[f32]) -> Vec<f32> {
    let mut areas = vec![0.0; count];
    for (triangle, area) in triangles.iter().zip(triangle_areas) {
        for &particle in triangle {
            areas[particle as usize] += area / 3.0;
        }
    }
    let mean = areas.iter().sum::<f32>() / areas.len() as f32;
    for area in areas.iter_mut().filter(|area| **area == 0.0) {
        *area = mean;
    }
    areas
}

/// Area of a triangle, m².
fn triangle_area(rest: &[Vec3], triangle: &[u32; 3]) -> f32 {
    let [a, b, c] = triangle.map(|i| rest[i as usize]);
    0.5 * (b - a).cross(c - a).length()
}
