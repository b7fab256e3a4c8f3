//! All that a mesh and its material may carry, once each.

use bevy::{
    asset::RenderAssetUsages,
    image::ImageSampler,
    mesh::{
        Indices, MeshVertexAttribute, UvChannel, VertexAttributeValues, VertexFormat,
        morph::{MeshMorphWeights, MorphAttributes},
        skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    },
    prelude::*,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
};
use bevy_drape::prelude::*;

use crate::cells::CELL;

const GRID: ClothGrid = ClothGrid { size: Vec2::splat(0.75), particles: UVec2::splat(21), lying: false };
const VERTICES: usize = 441;

const WEIGHT_OF_WEFT: MeshVertexAttribute = MeshVertexAttribute::new("Weft_Weight", 988_540_917, VertexFormat::Float32);

/// A cloth and what is special about it.
pub struct Case {
    pub name: &'static str,
    pub mesh: Mesh,
    pub material: StandardMaterial,
    /// The way that its skin takes it, where that is followed; zero without one.
    pub skin: Vec3,
    /// The way that its morph targets take it, where they are followed; zero without any.
    pub morph: Vec3,
    /// Share of it that is there to be seen, at least.
    pub share: f32,
}

impl Case {
    fn new(name: &'static str, mesh: Mesh) -> Self {
        Self { name, mesh, material: StandardMaterial::default(), skin: Vec3::ZERO, morph: Vec3::ZERO, share: 0.9 }
    }
}

/// One row of cells after the other. A cell is left free to the right of each that its skin or its morph targets take there.
pub fn cases(images: &mut Assets<Image>) -> Vec<Option<Case>> {
    let cell = Vec3::X * CELL;
    let white = || vec![[1.0, 1.0, 1.0, 1.0]; VERTICES];
    let plain = |name| Case::new(name, grid());
    let with = |name, attribute, values: VertexAttributeValues| {
        Case::new(name, grid().with_inserted_attribute(attribute, values))
    };
    let normal_map = Some(images.add(normal_map()));
    let holes = Some(images.add(holes()));
    vec![
        Some(Case { skin: cell, ..Case::new("skin", skinned(grid())) }),
        None,
        Some(Case { morph: cell, ..Case::new("morph targets", morphed(grid(), cell)) }),
        None,
        Some(Case {
            skin: cell,
            morph: -cell,
            ..Case::new("skin and morph targets", morphed(skinned(everything()), -cell))
        }),
        None,
        Some(with("a custom attribute", WEIGHT_OF_WEFT, vec![0.5_f32; VERTICES].into())),
        Some(Case {
            material: StandardMaterial {
                base_color_texture: holes.clone(),
                base_color_channel: UvChannel::Uv1,
                ..default()
            },
            ..with("two UV sets", Mesh::ATTRIBUTE_UV_1, vec![[0.0_f32; 2]; VERTICES].into())
        }),
        Some(with("vertex colours", Mesh::ATTRIBUTE_COLOR, white().into())),
        Some(with("tangents", Mesh::ATTRIBUTE_TANGENT, vec![[1.0_f32, 0.0, 0.0, 1.0]; VERTICES].into())),
        Some(Case {
            material: StandardMaterial { normal_map_texture: normal_map.clone(), ..default() },
            ..with("a normal map", Mesh::ATTRIBUTE_TANGENT, vec![[1.0_f32, 0.0, 0.0, 1.0]; VERTICES].into())
        }),
        Some(Case {
            material: StandardMaterial { normal_map_texture: normal_map, ..default() },
            ..plain("a normal map without tangents")
        }),
        Some(Case::new("indices of 16 bits", with_short_indices(grid()))),
        Some(plain("indices of 32 bits")),
        Some(Case::new("no indices", grid().with_duplicated_vertices())),
        Some(Case {
            material: StandardMaterial { alpha_mode: AlphaMode::Blend, ..default() },
            ..plain("a material that blends")
        }),
        Some(Case {
            material: StandardMaterial { alpha_mode: AlphaMode::Mask(0.5), base_color_texture: holes, ..default() },
            share: 0.4,
            ..plain("a material with a mask")
        }),
        Some(Case::new("all at once", everything())),
    ]
}

/// A skin of one joint, which takes meshes to `place`.
pub fn spawn_skin(world: &mut World, place: Vec3) -> SkinnedMesh {
    let joint = world.spawn(Transform::from_translation(place)).id();
    let poses = vec![Mat4::IDENTITY];
    let inverse_bindposes = world.resource_mut::<Assets<SkinnedMeshInverseBindposes>>().add(poses);
    SkinnedMesh { inverse_bindposes, joints: vec![joint] }
}

/// All morph targets at their full weight.
pub fn weights() -> MeshMorphWeights {
    MeshMorphWeights::Value { weights: vec![1.0] }
}

/// A mesh with most of what there is, for a cloth that gets another one.
pub fn everything() -> Mesh {
    with_short_indices(grid())
        .with_inserted_attribute(WEIGHT_OF_WEFT, vec![0.5_f32; VERTICES])
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_1, vec![[0.0_f32; 2]; VERTICES])
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, vec![[1.0_f32; 4]; VERTICES])
        .with_inserted_attribute(Mesh::ATTRIBUTE_TANGENT, vec![[1.0_f32, 0.0, 0.0, 1.0]; VERTICES])
}

fn grid() -> Mesh {
    GRID.into()
}

fn skinned(mesh: Mesh) -> Mesh {
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, VertexAttributeValues::Uint16x4(vec![[0; 4]; VERTICES]))
        .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, vec![[1.0, 0.0, 0.0, 0.0]; VERTICES])
        .with_generated_skinned_mesh_bounds()
        .expect("it has a skin")
}

fn morphed(mesh: Mesh, way: Vec3) -> Mesh {
    mesh.with_morph_targets(vec![MorphAttributes::new(way, Vec3::ZERO, Vec3::ZERO); VERTICES])
}

fn with_short_indices(mut mesh: Mesh) -> Mesh {
    let short = mesh.indices().into_iter().flat_map(Indices::iter).map(|index| index as u16).collect();
    mesh.insert_indices(Indices::U16(short));
    mesh
}

/// Waves across the cloth.
fn normal_map() -> Image {
    let slopes = [0_u8, 64, 128, 192, 255, 192, 128, 64];
    image(8, TextureFormat::Rgba8Unorm, |x, _| [slopes[x], 128, 220, 255])
}

/// White with holes: every other square is black, and lets through what is behind.
fn holes() -> Image {
    image(8, TextureFormat::Rgba8UnormSrgb, |x, y| [if (x + y) % 2 == 0 { 255 } else { 0 }; 4])
}

fn image(side: usize, format: TextureFormat, texel: impl Fn(usize, usize) -> [u8; 4]) -> Image {
    let texels = (0..side * side).flat_map(|index| texel(index % side, index / side)).collect();
    let size = Extent3d { width: side as u32, height: side as u32, depth_or_array_layers: 1 };
    let mut image = Image::new(size, TextureDimension::D2, texels, format, RenderAssetUsages::RENDER_WORLD);
    image.sampler = ImageSampler::nearest();
    image
}
