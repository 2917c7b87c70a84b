//! Contacts of every kind: of the sector, with the next sector, with a damper body, with the ground.

mod chains;
mod cylinder;
mod published;
mod rigid;
mod sectors;
mod whole_wheel;
