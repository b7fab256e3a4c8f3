//! Real-time cloth for the Bevy game engine, in real units.
//!
//! Put a [`Cloth`](prelude::Cloth) next to a `Mesh3d`, and that mesh hangs, blows in the wind and drapes over
//! obstacles, at a fixed time step and with the same bits on every run. This page is a tour; each type has its own
//! page, with units and sensible ranges.
//!
//! - [Getting started](#getting-started)
//! - [Fabrics](#fabrics)
//! - [Pins](#pins)
//! - [Wind and forces](#wind-and-forces)
//! - [Obstacles](#obstacles)
//! - [Cloth on cloth](#cloth-on-cloth)
//! - [Characters](#characters)
//! - [Models from Blender](#models-from-blender)
//! - [Dragging](#dragging)
//! - [Panel](#panel)
//! - [Debugging](#debugging)
//! - [Time and order](#time-and-order)
//! - [Determinism](#determinism)
//! - [Servers](#servers)
//! - [Troubleshooting](#troubleshooting)
//! - [Units](#units)
//! - [Features](#features)
//! - [The solver alone](#the-solver-alone)
//!
//! # Getting started
//!
//! Add [`ClothPlugin`](prelude::ClothPlugin), and spawn a mesh with a [`Cloth`](prelude::Cloth). All else comes with
//! it: [`Fabric`](prelude::Fabric), [`Pins`](prelude::Pins), [`ClothState`](prelude::ClothState) to read and push the
//! cloth, and [`ClothStatus`](prelude::ClothStatus), which says whether it runs.
//!
//! ```no_run
//! use bevy::prelude::*;
//! use bevy_drape::prelude::*;
//!
//! App::new().add_plugins((DefaultPlugins, ClothPlugin::default())).add_systems(Startup, setup).run();
//!
//! fn setup(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
//!     commands.spawn((
//!         Mesh3d(meshes.add(ClothGrid::new(1.0, 1.0, 32, 32))),
//!         Cloth::default(),
//!         Pins::edge_corners(ClothEdge::Top),
//!         Transform::from_xyz(0.0, 2.0, 0.0),
//!     ));
//! }
//! ```
//!
//! Any triangle mesh will do, from code or glTF, indexed or not. Vertices that share a position move as one particle
//! and stay several vertices. Meshes that load late become cloth when they arrive, meshes that change are rebuilt, and
//! the mesh asset is copied for each cloth. In a loaded scene, let [the file say so](#models-from-blender), or insert `Cloth` on the
//! entity that has the `Mesh3d`, or on one above several: without a mesh of its own, it makes one cloth of all meshes below, sewn
//! where they meet ([`ClothPartOf`](prelude::ClothPartOf)).
//! Cloth takes least time on a mesh that is one rectangle or tube of quads, triangulated or not:
//! [`ClothGrid`](prelude::ClothGrid) makes such.
//!
//! # Fabrics
//!
//! A [`Fabric`](prelude::Fabric) has what a textile laboratory measures: density, thickness, stiffness along warp and
//! weft, shear, bending rigidity, damping, friction, drag and lift. Its constants don't depend on the mesh, as long as
//! edges are no longer than [`max_edge_length`](prelude::Fabric::max_edge_length). Eight presets, from silk to leather,
//! say which of their constants were measured.
//!
//! ```
//! # use bevy_drape::prelude::*;
//! let stiff_denim = Fabric { bending_rigidity: 60e-6, ..Fabric::DENIM };
//! assert!(stiff_denim.max_edge_length() < 0.041); // a mesh with longer edges can't show its folds
//! println!("{}", Fabric::PRESETS[0].about()); // which of its constants were measured, and by whom
//! ```
//!
//! The warp runs along V of the UVs, the weft along U; the vertex attribute [`ATTRIBUTE_WARP`](prelude::ATTRIBUTE_WARP)
//! says otherwise. A [`FabricHandle`](prelude::FabricHandle) follows a `*.fabric.ron` file, which may be edited while
//! the app runs, where it enables Bevy's feature `file_watcher`; a file with a field that is missing, unknown or out of
//! its range is refused with file, line and field. [`ClothSprings`](prelude::ClothSprings) beside the cloth are springs
//! of the textbook instead, and what they amount to depends on the mesh.
//!
//! # Pins
//!
//! [`Pins`](prelude::Pins) fix vertices to the cloth's own entity, to another one, or to the world: by index, region,
//! UV, vertex colour, attribute, corner, edge or function. Change the component at any time, or use
//! [`pin_cloth`](prelude::ClothCommands::pin_cloth) and [`unpin_cloth`](prelude::ClothCommands::unpin_cloth).
//!
//! ```
//! # use bevy::prelude::*;
//! # use bevy_drape::prelude::*;
//! # #[derive(Component)] struct Pole;
//! fn hoist(mut commands: Commands, pole: Single<Entity, With<Pole>>, flag: Single<Entity, With<Cloth>>) {
//!     commands.entity(*flag).insert(Pins::edge(ClothEdge::Left).to_entity(*pole));
//! }
//! ```
//!
//! Tethers keep every particle within the cloth's own length of its pins, plus
//! [`tether_slack`](prelude::Cloth::tether_slack): they keep pinned cloth from stretching like rubber. A glTF model [can
//! say itself](#models-from-blender) what is pinned or where its warp runs, by the attributes [`_PIN`](prelude::ATTRIBUTE_PIN) and
//! [`_WARP`](prelude::ATTRIBUTE_WARP).
//!
//! # Wind and forces
//!
//! A [`Wind`](prelude::Wind) is an entity. It presses on triangles by area and angle, everywhere or in a region, with
//! gusts and eddies from a seed. [`ClothGravity`](prelude::ClothGravity) is a resource.
//! [`ClothState`](prelude::ClothState) takes forces and impulses of a game's own.
//!
//! ```
//! # use bevy::prelude::*;
//! # use bevy_drape::prelude::*;
//! fn blow(mut commands: Commands) {
//!     commands.spawn(Wind { velocity: Vec3::X * 4.0, gusts: 0.6, ..default() });
//! }
//!
//! fn explode(mut cloths: Query<&mut ClothState>) {
//!     for mut cloth in &mut cloths {
//!         cloth.add_impulse_in_radius(Vec3::ZERO, 2.0, Vec3::Y * 0.5); // N·s
//!     }
//! }
//! ```
//!
//! # Obstacles
//!
//! An entity with a [`ClothCollider`](prelude::ClothCollider) is an obstacle, moved by its transform: a primitive, or,
//! with the feature `mesh_colliders`, a mesh, a convex hull or a terrain. Contact is solved in every substep, with
//! Coulomb friction and layers.
//!
//! ```
//! # use bevy::prelude::*;
//! # use bevy_drape::prelude::*;
//! fn furnish(mut commands: Commands) {
//!     commands.spawn(ClothCollider::from(InfinitePlane3d::default())); // the ground
//!     commands.spawn((ClothCollider::from(Sphere::new(0.3)), Transform::from_xyz(0.0, 0.5, 0.0)));
//! }
//! ```
//!
//! Move obstacles in `FixedUpdate`; those that only late cloth meets, once a frame ([time and order](#time-and-order)). One that is put elsewhere sweeps nothing, if that is told by
//! [`teleport_collider`](prelude::ClothCommands::teleport_collider) or is beyond the
//! [`ColliderTeleportThreshold`](prelude::ColliderTeleportThreshold). The colliders of Avian and Rapier are obstacles
//! too, and cloth pushes their bodies: [`ClothAvianPlugin`](prelude::ClothAvianPlugin),
//! [`ClothRapierPlugin`](prelude::ClothRapierPlugin).
//!
//! # Cloth on cloth
//!
//! [`Cloth::self_collision`](prelude::Cloth::self_collision), which is off by default, since it costs, keeps triangles and
//! edges apart, of one cloth and of all others that have it on: folds, layers, knots and piles.
//!
//! ```
//! # use bevy_drape::prelude::*;
//! let sheet = Cloth { self_collision: true, self_distance: 0.004, ..Default::default() };
//! ```
//!
//! # Characters
//!
//! A `Cloth` on a skinned mesh is worn: its pins are on the skin, a [`ClothSkin`](prelude::ClothSkin) says how far the rest may be
//! from where the skeleton has it, and it steps after animation, to the very moment that is drawn
//! ([`ClothTiming`](prelude::ClothTiming)).
//!
//! ```
//! # use bevy::prelude::*;
//! # use bevy_drape::prelude::*;
//! # fn dress(mut commands: Commands, cape: Entity) {
//! commands.entity(cape).insert((
//!     Cloth::default(),
//!     Pins::edge(ClothEdge::Top),
//!     ClothSkin { max_distance: ClothMap::Uniform(0.5), backstop: Some(0.01), ..default() },
//! ));
//! # }
//! ```
//!
//! A [`ClothBody`](prelude::ClothBody) on the root of a character gives its joints capsules, made from its skin. The clothes of that
//! character meet them, and those of others only by [`ClothSkin::meets_others`](prelude::ClothSkin::meets_others): in a crowd,
//! nobody's cape hooks on somebody else's arm.
//!
//! ```
//! # use bevy::prelude::*;
//! # use bevy_drape::prelude::*;
//! fn spawn_hero(mut commands: Commands) {
//!     let except = vec!["Cape".into(), "Hair".into()]; // meshes that aren't of the body, or joints that need no capsule
//!     commands.spawn((Name::new("hero"), Transform::default(), ClothBody { except, ..default() })); // and its scene
//! }
//! ```
//!
//! A `ClothCollider::mesh()` next to a `SkinnedMesh` follows the skeleton, too, and other obstacles may hang on bones. What isn't skinned can be pinned to bones, as to any entity; with [`ClothTiming::Late`](prelude::ClothTiming) it
//! steps when the animation of the frame has been applied, too.
//!
//! Clothes that are models of their own, on a skeleton with the same joints, are put on by [`ClothWornBy`](prelude::ClothWornBy):
//!
//! ```
//! # use bevy::prelude::*;
//! # use bevy_drape::prelude::*;
//! fn put_on(mut commands: Commands, coat: Entity, hero: Entity) {
//!     commands.entity(coat).insert((ClothWornBy(hero), ChildOf(hero))); // and off by remove::<ClothWornBy>()
//! }
//! ```
//!
//! A mesh that is finer than what is simulated follows it by a [`ClothProxy`](prelude::ClothProxy).
//!
//! How much of its motion they feel says [`ClothInertia`](prelude::ClothInertia); a skeleton that is put elsewhere takes its clothes
//! along ([`ClothTeleport`](prelude::ClothTeleport)).
//! [`teleport_cloth`](prelude::ClothCommands::teleport_cloth) on the root of a character takes along its cloths,
//! obstacles and pins; [`shift_world`](prelude::WorldShiftCommands::shift_world) is for floating origins.
//!
//! # Models from Blender
//!
//! With the feature `gltf`, which is on by default, a glTF file says itself what is cloth. An artist writes the custom property
//! `cloth` on an object, a mesh or a material, paints `_CLOTH` on its vertices, and exports both; the game spawns the scene.
//!
//! ```no_run
//! # use bevy::prelude::*;
//! fn spawn_hero(mut commands: Commands, assets: Res<AssetServer>) {
//!     commands.spawn(WorldAssetRoot(assets.load(GltfAssetLabel::Scene(0).from_asset("hero.glb")))); // in a cape that is cloth
//! }
//! ```
//!
//! What is in the file are the components of this page, in its scene: [`Cloth`](prelude::Cloth), [`Fabric`](prelude::Fabric) or
//! [`FabricHandle`](prelude::FabricHandle), [`Pins`](prelude::Pins), [`ClothSkin`](prelude::ClothSkin),
//! [`ClothBody`](prelude::ClothBody), [`ClothCollider`](prelude::ClothCollider) and [`Wind`](prelude::Wind). Instances have them, a
//! scene that is reloaded has what its file says then, and code may change or remove them. `docs/blender.md` in the repository has
//! all properties, and where Blender's exporter is told to write them.
//!
//! # Dragging
//!
//! [`ClothPickingPlugin`](prelude::ClothPickingPlugin) lets mouse and fingers take hold of cloth, by a pull of bounded
//! force. The wheel, or a second finger beside the cloth, moves the point nearer and farther; let go with Shift, it
//! stays pinned. A camera that turns with the same button should rest while [`PointerGrabs`](prelude::PointerGrabs)
//! isn't empty. Hands in virtual reality and scripts do the same by code:
//!
//! ```
//! # use bevy::prelude::*;
//! # use bevy_drape::prelude::*;
//! # #[derive(Component)] struct Hand { hold: Option<GrabId> }
//! fn follow_hand(cloth: Single<(&ClothState, &mut ClothGrabs)>, mut hand: Single<(&mut Hand, &Transform)>) {
//!     let (state, mut grabs) = cloth.into_inner();
//!     let (hand, place) = &mut *hand;
//!     if hand.hold.is_none() {
//!         let point = state.nearest_point(place.translation);
//!         hand.hold = point.and_then(|point| grabs.grab(state, point, ClothGrip::default()));
//!     }
//!     if let Some(hold) = hand.hold {
//!         grabs.move_grab(hold, place.translation); // later: grabs.release(hold)
//!     }
//! }
//! ```
//!
//! [`ClothGrabbed`](prelude::ClothGrabbed) and [`ClothReleased`](prelude::ClothReleased) tell of both.
//!
//! # Panel
//!
//! [`ClothPanelPlugin`](panel::ClothPanelPlugin) opens a window with F1. At its top, and always in sight: the time of a step with its
//! history, why it took so many substeps, stretch and energy; pause, single step and slow motion. Below, advice where the settings
//! ask for more than the substeps can solve, and the settings: every constant of the fabric with its unit, by what it acts on, and
//! the source of a preset; solver, timing and pins; skin, inertia and teleports of clothes; wind, and the budget of all cloth.
//! *Revert* goes back to what was loaded, *Copy as Rust* puts the components' code on the clipboard. [`cloth_panel`](panel::cloth_panel) draws the same into a window of a game's own. All components work in
//! bevy-inspector-egui as well.
//!
//! ```no_run
//! # #[cfg(feature = "panel")] {
//! use bevy::prelude::*;
//! use bevy_drape::{panel::ClothPanelPlugin, prelude::*};
//!
//! App::new().add_plugins((DefaultPlugins, ClothPlugin::default(), ClothPanelPlugin::default())).run();
//! # }
//! ```
//!
//! # Debugging
//!
//! [`ClothReport`](prelude::ClothReport) has what the latest step did and how long it took,
//! [`ClothState`](prelude::ClothState) by [`strain`](prelude::ClothState::strain) and
//! [`energy`](prelude::ClothState::energy) how the cloth fares, and by [`structure`](prelude::ClothState::structure) what
//! its mesh was found to be. [`ClothDebugPlugin`](debug::ClothDebugPlugin) draws springs by strain, tethers, pins,
//! normals, obstacles and wind, as a [`ClothDebugConfig`](debug::ClothDebugConfig) or a
//! [`ClothDebugView`](debug::ClothDebugView) asks; [`ClothDiagnosticsPlugin`](debug::ClothDiagnosticsPlugin) counts for
//! Bevy's diagnostics. Nothing panics: what can't be used is refused once, in a warning with the cause and the mend.
//! `docs/debugging.md` in the repository goes through the symptoms.
//!
//! # Time and order
//!
//! Cloth steps in `FixedPostUpdate`, or in the schedule that [`ClothPlugin::new`](prelude::ClothPlugin::new) is given,
//! and drawing interpolates. [`ClothSystems`](prelude::ClothSystems) are the stages to order systems around: `Prepare`
//! (`PreUpdate`), `Gather`, `Simulate` and `Finalize` (the plugin's schedule), `Draw` (`PostUpdate`). Push cloth before
//! `Simulate`, read it after `Finalize`.
//!
//! Animation, though, is sampled in `PostUpdate`, after all fixed steps. Clothes on a character, or a flag on a pole in its
//! hand, step with [`ClothTiming::Late`](prelude::ClothTiming): once in each frame, by the frame's time, when transforms have
//! been propagated, and nothing is interpolated. They touch what is drawn. Add forces before
//! [`ClothSystems::Late`](prelude::ClothSystems::Late), and read them after it. For the same motion whatever the frames are,
//! as servers and replays need it, and for bodies of physics engines, stay with fixed steps.
//!
//! ```
//! # use bevy::prelude::*;
//! # use bevy_drape::prelude::*;
//! # #[derive(Component)] struct Hand;
//! fn raise_flag(mut commands: Commands, hand: Single<Entity, With<Hand>>, mut meshes: ResMut<Assets<Mesh>>) {
//!     commands.spawn((
//!         Mesh3d(meshes.add(ClothGrid::new(1.0, 0.6, 33, 21))),
//!         Cloth { timing: ClothTiming::Late, ..default() },
//!         Pins::edge(ClothEdge::Left).to_entity(*hand),
//!     ));
//! }
//! ```
//!
//! ```
//! # use bevy::prelude::*;
//! # use bevy_drape::prelude::*;
//! # fn read_positions() {}
//! # let mut app = App::new();
//! app.add_observer(|ready: On<ClothReady>| info!("{} is cloth", ready.entity))
//!     .add_systems(FixedPostUpdate, read_positions.after(ClothSystems::Finalize));
//! ```
//!
//! Besides [`ClothReady`](prelude::ClothReady) there are [`ClothFailed`](prelude::ClothFailed) and
//! [`ClothReset`](prelude::ClothReset).
//!
//! Cloth that has come to rest falls [asleep](prelude::ClothStatus::Asleep), which
//! [`ClothFellAsleep`](prelude::ClothFellAsleep) tells, and wakes by itself when something changes near it
//! ([`ClothWokeUp`](prelude::ClothWokeUp)). [`ClothStatus::is_running`](prelude::ClothStatus::is_running) is true of both;
//! [`ClothSleepingDisabled`](prelude::ClothSleepingDisabled) forbids it.
//!
//! [`ClothBudget`](prelude::ClothBudget) limits the time that all cloth takes: what is far from all cameras gets fewer substeps
//! first. [`Cloth::max_work`](prelude::Cloth::max_work) limits one cloth.
//!
//! # Determinism
//!
//! The same input gives the same bits: on one thread or several, whatever instructions the processor has, and whatever
//! order the world stores its entities' components in. What differs from run to run is input: frames that move
//! obstacles, pointers, and when large meshes, which are worked on beside the frames, become cloth.
//!
//! ```
//! # use bevy::prelude::*;
//! # use bevy_drape::prelude::*;
//! App::new().add_plugins((MinimalPlugins, ClothPlugin::default().single_threaded())); // the same bits as without
//! ```
//!
//! # Servers
//!
//! The crate builds and runs without a window, a renderer and its default features.
//!
//! ```no_run
//! use bevy::{mesh::MeshPlugin, prelude::*};
//! use bevy_drape::prelude::*;
//!
//! App::new()
//!     .add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), MeshPlugin, ClothPlugin::default()))
//!     .run();
//! ```
//!
//! # Troubleshooting
//!
//! Look at [`ClothStatus`](prelude::ClothStatus) first. `Waiting`: there is no `Mesh3d` on the entity or below it, or a mesh
//! hasn't loaded. `Building`: a mesh of more than 10,000 triangles is worked on beside the frames. `Failed`: the
//! [`ClothError`] says what is wrong and how to mend it.
//!
//! | symptom | what to do |
//! |---|---|
//! | it stretches | less [`max_strain`](prelude::Cloth::max_strain) or more [`substeps`](prelude::Cloth::substeps); check [`tether_slack`](prelude::Cloth::tether_slack) and the fabric's stiffness |
//! | folds are too wide, and the log says that the mesh is too coarse | a finer mesh, or more [`bending_rigidity`](prelude::Fabric::bending_rigidity) |
//! | triangles cut through an edge of an obstacle | more [`collision_margin`](prelude::Cloth::collision_margin), more substeps, or a finer mesh |
//! | a small, fast or sharp obstacle pierces it | 96 substeps by hand; as a mesh, 32 |
//! | it passes through itself or other cloth | `self_collision` on both, and their layers and masks; more substeps |
//! | it jitters on an obstacle | at least 8 substeps where they are set by hand; move obstacles in `FixedUpdate` |
//! | it is black on one side | `double_sided: true, cull_mode: None` in the material |
//! | it lags behind a jump of its entity | [`teleport_cloth`](prelude::ClothCommands::teleport_cloth), on the root of its character |
//! | an obstacle that is put elsewhere throws it | [`teleport_collider`](prelude::ClothCommands::teleport_collider) |
//! | a very fast obstacle passes without a touch | a larger [`ColliderTeleportThreshold`](prelude::ColliderTeleportThreshold) |
//!
//! # Units
//!
//! Metres, kilograms, seconds, newtons; one unit of world space is a metre. Density is kg/m², thickness m, stiffness
//! N/m (force over width and strain), rigidity N·m, inner damping s, damping of the velocity 1/s; of plain springs, N/m
//! and N·s/m. Rest lengths and masses come from the mesh's rest shape in world scale. Lengths follow the scale of the
//! entity while the cloth runs; masses are those of when it was built, so call
//! [`reset_cloth`](prelude::ClothCommands::reset_cloth) after a change that stays.
//!
//! # Features
//!
//! | feature | what it brings |
//! |---|---|
//! | `parallel` (default) | steps several cloths side by side, and shares a large one between threads; without it everything runs on one thread, with the same bits |
//! | `mesh_colliders` (default) | meshes, convex hulls and height fields as obstacles |
//! | `gltf` (default) | glTF files [say themselves what is cloth](#models-from-blender) |
//! | `picking` (default) | [`ClothPickingPlugin`](prelude::ClothPickingPlugin), on `bevy_picking` |
//! | `avian` | [`ClothAvianPlugin`](prelude::ClothAvianPlugin), for Avian 0.7 |
//! | `rapier` | [`ClothRapierPlugin`](prelude::ClothRapierPlugin), for bevy_rapier3d 0.36 |
//! | `panel` | [`ClothPanelPlugin`](panel::ClothPanelPlugin), on bevy_egui 0.40.1 |
//! | `debug` | [`ClothDebugPlugin`](debug::ClothDebugPlugin) and [`ClothDiagnosticsPlugin`](debug::ClothDiagnosticsPlugin) |
//!
//! # The solver alone
//!
//! How a mesh becomes what is drawn:
//!
//! ```text
//! mesh -> build -> particles and topology
//!                           |
//!   settings, pins, hands, obstacles, winds -> [ forces -> levels -> tethers -> strands -> contact ] x substeps -> state
//!                                                                                                                  |
//!                                            renderer <- mesh <- normals, tangents <- interpolation <- draw <------+
//! ```
//!
//! The solver is in [`solver`] and can be used without Bevy's ECS. `docs/architecture.md` in the repository has a step
//! in its order.

