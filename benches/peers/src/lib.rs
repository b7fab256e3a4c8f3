//! The scene `hang` in other cloth solvers, to compare bevy_drape with.
//!
//! [`scene`] says what hangs, a peer is a [`measure::Peer`] that moves it, and [`line::Line`] is what comes out.

pub mod line;
pub mod measure;
pub mod scene;
