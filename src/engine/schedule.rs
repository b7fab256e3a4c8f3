//! When the bridges to physics engines do their work.

use bevy::{
    ecs::{schedule::ScheduleConfigs, system::ScheduleSystem},
    prelude::*,
};

use super::{Engine, Pushes};
use crate::{
    schedule::{ClothSystems, schedule_of_steps},
    surroundings::collider,
};

/// Has the systems of a bridge to a physics engine run: the first gathers colliders, the second pushes bodies. For the
/// `finish` of `plugin`, when it is known in which schedule. All that `engine_is_done` runs comes first, if that is in the
/// same schedule.
pub(super) fn bridge(
    app: &mut App,
    plugin: &str,
    engine: Engine,
    engine_is_done: impl SystemSet,
    (gather, push): (ScheduleConfigs<ScheduleSystem>, ScheduleConfigs<ScheduleSystem>),
) {
    let Some(schedule) = schedule_of_steps(app) else {
        warn!("{plugin} can't do its work: it needs ClothPlugin; add it to the app");
        return;
    };
    if !app.world().contains_resource::<Pushes>() {
        app.init_resource::<Pushes>()
            .configure_sets(
                schedule,
                (
                    // In the same order always: contact depends on that of the obstacles.
                    (BridgeSystems::Gather(Engine::Avian), BridgeSystems::Gather(Engine::Rapier))
                        .chain()
                        .in_set(ClothSystems::Gather)
                        .after(collider::gather_obstacles),
                    (BridgeSystems::Push(Engine::Avian), BridgeSystems::Push(Engine::Rapier))
                        .chain()
                        .in_set(ClothSystems::Finalize),
                ),
            )
            .add_systems(
                schedule,
                (
                    super::untie_attached.in_set(ClothSystems::Gather).after(BridgeSystems::Gather(Engine::Rapier)),
                    super::collect_pushes.in_set(ClothSystems::Finalize).before(BridgeSystems::Push(Engine::Avian)),
                    super::note_anchors.in_set(ClothSystems::Finalize).after(BridgeSystems::Push(Engine::Rapier)),
                ),
            );
    }
    app.configure_sets(schedule, ClothSystems::Gather.after(engine_is_done)).add_systems(
        schedule,
        (gather.in_set(BridgeSystems::Gather(engine)), push.in_set(BridgeSystems::Push(engine))),
    );
}

/// What bridges to physics engines do.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum BridgeSystems {
    /// Adds an engine's colliders to the obstacles.
    Gather(Engine),
    /// Pushes an engine's bodies.
    Push(Engine),
}
