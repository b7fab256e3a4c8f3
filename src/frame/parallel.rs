//! Runs a system's work side by side.

use bevy::tasks::{ComputeTaskPool, TaskPool};

/// The task pool, where there is one and work may be done in `parallel`.
pub(crate) fn pool(parallel: bool) -> Option<&'static TaskPool> {
    ComputeTaskPool::try_get().filter(|_| parallel).map(|pool| &**pool)
}

/// Visits all items, side by side on the task pool where there is one.
///
/// A task an item, since a cloth is much work. The calling thread works along with the pool's. Systems that call this
/// ask for the main thread (`NonSendMarker`), which would only wait otherwise: on two cores that is half of the machine.
pub(crate) fn for_each<T: Send>(items: impl IntoIterator<Item = T>, parallel: bool, visit: impl Fn(T) + Send + Sync) {
    let visit = &visit;
    match pool(parallel) {
        Some(pool) => {
            pool.scope(|scope| items.into_iter().for_each(|item| scope.spawn(async move { visit(item) })));
        }
        None => items.into_iter().for_each(visit),
    }
}
