//! Sheets that are solved as one linear system: one by itself, or several that touch each other.

use fearless_simd::dispatch;

use crate::{
    constraint::implicit::{
        ITERATIONS, ImplicitBuffers, ImplicitSheet,
        between::ContactsBetween,
        direction::Direction,
        vectors::{self, point},
    },
    layout::{points::Points, simd::SimdLevel},
    particles::{gathered::GatheredParticles, lanes::Lanes},
};

/// The inertia is rough where the best step along it undoes this share of it, or more: no unit.
///
/// Cloth that swings freely undoes 0.04 at most, but for moments. At 0.2 some skirts fall half as fast.
const ROUGH: f32 = 0.05;

/// Root mean square speed below which the inertia is the first direction even if it is rough, m/s: cloth that is about to rest may be
/// stopped as a whole, and rests the sooner.
const SWIFT: f32 = 0.01;

/// A sheet in a substep.
pub(crate) struct SheetSystem<'a> {
    /// Its number among the cloths that are stepped together.
    pub number: u32,
    pub sheet: ImplicitSheet<'a>,
    /// Its particles: where they would be by themselves, without gravity.
    pub lanes: &'a mut Lanes,
    /// The force on each of them, N.
    pub force: Option<&'a Points>,
    pub gathered: &'a mut GatheredParticles,
    pub buffers: &'a mut ImplicitBuffers,
    pub simd_level: SimdLevel,
}

/// Moves the particles of sheets to where gravity, forces, what holds them together and what they touch take them.
pub(crate) fn solve(sheets: &mut [SheetSystem], between: &mut ContactsBetween) {
    for SheetSystem { sheet, lanes, gathered, buffers, simd_level, .. } in &mut *sheets {
        gathered.read(lanes, true, *simd_level);
        let count = gathered.now.len().next_multiple_of(2);
        gathered.now.resize(count, [0.0; 4]);
        gathered.before.resize(count, [0.0; 4]);
        sheet.linearise_contacts(gathered, buffers);
    }
    between.linearise(sheets);
    for SheetSystem { number, sheet, gathered, buffers, simd_level, .. } in &mut *sheets {
        let touching = between.touching(*number);
        sheet.linearise(simd_level.level(), touching, gathered, buffers);
    }
    between.pull(sheets);
    between.multiply(sheets, |buffers| &mut buffers.inertia);
    between.multiply(sheets, |buffers| &mut buffers.fall);
    for SheetSystem { number, sheet, force, buffers, simd_level, .. } in &mut *sheets {
        let is_touching = between.touching(*number).next().is_some();
        sheet.begin_search(simd_level.level(), *force, is_touching, buffers);
    }
    let along_inertia = measure(sheets, |buffers| &mut buffers.inertia);
    let is_last = is_inertia_last(sheets, along_inertia);
    if is_last {
        sheets.iter_mut().for_each(|system| system.begin_last_direction());
    } else {
        advance(sheets, |buffers| &mut buffers.inertia, along_inertia);
    }
    sheets.iter_mut().for_each(|system| system.buffers.latest.clear());
    for _ in 0..ITERATIONS {
        between.scale_residuals(sheets);
        for SheetSystem { sheet, buffers, simd_level, .. } in &mut *sheets {
            sheet.precondition(simd_level.level(), buffers);
        }
        between.scale_ways(sheets);
        turn(sheets);
        for SheetSystem { sheet, buffers, simd_level, .. } in &mut *sheets {
            sheet.multiply(simd_level.level(), buffers);
        }
        between.multiply(sheets, |buffers| &mut buffers.latest);
        go(sheets, |buffers| &mut buffers.latest);
    }
    if is_last {
        sheets.iter_mut().for_each(|system| system.end_last_direction());
        go(sheets, |buffers| &mut buffers.inertia);
    }
    for SheetSystem { sheet, gathered, buffers, .. } in &mut *sheets {
        sheet.move_particles(gathered, buffers);
    }
    between.finish(sheets);
    for SheetSystem { lanes, gathered, simd_level, .. } in sheets {
        gathered.write(lanes, *simd_level);
    }
}

