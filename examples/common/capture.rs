//! Renders a fixed number of frames into picture files, with neither a window nor a display.

use std::{
    fs,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use bevy::{
    camera::{RenderTarget, Viewport},
    prelude::*,
    render::{
        render_resource::{TextureFormat, TextureUsages},
        view::screenshot::{Screenshot, ScreenshotCaptured},
    },
    time::{TimeSystems, TimeUpdateStrategy},
    window::WindowRef,
};

use super::loading::{Loading, LoadingPlugin};

/// Time between two frames in seconds.
const FRAME: f64 = 1.0 / 60.0;

/// Side of the picture that is drawn while everything loads, in pixels.
const SMALLEST_VIEWPORT: u32 = 16;

/// No example needs as long as this to load or to write its last picture; a lost graphics device would take forever.
const PATIENCE: Duration = Duration::from_secs(180);

/// Points each camera at an offscreen image, counts frames once everything has loaded, writes some of them and ends
/// the app. Add it after Bevy's own plugins.
pub struct CapturePlugin {
    pub directory: PathBuf,
    pub frames: u32,
    /// Each frame whose number can be divided by this is written.
    pub every: u32,
    /// Width and height of the pictures in pixels.
    pub size: UVec2,
}

impl Plugin for CapturePlugin {
    fn build(&self, app: &mut App) {
        let mut image = Image::new_target_texture(self.size.x, self.size.y, TextureFormat::Rgba8UnormSrgb, None);
        image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
        let target = app.world_mut().resource_mut::<Assets<Image>>().add(image);
        // Nothing may move before the first frame counts.
        app.world_mut().resource_mut::<Time<Virtual>>().pause();

        app.add_plugins(LoadingPlugin)
            .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(FRAME)))
            .insert_resource(Capture {
                directory: self.directory.clone(),
                frames: self.frames,
                every: self.every,
                target,
                stage: Stage::Loading,
                frame: 0,
                unwritten: 0,
                since: Instant::now(),
            })
            .add_observer(retarget)
            .add_systems(First, begin_frame.before(TimeSystems))
            .add_systems(Last, end_frame);
    }
}

#[derive(Resource)]
struct Capture {
    directory: PathBuf,
    frames: u32,
    every: u32,
    target: Handle<Image>,
    stage: Stage,
    /// Number of the current frame, from 1.
    frame: u32,
    /// Pictures that were taken but aren't in their files yet.
    unwritten: u32,
    /// When the current stage began or last made progress.
    since: Instant,
}

#[derive(Clone, Copy, PartialEq)]
enum Stage {
    Loading,
    Running,
    Writing,
}

impl Capture {
    fn is_wanted(&self, frame: u32) -> bool {
        frame.is_multiple_of(self.every) || frame == self.frames
    }

    fn path(&self, frame: u32) -> PathBuf {
        self.directory.join(format!("frame_{frame:04}.png"))
    }

    fn enter(&mut self, stage: Stage) {
        self.stage = stage;
        self.since = Instant::now();
    }
}

pub fn create_directory(directory: &Path) -> Result<(), String> {
    fs::create_dir_all(directory)
        .map_err(|error| format!("Cannot create the directory {}: {error}", directory.display()))
}

/// A camera that draws into the pictures, and the part of them that it fills.
#[derive(Component)]
struct Photographer {
    viewport: Option<Viewport>,
}

/// A camera for the window, which doesn't exist, draws into the picture instead.
fn retarget(
    add: On<Add, Camera>,
    capture: Res<Capture>,
    mut cameras: Query<(&Camera, &mut RenderTarget)>,
    mut commands: Commands,
) {
    let Ok((camera, mut target)) = cameras.get_mut(add.entity) else {
        return;
    };
    if !matches!(*target, RenderTarget::Window(WindowRef::Primary)) {
        return;
    }
    *target = RenderTarget::Image(capture.target.clone().into());
    if camera.is_active {
        commands.entity(add.entity).insert(Photographer { viewport: camera.viewport.clone() });
    }
}

/// A software renderer takes a second over each frame, so those that nobody will see are simulated but not drawn.
fn begin_frame(mut capture: ResMut<Capture>, mut cameras: Query<(&mut Camera, &Photographer)>) {
    if capture.stage == Stage::Running {
        capture.frame += 1;
    }
    let is_drawn = match capture.stage {
        Stage::Loading => true,
        Stage::Running => capture.is_wanted(capture.frame),
        Stage::Writing => false,
    };
    // Only drawing brings up the pipelines to wait for, but a few pixels do.
    let a_few_pixels = Viewport { physical_size: UVec2::splat(SMALLEST_VIEWPORT), ..default() };
    for (mut camera, photographer) in &mut cameras {
        camera.is_active = is_drawn;
        camera.viewport = match capture.stage {
            Stage::Loading => Some(a_few_pixels.clone()),
            Stage::Running | Stage::Writing => photographer.viewport.clone(),
        };
    }
}

fn end_frame(
    mut capture: ResMut<Capture>,
    mut loading: Loading,
    mut time: ResMut<Time<Virtual>>,
    mut commands: Commands,
    mut exit: MessageWriter<AppExit>,
) {
    match capture.stage {
        Stage::Loading => match loading.is_done() {
            Ok(true) => {
                time.unpause();
                capture.enter(Stage::Running);
            }
            Ok(false) => {}
            Err(cause) => give_up(&mut exit, &cause),
        },
        Stage::Running => {
            capture.since = Instant::now();
            if capture.is_wanted(capture.frame) {
                take_picture(&mut commands, &mut capture);
            }
            if capture.frame == capture.frames {
                capture.enter(Stage::Writing);
            }
        }
        Stage::Writing if capture.unwritten == 0 => {
            println!("{}", capture.path(capture.frames).display());
            exit.write(AppExit::Success);
        }
        Stage::Writing => {}
    }
    if capture.since.elapsed() > PATIENCE {
        give_up(&mut exit, "The graphics driver or a file took too long; no more pictures are written.");
    }
}

fn take_picture(commands: &mut Commands, capture: &mut Capture) {
    let path = capture.path(capture.frame);
    capture.unwritten += 1;
    commands.spawn(Screenshot::image(capture.target.clone())).observe(
        move |shot: On<ScreenshotCaptured>, mut capture: ResMut<Capture>, mut exit: MessageWriter<AppExit>| {
            capture.since = Instant::now();
            match write_picture(&shot.image, &path) {
                Ok(()) => capture.unwritten = capture.unwritten.saturating_sub(1),
                Err(cause) => give_up(&mut exit, &cause),
            }
        },
    );
}

fn write_picture(image: &Image, path: &Path) -> Result<(), String> {
    let failure = |error: String| format!("Cannot write {}: {error}", path.display());
    let picture = image.clone().try_into_dynamic().map_err(|error| failure(error.to_string()))?;
    // The alpha channel holds no picture.
    picture.to_rgb8().save(path).map_err(|error| failure(error.to_string()))
}

fn give_up(exit: &mut MessageWriter<AppExit>, cause: &str) {
    eprintln!("{cause}");
    exit.write(AppExit::error());
}
