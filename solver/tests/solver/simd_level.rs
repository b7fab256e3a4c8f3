//! Whatever the processor has, the bits are the same.

use bevy_math::{DVec3, Isometry3d, Vec3, Vec3A, primitives::Sphere};
use drape_solver::{
    Elasticity, Gusts, Material, Method, Obstacle, SimdLevel, Solid, SourceMesh, WindRegion, WindSource,
};

use crate::{
    bench_bed::{ALL, Bed, bits},
    fixtures::{
        hand::{Grip, hand},
        material::{Fabric, Springs, springs_in_air},
        mesh::{Grid, icosphere, shaped},
    },
    lattices::{hexagons, strewn},
    strand_packs::{ell, sleeve},
};

/// Plain springs.
fn of_springs(damping: f32) -> Material {
    let constants =
        Springs { structural_damping: damping, shear_damping: damping, bend_damping: damping, ..Springs::default() };
    Material { damping: 0.5, ..springs_in_air(constants) }
}

/// A sheet that gets stiffer, and gives way where it is pressed together.
fn of_moduli(damping: f32) -> Material {
    let sheet = Fabric { damping: 0.5, stretch_damping: 0.1 * damping, bend_damping: damping, ..Fabric::DENIM };
    Fabric { compression: 0.5, warp_stiffening: 2.0, weft_stiffening: 1.0, ..sheet }.material()
}

/// A cloth to which all that there is happens at once.
fn scene(mesh: impl Into<SourceMesh>, method: Method, material: Material) -> Bed {
    let bed = Bed::new(mesh, material).pinned([0, 4]).tethered(&[0, 4]).with_levels();
    let mut bed = Bed { method, max_substeps: 512, ..bed };
    if let (Method::Explicit, Elasticity::Moduli(moduli)) = (method, &mut bed.material.elasticity) {
        // What stiffens where it is torn at outgrows the substeps that the explicit method was given.
        moduli.stiffening = [0.0; 2];
    }
    let gusts = Gusts { strength: 0.5, period: 4.0, turbulence: 0.3, eddy_size: 1.0, seed: 7 };
    let (region, origin) = (WindRegion::Everywhere, Vec3A::ZERO);
    let velocity = Vec3A::new(1.0, 2.0, 6.0);
    bed.winds = vec![WindSource { velocity, gusts, region, origin, travelled: DVec3::ZERO, gusts_passed: 0.0 }];
    let pose = Isometry3d::from_translation(Vec3::from(bed.centre()) + Vec3::new(0.0, -0.2, 0.2));
    bed.obstacles = vec![Obstacle::still(Solid::Sphere(Sphere::new(0.25)), pose)];
    bed.grabs = vec![hand(&bed, 100, [0.2, 0.3, 0.5], Grip::default())];
    bed.particles.force[20] = Vec3A::new(0.01, 0.02, 0.0);
    bed
}

#[test]
fn the_widest_instructions_and_the_plainest_give_the_same_bits() {
    // In rows and columns that fill blocks of eight, that don't, in none, and on threads, without and with levels.
    let meshes = [
        SourceMesh::from(Grid::new(1.0, 1.0, 24, 24)),
        Grid::new(1.0, 0.8, 21, 17).lying().into(),
        icosphere(0.4, 6),
        strewn(20),
        shaped(hexagons(20), |p| 0.05 * p),
        sleeve(16, 24),
        ell(22),
    ];
    let materials = [of_springs(0.0), of_springs(0.02), of_moduli(0.0), of_moduli(0.02)];
    let cases = ALL.into_iter().flat_map(|method| materials.map(|material| (method, material)));
    for ((method, material), mesh) in cases.flat_map(|case| meshes.iter().map(move |mesh| (case, mesh.clone()))) {
        let [best, baseline] = [SimdLevel::Best, SimdLevel::Baseline].map(|simd_level| {
            let mut bed = scene(mesh.clone(), method, material);
            bed.scratch.simd_level = simd_level;
            // Where a sheet is torn at for long, the explicit method comes to its end.
            let frames = if method == Method::Explicit { 20 } else { 60 };
            let touched = (0..frames).map(|_| bed.step(1.0 / 60.0).contacts).max();
            assert!(touched > Some(0), "{method:?}: the scene of {} particles has contacts", bed.particles.len());
            assert!(bed.particles.is_finite(), "{method:?} {:?} {}", material.elasticity, bed.particles.len());
            bits(&bed.particles)
        });
        assert!(best == baseline, "{method:?}, {:?}, {} numbers", material.elasticity, best.len());
    }
}
