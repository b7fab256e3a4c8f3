//! Runs a system's work side by side.

use bevy::{
    ecs::query::{IterQueryData, QueryFilter},
    prelude::*,
    tasks::{ComputeTaskPool, TaskPool},
};

/// The task pool, where there is one and work may be done in `parallel`.
pub(crate) fn pool(parallel: bool) -> Option<&'static TaskPool> {
    ComputeTaskPool::try_get().filter(|_| parallel).map(|pool| &**pool)
}

/// Visits all matches of a query, side by side on the task pool where there is one.
///
/// A task a match, since a cloth is much work. The calling thread works along with the pool's. Systems that call this
/// ask for the main thread (`NonSendMarker`), which would only wait otherwise: on two cores that is half of the machine.
pub(crate) fn for_each<D, F>(
    query: &mut Query<D, F>,
    parallel: bool,
    visit: impl for<'w, 's> Fn(D::Item<'w, 's>) + Send + Sync,
) where
    D: IterQueryData,
    for<'w, 's> D::Item<'w, 's>: Send,
    F: QueryFilter,
{
    let visit = &visit;
    match pool(parallel) {
        Some(pool) => {
            pool.scope(|scope| query.iter_mut().for_each(|item| scope.spawn(async move { visit(item) })));
        }
        None => query.iter_mut().for_each(visit),
    }
}
