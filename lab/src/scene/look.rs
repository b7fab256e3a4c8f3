//! What is looked at after each frame.

use bevy::math::Vec3A;
use bevy_drape::solver::{SpringKind, constraint::unstructured::spring::strain, measure};

use super::{Scene, depth};

/// What a scene is like after a frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct Look {
    /// Strain of the structural springs, no unit.
    pub max_strain: f32,
    pub p99_strain: f32,
    pub mean_strain: f32,
    /// The deepest place of any triangle inside an obstacle, m.
    pub penetration: f32,
    /// The deepest particle, m.
    pub particle_penetration: f32,
    /// Pairs of triangles that pass through each other, of all cloths.
    pub intersecting_pairs: usize,
    /// Speed of the fastest particle, m/s.
    pub max_speed: f32,
    /// What the experiment counts.
    pub fault: f32,
}

impl Look {
    pub fn at(scene: &Scene) -> Self {
        let mut strains: Vec<f32> = scene
            .cloths
            .iter()
            .flat_map(|cloth| {
                let position = &cloth.particles.position;
                cloth.topology.springs_of(SpringKind::Structural).map(|spring| strain(position, spring))
            })
            .collect();
        // A full sort of a large cloth's springs would take longer than its frame.
        let at = (strains.len() - 1) * 99 / 100;
        let (_, p99, above) = strains.select_nth_unstable_by(at, f32::total_cmp);
        let (p99_strain, max_strain) = (*p99, above.iter().copied().fold(*p99, f32::max));
        let speeds = scene.cloths.iter().flat_map(|cloth| &cloth.particles.velocity).map(|v| v.length());
        Self {
            max_strain,
            p99_strain,
            mean_strain: strains.iter().map(|strain| strain.max(0.0)).sum::<f32>() / strains.len() as f32,
            penetration: penetration(scene),
            particle_penetration: particle_penetration(scene),
            intersecting_pairs: intersecting_pairs(scene),
            max_speed: speeds.fold(0.0, f32::max),
            fault: scene.fault.as_ref().map_or(0.0, |fault| (fault.count)(scene)),
        }
    }

    /// The worse of two, each value by itself.
    pub fn worse_of(&self, other: &Self) -> Self {
        Self {
            max_strain: self.max_strain.max(other.max_strain),
            p99_strain: self.p99_strain.max(other.p99_strain),
            mean_strain: self.mean_strain.max(other.mean_strain),
            penetration: self.penetration.max(other.penetration),
            particle_penetration: self.particle_penetration.max(other.particle_penetration),
            intersecting_pairs: self.intersecting_pairs.max(other.intersecting_pairs),
            max_speed: self.max_speed.max(other.max_speed),
            fault: self.fault.max(other.fault),
        }
    }
}

fn penetration(scene: &Scene) -> f32 {
    let mut deepest = 0.0;
    for (solid, obstacle) in scene.solids.iter().zip(&scene.surroundings.obstacles) {
        let to_local = obstacle.end.inverse();
        for triangle in scene.triangles() {
            deepest = depth::deepest(solid, triangle.map(|corner| to_local.transform_point(corner)), deepest);
        }
    }
    deepest
}

fn particle_penetration(scene: &Scene) -> f32 {
    let obstacles = || scene.solids.iter().zip(&scene.surroundings.obstacles);
    let depth = |p: &Vec3A| {
        let depths =
            obstacles().map(|(solid, obstacle)| -solid.surface(obstacle.end.inverse().transform_point(*p)).distance);
        depths.fold(0.0, f32::max)
    };
    scene.cloths.iter().flat_map(|cloth| &cloth.particles.position).map(depth).fold(0.0, f32::max)
}

fn intersecting_pairs(scene: &Scene) -> usize {
    let cloths = scene.cloths.iter().map(|cloth| (&cloth.particles, &cloth.topology));
    let with_others =
        cloths.clone().enumerate().flat_map(|(i, one)| cloths.clone().skip(i + 1).map(move |other| (one, other)));
    let within: usize =
        cloths.clone().map(|(particles, topology)| measure::intersecting_pairs(particles, topology)).sum();
    within + with_others.map(|(one, other)| measure::intersecting_pairs_between(one, other, Vec3A::ZERO)).sum::<usize>()
}
