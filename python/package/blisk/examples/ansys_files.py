"""From files of Ansys to a percentile, without Ansys: the beam that ansys-mapdl-reader installs, as a blade that rubs.

docs/import.md says what of it is not like a wheel, and what is different for files of your own.
"""

import sys
from pathlib import Path

from ansys.mapdl import reader
from ansys.mapdl.reader import examples

import blisk

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "results")

# In Ansys these are components (NSEL, CM). The beam has none that fit, so its nodes are picked by position.
archive = reader.Archive(examples.hexarchivefile, parse_vtk=False)
node_at = dict(zip(archive.nnum.tolist(), archive.nodes[:, :3].tolist()))
root = [node for node, (x, y, z) in node_at.items() if z == 0.0]
side = [node for node, (x, y, z) in node_at.items() if y == 1.0 and x <= 0.5 and 2.5 <= z <= 3.0]
tip = [node for node, position in node_at.items() if position == [1.0, 1.0, 5.0]]

sector = blisk.Sector.from_ansys(
    examples.fullfile,
    examples.hexarchivefile,
    blade_full=examples.fullfile,
    rst=examples.rstfile,
    out=folder / "beam-sector",
    sectors=6,
    axis="x",
    sets={"ROOT": root, "SIDE": side, "TIP": tip},
    low_face="ROOT",
    high_face="ROOT",
    contact={"first": "blisk.SIDE", "second": "ground"},
    force={"set": "TIP", "component": "z"},
    observe={"name": "tip", "set": "TIP"},
)
print(sector.report)
check, result = sector.check, sector.check["result_file"]
print(f"{check['frequencies_compared']} frequencies within {check['worst_relative_difference']:.0e} of SciPy")
print(f"{result['modes_compared']} modes of {result['reference']} within {result['worst_relative_difference']:.0e} of Ansys")

study = blisk.Study(
    study={"name": "beam", "seed": 7, "patterns": 80},
    model=sector.model,
    contact={
        "law": "simplified_3d",
        "friction_coefficient": 0.3,
        "tangential_stiffness_n_per_m": 2.0e3,
        "normal_stiffness_n_per_m": 2.0e3,
    },
    damping={"structural_loss_factor": 0.01},
    excitation={"engine_orders": [2], "amplitude_n": 1.0},
    mistuning={"distribution": {"kind": "normal"}},
    sweep={"normal_load_n": ["slide", 2, 3, 6, "stuck"], "standard_deviation": [0.02]},
)
results = blisk.run(study, out=folder / "beam", progress=True)
best = results.best(percentile=95)
print(f"{best.normal_load_n:g} N per sector: P95 {best.value:.3e} m, 95 % bounds {best.lower:.3e} to {best.upper:.3e} m")
