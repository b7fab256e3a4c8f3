//! Bodies: characters get capsules from their skin, which their own clothes meet.

mod bad;
mod clothes;
mod limb;
mod made;
mod on_mannequin;
