//! What the benches share.

#![allow(dead_code)] // No bench needs all of it.

pub mod case;
pub mod machine;
