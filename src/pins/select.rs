//! Resolves pin selectors against a mesh.

use core::fmt;
use std::sync::Arc;

use bevy::{mesh::VertexAttributeValues, prelude::*};

use super::{ClothEdge, PinSelector, PinTarget, Pins};
use crate::{
    error::ClothError,
    mesh_input::read_uvs,
    solver::{Topology, build::weld::NO_PARTICLE},
};

/// Vertices within this of a sheet's largest or smallest UV are on its edge.
const UV_TOLERANCE: f32 = 1e-4;

/// Vertex colours within this of the wanted one, per channel, are the same: exporters store 8 bits.
const COLOR_TOLERANCE: f32 = 1.0 / 255.0;

/// What a pin predicate may look at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinVertex {
    /// The mesh's vertex index.
    pub index: u32,
    /// Rest position in the mesh's own space, m.
    pub position: Vec3,
    /// First UV, where the mesh has one.
    pub uv: Option<Vec2>,
}

/// What a predicate asks of a vertex.
type Accepts = dyn Fn(&PinVertex) -> bool + Send + Sync;

/// A function that chooses vertices.
#[derive(Clone, Default, Reflect)]
#[reflect(opaque)]
#[reflect(Default, Clone, Debug)]
pub struct PinPredicate(Option<Arc<Accepts>>);

impl PinPredicate {
    /// Wraps a function.
    pub fn new(accepts: impl Fn(&PinVertex) -> bool + Send + Sync + 'static) -> Self {
        Self(Some(Arc::new(accepts)))
    }

    fn accepts(&self, vertex: &PinVertex) -> bool {
        self.0.as_ref().is_some_and(|accepts| accepts(vertex))
    }
}

/// The same function, not one that does the same.
impl PartialEq for PinPredicate {
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Some(one), Some(other)) => Arc::ptr_eq(one, other),
            (None, None) => true,
            _ => false,
        }
    }
}

impl fmt::Debug for PinPredicate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "PinPredicate(fn)" } else { "PinPredicate(none)" })
    }
}

/// What each particle is fixed to, [`PinTarget::Free`] for most, and the groups that don't fit the mesh.
///
/// `particle_of_vertex` and `topology` belong to `mesh`.
pub(crate) fn targets_by_particle(
    pins: &Pins,
    mesh: &Mesh,
    particle_of_vertex: &[u32],
    topology: &Topology,
) -> (Vec<PinTarget>, Vec<(usize, ClothError)>) {
    let mut refused = Vec::new();
    let mut targets = vec![PinTarget::Free; topology.particle_count()];
    let selection = Selection { mesh, particle_of_vertex, topology };
    for (index, group) in pins.groups.iter().enumerate() {
        match selection.vertices(&group.select) {
            Ok(vertices) => {
                for vertex in vertices {
                    // A mesh that has just changed may have more vertices than the cloth that was made from it.
                    let particle = particle_of_vertex.get(vertex as usize).copied().unwrap_or(NO_PARTICLE);
                    if particle != NO_PARTICLE {
                        targets[particle as usize] = group.to;
                    }
                }
            }
            Err(error) => refused.push((index, error)),
        }
    }
    (targets, refused)
}

/// A mesh to select vertices of.
struct Selection<'a> {
    mesh: &'a Mesh,
    particle_of_vertex: &'a [u32],
    topology: &'a Topology,
}