/// Compiles the code of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

mod cloth;
mod error;
mod fabric;
mod garment;
mod parameter;
mod pins;
mod proxy;
mod skin;
mod state;

pub mod build;
mod mesh_input;

mod attach;
mod frame;
mod simulate;
mod surroundings;

mod draw;

#[cfg(feature = "gltf")]
mod gltf;

mod commands;
mod schedule;

#[cfg(any(feature = "avian", feature = "rapier"))]
mod engine;
#[cfg(any(feature = "debug", feature = "panel", feature = "picking"))]
mod tools;

pub use drape_solver as solver;
pub use error::ClothError;
pub use surroundings::collider::Obstacles;
#[cfg(feature = "debug")]
pub use tools::debug;
#[cfg(feature = "panel")]
pub use tools::panel;
#[cfg(feature = "picking")]
pub use tools::picking;

/// What a game needs.
pub mod prelude {
    #[cfg(any(feature = "avian", feature = "rapier"))]
    pub use crate::engine::NotClothCollider;
    #[cfg(feature = "avian")]
    pub use crate::engine::avian::{ClothAvianPlugin, ClothAvianSettings};
    #[cfg(feature = "rapier")]
    pub use crate::engine::rapier::{ClothRapierPlugin, ClothRapierSettings};
    #[cfg(feature = "mesh_colliders")]
    pub use crate::surroundings::collider::mesh::HeightField;
    #[cfg(feature = "picking")]
    pub use crate::tools::picking::{ClothPickingPlugin, ClothPickingSettings, PointerGrabs};
    pub use crate::{
        cloth::{Cloth, ClothSolver, ClothTiming},
        commands::{ClothCommands, WorldShiftCommands},
        error::ClothError,
        fabric::{ClothSprings, Fabric, FabricPreset, file::FabricFileError, handle::FabricHandle},
        frame::ColliderTeleportThreshold,
        garment::{ClothPartOf, ClothParts},
        mesh_input::{ATTRIBUTE_WARP, ClothGrid},
        pins::{ATTRIBUTE_PIN, ClothEdge, PinGroup, PinPredicate, PinSelector, PinTarget, PinVertex, Pins},
        proxy::ClothProxy,
        schedule::{ClothPlugin, ClothSystems},
        simulate::budget::ClothBudget,
        skin::{
            ATTRIBUTE_CLOTH, ATTRIBUTE_CLOTH_BACKSTOP, ClothInertia, ClothMap, ClothOutfit, ClothSkin, ClothTeleport,
            ClothWornBy, TeleportMode,
        },
        solver::{Ellipsoid, LevelPass, MeshError, Solid, TaperedCapsule},
        state::{
            ClothAttachments, ClothFailed, ClothFellAsleep, ClothGrabbed, ClothGrabs, ClothGrip, ClothPoint,
            ClothReady, ClothReleased, ClothReport, ClothReset, ClothSleepingDisabled, ClothState, ClothStatus,
            ClothWokeUp, GrabId, ResetCause,
        },
        surroundings::{
            ClothGravity,
            body::{ClothBody, ClothBodyPart},
            collider::{ClothCollider, ColliderShape},
            wind::{Wind, WindShape},
        },
    };
}
