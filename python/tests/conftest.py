"""What the tests share: a small study, its results, and the command."""

import copy
import os
import subprocess
import sys
from pathlib import Path

import pytest

import blisk

ROOT = Path(__file__).resolve().parents[2]

SMALL = {
    "study": {"name": "small", "seed": 7, "patterns": 80},
    "model": {
        "source": "lumped",
        "lumped": {
            "sectors": 6,
            "blade_mass_kg": 0.25,
            "disk_mass_kg": 1.0,
            "ring_mass_kg": 0.03,
            "blade_stiffness_n_per_m": 2.5e6,
            "disk_ground_stiffness_n_per_m": 7.0e6,
            "disk_coupling_stiffness_n_per_m": 2.5e5,
            "ring_coupling_stiffness_n_per_m": 8.0e5,
            "ring_disk_stiffness_n_per_m": 1.0e4,
        },
    },
    "contact": {"law": "macro_slip_1d", "friction_coefficient": 0.3, "tangential_stiffness_n_per_m": 8.0e5},
    "damping": {"structural_loss_factor": 0.002},
    "excitation": {"engine_orders": [2], "amplitude_n": 10.0},
    "mistuning": {"distribution": {"kind": "normal"}},
    "sweep": {"normal_load_n": ["slide", 50, 150, "stuck"], "standard_deviation": [0.03]},
    "solver": {"harmonics": [1, 3]},
}

# Rows enough that a run can be stopped while it solves them.
MANY = 20_000


def installed() -> Path:
    """The command that the package installs."""
    return Path(sys.executable).with_name("blisk")


def called(*arguments, command=None, cwd=None):
    """A finished command with its output as text."""
    line = [str(command or installed()), *map(str, arguments)]
    return subprocess.run(line, cwd=cwd, capture_output=True, text=True, check=False)


@pytest.fixture
def small():
    return copy.deepcopy(SMALL)


@pytest.fixture(scope="session")
def program():
    """The program that cargo has built, where BLISK names it; else the command of the package."""
    return Path(os.environ.get("BLISK", installed()))


@pytest.fixture(scope="session")
def finished(tmp_path_factory):
    """Results of the small study, which no test changes."""
    return blisk.run(blisk.Study(**SMALL), out=tmp_path_factory.mktemp("finished") / "small", threads=2)
