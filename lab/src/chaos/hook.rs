//! Panics of scenes, caught and told of where they are counted.

use core::cell::RefCell;
use std::{
    panic::{self, AssertUnwindSafe},
    sync::Once,
};

thread_local! {
    /// What the scene on this thread has panicked with, if there is a scene.
    static CAUGHT: RefCell<Option<String>> = const { RefCell::new(None) };
}

static HOOK: Once = Once::new();

/// Does some work, and gives the first message and place of a panic in it.
pub fn catch(work: impl FnOnce()) -> Result<(), String> {
    HOOK.call_once(listen);
    CAUGHT.set(Some(String::new()));
    let result = panic::catch_unwind(AssertUnwindSafe(work));
    let message = CAUGHT.take().unwrap_or_default();
    result.map_err(|_| message)
}

/// Keeps the messages of scenes; those of others go where they went.
fn listen() {
    let others = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        let is_caught = CAUGHT.with_borrow_mut(|caught| match caught {
            Some(message) => {
                if message.is_empty() {
                    *message = info.to_string().replace('\n', " ");
                }
                true
            }
            None => false,
        });
        if !is_caught {
            others(info);
        }
    }));
}
