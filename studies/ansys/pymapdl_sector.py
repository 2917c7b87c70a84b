"""A sector bundle from a running Ansys, by PyMAPDL.

    python pymapdl_sector.py MODEL.cdb SECTORS [OUT]

MODEL.cdb is one sector with the components LOW and HIGH (nodes of the cut faces), BLADE (elements) and TIP (one node,
which is forced along the axis and observed). Z is the axis of rotation; the units are m, kg, s. Needs the packages
ansys-mapdl-core, ansys-mapdl-reader, scipy and blisk.

This script was written after the manuals. It has not been run with Ansys, since that needs a licence; the tests give it
a session that hands out files.
"""

import sys
from pathlib import Path

import blisk

# The modal analysis of the sector: its .full file has stiffness and mass, its modes are a check.
SECTOR = """/SOLU
ANTYPE,MODAL
MODOPT,LANB,10
MXPAND,10
LUMPM,OFF
SOLVE
FINISH
/COPY,,full,,wheel,full
/COPY,,rst,,wheel,rst"""

# The blade alone: the same model with its elements alone. WRFULL stops when the file is written.
BLADE = """/SOLU
ANTYPE,MODAL
CMSEL,S,BLADE,ELEM
NSLE
MODOPT,LANB,1
WRFULL,1
SOLVE
FINISH
/COPY,,full,,blade,full"""


def exported(mapdl, folder):
    """Solves the sector and the blade alone, and brings the files into the folder."""
    commands = [
        "/PREP7",
        "ALLSEL",
        "CDWRITE,DB,wheel,cdb",
        "FINISH",
        *SECTOR.splitlines(),
        *BLADE.splitlines(),
        "ALLSEL",
    ]
    for command in commands:
        mapdl.run(command)
    for name in ("wheel.cdb", "wheel.full", "wheel.rst", "blade.full"):
        mapdl.download(name, target_dir=str(folder))


def sector(mapdl, sectors, out):
    """The bundle of the model that the session holds; its frequencies are checked on the way."""
    folder = Path(out) / "ansys"
    folder.mkdir(parents=True, exist_ok=True)
    exported(mapdl, folder)
    return blisk.Sector.from_ansys(
        folder / "wheel.full",
        folder / "wheel.cdb",
        blade_full=folder / "blade.full",
        rst=folder / "wheel.rst",
        out=out,
        sectors=sectors,
        low_face="LOW",
        high_face="HIGH",
        force={"set": "TIP", "component": "z"},
        observe={"name": "tip", "set": "TIP"},
    )


def main(model, sectors, out="bundle"):
    from ansys.mapdl.core import launch_mapdl

    # With distributed memory the .full file is in parts.
    mapdl = launch_mapdl(additional_switches="-smp")
    try:
        mapdl.upload(model)
        mapdl.run("/PREP7")
        mapdl.cdread("DB", Path(model).stem, Path(model).suffix[1:])
        made = sector(mapdl, int(sectors), out)
    finally:
        mapdl.exit()
    print(made.report)
    print("worst difference from a cyclic eigenproblem of the matrices:", made.check["worst_relative_difference"])
    print("worst difference from the modes of Ansys:", made.check["result_file"]["worst_relative_difference"])


if __name__ == "__main__":
    main(*sys.argv[1:])
