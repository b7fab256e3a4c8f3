//! The solver alone, without an `App`: against answers on paper, for its bits, its memory and its robustness.

mod air;
mod bench_bed;
mod bending;
mod bodies;
mod boundaries;
mod contact;
mod convergence;
mod crowds;
mod determinism;
mod experiments;
mod golden;
mod grabs;
mod grain;
mod lattices;
mod levels;
mod memory;
mod meshes;
mod mounts;
mod rates;
mod robustness;
#[allow(dead_code, unused_imports, reason = "shared with the lab")]
#[path = "../../examples/lab/scene/mod.rs"]
mod scene;
mod self_collision;
mod sharp;
mod sheets;
mod simd_level;
mod speed_limit;
mod springs;
mod stages;
mod statics;
mod strands;
mod tethers;
mod threads;
mod topology;
