//! Runs the binary in a folder of its own.

use std::path::PathBuf;
use std::process::{Child, Command, Stdio};

/// What a command came to.
pub struct Ended {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

/// A folder with a study in it.
pub struct Place {
    folder: tempfile::TempDir,
}

/// A small study that is valid as it stands: blade, disk and ring with friction.
pub const GOOD: &str = r#"schema = 1

[study]
name = "small"
seed = 7
patterns = 10

[model]
source = "lumped"

[model.lumped]
sectors = 6
blade_mass_kg = 0.25
disk_mass_kg = 1.0
ring_mass_kg = 0.03
blade_stiffness_n_per_m = 2.5e6
disk_ground_stiffness_n_per_m = 7.0e6
disk_coupling_stiffness_n_per_m = 2.5e5
ring_coupling_stiffness_n_per_m = 8.0e5
ring_disk_stiffness_n_per_m = 1.0e4

[contact]
law = "macro_slip_1d"
friction_coefficient = 0.3
tangential_stiffness_n_per_m = 8.0e5

[damping]
structural_loss_factor = 0.002

[excitation]
engine_orders = [2]
amplitude_n = 10.0

[mistuning]
distribution = { kind = "normal" }

[sweep]
normal_load_n = ["slide", 50, "stuck"]
standard_deviation = [0.03]

[solver]
harmonics = [1, 3]
"#;

impl Place {
    pub fn new() -> Self {
        Self {
            folder: tempfile::tempdir().expect("a temporary folder"),
        }
    }

    /// A folder with `study.toml`.
    pub fn with(study: &str) -> Self {
        let place = Self::new();
        place.write("study.toml", study);
        place
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, content: &str) {
        std::fs::write(self.path(name), content).expect("write");
    }

    /// A command that goes on by itself. Whoever runs the tests may ignore signals, which a child would inherit.
    pub fn start(&self, arguments: &[&str]) -> Child {
        Command::new("env")
            .arg("--default-signal=INT,TERM,HUP,USR1")
            .arg(env!("CARGO_BIN_EXE_blisk"))
            .args(arguments)
            .current_dir(self.folder.path())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the binary starts")
    }

    pub fn run(&self, arguments: &[&str]) -> Ended {
        let output = Command::new(env!("CARGO_BIN_EXE_blisk"))
            .args(arguments)
            .current_dir(self.folder.path())
            .output()
            .expect("the binary starts");
        Ended {
            code: output.status.code().expect("it ends by itself"),
            stdout: String::from_utf8(output.stdout).expect("UTF-8"),
            stderr: String::from_utf8(output.stderr).expect("UTF-8"),
        }
    }
}

/// Sends the signal of this name; false if the command has ended already.
pub fn signal(child: &Child, name: &str) -> bool {
    Command::new("sh")
        .args(["-c", &format!("kill -{name} {} 2>/dev/null", child.id())])
        .status()
        .expect("a shell")
        .success()
}

/// Waits for the end of a command; a signal has code -1.
pub fn ended(child: Child) -> Ended {
    let output = child.wait_with_output().expect("it ends");
    Ended {
        code: output.status.code().unwrap_or(-1),
        stdout: String::new(),
        stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}
