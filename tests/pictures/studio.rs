//! An app that draws into an image and is driven frame by frame, with neither a window nor a display.

use std::{
    io::{self, Write},
    mem,
    path::{Path, PathBuf},
    sync::{Arc, Mutex},
    time::{Duration, Instant},
};

use bevy::{
    app::PluginsState,
    log::{BoxedLayer, LogPlugin, tracing_subscriber::fmt},
    prelude::*,
    render::{
        RenderApp, RenderPlugin,
        pipelined_rendering::PipelinedRenderingPlugin,
        render_resource::{PipelineCache, TextureFormat, TextureUsages},
        view::screenshot::{Screenshot, ScreenshotCaptured},
    },
    tasks::tick_global_task_pools_on_main_thread,
    time::TimeUpdateStrategy,
    window::ExitCondition,
    winit::WinitPlugin,
};
use image::RgbImage;

/// Time between two frames in seconds: four steps, so that much happens in few pictures.
const FRAME: f64 = 4.0 / 60.0;

/// A software renderer takes a second over some frames, and one that has been lost takes forever.
const PATIENCE: Duration = Duration::from_secs(120);

/// An app that stands still until [`Studio::start`].
pub struct Studio {
    pub app: App,
    /// What cameras are to draw into.
    pub target: Handle<Image>,
    errors: Errors,
}

/// All that has been logged as an error.
#[derive(Resource, Clone, Default)]
struct Errors(Arc<Mutex<Vec<u8>>>);

impl Write for Errors {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().expect("nobody panics while it is written").write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn keep_errors(app: &mut App) -> Option<BoxedLayer> {
    let errors = Errors::default();
    app.insert_resource(errors.clone());
    Some(Box::new(fmt::layer().with_ansi(false).with_writer(move || errors.clone())))
}

/// The picture that was taken last.
#[derive(Resource, Default)]
struct Taken(Option<Image>);

impl Studio {
    pub fn new(size: UVec2) -> Self {
        let mut app = App::new();
        let plugins = DefaultPlugins
            .set(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
            // A pipeline that is still being compiled leaves its objects out of the frame.
            .set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() })
            .set(LogPlugin { custom_layer: keep_errors, ..default() })
            .disable::<WinitPlugin>()
            // What a frame draws, and what goes wrong with it, is known when the update is over.
            .disable::<PipelinedRenderingPlugin>();
        app.add_plugins(plugins)
            .init_resource::<Taken>()
            .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(FRAME)));
        app.world_mut().resource_mut::<Time<Virtual>>().pause();
        let mut image = Image::new_target_texture(size.x, size.y, TextureFormat::Rgba8UnormSrgb, None);
        image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
        let target = app.world_mut().resource_mut::<Assets<Image>>().add(image);
        let errors = app.world().resource::<Errors>().clone();
        Self { app, target, errors }
    }

    /// Draws until there are pipelines for all that is to be seen; from then on time goes on.
    pub fn start(&mut self) {
        /// Frames in a row without anything to wait for: what one frame brings may ask for more in the next.
        const QUIET_FRAMES: u32 = 3;
        while self.app.plugins_state() == PluginsState::Adding {
            tick_global_task_pools_on_main_thread();
        }
        self.app.finish();
        self.app.cleanup();
        let (begin, mut quiet) = (Instant::now(), 0);
        while quiet < QUIET_FRAMES {
            assert!(begin.elapsed() < PATIENCE, "the pipelines take too long");
            self.run(1);
            let pipelines = self.app.sub_app(RenderApp).world().resource::<PipelineCache>();
            quiet = if pipelines.waiting_pipelines().count() == 0 { quiet + 1 } else { 0 };
        }
        self.app.world_mut().resource_mut::<Time<Virtual>>().unpause();
    }

    /// Draws so many frames. Fails where an error is logged or the app wants to quit.
    #[track_caller]
    pub fn run(&mut self, frames: usize) {
        for _ in 0..frames {
            self.app.update();
            let log = mem::take(&mut *self.errors.0.lock().expect("nobody panics while it is written"));
            let log = String::from_utf8_lossy(&log);
            assert!(!log.contains("ERROR"), "{log}");
            assert_eq!(self.app.should_exit(), None, "{log}");
        }
    }

    /// Draws a frame and returns it; later ones bring it here. It is also kept in a file of this name.
    #[track_caller]
    pub fn picture(&mut self, name: &str) -> RgbImage {
        let shot = Screenshot::image(self.target.clone());
        self.app.world_mut().spawn(shot).observe(|shot: On<ScreenshotCaptured>, mut taken: ResMut<Taken>| {
            taken.0 = Some(shot.image.clone());
        });
        let begin = Instant::now();
        let image = loop {
            assert!(begin.elapsed() < PATIENCE, "the picture takes too long");
            self.run(1);
            if let Some(image) = self.app.world_mut().resource_mut::<Taken>().0.take() {
                break image;
            }
        };
        let picture = image.try_into_dynamic().expect("it is a picture").to_rgb8();
        picture.save(path(name)).unwrap_or_else(|error| panic!("cannot write {}: {error}", path(name).display()));
        picture
    }
}

/// Where a picture is kept.
pub fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.png"))
}
