//! What is drawn, looked at in pictures: one module per scene. They need a graphics driver, and no display.

mod cases;
mod cells;
mod colours;
mod meshes;
mod playground;
mod studio;