impl Selection<'_> {
    fn vertices(&self, select: &PinSelector) -> Result<Vec<u32>, ClothError> {
        let chosen: Vec<u32> = match select {
            PinSelector::Indices(indices) => return self.checked(indices),
            PinSelector::Region { min, max } => {
                let (min, max) = (min.min(*max), min.max(*max));
                self.by(self.positions()?, |p| p.cmpge(min).all() && p.cmple(max).all())
            }
            PinSelector::UvRegion(region) => self.by(self.uvs()?, |&uv| region.contains(uv)),
            PinSelector::VertexColor(color) => self.by_color(color)?,
            PinSelector::Attribute(name) => self.by_attribute(name)?,
            PinSelector::Corners => self.corners(),
            PinSelector::Edge(edge) => self.edge(*edge)?,
            PinSelector::EdgeCorners(edge) => {
                let corners = self.corners();
                let mut ends = self.edge(*edge)?;
                ends.retain(|vertex| corners.contains(vertex));
                ends
            }
            PinSelector::Predicate(predicate) => self.by_predicate(predicate)?,
        };
        if chosen.is_empty() {
            return Err(ClothError::NothingPinned { selector: format!("{select:?}") });
        }
        Ok(chosen)
    }

    /// Indices of the `values` that are wanted, one value a vertex.
    fn by<T>(&self, values: Vec<T>, wanted: impl Fn(&T) -> bool) -> Vec<u32> {
        (0..).zip(&values).filter(|(_, value)| wanted(value)).map(|(i, _)| i).collect()
    }

    fn checked(&self, indices: &[u32]) -> Result<Vec<u32>, ClothError> {
        let count = self.particle_of_vertex.len() as u32;
        match indices.iter().find(|&&vertex| vertex >= count) {
            Some(&vertex) => Err(ClothError::PinOutOfRange { vertex, count }),
            None => Ok(indices.to_vec()),
        }
    }

    fn positions(&self) -> Result<Vec<Vec3>, ClothError> {
        match self.mesh.try_attribute(Mesh::ATTRIBUTE_POSITION) {
            Ok(VertexAttributeValues::Float32x3(values)) => Ok(values.iter().copied().map(Vec3::from).collect()),
            _ => Err(ClothError::NoPositions),
        }
    }

    fn uvs(&self) -> Result<Vec<Vec2>, ClothError> {
        read_uvs(self.mesh).ok_or_else(|| lacks("UV coordinates"))
    }

    fn by_color(&self, wanted: &LinearRgba) -> Result<Vec<u32>, ClothError> {
        let wanted = wanted.to_vec4();
        let is_wanted = |color: Vec4| (color - wanted).abs().max_element() <= COLOR_TOLERANCE;
        match self.mesh.try_attribute(Mesh::ATTRIBUTE_COLOR) {
            Ok(VertexAttributeValues::Float32x4(colors)) => {
                Ok(self.by(colors.clone(), |&color| is_wanted(color.into())))
            }
            Ok(VertexAttributeValues::Unorm8x4(colors)) => {
                Ok(self.by(colors.clone(), |color| is_wanted(Vec4::from(color.map(f32::from)) / 255.0)))
            }
            _ => Err(lacks("vertex colours")),
        }
    }

    fn by_attribute(&self, name: &str) -> Result<Vec<u32>, ClothError> {
        let values = self.mesh.try_attributes().ok().and_then(|mut attributes| {
            attributes.find(|(attribute, _)| attribute.name == name).map(|(_, values)| values)
        });
        match values {
            Some(VertexAttributeValues::Float32(weights)) => Ok(self.by(weights.clone(), |&weight| weight >= 0.5)),
            _ => Err(lacks(&format!("the attribute \"{name}\" of format Float32"))),
        }
    }

    fn by_predicate(&self, predicate: &PinPredicate) -> Result<Vec<u32>, ClothError> {
        let uvs = read_uvs(self.mesh);
        let vertices = (0..).zip(self.positions()?).map(|(index, position)| PinVertex {
            index,
            position,
            uv: uvs.as_ref().and_then(|uvs| uvs.get(index as usize).copied()),
        });
        Ok(vertices.filter(|vertex| predicate.accepts(vertex)).map(|v| v.index).collect())
    }

    fn edge(&self, edge: ClothEdge) -> Result<Vec<u32>, ClothError> {
        let along = |uv: &Vec2| match edge {
            ClothEdge::Top => uv.y,
            ClothEdge::Bottom => -uv.y,
            ClothEdge::Left => uv.x,
            ClothEdge::Right => -uv.x,
        };
        let uvs = self.uvs()?;
        let least = uvs.iter().map(along).fold(f32::INFINITY, f32::min);
        Ok(self.by(uvs, |uv| along(uv) <= least + UV_TOLERANCE))
    }

    /// Vertices of particles that are in one cell and nothing else.
    fn corners(&self) -> Vec<u32> {
        let count = self.topology.particle_count();
        let (mut cells, mut triangles) = (vec![0; count], vec![0; count]);
        for &particle in self.topology.cells.as_flattened() {
            cells[particle as usize] += 1;
        }
        for &particle in self.topology.triangles.as_flattened() {
            triangles[particle as usize] += 1;
        }
        let is_corner = |&particle: &u32| {
            particle != NO_PARTICLE && {
                let particle = particle as usize;
                cells[particle] == 1 && triangles[particle] <= 2
            }
        };
        self.by(self.particle_of_vertex.to_vec(), is_corner)
    }
}

fn lacks(attribute: &str) -> ClothError {
    ClothError::PinsNeedAttribute { attribute: attribute.into() }
}
