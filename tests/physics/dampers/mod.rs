//! Contacts of every kind: of the sector, with the next sector, with a damper body, with the ground.

mod built_in;
mod chains;
mod cylinder;
mod energy;
mod limits;
mod marched;
mod published;
mod rigid;
mod sectors;
mod whole_wheel;
