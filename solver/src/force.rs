//! Forces of the surroundings that aren't constraints.

pub mod wind;