impl SheetSystem<'_> {
    /// Makes the inertia the last direction of search instead of the first, in two parts: the way x' - x of the whole substep is
    /// the inertia and what the correction grows by.
    fn begin_last_direction(&mut self) {
        self.buffers.inertia.per_curvature = 0.0;
        self.add_correction_to_inertia(-1.0);
    }

    /// The second part, once the other directions have been searched.
    fn end_last_direction(&mut self) {
        self.add_correction_to_inertia(1.0);
    }

    /// Adds the correction some `times` to the inertia, and the matrix times it, which is what the residual has lost.
    fn add_correction_to_inertia(&mut self, times: f32) {
        let ImplicitBuffers { inertia: Direction { way, product, .. }, correction, residual, .. } = &mut *self.buffers;
        dispatch!(self.simd_level.level(), simd => vectors::add_part(simd, times, correction, way));
        dispatch!(self.simd_level.level(), simd => vectors::add_part(simd, -times, residual, product));
    }
}

/// Whether the inertia, along which these are the curvature and the slope, is better the last direction of search than the first.
fn is_inertia_last(sheets: &[SheetSystem], [curvature, slope]: [f32; 2]) -> bool {
    let is_rough = -slope > ROUGH * curvature;
    is_rough && sheets.iter().any(|system| system.sheet.meets_cloth) && is_swift(sheets)
}

/// Whether sheets move so fast, in the root mean square, that it would be seen if they were stopped.
fn is_swift(sheets: &[SheetSystem]) -> bool {
    let h = sheets.first().map_or(0.0, |system| system.sheet.h);
    let [mut squares, mut mass] = [0.0; 2];
    for SheetSystem { buffers, .. } in sheets {
        for ([own, ..], way) in buffers.masses.mass.iter().zip(&buffers.inertia.way) {
            squares += own * point(way).length_squared();
            mass += own;
        }
    }
    let swift = SWIFT * h;
    squares > swift * swift * mass
}

/// Goes along a direction of search as far as is best for all sheets.
fn go(sheets: &mut [SheetSystem], direction: fn(&mut ImplicitBuffers) -> &mut Direction) {
    let along = measure(sheets, direction);
    advance(sheets, direction, along);
}

/// The curvature along a direction of search, kg m², and the slope, which goes down: of all sheets.
fn measure(sheets: &mut [SheetSystem], direction: fn(&mut ImplicitBuffers) -> &mut Direction) -> [f32; 2] {
    let mut sums = [0.0; 2];
    for SheetSystem { buffers, simd_level, .. } in sheets {
        let residual = core::mem::take(&mut buffers.residual);
        let measured = direction(buffers).measure(simd_level.level(), &residual);
        buffers.residual = residual;
        sums = core::array::from_fn(|k| sums[k] + measured[k]);
    }
    sums
}

/// Goes along a direction of search that has been measured.
fn advance(
    sheets: &mut [SheetSystem],
    direction: fn(&mut ImplicitBuffers) -> &mut Direction,
    [curvature, slope]: [f32; 2],
) {
    let per_curvature = Direction::per_curvature(curvature);
    for SheetSystem { buffers, simd_level, .. } in sheets {
        let [mut correction, mut residual] =
            [core::mem::take(&mut buffers.correction), core::mem::take(&mut buffers.residual)];
        let along = direction(buffers);
        along.per_curvature = per_curvature;
        along.advance(simd_level.level(), slope * per_curvature, [&mut correction, &mut residual]);
        (buffers.correction, buffers.residual) = (correction, residual);
    }
}

/// Turns the latest direction of all sheets to what the preconditioner has made of the residual.
fn turn(sheets: &mut [SheetSystem]) {
    let mut sums = [0.0; 2];
    for SheetSystem { buffers, simd_level, .. } in &mut *sheets {
        let ImplicitBuffers { latest, inertia, preconditioned, .. } = &**buffers;
        let products = [&latest.product[..], &inertia.product];
        let overlaps = dispatch!(simd_level.level(), simd => vectors::dot_both(simd, preconditioned, products));
        sums = core::array::from_fn(|k| sums[k] + overlaps[k]);
    }
    for SheetSystem { buffers, simd_level, .. } in sheets {
        let ImplicitBuffers { latest, inertia, preconditioned, .. } = &mut **buffers;
        // In exact numbers, it is conjugate to all directions but these two.
        let parts = [-sums[0] * latest.per_curvature, -sums[1] * inertia.per_curvature];
        dispatch!(simd_level.level(), simd => vectors::turn(simd, preconditioned, parts, &inertia.way, &mut latest.way));
    }
}
