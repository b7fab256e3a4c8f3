//! Square, tileable textures made in code, with the smaller copies without which a fine pattern shimmers.

use bevy::{
    asset::RenderAssetUsages,
    image::{ImageAddressMode, ImageSampler, ImageSamplerDescriptor},
    prelude::*,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
};

#[derive(Clone, Copy, PartialEq)]
pub enum Texels {
    /// Linear red, green and blue from 0 to 1.
    Colours,
    /// Unit vectors in tangent space.
    Normals,
}

/// A texture of `size` by `size` texels, `size` being a power of two, whose value in each texel is
/// `texel(u, v)` with u to the right and v down, both from 0 to 1.
pub fn tile(size: u32, kind: Texels, texel: impl Fn(f32, f32) -> Vec3) -> Image {
    let centre = |index: u32| (index as f32 + 0.5) / size as f32;
    let mut level: Vec<Vec3> =
        (0..size * size).map(|index| texel(centre(index % size), centre(index / size))).collect();

    let mut bytes = Vec::new();
    let mut side = size;
    loop {
        bytes.extend(level.iter().flat_map(|value| encode(kind, *value)));
        if side == 1 {
            break;
        }
        level = halve(kind, &level, side as usize);
        side /= 2;
    }
    image(size, kind, bytes)
}

/// Averages each square of four texels into one.
fn halve(kind: Texels, level: &[Vec3], side: usize) -> Vec<Vec3> {
    let half = side / 2;
    (0..half * half)
        .map(|index| {
            let corner = 2 * (index % half) + 2 * (index / half) * side;
            let sum = level[corner] + level[corner + 1] + level[corner + side] + level[corner + side + 1];
            match kind {
                Texels::Colours => sum / 4.0,
                Texels::Normals => sum.normalize_or(Vec3::Z),
            }
        })
        .collect()
}

fn encode(kind: Texels, value: Vec3) -> [u8; 4] {
    match kind {
        Texels::Colours => Color::linear_rgb(value.x, value.y, value.z).to_srgba().to_u8_array(),
        Texels::Normals => {
            let byte = |component: f32| (component * 127.5 + 127.5).round() as u8;
            [byte(value.x), byte(value.y), byte(value.z), u8::MAX]
        }
    }
}

fn image(size: u32, kind: Texels, bytes: Vec<u8>) -> Image {
    let format = match kind {
        Texels::Colours => TextureFormat::Rgba8UnormSrgb,
        Texels::Normals => TextureFormat::Rgba8Unorm,
    };
    let mut image = Image::new_uninit(
        Extent3d { width: size, height: size, depth_or_array_layers: 1 },
        TextureDimension::D2,
        format,
        RenderAssetUsages::RENDER_WORLD,
    );
    image.data = Some(bytes);
    image.texture_descriptor.mip_level_count = size.ilog2() + 1;
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: ImageAddressMode::Repeat,
        address_mode_v: ImageAddressMode::Repeat,
        // No anisotropy: software renderers leave specks where its level changes, and take twice as long.
        ..ImageSamplerDescriptor::linear()
    });
    image
}
