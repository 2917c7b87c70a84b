"""From runs of another code to an import file, the bundle that ``blisk import`` makes of it, and the check."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional, Union

from .. import _native
from .._needed import needed
from .._toml import text_of
from . import _check, _faces
from ._keywords import Tables, Wheel
from ._run import Matrices, Run, refused

_ROWS_OF_ALL = 5000
"""A sector of at most so many rows is checked at every nodal diameter; SciPy takes seconds for each of a larger one."""
_CHECK_TOLERANCE = 1e-6


@dataclass
class Imported:
    """The bundle that was made, what the import says of it, and what the check says."""

    folder: Path
    answer: tuple[str, str]
    check: dict[str, Any]


class Import:
    """An import in the making: bodies with their runs, faces and tables."""

    def __init__(self, wheel: Wheel, run: Run, blade: Matrices, others: Mapping[str, Run]) -> None:
        wheel.checked()
        wheel.steps.begins("finding the cut faces" if wheel.low_face is None else "pairing the cut faces")
        self.wheel = wheel
        self.runs = {"blisk": run, **others}
        self.blade = blade
        self.pairs: dict[str, list[tuple[int, int]]] = {}
        self.tables: dict[str, dict[str, Any]] = {}
        if wheel.sets:
            run.add_sets(wheel.sets)
        inside: dict[str, set[int]] = {}
        for body in ("ring", "damper"):
            given = wheel.ring if body == "ring" else wheel.damper
            if given is None:
                continue
            # What names the files of the body is no key of the import file.
            own = {
                key: value for key, value in given.items() if key in ("set", "low_face", "high_face", "grounding_hz")
            }
            if body not in others:
                if "set" not in own:
                    raise ValueError(
                        f"{body} has no `set`; accepted: a set of the mesh with its nodes, or files of its own"
                    )
                inside[body] = run.nodes_of(str(own["set"]), f"{body}.set")
            self.tables[body] = own
        used = {node for node, _ in run.matrices.rows} | {node for element in run.elements for node in element}
        blisk = used.difference(*inside.values())
        self.tables["blisk"] = {"low_face": wheel.low_face, "high_face": wheel.high_face}
        self._put_faces("blisk", run, blisk)
        if "ring" in self.tables:
            ring = self.runs.get("ring", run)
            self._put_faces("ring", ring, inside.get("ring", set(ring.positions)))

    def tolerance(self, run: Run) -> float:
        """The largest distance between a high node and its low node after the turn, in the unit of the mesh."""
        if self.wheel.position_tolerance_m is not None:
            return self.wheel.position_tolerance_m * (1e3 if self.wheel.units == "mm-t-s" else 1.0)
        farthest = max(sum(x * x for x in position) for position in run.positions.values()) ** 0.5
        return 1e-6 * float(farthest)

    def _put_faces(self, body: str, run: Run, nodes: Iterable[int]) -> None:
        """Finds the faces of a body, or looks up those that are named."""
        wheel, table = self.wheel, self.tables[body]
        place = (wheel.axis, wheel.sectors, self.tolerance(run))
        low, high = table.get("low_face"), table.get("high_face")
        if low is not None and high is not None:
            faces = run.nodes_of(low, f"{body}.low_face"), run.nodes_of(high, f"{body}.high_face")
            self.pairs[body] = _faces.pairs(run.positions, faces[0], faces[1], *place)
            return
        if low is not None or high is not None:
            raise ValueError(f"{body} has one of low_face and high_face; accepted: both, or none and they are found")
        own = _faces.found(run.positions, nodes, *place, body)
        names = [f"{body.upper()}_LOW", f"{body.upper()}_HIGH"]
        if run.mesh_format == "nastran":
            # Sets have numbers there.
            free = 1 + max([int(name) for name in run.sets if name.isdecimal()], default=0)
            names = [str(free), str(free + 1)]
        run.add_sets({names[0]: [low for low, _ in own], names[1]: [high for _, high in own]})
        table["low_face"], table["high_face"] = names
        self.pairs[body] = own

    def write(self) -> Path:
        """Writes meshes, matrices and the import file into ``out/import``; gives the path of the import file."""
        wheel, folder = self.wheel, Path(self.wheel.out) / "import"
        folder.mkdir(parents=True, exist_ok=True)
        run = self.runs["blisk"]
        code = {"calculix": "calculix", "ansys": "ansys", "nastran": "nastran"}[run.mesh_format]
        file: dict[str, Any] = {
            "code": code,
            "matrix_format": "matrix_market",
            "name": wheel.name,
            "sectors": wheel.sectors,
            "units": wheel.units,
            "axis": wheel.axis,
            "position_tolerance_m": wheel.position_tolerance_m,
        }
        for body, own in self.runs.items():
            ending = {"calculix": "inp", "ansys": "cdb", "nastran": "bdf"}[own.mesh_format]
            mesh = folder / f"{body}.{ending}"
            mesh.write_text(own.text(), encoding="utf-8")
            self.tables[body] = {"mesh": mesh.name, **_matrix_files(folder, body, own.matrices), **self.tables[body]}
        blade = _matrix_files(folder, "blade", self.blade)
        self.tables["blisk"].update(blade_stiffness=blade["stiffness"], blade_dofs=blade["dofs"])
        for body in ("blisk", "ring", "damper"):
            file[body] = self.tables.get(body)
        file.update(
            contact=_one_or_several(wheel.contact), force=_several(wheel.force), observe=_several(wheel.observe)
        )
        path = folder / "import.toml"
        path.write_text(text_of(file), encoding="utf-8")
        return path

    def carried_out(self) -> Imported:
        """Writes all, makes the bundle, and compares its frequencies with those of a cyclic eigenproblem."""
        wheel, folder = self.wheel, Path(self.wheel.out)
        wheel.steps.begins(f"writing what the bundle is made of: {folder / 'import'}")
        path = self.write()
        several = f", with {wheel.frequencies} frequencies per nodal diameter" if wheel.frequencies else ""
        wheel.steps.begins(f"making the bundle{several}: {folder}")
        answer = _native.import_sector(path, folder, wheel.frequencies)
        ours = json.loads(answer[0])["frequencies_hz"] if wheel.frequencies else []
        return Imported(folder, answer, self._checked(ours) if ours else {})

    def _checked(self, ours: list[list[float]]) -> dict[str, Any]:
        wheel = self.wheel
        if wheel.check is False or wheel.check == []:
            return {}
        contacts = _several(wheel.contact) or []
        if any(contact.get("pairing") == "projection" for contact in contacts):
            # The matrices of the bundle are those of the projected ring.
            return {"skipped": "the ring is projected on the blisk: the bundle has other matrices than the files"}
        every = range(wheel.sectors // 2 + 1)
        size = sum(len(own.matrices.rows) for own in self.runs.values())
        if wheel.check is not True:
            diameters = list(wheel.check)
        else:
            diameters = list(every) if size <= _ROWS_OF_ALL else sorted({0, min(1, every[-1]), every[-1]})
        bodies = []
        run = self.runs["blisk"]
        inside = {
            body: run.nodes_of(str(self.tables[body]["set"]), f"{body}.set")
            for body in ("ring", "damper")
            if body in self.tables and body not in self.runs
        }
        for body in ("blisk", "ring", "damper"):
            if body not in self.tables:
                continue
            own = self.runs.get(body, run)
            rows = own.matrices.rows
            if body in inside:
                kept = [row for row, (node, _) in enumerate(rows) if node in inside[body]]
            elif body == "blisk" and inside:
                others = set().union(*inside.values())
                kept = [row for row, (node, _) in enumerate(rows) if node not in others]
            else:
                kept = list(range(len(rows)))
            matrices = own.matrices if len(kept) == len(rows) else own.matrices.keeping(kept)
            grounding_hz = float(self.tables[body].get("grounding_hz", 0.0))
            bodies.append((matrices, self.pairs.get(body, []), grounding_hz))
        place = (wheel.axis, wheel.sectors, wheel.frequencies)
        theirs = _check.cyclic_frequencies_hz(bodies, *place, diameters, wheel.steps.begins)
        return _check.compared(ours, theirs, _CHECK_TOLERANCE, "a cyclic eigenproblem of the matrices by SciPy")


def _matrix_files(folder: Path, name: str, matrices: Matrices) -> dict[str, str]:
    """Writes the matrices as Matrix Market files, and the table of their rows; gives the keys of the import file."""
    sparse, mmwrite = needed("scipy.sparse", "an import"), needed("scipy.io", "an import").mmwrite
    keys = {"dofs": f"{name}_dofs.csv"}
    for key, matrix in (("stiffness", matrices.stiffness), ("mass", matrices.mass)):
        if matrix is not None:
            keys[key] = f"{name}_{key}.mtx"
            lower = sparse.tril(matrix).tocoo()
            mmwrite(os.fspath(folder / keys[key]), lower, field="real", precision=17, symmetry="symmetric")
    lines = [f"{row},{node},{direction + 1}\n" for row, (node, direction) in enumerate(matrices.rows, start=1)]
    (folder / keys["dofs"]).write_text("row,node,direction\n" + "".join(lines), encoding="utf-8")
    return keys


def _several(tables: Tables) -> Optional[list[dict[str, Any]]]:
    """Tables of a list, which may be given as one alone."""
    if tables is None:
        return None
    return [dict(tables)] if isinstance(tables, Mapping) else [dict(own) for own in tables]


def _one_or_several(tables: Tables) -> Union[dict[str, Any], list[dict[str, Any]], None]:
    """A table, or a list of them, as it was given."""
    return dict(tables) if isinstance(tables, Mapping) else _several(tables)


def blade_of(run: Run, blade: Optional[Matrices], what: str) -> Matrices:
    """The blade's stiffness over free rows of the blisk."""
    if blade is None:
        raise refused(f"the stiffness of the blade alone is missing; accepted: {what}")
    free = set(run.matrices.rows)
    kept = [row for row, own in enumerate(blade.rows) if own in free]
    if not kept:
        raise refused(
            "no row of the blade's stiffness is a free row of the blisk; accepted: the same node numbers in both"
        )
    return blade if len(kept) == len(blade.rows) else blade.keeping(kept)
