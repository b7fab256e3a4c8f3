//! The command line of the random scenes.

use core::{ops::Range, str::FromStr};

use clap::Args;

/// What to run.
#[derive(Args, Clone, Debug)]
pub struct Options {
    /// Seeds to run: from the first on, up to the second without it
    #[arg(long, value_name = "A..B", default_value = "0..200")]
    pub seeds: Seeds,
    /// Tells on standard error what each scene is made of, and in which frame what happens
    #[arg(long)]
    pub verbose: bool,
    /// Seconds after which a scene is cut short, and counted as that
    #[arg(long, default_value_t = 10.0)]
    pub budget: f64,
    /// Scenes side by side; as many as the machine has cores by default
    #[arg(long)]
    pub threads: Option<usize>,
}

impl Options {
    /// A run of these seeds that tells nothing.
    pub fn of(seeds: Range<u64>) -> Self {
        Self { seeds: Seeds(seeds), verbose: false, budget: 60.0, threads: None }
    }
}

/// A range of seeds.
#[derive(Clone, Debug, PartialEq)]
pub struct Seeds(pub Range<u64>);

impl FromStr for Seeds {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ends = text.split_once("..").and_then(|(from, to)| Some((from.parse().ok()?, to.parse().ok()?)));
        match ends {
            Some((from, to)) if from < to => Ok(Self(from..to)),
            _ => Err("seeds are two numbers, the second one larger: 0..200".into()),
        }
    }
}
