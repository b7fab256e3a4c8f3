//! Experiments on cloth without a window: what the lab measures, and what tests and examples take from it.
//!
//! - [`scene`]: the standard scenes. Cloths on the bare solver, what surrounds them, and what happens.
//! - [`laboratory`]: what a textile laboratory measures, compared with answers on paper.
//! - [`chaos`]: random scenes in headless apps.
//! - [`command_line`]: all of these, and what they cost, as JSON lines.

pub mod app;
pub mod chaos;
pub mod character;
pub mod clips;
pub mod command_line;
pub mod contact;
pub mod hang;
pub mod laboratory;
pub mod measure;
pub mod mesh;
pub mod options;
pub mod oracle;
pub mod pins;
pub mod report;
pub mod scene;
pub mod shares;
pub mod sizes;
pub mod sweep;
pub mod threads;
