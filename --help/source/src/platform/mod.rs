//! What the operating system says of this machine and its processes.
//!
//! Linux answers through `/proc` (`linux`), every other system through the crate `sysinfo` (`portable`). Only this folder knows
//! which.

mod linux;
mod portable;

/// Name of this machine; empty if it has none.
#[must_use]
pub fn host_name() -> String {
    linux::host_name()
        .or_else(portable::host_name)
        .unwrap_or_default()
}

/// Identity of the present boot of this machine; empty where the system has none.
#[must_use]
pub fn boot_identity() -> String {
    linux::boot_identity().unwrap_or_default()
}

/// Start of the living process `process` of this machine; none if no such process lives.
///
/// The unit is that of the system (clock ticks after the boot, or seconds since 1970): two starts on
/// one machine can be compared for equality, no more.
#[must_use]
pub fn process_start(process: u32) -> Option<u64> {
    if linux::knows_processes() {
        linux::process_start(process)
    } else {
        portable::process_start(process)
    }
}

/// Time that the calling thread has had on a processor, in seconds; none where the system does not say.
#[must_use]
pub fn thread_processor_time_s() -> Option<f64> {
    linux::thread_processor_time_s()
}

/// Largest memory of this process so far, in bytes, or the present one where the system keeps no
/// largest; none where it says neither.
#[must_use]
pub fn peak_memory_bytes() -> Option<u64> {
    linux::peak_memory_bytes().or_else(portable::memory_bytes)
}

/// Whether this process was started with `signal` ignored; no where the system does not say.
#[must_use]
pub fn ignores_signal(signal: i32) -> bool {
    linux::ignored_signals().is_some_and(|mask| mask & (1 << (signal - 1)) != 0)
}
