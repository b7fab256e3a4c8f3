//! What a scene is made of and what happens in it, for those who look for the cause of something.

use core::{cell::Cell, fmt::Display};

/// Tells what happens, if anybody listens.
#[derive(Debug)]
pub struct Diary {
    seed: u64,
    frame: Cell<u32>,
    is_open: bool,
}

impl Diary {
    pub fn new(seed: u64, is_open: bool) -> Self {
        Self { seed, frame: Cell::new(0), is_open }
    }

    /// Turns to the page of a frame.
    pub fn turn_to(&self, frame: u32) {
        self.frame.set(frame);
    }

    pub fn frame(&self) -> u32 {
        self.frame.get()
    }

    pub fn note(&self, what: impl Display) {
        if self.is_open {
            eprintln!("seed {}, frame {}: {what}", self.seed, self.frame.get());
        }
    }
}
