//! Cloth that mouse and fingers can grab, on `bevy_picking`.
