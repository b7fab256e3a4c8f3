//! glTF files that say themselves what is cloth, with nothing in the app but the plugin.

mod bad;
mod bodies;
mod file;
mod garments;
mod paint;
mod scenes;
mod shop;
mod worn;
