//! What the panel does, driven by pointer and keys through its accessibility tree: one module per behaviour.

#![cfg(feature = "panel")]

mod common;

mod bad_numbers;
mod budget;
mod choice;
mod clipboard;
mod clock;
#[cfg(feature = "debug")]
mod drawing;
mod edits;
mod fabrics;
mod hovers;
mod inspector;
mod numbers;
mod readings;
mod revert;
mod springs;
mod warnings;
mod window;
mod winds;
mod worn;
