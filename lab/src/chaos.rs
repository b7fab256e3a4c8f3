//! Random scenes through the public API: what no test has thought of.
//!
//! Each follows from its seed alone, which also says whether its settings stay within their documented ranges. All of them
//! have to stay finite, and no cloth whose settings are in range may have to be put back to its last finite pose.

mod cast;
mod clock;
mod diary;
mod dice;
mod event;
mod hook;
mod mesh;
mod movement;
mod obstacle;
mod options;
mod outcome;
mod pins;
mod place;
mod settings;
mod stage;
mod tally;
mod trial;
mod watch;

pub use options::Options;
pub use tally::run;
