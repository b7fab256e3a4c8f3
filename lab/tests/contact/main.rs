//! The lab's experiments on contact, watched frame by frame at sizes that take seconds.

mod experiments;
mod self_collision;
mod sharp;
