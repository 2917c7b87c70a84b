//! What Linux says in `/proc` (proc(5)). Every answer is none where there is no such file.

use std::fs::read_to_string;
use std::path::Path;

/// Whether `/proc` lists processes, so that one which is not there does not live.
pub(super) fn knows_processes() -> bool {
    Path::new("/proc/self/stat").exists()
}

/// Name of this machine.
pub(super) fn host_name() -> Option<String> {
    trimmed(&read_to_string("/proc/sys/kernel/hostname").ok()?)
}

/// Random identity that the kernel draws at every boot.
pub(super) fn boot_identity() -> Option<String> {
    trimmed(&read_to_string("/proc/sys/kernel/random/boot_id").ok()?)
}

/// Start of a living process in clock ticks after the boot (field 22 of `stat`).
pub(super) fn process_start(process: u32) -> Option<u64> {
    let text = read_to_string(format!("/proc/{process}/stat")).ok()?;
    // The name of the process, in parentheses, may hold anything.
    let (_, fields) = text.rsplit_once(')')?;
    fields.split_whitespace().nth(19)?.parse().ok()
}

/// Time of the calling thread on a processor, in seconds.
pub(super) fn thread_processor_time_s() -> Option<f64> {
    let text = read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: u64 = text.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds as f64)
}

/// Largest resident memory of this process so far, in bytes (`VmHWM`).
pub(super) fn peak_memory_bytes() -> Option<u64> {
    let kibibytes: u64 = status("VmHWM:")?.split_whitespace().next()?.parse().ok()?;
    Some(1024 * kibibytes)
}

/// Bit `signal - 1` is set where that signal is ignored (`SigIgn`): by `nohup`, or in the background of
/// a script.
pub(super) fn ignored_signals() -> Option<u64> {
    u64::from_str_radix(status("SigIgn:")?.trim(), 16).ok()
}

/// The rest of the line of `/proc/self/status` that begins with `key`.
fn status(key: &str) -> Option<String> {
    let text = read_to_string("/proc/self/status").ok()?;
    let value = text.lines().find_map(|line| line.strip_prefix(key))?;
    Some(value.to_owned())
}

fn trimmed(text: &str) -> Option<String> {
    let text = text.trim();
    (!text.is_empty()).then(|| text.to_owned())
}
