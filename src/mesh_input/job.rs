//! Work that takes longer than a frame, in tasks beside the frames.

use bevy::tasks::{AsyncComputeTaskPool, Task, TaskPool, futures::check_ready};

/// Jobs by what they are to come to. All who ask for the same wait for the same one.
#[derive(Debug)]
pub(crate) struct Jobs<K, T>(Vec<Job<K, T>>);

#[derive(Debug)]
struct Job<K, T> {
    key: K,
    task: Task<T>,
    /// What has come out of the task.
    done: Option<T>,
    /// Whether somebody has asked for it in this frame.
    is_wanted: bool,
}

impl<K, T> Default for Jobs<K, T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<K: PartialEq, T: Send + Sync + 'static> Jobs<K, T> {
    /// Drops what nobody has asked for since the last time or what `is_stale`, and looks for what is done. Once a frame,
    /// so that all who wait for the same see it in the same frame.
    pub fn update(&mut self, is_stale: impl Fn(&K) -> bool) {
        self.0.retain_mut(|job| core::mem::take(&mut job.is_wanted) && !is_stale(&job.key));
        for job in &mut self.0 {
            // A task that is done must not be asked again.
            if job.done.is_none() {
                job.done = check_ready(&mut job.task);
            }
        }
    }

    /// Whether a job has been begun and isn't done.
    pub fn is_running(&mut self, key: &K) -> bool {
        self.ask(key).is_some_and(|job| job.done.is_none())
    }

    /// What a job has come to, which nobody who asks in each frame loses. None while it runs, and when `work` has just
    /// been begun for it.
    pub fn get_or_begin<F>(&mut self, key: K, work: impl FnOnce() -> F) -> Option<&T>
    where
        F: Future<Output = T> + Send + Sync + 'static,
    {
        if self.ask(&key).is_none() {
            let task = AsyncComputeTaskPool::get_or_init(TaskPool::new).spawn(work());
            self.0.push(Job { key, task, done: None, is_wanted: true });
            return None;
        }
        self.0.iter().find(|job| job.key == key)?.done.as_ref()
    }

    /// Drops a job: what it has come to is of no use.
    pub fn forget(&mut self, key: &K) {
        self.0.retain(|job| job.key != *key);
    }

    fn ask(&mut self, key: &K) -> Option<&mut Job<K, T>> {
        let job = self.0.iter_mut().find(|job| job.key == *key)?;
        job.is_wanted = true;
        Some(job)
    }
}

#[cfg(test)]
mod tests {
    use std::{
        sync::{
            Arc,
            atomic::{AtomicU32, Ordering},
        },
        thread,
    };

    use super::*;

    #[test]
    fn a_job_is_begun_once_and_kept_as_long_as_somebody_asks() {
        let (mut jobs, begun) = (Jobs::default(), Arc::new(AtomicU32::new(0)));
        let ask = |jobs: &mut Jobs<&str, u32>| {
            let begun = begun.clone();
            jobs.get_or_begin("job", || async move { begun.fetch_add(1, Ordering::Relaxed) }).copied()
        };
        let ask_until_done = |jobs: &mut Jobs<&str, u32>| {
            loop {
                jobs.update(|_| false);
                if let Some(done) = ask(jobs) {
                    return done;
                }
                thread::yield_now();
            }
        };
        assert_eq!([ask_until_done(&mut jobs), ask_until_done(&mut jobs)], [0, 0]);
        assert!(!jobs.is_running(&"job"));
        // Asked for before the first, and not before the second.
        jobs.update(|_| false);
        jobs.update(|_| false);
        assert!(jobs.0.is_empty());
        assert_eq!(ask_until_done(&mut jobs), 1);
        jobs.update(|_| true);
        assert!(jobs.0.is_empty(), "what is stale is dropped");
    }
}
