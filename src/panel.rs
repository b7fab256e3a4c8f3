//! A window that tunes cloth live, on egui.
