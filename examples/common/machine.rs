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

/// Whether a window can be opened. The variable may name a display that isn't there, so this really connects.
#[cfg(target_os = "linux")]
pub fn has_display() -> bool {
    x11rb::connect(None).is_ok()
}

/// Whether a window can be opened.
#[cfg(not(target_os = "linux"))]
pub fn has_display() -> bool {
    true
}

/// The name that cargo gave to this program.
pub fn example_name() -> String {
    std::env::current_exe()
        .ok()
        .and_then(|path| Some(path.file_stem()?.to_string_lossy().into_owned()))
        .unwrap_or_else(|| "example".to_owned())
}
