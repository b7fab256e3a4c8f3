//! The picture: a golden sun over waves that hang like swags of cloth.

use std::{f32::consts::TAU, io::Cursor};

use bevy::math::ops::cos;
use image::{
    ImageError, Rgb, RgbImage,
    codecs::png::{CompressionType, FilterType, PngEncoder},
};

use super::{
    SIZE,
    mesh::{FLY_U, HOIST_U},
};

const WIDTH: u32 = 768;
const HEIGHT: u32 = 512;

/// Each texel is the mean of this many samples squared.
const SAMPLES: u32 = 4;

type Colour = [f32; 3];
const SEA: Colour = [16.0, 70.0, 84.0];
const GOLD: Colour = [238.0, 180.0, 58.0];
const CREAM: Colour = [246.0, 236.0, 214.0];
const CORAL: Colour = [212.0, 78.0, 54.0];
const WINE: Colour = [126.0, 34.0, 44.0];

pub fn png() -> Result<Vec<u8>, ImageError> {
    let mut bytes = Cursor::new(Vec::new());
    // The grain repeats exactly, which the compression finds only in unfiltered rows.
    let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::NoFilter);
    RgbImage::from_fn(WIDTH, HEIGHT, texel).write_with_encoder(encoder)?;
    Ok(bytes.into_inner())
}

fn texel(column: u32, row: u32) -> Rgb<u8> {
    let mut sum = [0.0; 3];
    for sample in 0..SAMPLES * SAMPLES {
        let within = |index: u32| (index as f32 + 0.5) / SAMPLES as f32;
        let u = (column as f32 + within(sample % SAMPLES)) / WIDTH as f32;
        let v = (row as f32 + within(sample / SAMPLES)) / HEIGHT as f32;
        let colour = design(along_flag(u) * SIZE[0], v * SIZE[1]);
        sum = std::array::from_fn(|channel| sum[channel] + colour[channel]);
    }
    let light = grain(column, row) / (SAMPLES * SAMPLES) as f32;
    Rgb(sum.map(|channel| (channel * light).round().clamp(0.0, 255.0) as u8))
}

/// From 0 at the hoist to 1 at the fly. In the margins of the texture the design simply goes on.
fn along_flag(u: f32) -> f32 {
    let (range, start) = if u < (HOIST_U[1] + FLY_U[1]) / 2.0 { (HOIST_U, 0.0) } else { (FLY_U, 0.5) };
    start + 0.5 * (u - range[0]) / (range[1] - range[0])
}

/// The colour at `x` metres from the hoist and `y` metres below the top.
fn design(x: f32, y: f32) -> Colour {
    // Two swags whose ends meet under the sun, right where the UV seam is.
    let wave = 0.05 * cos(TAU * x / (SIZE[0] / 2.0));
    let below = y - 0.62 + wave;
    let from_sun = (x - SIZE[0] / 2.0).hypot(y - 0.44);
    match below {
        0.24.. => WINE,
        0.06..0.09 | 0.21..0.24 => CREAM,
        0.0..0.06 => SEA,
        0.09.. => CORAL,
        -0.03..0.0 => CREAM,
        _ if from_sun < 0.22 => GOLD,
        _ if (0.26..0.285).contains(&from_sun) => GOLD,
        _ => SEA,
    }
}

/// Threads over and under, four texels wide.
fn grain(column: u32, row: u32) -> f32 {
    let is_warp = (column / 4 + row / 4).is_multiple_of(2);
    let across = if is_warp { column } else { row } % 4;
    match across {
        0 | 3 => 0.96,
        _ if is_warp => 1.01,
        _ => 1.0,
    }
}
