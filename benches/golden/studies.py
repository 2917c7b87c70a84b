"""A case, and its input files: studies of the repository made small, and files to import."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "tests" / "data"


class Case:
    """Files to begin with, and command lines that are carried out one after the other in their folder.

    A line has the exit code that is expected, where it is not 0, and the arguments of the program. Two other lines
    damage a file in between: `flip FILE` changes the byte in its middle, `remove FILE` takes it away.
    """

    def __init__(self, name, files, *lines):
        self.name, self.lines = name, lines
        self.files = {"study.toml": files} if isinstance(files, str) else files


def study(path, *changes):
    """The text of a study of the repository with changes, each of them one of these.

    `key = value` takes the place of the only line of that key; `key =` takes the line away. What begins with the head
    of a table goes under that head, which is added where it is not there.
    """
    text = (ROOT / path).read_text()
    # Files that a study names lie in the repository.
    text = text.replace('"../', f'"{(ROOT / path).parent.parent.as_posix()}/')
    for change in changes:
        text = changed(text, change)
    return text


def changed(text, change):
    if change.startswith("["):
        head, _, lines = change.partition("\n")
        if f"\n{head}\n" not in text or head.startswith("[["):
            return f"{text}\n{change}\n"
        return text.replace(f"\n{head}\n", f"\n{head}\n{lines}\n", 1)
    key, _, value = change.partition(" =")
    line = f"{change}\n" if value else ""
    text, count = re.subn(rf"^{re.escape(key)} = .*\n", lambda _: line, text, flags=re.MULTILINE)
    assert count == 1, f"{count} lines of {key}"
    return text


def small(*changes):
    """Six sectors of blade, disk and ring: milliseconds a row."""
    return study("tests/readers/small.toml", *changes)


def report(*changes):
    """The same with as many patterns as a P95 needs."""
    return study("tests/report/study.toml", "patterns = 90", *changes)


def bundle(law, *changes):
    """A sector bundle of eight sectors, whose contact pairs move along three directions."""
    normal = "normal_stiffness_n_per_m =" + ("" if law.startswith("macro_slip") else " 2.0e8")
    text = study("studies/wheel.toml", f"law = '{law}'", normal, "normal_load_n = [320]", *changes)
    return text.replace("wheel24", "wheel8")


def built_in(path, sectors, load, *changes):
    """A built-in wheel of few elements: seconds."""
    elements = f"[model.parametric]\nsectors = {sectors}\nblade_radial_elements = 2\ndisk_radial_elements = 2"
    few = ("patterns = 1", f"engine_orders = [{sectors // 3}]", f"normal_load_n = {load}")
    return study(path, elements, *few, *changes)


def measured(*changes):
    """Wheels of a file in the place of a distribution."""
    return ("patterns =", "standard_deviation =", "distribution =", "[mistuning]\nfile = 'wheels.csv'", *changes)


def of_bundle(path, *changes):
    """A study of a bundle that an earlier line writes."""
    few = ("patterns = 1", "engine_orders = [2]", "normal_load_n = [50]")
    return study("studies/calculix/study_rest.toml", f"path = '{path}'", *few, *changes)


# Four nodes, two on each face of an eighth of a wheel.
NODES = {1: (1.0, 0.0, 0.0), 2: (1.0, 0.0, 1.0), 3: (0.5**0.5, 0.5**0.5, 0.0), 4: (0.5**0.5, 0.5**0.5, 1.0)}
ROWS = "row,node,direction\n"


def import_files():
    """Import files of four nodes, one a format of matrices, and what they name but matrices of the repository."""
    files = {
        "rows.csv": ROWS + "".join(f"{3 * node - 3 + axis},{node},{axis}\n" for node in NODES for axis in (1, 2, 3)),
        "blade.csv": ROWS + "1,2,1\n2,2,2\n3,2,3\n",
        "calculix.mesh": calculix_mesh(),
        "ansys.mesh": ansys_mesh(),
        "nastran.mesh": nastran_mesh(),
        "matrix_market.blade": "%%MatrixMarket matrix coordinate real symmetric\n3 3 3\n1 1 10\n2 2 10\n3 3 10\n",
        "dmig.blade": "DMIG,KAAX,0,6,2,0\n" + "".join(f"DMIG,KAAX,2,{axis},,2,{axis},10.0\n" for axis in (1, 2, 3)),
        "op4.blade": op4_blade(),
        "harwell_boeing.blade": harwell_boeing_blade(),
    }
    for name, code, matrices, stiffness, mass in (
        ("mm", "calculix", "matrix_market", "scipy_k.mtx", "scipy_m.mtx"),
        ("hb", "ansys", "harwell_boeing", "scipy_k.rua", "scipy_m.rua"),
        ("dmig", "nastran", "dmig", "pynastran_double.pch", "pynastran_double.pch"),
        *(
            (form, "nastran", "op4", f"pyyeti_{form}.op4", f"pyyeti_{form}.op4")
            for form in ("dense", "bigmat", "nonbigmat")
        ),
    ):
        files[f"{name}.toml"] = import_file(code, matrices, stiffness, mass)
    return files


def import_file(code, matrices, stiffness, mass):
    low, high = ("1", "2") if code == "nastran" else ("LOW", "HIGH")
    folder = (DATA / "import_formats").as_posix()
    names = "stiffness_name = 'KAA'\nmass_name = 'MAA'\n" if matrices == "op4" else ""
    return (
        f"code = '{code}'\nmatrix_format = '{matrices}'\nname = 'four'\nsectors = 8\n"
        f"[blisk]\nmesh = '{code}.mesh'\nlow_face = '{low}'\nhigh_face = '{high}'\n"
        f"stiffness = '{folder}/{stiffness}'\nmass = '{folder}/{mass}'\ndofs = 'rows.csv'\n{names}"
        f"blade_stiffness = '{matrices}.blade'\nblade_dofs = 'blade.csv'\n"
        "[[force]]\nnode = 2\ncomponent = 'z'\n[[observe]]\nname = 'tip'\nnode = 2\n"
    )


def calculix_mesh():
    nodes = "".join(f"{node},{x},{y},{z}\n" for node, (x, y, z) in NODES.items())
    return f"*NODE,NSET=ALL\n{nodes}*NSET,NSET=LOW\n1,2\n*NSET,NSET=HIGH\n3,4\n"


def nastran_mesh():
    nodes = "".join(f"GRID,{node},,{x:.9f},{y:.9f},{z:.9f}\n" for node, (x, y, z) in NODES.items())
    return f"BEGIN BULK\n{nodes}SET1,1,1,2\nSET1,2,3,4\nENDDATA\n"


def ansys_mesh():
    nodes = "".join(f"{node:9}{0:9}{0:9}{x:24.16E}{y:24.16E}{z:24.16E}\n" for node, (x, y, z) in NODES.items())
    faces = "".join(
        f"CMBLOCK,{name:8},NODE,{2:8}\n(8i10)\n{first:10}{-first - 1:10}\n" for name, first in (("LOW", 1), ("HIGH", 3))
    )
    return f"/PREP7\nNBLOCK,6,SOLID,{4:10},{4:10}\n(3i9,6e24.16e3)\n{nodes}N,R5.3,LOC,       -1,\n{faces}FINISH\n"


def op4_blade():
    columns = "".join(f"{column:8}{column:8}{1:8}\n 1.0000000000000000E+01\n" for column in (1, 2, 3))
    return f"{3:8}{3:8}{6:8}{2:8}{'K':8}1P,3E23.16\n{columns}{4:8}{1:8}{1:8}\n 1.0000000000000000E+00\n"


def harwell_boeing_blade():
    formats = f"{'(1I14)':16}{'(1I14)':16}{'(1D26.17)':20}{'(1D26.17)':20}\n"
    head = f"{'blade':72}{'K':8}\n{10:14}{4:14}{3:14}{3:14}{0:14}\n{'RSA':14}{3:14}{3:14}{3:14}{0:14}\n{formats}"
    return head + "".join(f"{place:14}\n" for place in (1, 2, 3, 4, 1, 2, 3)) + 3 * f"{'1.00000000000000000D+01':>26}\n"
