//! The standard cloth, free or hung up.

use std::{io, time::Instant};

use bevy::{
    math::{Vec3A, ops},
    prelude::*,
};
use bevy_drape::{build, solver::Topology};

use super::{
    mesh::{self, MeshSource, Top},
    options::{Options, PinnedPart, Switch},
    pins,
    scene::{Cloth, Scene, Settings},
};

/// The cloth hangs from two corners of its top, or from the whole of it.
pub fn hang(options: &Options, mesh: &MeshSource, pinned: PinnedPart) -> io::Result<Scene> {
    let settings = options.settings(false)?;
    let (mut cloth, top) = free(options, &settings, mesh)?;
    let pins = pins::choose(&cloth.topology, &top, pinned);
    cloth.hold(&pins);
    if options.tethers == Switch::On {
        let begun = Instant::now();
        cloth.rig.tethers = Some(build::tethers(&cloth.topology, &pins));
        cloth.tethers_ms = begun.elapsed().as_secs_f64() * 1e3;
    }
    Ok(Scene::new(&settings, [cloth]))
}

/// The cloth at rest but for a smooth ripple of 1 mm, and what it hangs by.
pub fn free(options: &Options, settings: &Settings, mesh: &MeshSource) -> io::Result<(Cloth, Top)> {
    let unusable = |cause: String| io::Error::other(format!("{mesh} can't be used: {cause}"));
    let mut sheet = mesh.sheet(options.n).map_err(unusable)?;
    if options.jitter > 0.0 {
        mesh::jitter(&mut sheet.mesh, options.jitter, options.n);
    }
    let mut cloth = settings.cloth(&sheet.mesh).map_err(|error| unusable(error.to_string()))?;
    cloth.particles.position = rippled(&cloth.topology, &sheet.top);
    if let MeshSource::Grid = mesh {
        // The standard cloth has the same mass at its border as inside.
        cloth.particles.inverse_mass.fill((options.n * options.n) as f32 / settings.material.density);
    }
    Ok((cloth, sheet.top))
}

/// The rest shape, moved by up to 1 mm along its normals: up and down where it lies. What stands stays at rest at its
/// top, where pins would keep a ring stretched.
fn rippled(topology: &Topology, top: &Top) -> Vec<Vec3A> {
    let mut normals = vec![Vec3A::ZERO; topology.particle_count()];
    for triangle in &topology.triangles {
        let [a, b, c] = triangle.map(|i| Vec3A::from(topology.rest[i as usize]));
        for &particle in triangle {
            normals[particle as usize] += (b - a).cross(c - a);
        }
    }
    let wave = |x: f32| ops::sin(core::f32::consts::TAU * x);
    let ripple = |((p, normal), depth): ((&Vec3, Vec3A), f32)| {
        let normal = normal / normal.length().max(f32::MIN_POSITIVE);
        let amplitude = if top.stands() { 0.001 * depth } else { 0.001 };
        Vec3A::from(*p) + normal * (amplitude * wave(p.x) * wave(p.z + 0.25))
    };
    topology.rest.iter().zip(normals).zip(top.depths(&topology.rest)).map(ripple).collect()
}
