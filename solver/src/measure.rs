//! What a laboratory would read off a cloth: how far it is stretched, and where its energy is.

use bevy_math::Vec3A;

use crate::{
    constraint::unstructured::{bend::element::BendElement, face::FaceStrain, spring},
    geometry::{
        bvh::{
            bounds::{Bounds, BvhBounds},
            traversal::Traversal,
        },
        intersection::intersect,
    },
    material::Material,
    particles::Particles,
    topology::{SpringKind, Topology},
};

/// Stretch along the strands: change of length over rest length of the structural springs, no unit. Negative where
/// they are pressed together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Strain {
    /// That of the spring that is stretched the most.
    pub largest: f32,
    /// Mean of what is stretched; what is pressed together counts as nothing.
    pub mean: f32,
}

/// Energy of a cloth, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Of motion: the sum of m v²/2 over the free particles.
    pub kinetic: f32,
    /// Of all springs, triangles and bends.
    pub elastic: f32,
    /// Of height: minus the sum of m g·x, with x relative to the cloth's origin. Only its changes mean something.
    pub gravitational: f32,
}

impl Energy {
    /// The sum of all.
    pub fn total(&self) -> f32 {
        self.kinetic + self.elastic + self.gravitational
    }
}

/// Measures the stretch of a cloth.
pub fn strain(particles: &Particles, topology: &Topology) -> Strain {
    let mut strain = Strain::default();
    let mut count = 0_u32;
    for structural in topology.springs_of(SpringKind::Structural) {
        let stretch = spring::strain(&particles.position, structural);
        strain.largest = if count == 0 { stretch } else { strain.largest.max(stretch) };
        strain.mean += stretch.max(0.0);
        count += 1;
    }
    strain.mean /= count.max(1) as f32;
    strain
}

/// Unit normals of particles at `position` (m): the sums of their triangles' normals, weighted by area. Zero for a particle
/// whose triangles have no area.
pub fn normals(triangles: &[[u32; 3]], position: &[Vec3A]) -> Vec<Vec3A> {
    let mut normals = vec![Vec3A::ZERO; position.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| position[i as usize]);
        let doubled_area = (b - a).cross(c - a);
        for &particle in triangle {
            normals[particle as usize] += doubled_area;
        }
    }
    normals.iter_mut().for_each(|normal| *normal = normal.normalize_or_zero());
    normals
}

/// Measures the energy of a cloth under `gravity`, m/s².
pub fn energy(particles: &Particles, topology: &Topology, material: &Material, gravity: Vec3A) -> Energy {
    let mut energy = Energy::default();
    for ((position, velocity), &w) in particles.position.iter().zip(&particles.velocity).zip(&particles.inverse_mass) {
        if w > 0.0 {
            energy.kinetic += 0.5 * velocity.length_squared() / w;
            energy.gravitational -= gravity.dot(*position) / w;
        }
    }
    for kind in SpringKind::ALL {
        for spring in topology.springs_of(kind) {
            let strain = spring::strain(&particles.position, spring);
            energy.elastic += material.spring(kind, spring).energy(spring.rest, strain);
        }
    }
    if let Some(moduli) = material.moduli() {
        let at = |particle: u32| particles.position[particle as usize];
        for face in &topology.faces {
            energy.elastic += face.area * FaceStrain::new(face, face.particles.map(at)).energy(moduli);
        }
        for bend in &topology.bends {
            energy.elastic += moduli.bending * BendElement::new(bend, bend.particles.map(at)).energy(bend);
        }
    }
    energy
}

/// Pairs of triangles of a cloth that pass through each other. Neighbours, which share a corner, don't count.
///
/// Costs as much as a step, and allocates.
pub fn intersecting_pairs(particles: &Particles, topology: &Topology) -> usize {
    let surface = topology.surface();
    let corners = |triangle: [u32; 3]| triangle.map(|i| particles.position[i as usize]);
    let mut places = BvhBounds::default();
    places.follow(surface, |triangle| Bounds::around(corners(triangle)), None::<fn(_) -> _>);
    let mut count = 0;
    Traversal::default().between((surface, &places), (surface, &places), |p, q| {
        for s in surface.of_leaf(p) {
            for t in surface.of_leaf(q).filter(|&t| s < t) {
                let (one, other) = (surface.triangles[s], surface.triangles[t]);
                let is_apart = !one.iter().any(|corner| other.contains(corner));
                count += usize::from(is_apart && intersect(corners(one), corners(other)));
            }
        }
    });
    count
}

/// Pairs of triangles of two cloths that pass through each other. The second's origin is `offset` (m) from the first's.
///
/// Costs as much as a step, and allocates.
pub fn intersecting_pairs_between(
    (particles, topology): (&Particles, &Topology),
    (others, other): (&Particles, &Topology),
    offset: Vec3A,
) -> usize {
    let (a, b) = (topology.surface(), other.surface());
    let corners = |triangle: [u32; 3]| triangle.map(|i| particles.position[i as usize]);
    let other_corners = |triangle: [u32; 3]| triangle.map(|i| others.position[i as usize] + offset);
    let [mut at, mut bt] = [BvhBounds::default(), BvhBounds::default()];
    at.follow(a, |triangle| Bounds::around(corners(triangle)), None::<fn(_) -> _>);
    bt.follow(b, |triangle| Bounds::around(other_corners(triangle)), None::<fn(_) -> _>);
    let mut count = 0;
    Traversal::default().between((a, &at), (b, &bt), |p, q| {
        for s in a.of_leaf(p) {
            for t in b.of_leaf(q) {
                count += usize::from(intersect(corners(a.triangles[s]), other_corners(b.triangles[t])));
            }
        }
    });
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        material::{Elasticity, SpringConstants},
        topology::{Spring, SpringBatch},
    };

    #[test]
    fn a_stretched_moving_pair_has_the_strain_and_the_energy_of_the_book() {
        let particles = Particles {
            position: vec![Vec3A::ZERO, Vec3A::X * 3.0],
            velocity: vec![Vec3A::ZERO, Vec3A::Y * 4.0],
            inverse_mass: vec![0.0, 0.5],
            ..Particles::default()
        };
        let topology = Topology {
            springs: vec![Spring { a: 0, b: 1, rest: 2.0, ..Spring::default() }],
            batches: vec![SpringBatch { kind: SpringKind::Structural, range: 0..1, on_strand: false, carries: false }],
            areas: vec![1.0; 2],
            ..Default::default()
        };
        let mut springs = [SpringConstants::default(); 3];
        springs[0].stiffness = 100.0;
        let material = Material::bare(1.0, Elasticity::Springs(springs));
        assert_eq!(strain(&particles, &topology), Strain { largest: 0.5, mean: 0.5 });
        let energy = energy(&particles, &topology, &material, Vec3A::X * 10.0);
        assert_eq!(energy, Energy { kinetic: 16.0, elastic: 50.0, gravitational: -60.0 });
    }
}
