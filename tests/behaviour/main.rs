//! What the plugin does in an app, without a window: one module per behaviour.

mod common;
mod quiet;

mod any_mesh;
#[cfg(feature = "mesh_colliders")]
mod bad_colliders;
mod bad_contact;
mod bad_meshes;
mod bad_pins;
mod bad_surroundings;
mod bad_transforms;
mod bad_values;
mod body;
mod budget;
mod changed_mesh;
mod closing_boxes;
mod cloth_on_cloth;
mod coarse_meshes;
mod collision_mask;
mod commands;
#[cfg(feature = "debug")]
mod debug;
mod determinism;
mod draws;
mod draws_between_steps;
mod events;
mod fabric_assets;
mod far_away;
mod floating_origin;
mod forces;
mod garments;
#[cfg(feature = "gltf")]
mod gltf;
mod grabs;
mod gravity;
mod jerks;
mod large_meshes;
mod late;
mod late_mesh;
mod mannequin;
#[cfg(feature = "mesh_colliders")]
mod mesh_colliders;
mod missing_plugins;
mod obstacles;
mod outfits;
mod pin_selectors;
mod pin_targets;
mod plain_springs;
#[cfg(feature = "picking")]
mod pointers;
mod presets;
mod proxies;
mod recovery;
mod reflection;
mod removal;
mod scaled;
mod scaled_obstacles;
mod schedules;
mod several_targets;
mod sides;
#[cfg(feature = "mesh_colliders")]
mod skinned_colliders;
mod skins;
mod sleep;
mod small_cloth;
mod stretch;
mod teleports;
mod uneven_flags;
mod violence;
mod winds;
mod worn;
