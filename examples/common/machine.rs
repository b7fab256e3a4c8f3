//! What this machine offers. Asked before the app is built, because Bevy panics where there is no graphics driver and
//! winit where there is no display.

use bevy::{render::settings::WgpuSettings, tasks::block_on};

/// Succeeds where the renderer will find something to draw with; a driver that draws on the processor is enough.
pub fn graphics_adapter() -> Result<(), String> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: WgpuSettings::default().backends.unwrap_or_default(),
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    match block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default())) {
        Ok(_) => Ok(()),
        Err(_) if cfg!(target_os = "linux") => {
            Err("No Vulkan driver was found: install the driver of your graphics card, or one that draws on the \
             processor (Debian and Ubuntu: apt-get install libvulkan1 mesa-vulkan-drivers)."
                .to_owned())
        }
        Err(_) => Err("No graphics driver was found: install the driver of your graphics card.".to_owned()),
    }
}

/// Why no window can be opened, if so. The variable may name a display that isn't there, so this really connects.
#[cfg(target_os = "linux")]
pub fn window_obstacle() -> Option<&'static str> {
    if x11rb::connect(None).is_err() {
        return Some("there is no display to open a window on");
    }
    let has_libraries = x11_dl::xlib::Xlib::open().is_ok()
        && x11_dl::xlib_xcb::Xlib_xcb::open().is_ok()
        && x11_dl::xinput2::XInput2::open().is_ok()
        && x11_dl::xcursor::Xcursor::open().is_ok()
        && xkbcommon_dl::x11::xkbcommon_x11_option().is_some();
    (!has_libraries).then_some(
        "windows need system libraries that are missing (Debian and Ubuntu: apt-get install libx11-xcb1 libxi6 \
         libxcursor1 libxkbcommon-x11-0)",
    )
}

/// Why no window can be opened, if so.
#[cfg(not(target_os = "linux"))]
pub fn window_obstacle() -> Option<&'static str> {
    None
}

/// The name that cargo gave to this program.
pub fn example_name() -> String {
    std::env::current_exe()
        .ok()
        .and_then(|path| Some(path.file_stem()?.to_string_lossy().into_owned()))
        .unwrap_or_else(|| "example".to_owned())
}
