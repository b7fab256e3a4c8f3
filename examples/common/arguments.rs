//! The command line that all examples understand.

use std::{path::PathBuf, str::FromStr};

use bevy::math::UVec2;
use clap::Parser;

/// Shows a scene in a window, or writes it to picture files.
#[derive(Parser)]
// Scripts give their own values first and then those of their user.
#[command(version, args_override_self = true)]
pub struct Arguments {
    /// Open no window and write pictures to this directory
    #[arg(long, value_name = "DIR")]
    pub capture: Option<PathBuf>,

    /// Number of frames to capture, 1/60 s apart
    #[arg(long, value_name = "N", default_value_t = 120, value_parser = clap::value_parser!(u32).range(1..))]
    pub frames: u32,

    /// Write each K-th captured frame only, and always the last
    #[arg(long, value_name = "K", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    pub every: u32,

    /// Size of the window or of the pictures, in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720")]
    pub size: Size,
}

/// A width and a height in pixels, each within what every graphics driver can render to.
#[derive(Clone, Copy)]
pub struct Size(pub UVec2);

const SMALLEST: u32 = 16;
const LARGEST: u32 = 8192;

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (width, height) = text.split_once('x').ok_or("expected a width and a height such as 1280x720")?;
        Ok(Self(UVec2::new(pixels(width)?, pixels(height)?)))
    }
}

fn pixels(text: &str) -> Result<u32, String> {
    text.parse()
        .ok()
        .filter(|number| (SMALLEST..=LARGEST).contains(number))
        .ok_or_else(|| format!("`{text}` is no number from {SMALLEST} to {LARGEST}"))
}
