//! When everything happens: the plugin, and the order of its systems. Bridges to physics engines put theirs between these.

use bevy::{
    app::FixedMain,
    asset::AssetEventSystems,
    ecs::schedule::{
        InternedScheduleLabel, ScheduleLabel, SingleThreadedExecutor, common_conditions::condition_changed_to,
    },
    prelude::*,
};

#[cfg(any(feature = "debug", feature = "panel"))]
use bevy::ecs::system::ScheduleSystem;

use crate::{
    attach, build, cloth, draw,
    fabric::{self, Fabric},
    frame::{self, ClothRun},
    simulate, skin,
    surroundings::{
        self, body,
        collider::{self, changes},
        wind,
    },
};

/// The stages of a cloth's frame, in their order. Games order their systems around them.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ClothSystems {
    /// `PreUpdate`: fabrics are copied from their assets, meshes become cloth (large ones once they are worked out), failed
    /// ones are tried again, resets are done.
    Prepare,
    /// The plugin's schedule: settings, pins, obstacles and winds are read. Move those before it.
    Gather,
    /// The plugin's schedule: all cloths take one step but those that step late. Add forces before it.
    Simulate,
    /// The plugin's schedule: events of the step are sent. Read positions after it.
    Finalize,
    /// `PostUpdate`, after transforms have been propagated: cloths that step [late](crate::prelude::ClothTiming::Late) do all of
    /// these three things, one after the other. Move what they hang on and meet before it, as animation does, and add forces
    /// before it: in `PostUpdate`, in `Update`, or in a fixed schedule, whose forces add up until then. Read positions after it.
    Late,
    /// `PostUpdate`, after transforms have been propagated: cloths are interpolated, shaded and written to their
    /// meshes, and grabs are told of.
    Draw,
}

/// Real-time cloth for all entities with a [`Cloth`](crate::prelude::Cloth).
///
/// Cloths whose [`timing`](crate::prelude::ClothTiming) is `Late` take no step in the plugin's schedule, whichever that is, but
/// one in each frame in [`ClothSystems::Late`], as long as time goes on. Without such cloths that costs nothing.
///
/// Needs Bevy's time, asset, mesh and transform plugins, which `DefaultPlugins` has; without a window, `MinimalPlugins`,
/// `TransformPlugin`, `AssetPlugin` and `MeshPlugin`. With less it does nothing and says what is missing.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_drape::prelude::*;
/// App::new().add_plugins((MinimalPlugins, ClothPlugin::new(FixedUpdate)));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ClothPlugin {
    schedule: InternedScheduleLabel,
    parallel: bool,
}

impl Default for ClothPlugin {
    /// Steps in `FixedPostUpdate`, several cloths at a time.
    fn default() -> Self {
        Self::new(FixedPostUpdate)
    }
}

impl ClothPlugin {
    /// Steps once each time that `schedule` runs, by the time that the `Time` resource gives there.
    ///
    /// In one of Bevy's fixed schedules, what is drawn is interpolated between steps. In any other, the latest step is
    /// drawn, and the motion depends on the frame rate as far as the time steps do. Cloth that steps late does so whatever the
    /// schedule: even in `PostUpdate`, it comes after the cloths of the schedule, and after transforms have been propagated.
    pub fn new(schedule: impl ScheduleLabel) -> Self {
        Self { schedule: schedule.intern(), parallel: true }
    }

    /// Steps all cloths on one thread, with the same bits as on several.
    pub fn single_threaded(mut self) -> Self {
        self.parallel = false;
        self
    }

    fn is_fixed(&self) -> bool {
        [
            FixedFirst.intern(),
            FixedPreUpdate.intern(),
            FixedUpdate.intern(),
            FixedPostUpdate.intern(),
            FixedLast.intern(),
            FixedMain.intern(),
        ]
        .contains(&self.schedule)
    }
}

