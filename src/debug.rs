//! Seeing inside: gizmos of springs, pins, tethers and forces, and Bevy diagnostics.
