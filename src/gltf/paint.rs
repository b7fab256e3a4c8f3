//! What is painted on the vertices of a mesh, put on Bevy's mesh as the attributes that cloth reads.

use bevy::{
    mesh::{MeshVertexAttribute, VertexAttributeValues},
    prelude::*,
};
use gltf::{Primitive, Semantic};

use super::{
    accessor::{self, Numbers},
    report::{Report, nearest},
};
use crate::{
    mesh_input::ATTRIBUTE_WARP,
    pins::ATTRIBUTE_PIN,
    skin::{ATTRIBUTE_CLOTH, ATTRIBUTE_CLOTH_BACKSTOP},
};

const CLOTH: &str = "_CLOTH";
const BACKSTOP: &str = "_CLOTH_BACKSTOP";
const PIN: &str = "_PIN";
const WARP: &str = "_WARP";

/// All attributes that are read.
const NAMES: [&str; 4] = [CLOTH, BACKSTOP, PIN, WARP];

/// What is painted on a primitive, for each vertex of the file.
#[derive(Clone, Debug, Default)]
pub(super) struct Paint {
    /// A number, or the red of a colour.
    numbers: Vec<(MeshVertexAttribute, Vec<f32>)>,
    /// A direction.
    warp: Option<Vec<[f32; 3]>>,
    /// Vertices of the triangles: Bevy gives each corner a vertex of its own where there are no normals.
    indices: Option<Vec<u32>>,
    /// Where the vertices are, if there are directions: Bevy may turn them.
    places: Vec<[f32; 3]>,
}

/// What of it matters to the objects that have the mesh.
#[derive(Clone, Debug, Default)]
pub(super) struct Painted {
    /// What is painted as `_CLOTH` on each vertex of Bevy's mesh.
    pub looseness: Option<Vec<f32>>,
    /// Whether any vertex is pinned by `_PIN`; none where that isn't painted.
    pub is_pinned: Option<bool>,
}

impl Painted {
    /// What is painted on several meshes, one after the other: what isn't on all of them is on none.
    pub fn joined(meshes: impl Iterator<Item = Self>) -> Self {
        let append = |all: Self, next: Self| Self {
            looseness: all.looseness.zip(next.looseness).map(|(all, next)| [all, next].concat()),
            is_pinned: all.is_pinned.zip(next.is_pinned).map(|(all, next)| all | next),
        };
        meshes.reduce(append).unwrap_or_default()
    }
}

impl Paint {
    /// Reads the attributes of a primitive. What can't be used is left out with one warning, which names the `mesh`.
    pub fn read(primitive: &Primitive, mesh: &str, buffers: &[Vec<u8>], report: &mut Report) -> Self {
        let mut paint = Self::default();
        let count = primitive.get(&Semantic::Positions).map_or(0, |positions| positions.count());
        for (semantic, accessor) in primitive.attributes() {
            let Semantic::Extras(name) = semantic else { continue };
            let written = format!("_{name}");
            let upper = written.to_uppercase();
            let Some(name) = NAMES.into_iter().find(|name| *name == upper) else {
                if upper.starts_with(CLOTH) {
                    let guess = nearest(&written, NAMES).unwrap_or(CLOTH);
                    report.warn(mesh, format_args!("no attribute is called {written}; did you mean {guess}?"));
                }
                continue;
            };
            if accessor.count() != count {
                let painted = accessor.count();
                report.warn(
                    mesh,
                    format_args!("{name} has {painted} values for {count} vertices and is left out; paint all of them"),
                );
                continue;
            }
            match accessor::read(&accessor, buffers) {
                Some(numbers) => paint.add(name, numbers, mesh, report),
                None => report.warn(
                    mesh,
                    format_args!("{name} can't be read and is left out; it has to be a number, a vector or a colour"),
                ),
            }
        }
        if !paint.is_empty() {
            let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
            paint.indices = reader.read_indices().map(|indices| indices.into_u32().collect());
            if paint.warp.is_some() {
                paint.places = reader.read_positions().into_iter().flatten().collect();
            }
        }
        paint
    }

    pub fn is_empty(&self) -> bool {
        self.numbers.is_empty() && self.warp.is_none()
    }