impl Plugin for ClothPlugin {
    fn build(&self, app: &mut App) {
        fabric::loader::register(app);
        #[cfg(feature = "gltf")]
        crate::gltf::register(app);
        app.init_resource::<surroundings::ClothGravity>()
            .init_resource::<simulate::budget::ClothBudget>()
            .init_resource::<simulate::budget::StepDuration>()
            .init_resource::<collider::Obstacles>()
            .init_resource::<changes::ObstacleChanges>()
            .init_resource::<wind::Winds>()
            .init_resource::<build::plan::PlanCache>()
            .init_resource::<frame::Steps>()
            .init_resource::<frame::Teleported>()
            .init_resource::<frame::ColliderTeleportThreshold>()
            .insert_resource(ClothRun { fixed: self.is_fixed(), parallel: self.parallel })
            .configure_sets(PreUpdate, ClothSystems::Prepare.run_if(has_what_it_needs))
            .configure_sets(
                self.schedule,
                (ClothSystems::Gather, ClothSystems::Simulate, ClothSystems::Finalize)
                    .chain()
                    // Where the schedule is also theirs.
                    .after(ClothSystems::Prepare)
                    .before(ClothSystems::Draw)
                    .run_if(has_what_it_needs),
            )
            .configure_sets(
                PostUpdate,
                (
                    ClothSystems::Late
                        .after(TransformSystems::Propagate)
                        // Where that is the plugin's schedule.
                        .after(ClothSystems::Finalize)
                        .run_if(has_what_it_needs.and_then(time_goes_on)),
                    ClothSystems::Draw
                        .after(TransformSystems::Propagate)
                        .before(AssetEventSystems)
                        .run_if(has_what_it_needs),
                )
                    .chain(),
            )
            .add_systems(
                PreUpdate,
                (
                    fabric::handle::copy_fabrics
                        .run_if(resource_exists::<Assets<Fabric>>)
                        .before(build::system::build_cloths),
                    (skin::outfit::put_on, build::garment::join_garments).chain().before(build::system::build_cloths),
                    build::system::build_cloths,
                    build::proxy::build_proxies.after(build::system::build_cloths),
                    body::make::make_bodies,
                    (
                        cloth::timing::choose_passes,
                        collider::begin_late_memory.run_if(condition_changed_to(true, cloth::timing::any_is_late)),
                    )
                        .chain()
                        .after(build::system::build_cloths),
                )
                    .in_set(ClothSystems::Prepare),
            )
            .add_systems(
                self.schedule,
                (frame::begin_fixed_step, frame::forget_teleports)
                    .chain()
                    .in_set(ClothSystems::Gather)
                    .before(cloth::update::update_settings),
            )
            .add_systems(
                PostUpdate,
                (frame::begin_late_step, run_late_pass.run_if(cloth::timing::any_is_late))
                    .chain()
                    .in_set(ClothSystems::Late),
            )
            .add_systems(
                PostUpdate,
                (attach::grabs::send_grab_events, draw::shape_cloths, draw::shape_proxies, draw::write_meshes)
                    .chain()
                    .in_set(ClothSystems::Draw),
            )
            .add_systems(PostUpdate, draw::fit_skins.in_set(ClothSystems::Draw))
            // Once more for meshes that are swapped after that: one that is drawn with the wrong skin ends the app.
            .add_systems(Last, draw::fit_skins.run_if(has_what_it_needs))
            .add_observer(build::system::on_cloth_removed)
            .add_observer(collider::on_collider_removed)
            .add_observer(body::on_body_removed)
            .add_observer(build::system::on_skeleton_removed)
            .add_observer(build::system::on_part_removed)
            .add_observer(build::proxy::on_proxy_removed)
            .add_observer(attach::pins::on_skin_removed)
            .add_observer(skin::outfit::on_taken_off)
            .add_observer(cloth::update::on_springs_removed);
        #[cfg(feature = "mesh_colliders")]
        app.init_resource::<collider::mesh::PreparedMeshes>().add_systems(
            self.schedule,
            collider::mesh::drop_changed_meshes
                .in_set(ClothSystems::Gather)
                .after(frame::forget_teleports)
                .before(collider::mesh::prepare_meshes),
        );
        add_pass(app, self.schedule);
        // A schedule of its own: the plugin's may be the one that it runs in.
        app.edit_schedule(LatePass, |schedule| {
            // One after the other anyway; what takes long is done side by side within.
            schedule
                .set_executor(SingleThreadedExecutor::new())
                .configure_sets((ClothSystems::Gather, ClothSystems::Simulate, ClothSystems::Finalize).chain());
        });
        add_pass(app, LatePass);
    }

