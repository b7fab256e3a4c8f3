//! Several threads that work on one large cloth.
//!
//! The work comes in phases, and each phase in units that have nothing to do with each other. Whoever is free takes the
//! next unit, and goes on to the next phase when all units of this one are done. The thread that asks for the work does
//! it too: a pool that is busy with other cloths delays nothing, since only units that somebody is at are waited for.

use core::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};

use bevy_tasks::TaskPool;

/// How often somebody who waits looks again before falling asleep: for some ten microseconds, about as long as waking up
/// takes.
const LOOKS: u32 = 1000;

/// Units of work that may be done at the same time and in any order.
pub(crate) struct Phase<'a> {
    /// Number of units.
    pub units: usize,
    /// Does a unit. The second number is that of the worker: no two of them have the same at the same time.
    pub work: &'a (dyn Fn(usize, usize) + Sync),
}

/// Number of workers that [`run`] has on a pool.
pub(crate) fn size(pool: &TaskPool) -> usize {
    pool.thread_num() + 1
}

/// Does all phases, one after the other.
pub(crate) fn run(pool: &TaskPool, phases: &[Phase]) {
    let progress: Vec<PhaseProgress> = phases.iter().map(|_| PhaseProgress::default()).collect();
    let work = |worker: usize| {
        for (phase, progress) in phases.iter().zip(&progress) {
            progress.work(phase, worker);
        }
    };
    let work = &work;
    pool.scope(|scope| {
        for worker in 1..size(pool) {
            scope.spawn(async move { work(worker) });
        }
        work(0);
    });
}

/// How far a phase is.
#[derive(Default)]
struct PhaseProgress {
    /// How many units have been taken, and how many of them from either end.
    taken: AtomicUsize,
    first: AtomicUsize,
    last: AtomicUsize,
    done: AtomicUsize,
    asleep: Mutex<()>,
    bell: Condvar,
}

impl PhaseProgress {
    /// Works along until all units are done.
    fn work(&self, phase: &Phase, worker: usize) {
        loop {
            if self.taken.fetch_add(1, Ordering::Relaxed) >= phase.units {
                break;
            }
            // Every other worker begins at the far end: what one had in the last phase it mostly has in the next.
            let unit = if worker.is_multiple_of(2) {
                self.first.fetch_add(1, Ordering::Relaxed)
            } else {
                phase.units - 1 - self.last.fetch_add(1, Ordering::Relaxed)
            };
            let _done = Done { progress: self, units: phase.units };
            (phase.work)(unit, worker);
        }
        let is_over = || self.done.load(Ordering::Acquire) >= phase.units;
        for _ in 0..LOOKS {
            if is_over() {
                return;
            }
            core::hint::spin_loop();
        }
        let mut asleep = self.asleep.lock().unwrap_or_else(PoisonError::into_inner);
        while !is_over() {
            asleep = self.bell.wait(asleep).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

/// Counts a unit when it is done, also by a panic: nobody waits for it for ever.
struct Done<'a> {
    progress: &'a PhaseProgress,
    units: usize,
}

impl Drop for Done<'_> {
    fn drop(&mut self) {
        let PhaseProgress { done, asleep, bell, .. } = self.progress;
        if done.fetch_add(1, Ordering::AcqRel) + 1 == self.units {
            let _asleep = asleep.lock().unwrap_or_else(PoisonError::into_inner);
            bell.notify_all();
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy_tasks::TaskPoolBuilder;

    use super::*;

    #[test]
    fn every_unit_is_done_once_and_after_all_of_the_phase_before() {
        for threads in [1, 3] {
            let pool = TaskPoolBuilder::new().num_threads(threads).build();
            let counts: Vec<AtomicUsize> = (0..100).map(|_| AtomicUsize::default()).collect();
            let count = |unit: usize, worker: usize| {
                assert!(worker < size(&pool));
                counts[unit].fetch_add(1, Ordering::Relaxed);
            };
            let check = |_, _| assert!(counts.iter().all(|count| count.load(Ordering::Relaxed) == 1));
            for _ in 0..50 {
                counts.iter().for_each(|count| count.store(0, Ordering::Relaxed));
                run(&pool, &[Phase { units: 100, work: &count }, Phase { units: 7, work: &check }]);
                check(0, 0);
            }
        }
    }
}