    fn add(&mut self, name: &str, numbers: Numbers, mesh: &str, report: &mut Report) {
        let mut bad = None;
        match name {
            WARP if numbers.width < 3 => {
                report
                    .warn(mesh, format_args!("{WARP} is no direction and is left out; it has to be a vector of three"));
            }
            WARP => {
                let direction = |(i, value): (usize, Vec4)| {
                    if !value.is_finite() {
                        bad.get_or_insert(i);
                        return [0.0; 3];
                    }
                    value.truncate().to_array()
                };
                self.warp = Some(numbers.values.into_iter().enumerate().map(direction).collect());
            }
            _ => {
                let (attribute, least, instead) = match name {
                    CLOTH => (ATTRIBUTE_CLOTH, 0.0, 0.0),
                    // Below zero there is none.
                    BACKSTOP => (ATTRIBUTE_CLOTH_BACKSTOP, f32::NEG_INFINITY, -1.0),
                    _ => (ATTRIBUTE_PIN, f32::NEG_INFINITY, 0.0),
                };
                let number = |(i, value): (usize, Vec4)| {
                    if value.x.is_finite() && value.x >= least {
                        return value.x;
                    }
                    bad.get_or_insert(i);
                    instead
                };
                self.numbers.push((attribute, numbers.values.into_iter().enumerate().map(number).collect()));
            }
        }
        if let Some(vertex) = bad {
            let mend = if name == CLOTH { "; paint 0 or more" } else { "; paint a finite number" };
            report.warn(mesh, format_args!("what is painted as {name} on vertex {vertex} doesn't count{mend}"));
        }
    }

    /// Puts it on the mesh that Bevy has made of the primitive. None, and the mesh as it is, where their vertices differ.
    pub fn put_on(&self, mesh: &mut Mesh) -> Option<Painted> {
        let count = mesh.try_attribute(Mesh::ATTRIBUTE_POSITION).ok()?.len();
        let corners = self.indices.as_ref().filter(|_| mesh.try_indices().is_err());
        let numbers =
            self.numbers.iter().map(|(attribute, values)| Some((*attribute, spread(values, corners, count)?)));
        let numbers: Vec<_> = numbers.collect::<Option<_>>()?;
        let mut warp = match &self.warp {
            Some(warp) => Some(spread(warp, corners, count)?),
            None => None,
        };
        if let Some(warp) = &mut warp
            && is_turned(mesh, &spread(&self.places, corners, count)?)
        {
            warp.iter_mut().for_each(|[x, _, z]| (*x, *z) = (-*x, -*z));
        }
        let find = |wanted: MeshVertexAttribute| numbers.iter().find(|(attribute, _)| attribute.id == wanted.id);
        let painted = Painted {
            looseness: find(ATTRIBUTE_CLOTH).map(|(_, values)| values.clone()),
            is_pinned: find(ATTRIBUTE_PIN).map(|(_, values)| values.iter().any(|&pin| pin >= 0.5)),
        };
        for (attribute, values) in numbers {
            mesh.insert_attribute(attribute, values);
        }
        if let Some(warp) = warp {
            mesh.insert_attribute(ATTRIBUTE_WARP, warp);
        }
        Some(painted)
    }
}

/// The values of `count` vertices: as they are, or one for each corner.
fn spread<T: Copy>(values: &[T], corners: Option<&Vec<u32>>, count: usize) -> Option<Vec<T>> {
    let values: Vec<T> = match corners {
        Some(corners) => corners.iter().map(|&corner| values.get(corner as usize).copied()).collect::<Option<_>>()?,
        None => values.to_vec(),
    };
    (values.len() == count).then_some(values)
}

/// Whether Bevy has turned the mesh about, as its loader can be asked to: X and Z are the other way round.
fn is_turned(mesh: &Mesh, places: &[[f32; 3]]) -> bool {
    let Ok(VertexAttributeValues::Float32x3(now)) = mesh.try_attribute(Mesh::ATTRIBUTE_POSITION) else { return false };
    let off_axis = now.iter().zip(places).find(|([x, _, z], _)| *x != 0.0 || *z != 0.0);
    off_axis.is_some_and(|([x, _, z], [file_x, _, file_z])| *x == -file_x && *z == -file_z)
}
