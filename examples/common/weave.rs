//! Plain weave: each thread goes over one crossing thread and under the next.

use std::f32::consts::PI;

use bevy::{
    math::{Affine2, ops::cos},
    prelude::*,
};

use super::mipmaps::{Texels, tile};

const TEXELS_PER_THREAD: u32 = 16;
const THREADS: u32 = 16;

/// How far a thread stands out, in thread widths. Real threads are rounder; at this size they would look like wicker.
const RELIEF: f32 = 0.35;

/// A two-sided, rough material of woven threads, whose pattern repeats `repeats` times over the mesh's UV square. Its
/// relief shows where the mesh has tangents.
pub fn fabric_material(images: &mut Assets<Image>, colour: Color, repeats: Vec2) -> StandardMaterial {
    StandardMaterial {
        base_color_texture: Some(woven(images, colour, THREADS)),
        normal_map_texture: Some(woven_normals(images, THREADS)),
        perceptual_roughness: 0.9,
        reflectance: 0.5,
        // Thin cloth glows a little when the sun is behind it.
        diffuse_transmission: 0.15,
        double_sided: true,
        cull_mode: None,
        uv_transform: Affine2::from_scale(repeats),
        ..default()
    }
}

/// The colours of a tileable piece of cloth.
pub fn woven(images: &mut Assets<Image>, colour: Color, threads_per_tile: u32) -> Handle<Image> {
    let threads = even(threads_per_tile);
    let colour = colour.to_linear().to_vec3();
    images.add(tile(texels(threads), Texels::Colours, |u, v| {
        let weave = Weave::at(u * threads as f32, v * threads as f32);
        // The gaps between the threads lie in their shadow.
        let light = 0.65 + 0.55 * weave.height;
        (colour * light * weave.dye(threads)).clamp(Vec3::ZERO, Vec3::ONE)
    }))
}

/// The relief that belongs to [`woven`] with the same number of threads.
pub fn woven_normals(images: &mut Assets<Image>, threads_per_tile: u32) -> Handle<Image> {
    let threads = even(threads_per_tile);
    let step = 0.5 / TEXELS_PER_THREAD as f32;
    images.add(tile(texels(threads), Texels::Normals, |u, v| {
        let (x, y) = (u * threads as f32, v * threads as f32);
        let height = |x: f32, y: f32| RELIEF * Weave::at(x, y).height;
        let slope_x = (height(x + step, y) - height(x - step, y)) / (2.0 * step);
        let slope_y = (height(x, y + step) - height(x, y - step)) / (2.0 * step);
        // V points down in the texture and up in Bevy's tangent space.
        Vec3::new(-slope_x, slope_y, 1.0).normalize()
    }))
}

/// An odd number of threads would put two that go over side by side where the tiles meet.
fn even(threads: u32) -> u32 {
    (threads.max(2) / 2 * 2).min(64)
}

fn texels(threads: u32) -> u32 {
    (threads * TEXELS_PER_THREAD).next_power_of_two()
}

/// The thread on top at a point of the cloth.
struct Weave {
    /// From 0 in the gaps to 1 on the crests.
    height: f32,
    /// Whether the thread runs along v.
    is_warp: bool,
    /// Which of the parallel threads it is.
    thread: i32,
    /// The place along the thread, in thread widths.
    along: f32,
}

impl Weave {
    /// `x` and `y` in thread widths.
    fn at(x: f32, y: f32) -> Self {
        let (column, row) = (x.floor(), y.floor());
        let is_warp = (column as i32 + row as i32) % 2 == 0;
        let (from_warp_axis, from_weft_axis) = (x - column - 0.5, y - row - 0.5);
        let (across, along) = if is_warp { (from_warp_axis, from_weft_axis) } else { (from_weft_axis, from_warp_axis) };
        let round = cos(PI * across).max(0.0).sqrt();
        let bow = 0.6 + 0.4 * cos(PI * along);
        Self {
            height: round * bow,
            is_warp,
            thread: if is_warp { column } else { row } as i32,
            along: if is_warp { y } else { x },
        }
    }

    /// No two threads take the dye alike, and none takes it evenly.
    fn dye(&self, threads: u32) -> f32 {
        let thread = self.thread.rem_euclid(threads as i32) as u32 + if self.is_warp { 0 } else { threads };
        let place = (self.along * 4.0).rem_euclid(threads as f32 * 4.0) as u32;
        0.94 + 0.08 * noise(thread, 0) + 0.05 * noise(thread, place + 1)
    }
}

/// From 0 to 1, the same for the same numbers.
pub fn noise(a: u32, b: u32) -> f32 {
    let mut bits = a.wrapping_mul(0x9E37_79B9) ^ b.wrapping_mul(0x85EB_CA6B);
    bits = (bits ^ (bits >> 15)).wrapping_mul(0x2C1B_3C6D);
    bits = (bits ^ (bits >> 12)).wrapping_mul(0x297A_2D39);
    (bits ^ (bits >> 15)) as f32 / u32::MAX as f32
}
