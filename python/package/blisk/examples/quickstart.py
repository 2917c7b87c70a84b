"""Which normal load of a ring damper keeps the amplitude low? A study of masses and springs, in seconds."""

import sys
from pathlib import Path

import blisk

study = blisk.Study(
    study={"name": "ring", "seed": 7, "patterns": 400},
    model={
        "source": "lumped",
        "lumped": {
            "sectors": 6,
            "blade_mass_kg": 0.25, "disk_mass_kg": 1.0, "ring_mass_kg": 0.03,
            "blade_stiffness_n_per_m": 2.5e6, "disk_ground_stiffness_n_per_m": 7.0e6,
            "disk_coupling_stiffness_n_per_m": 2.5e5, "ring_coupling_stiffness_n_per_m": 8.0e5,
            "ring_disk_stiffness_n_per_m": 1.0e4,
        },
    },
    contact={"law": "macro_slip_1d", "friction_coefficient": 0.3, "tangential_stiffness_n_per_m": 8.0e5},
    damping={"structural_loss_factor": 0.002},
    excitation={"engine_orders": [2], "amplitude_n": 10.0},
    mistuning={"distribution": {"kind": "normal"}},
    sweep={"normal_load_n": ["slide", 50, 100, 150, "stuck"], "standard_deviation": [0.03]},
)
for remark in study.check():
    print("remark:", remark)
folder = Path(sys.argv[1] if len(sys.argv) > 1 else "results")
results = blisk.run(study, out=folder / study.name, progress=True)
print(results.summary_text)
best = results.best(percentile=99)
print(f"lowest P99: {best.value:.3e} m ({best.lower:.3e} to {best.upper:.3e} m) at {best.normal_load_n:g} N per sector")
print("report:", results.report(folder / "report.html", curves=False))