    /// Does what needs a plugin that has come later, and says what is missing.
    fn finish(&self, app: &mut App) {
        fabric::loader::register(app);
        let world = app.world();
        let needs = [
            ("TimePlugin (in MinimalPlugins)", world.contains_resource::<Time>()),
            ("TransformPlugin", app.is_plugin_added::<TransformPlugin>()),
            ("AssetPlugin and MeshPlugin", world.contains_resource::<Assets<Mesh>>()),
        ];
        let missing: Vec<&str> = needs.iter().filter(|(_, there)| !there).map(|&(plugin, _)| plugin).collect();
        if !missing.is_empty() {
            warn!("ClothPlugin can't do its work: it needs {}; add them to the app", missing.join(", "));
        }
    }
}

/// The schedule of the late pass, which runs once a frame in [`ClothSystems::Late`].
#[derive(ScheduleLabel, Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct LatePass;

/// Adds the systems of a pass to its schedule. Each of them works on the cloths of the pass that has begun, and remembers what it
/// has to for each pass.
fn add_pass(app: &mut App, schedule: impl ScheduleLabel + Clone) {
    app.add_systems(
        schedule.clone(),
        (
            (
                cloth::update::update_settings,
                attach::pins::update_pins,
                attach::pins::advance_builds,
                attach::pins::follow_targets,
                attach::grabs::lead_grabs,
                collider::gather_obstacles,
                wind::gather_winds,
            )
                .chain()
                .in_set(ClothSystems::Gather),
            (changes::find_changes, simulate::budget::divide_budget, simulate::step_cloths, changes::forget_changes)
                .chain()
                .in_set(ClothSystems::Simulate),
            simulate::report_steps.in_set(ClothSystems::Finalize),
        ),
    );
    #[cfg(feature = "mesh_colliders")]
    app.add_systems(
        schedule,
        collider::mesh::prepare_meshes
            .in_set(ClothSystems::Gather)
            .after(frame::forget_teleports)
            .before(collider::gather_obstacles),
    );
}

/// Steps all cloths that step late.
fn run_late_pass(world: &mut World) {
    // It is there, and a system may not fail the app where somebody has taken it out.
    let _ = world.try_run_schedule(LatePass);
}

/// While time stands still, no cloth steps, and what is remembered of the latest step stays true.
fn time_goes_on(time: Option<Res<Time>>) -> bool {
    time.is_some_and(|time| time.delta_secs() > 0.0)
}

/// Without time or meshes there is nothing to do, and no system may ask for them.
fn has_what_it_needs(time: Option<Res<Time>>, meshes: Option<Res<Assets<Mesh>>>) -> bool {
    time.is_some() && meshes.is_some()
}

/// Has `system` run after each step, in the schedule that [`ClothPlugin`] was given: for the `finish` of `plugin`, when
/// that is known whichever was added first. Says so where there is none.
#[cfg(any(feature = "debug", feature = "panel"))]
pub(crate) fn run_after_steps<M>(app: &mut App, plugin: &str, system: impl IntoScheduleConfigs<ScheduleSystem, M>) {
    match schedule_of_steps(app) {
        Some(schedule) => drop(app.add_systems(schedule, system.in_set(ClothSystems::Finalize))),
        None => warn!("{plugin} can't do its work: it needs ClothPlugin; add it to the app"),
    }
}

/// The schedule that [`ClothPlugin`] was given, if it has been added.
#[cfg(any(feature = "avian", feature = "rapier", feature = "debug", feature = "panel"))]
pub(crate) fn schedule_of_steps(app: &App) -> Option<InternedScheduleLabel> {
    app.get_added_plugins::<ClothPlugin>().first().map(|cloth| cloth.schedule)
}
