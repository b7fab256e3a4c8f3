//! An app whose warnings are counted.

use std::{
    io::{self, Write},
    sync::{Arc, Mutex},
};

use bevy::{
    ecs::schedule::{ScheduleLabel, SingleThreadedExecutor},
    log::{tracing::subscriber, tracing_subscriber::fmt},
    prelude::*,
};
use bevy_drape::prelude::*;

use crate::common::*;

/// What is logged on this thread.
#[derive(Clone, Default)]
struct Log(Arc<Mutex<Vec<u8>>>);

impl Write for Log {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().expect("no test fails while it writes").write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// An app that works on one thread, and what it has warned of.
pub struct Quiet {
    pub app: App,
    log: Log,
}

impl Quiet {
    pub fn new() -> Self {
        let mut app = headless_with(ClothPlugin::new(Update).single_threaded());
        for schedule in [PreUpdate.intern(), Update.intern()] {
            app.edit_schedule(schedule, |schedule| {
                schedule.set_executor(SingleThreadedExecutor::new());
            });
        }
        Self { app, log: Log::default() }
    }

    /// The warnings of so many frames.
    pub fn run(&mut self, frames: usize) -> Vec<String> {
        let log = self.log.clone();
        let listener = fmt().with_ansi(false).with_writer(move || log.clone()).finish();
        subscriber::with_default(listener, || run(&mut self.app, frames));
        let said = core::mem::take(&mut *self.log.0.lock().expect("no test fails while it writes"));
        String::from_utf8(said).expect("text").lines().filter(|line| line.contains("WARN")).map(Into::into).collect()
    }
}
