//! The state becomes pixels: interpolated particles, normals and tangents, the mesh.

mod bind_space;
mod binding;
mod carry;
mod mesh;
mod proxy;
mod shading;
mod skin;

pub(crate) use binding::Binding;
pub(crate) use mesh::{ClothMesh, Drawn, DrawnMesh, release, shape_cloths, write_meshes};
pub(crate) use proxy::shape_proxies;
#[cfg(feature = "mesh_colliders")]
pub(crate) use skin::TakenOff;
pub(crate) use skin::{Lost, copy_with_skin, copy_without_skin, fit_skins, take_skin_off};
