//! What the crate `sysinfo` says of this machine and its processes, on any system that it knows.

use sysinfo::{Pid, ProcessRefreshKind, ProcessesToUpdate, System};

/// Name of this machine.
pub(super) fn host_name() -> Option<String> {
    System::host_name().filter(|name| !name.is_empty())
}

/// Start of a living process in seconds since 1970.
pub(super) fn process_start(process: u32) -> Option<u64> {
    of_process(
        process,
        ProcessRefreshKind::nothing(),
        sysinfo::Process::start_time,
    )
}

/// Present memory of this process in bytes.
pub(super) fn memory_bytes() -> Option<u64> {
    let memory = ProcessRefreshKind::nothing().with_memory();
    of_process(std::process::id(), memory, sysinfo::Process::memory)
}

/// What `answer` says of a living process after `refresh`; none if it does not live.
fn of_process(
    process: u32,
    refresh: ProcessRefreshKind,
    answer: impl Fn(&sysinfo::Process) -> u64,
) -> Option<u64> {
    let process = Pid::from_u32(process);
    let mut system = System::new();
    system.refresh_processes_specifics(ProcessesToUpdate::Some(&[process]), true, refresh);
    system.process(process).map(answer)
}

#[cfg(test)]
mod tests {
    use super::{host_name, memory_bytes, process_start};
    use crate::platform::linux;

    /// Any command that stays until it is killed, on every system.
    fn sleeper() -> std::process::Child {
        let mut command = if cfg!(windows) {
            let mut command = std::process::Command::new("ping");
            command.args(["-n", "60", "127.0.0.1"]);
            command
        } else {
            let mut command = std::process::Command::new("sleep");
            command.arg("60");
            command
        };
        command.spawn().expect("a process")
    }

    #[test]
    fn without_proc_a_living_process_lives_and_one_that_has_ended_does_not() {
        let current_id = std::process::id();
        assert!(process_start(current_id).is_some_and(|start| start > 0));
        assert_eq!(process_start(current_id), process_start(current_id));
        let mut child = sleeper();
        let number = child.id();
        let start = process_start(number).expect("it lives");
        assert!(
            Some(start) >= process_start(current_id),
            "it was started later"
        );
        child.kill().expect("killed");
        child.wait().expect("ended");
        assert_eq!(process_start(number), None);
    }

    #[test]
    fn without_proc_host_and_memory_are_those_that_proc_tells() {
        if linux::knows_processes() {
            assert_eq!(host_name(), linux::host_name());
            let (memory, peak) = (memory_bytes(), linux::peak_memory_bytes());
            assert!(
                memory > Some(1 << 16) && memory <= peak,
                "{memory:?} {peak:?}"
            );
        }
        assert!(memory_bytes().is_some());
    }
}
