"""Sectors: bundles, and where they come from."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

from . import _native
from ._answer import Answer, answer_of
from ._import import _abaqus, _ansys, _arrays, _check, _nastran
from ._import._keywords import Keywords, Wheel, with_keywords
from ._import._run import Matrices, held_nodes, refused, saying_first, symmetric
from ._import._write import Import, Imported, blade_of
from ._needed import needed

if TYPE_CHECKING:
    from typing_extensions import Unpack

_Path = Union[str, "os.PathLike[str]"]


class Sector:
    """One cyclic sector of a wheel: a sector bundle, the folder that a study reads with ``source = "bundle"``.

    It is made from the files of a finite-element code (``from_ansys``, ``from_nastran``, ``from_abaqus``), from arrays
    (``from_arrays``) or by an import file (``from_import_file``), or it is there already (``from_bundle``):

        sector = blisk.Sector.from_ansys("file.full", "sector.cdb", out="wheel", sectors=24, ...)
        study = blisk.Study(study={...}, model=sector.model, ...)

    ``folder``: that of the bundle, for ``from_bundle`` alone. Every maker from files has the same keywords beside those
    of its files; its help lists them.

    What is not accepted is an ``InputError`` with the words of ``blisk import``. A package that is missing is an
    ``ImportError`` that names it.
    """

    folder: Path
    """The folder of the bundle."""
    report: Optional[Answer]
    """What the import found: bodies, faces, contact, ``frequencies_hz``; as ``blisk import --json``. Its text ends with
    what was compared. ``None``: none was made."""
    check: dict[str, Any]
    """The frequencies on another way: ``worst_relative_difference``, ``frequencies_compared``, ``nodal_diameters``, and
    ``result_file`` where one was given. Empty: nothing was compared."""

    def __init__(self, folder: _Path) -> None:
        self.folder = Path(folder)
        self.report = None
        self.check = {}
        self._facts: dict[str, Any] = json.loads(_native.bundle_facts(self.folder))

    @classmethod
    def from_bundle(cls, folder: _Path) -> Sector:
        """A bundle that is there.

        ``folder``: its folder. Returns the sector.
        """
        return cls(folder)

    @classmethod
    def from_import_file(cls, file: _Path, out: _Path, frequencies: int = 0) -> Sector:
        """The bundle that an import file makes, as ``blisk import FILE --out OUT --frequencies N`` does.

        ``file``: the import file.
        ``out``: the folder of the bundle to write.
        ``frequencies``: so many contact-free frequencies per nodal diameter are computed, Hz, 0 to 1000.

        Returns the sector.
        """
        if not 0 <= frequencies <= 1000:
            raise ValueError(f"frequencies = {frequencies} is not accepted; accepted: 0 to 1000")
        answer = _native.import_sector(Path(file), Path(out), frequencies)
        return cls._of(Imported(Path(out), answer, {}))

    @classmethod
    @with_keywords
    def from_ansys(
        cls,
        full: _Path,
        cdb: _Path,
        *,
        blade_full: Optional[_Path] = None,
        blade_emat: Optional[_Path] = None,
        blade: Union[str, Iterable[int], None] = None,
        rst: Optional[_Path] = None,
        **keywords: Unpack[Keywords],
    ) -> Sector:
        """A sector of Ansys. Needs ansys-mapdl-reader and SciPy, and no Ansys.

        ``full``: the ``.full`` file of a modal analysis of the sector, its cut faces free.
        ``cdb``: its mesh by ``CDWRITE``; the components are the sets.
        ``blade_full``: the stiffness of the blade alone, the ``.full`` file of a run with the blade's elements alone.
        ``blade_emat``, ``blade``: the same in another way, the ``.emat`` file of the run itself, and a component or the
        numbers of the elements.
        ``rst``: a result file that is compared as well. One of a cyclic analysis: its frequencies by nodal diameter. One
        of the sector alone: each mode has to satisfy ``K u = omega^2 M u`` away from the faces and the held nodes.
        ``ring``, ``damper`` with files of their own: the keys ``full`` and ``cdb``, and ``held``.
        """
        wheel = Wheel.of(cdb, keywords)
        wheel.steps.begins(f"reading {full} and {cdb}")
        own = _ansys.run(full, cdb, wheel.held, wheel.sets)
        others = {}
        for body, table in _with_files(wheel.ring, wheel.damper, ("full", "cdb")):
            wheel.steps.begins(f"reading {table['full']} and {table['cdb']}")
            others[body] = _ansys.run(table["full"], table["cdb"], table.get("held", ()))
        alone: Optional[Matrices] = None
        if blade_full is not None:
            wheel.steps.begins(f"reading {blade_full}")
            alone = _ansys.blade_of_file(own, full, blade_full)
        elif blade_emat is not None and blade is not None:
            wheel.steps.begins(f"reading {blade_emat}")
            alone = _ansys.blade_of_elements(own, cdb, blade_emat, blade)
        alone = blade_of(own, alone, "blade_full, or blade_emat and blade")
        with saying_first(own.doubt, *(of_body.doubt for of_body in others.values())):
            work = Import(wheel, own, alone, others)
            made = work.carried_out()
        if rst is not None:
            wheel.steps.begins(f"comparing with {rst}")
            faces = [node for pair in work.pairs["blisk"] for node in pair]
            ours = cls(made.folder).frequencies_hz
            made.check["result_file"] = _ansys.result_checked(rst, full, own, faces, ours, wheel.sectors)
        return cls._of(made, wheel)

    @classmethod
    @with_keywords
    def from_nastran(
        cls,
        bdf: _Path,
        matrices: _Path,
        *,
        blade: Optional[_Path] = None,
        mass: Optional[_Path] = None,
        rows: Optional[Sequence[Sequence[int]]] = None,
        blade_rows: Optional[Sequence[Sequence[int]]] = None,
        stiffness_name: Optional[str] = None,
        mass_name: Optional[str] = None,
        blade_stiffness_name: Optional[str] = None,
        **keywords: Unpack[Keywords],
    ) -> Sector:
        """A sector of Nastran. Needs pyYeti and SciPy, and no Nastran.

        ``bdf``: the bulk data; the SET1 entries are the sets, and their names are their numbers.
        ``matrices``: stiffness and mass, ``.op2``, ``.op4`` (``.ou1`` to ``.ou7`` of MYSTRAN) or a punch file ``.pch`` with
        DMIG.
        ``mass``: the file of the mass, where it is another one.
        ``stiffness_name``, ``mass_name``: names of the matrices in the files; needed unless only one begins with K or M.
        ``rows``: node and direction (1, 2, 3) of each row of an ``.op2`` or ``.op4``, shape (n, 2); unless given 3 or 6
        rows for each grid point in ascending order. Empty rows are left out, as those of rotations are.
        ``blade``: the file of the stiffness of the blade's elements alone.
        ``blade_rows``, ``blade_stiffness_name``: as ``rows`` and ``stiffness_name``, of that file.
        ``held``: here of use where the matrices are those without SPC.
        ``ring``, ``damper`` with files of their own: the keys ``bdf`` and ``matrices``, and ``rows``, ``held``.
        """
        wheel = Wheel.of(bdf, keywords)
        wheel.steps.begins(f"reading {bdf} and {matrices}")
        names = (stiffness_name, mass_name)
        made = _nastran.matrices(_nastran.grids(bdf), matrices, mass or matrices, rows, names)
        own = _nastran.run(bdf, made, wheel.held, wheel.sets)
        others = {}
        for body, table in _with_files(wheel.ring, wheel.damper, ("bdf", "matrices")):
            wheel.steps.begins(f"reading {table['bdf']} and {table['matrices']}")
            points = _nastran.grids(table["bdf"])
            of_body = _nastran.matrices(points, table["matrices"], table["matrices"], table.get("rows"), (None, None))
            others[body] = _nastran.run(table["bdf"], of_body, table.get("held", ()))
        alone = None
        if blade is not None:
            wheel.steps.begins(f"reading {blade}")
            of_blade = rows if blade_rows is None else blade_rows
            alone = _nastran.matrices(own.positions, blade, None, of_blade, (blade_stiffness_name, None)).without_held(
                held_nodes(wheel.held, own.sets, wheel.sets)
            )
        alone = blade_of(own, alone, "blade, a file with the stiffness of the blade's elements alone")
        return cls._of(Import(wheel, own, alone, others).carried_out(), wheel)

    @classmethod
    @with_keywords
    def from_abaqus(
        cls,
        inp: _Path,
        stiffness: _Path,
        mass: _Path,
        *,
        blade_stiffness: Optional[_Path] = None,
        blade_inp: Optional[_Path] = None,
        **keywords: Unpack[Keywords],
    ) -> Sector:
        """A sector of Abaqus. Needs SciPy, and no Abaqus.

        ``inp``: the input file, flat or with one instance that is not moved; its node and element sets are the sets.
        ``stiffness``, ``mass``: the ``.mtx`` files of ``*MATRIX GENERATE, STIFFNESS, MASS`` and ``*MATRIX OUTPUT``, in any
        of its text formats. ``COORDINATE`` does not name its rows: they are those of the nodes of the elements.
        ``blade_stiffness``: that of a job with the blade's elements alone, same nodes.
        ``blade_inp``: the input file of that job, which ``COORDINATE`` needs.
        ``held``: rows with a penalty of 1e30 or more on the diagonal are taken out, too.
        ``ring``, ``damper`` with files of their own: the keys ``inp``, ``stiffness`` and ``mass``, and ``held``.
        """
        wheel = Wheel.of(inp, keywords)
        wheel.steps.begins(f"reading {inp}, {stiffness} and {mass}")
        own = _abaqus.run(inp, stiffness, mass, wheel.held, wheel.sets)
        others = {}
        for body, table in _with_files(wheel.ring, wheel.damper, ("inp", "stiffness", "mass")):
            wheel.steps.begins(f"reading {table['inp']}, {table['stiffness']} and {table['mass']}")
            others[body] = _abaqus.run(table["inp"], table["stiffness"], table["mass"], table.get("held", ()))
        alone = None
        if blade_stiffness is not None:
            wheel.steps.begins(f"reading {blade_stiffness}")
            deck = _abaqus.Deck(inp if blade_inp is None else blade_inp)
            alone = _abaqus.matrices(deck, blade_stiffness, None).without_held(held_nodes(wheel.held, own.sets, wheel.sets))
        alone = blade_of(own, alone, "blade_stiffness, the .mtx file of a job with the blade's elements alone")
        return cls._of(Import(wheel, own, alone, others).carried_out(), wheel)

    @classmethod
    @with_keywords
    def from_arrays(
        cls,
        stiffness: Any,
        mass: Any,
        blade_stiffness: Any,
        nodes: Any,
        *,
        rows: Optional[Sequence[Sequence[int]]] = None,
        elements: Optional[Mapping[str, Any]] = None,
        **keywords: Unpack[Keywords],
    ) -> Sector:
        """A sector from matrices in memory. Needs NumPy and SciPy.

        ``stiffness``, ``mass``, ``blade_stiffness``: arrays or sparse matrices of shape (n, n) over the same rows, with
        both triangles or one; in N/m and kg, or in the units that ``units`` says.
        ``nodes``: positions in x, y, z, of shape (m, 3) and numbered from 1, or a dictionary by node number; or a mesh
        of meshio, whose elements and ``point_sets`` are taken, its nodes numbered from 1.
        ``rows``: node and direction (1, 2, 3 for x, y, z) of each row, shape (n, 2); three for each node unless given.
        ``elements``: node numbers of solid elements by their type in Abaqus or meshio, like ``{"C3D8": array of (k, 8)}``;
        a contact needs them, or a ``normal``.
        """
        wheel = Wheel.of("wheel", keywords)
        wheel.steps.begins("reading the arrays")
        own, named = _arrays.run(stiffness, mass, rows, nodes, elements, wheel.held, wheel.sets)
        blade = symmetric(blade_stiffness, "blade_stiffness")
        if blade.shape[0] != len(named):
            raise refused(f"blade_stiffness has {blade.shape[0]} rows, stiffness {len(named)}; accepted: the same rows")
        free = Matrices(named, blade).without_held(held_nodes(wheel.held, own.sets, wheel.sets))
        alone = blade_of(own, free, "blade_stiffness")
        return cls._of(Import(wheel, own, alone, {}).carried_out(), wheel)

    @classmethod
    def _of(cls, made: Imported, wheel: Optional[Wheel] = None) -> Sector:
        sector = cls(made.folder)
        values, text = made.answer
        compared = _check.words(made.check)
        sector.report = answer_of((values, f"{text.rstrip()}\n{compared}" if compared else text))
        sector.check = made.check
        if wheel is not None:
            wheel.steps.begins("ready")
        return sector

    @property
    def model(self) -> dict[str, Any]:
        """The table ``model`` of a study of this sector."""
        return {"source": "bundle", "bundle": {"path": str(self.folder.resolve())}}

    @property
    def name(self) -> str:
        """Name of the model."""
        return str(self._facts["name"])

    @property
    def sectors(self) -> int:
        """Number of sectors of the wheel."""
        return int(self._facts["sectors"])

    @property
    def dofs(self) -> int:
        """Number of dofs of the sector, both cut faces included."""
        return int(self._facts["dofs"])

    def frequencies_hz(self, count: int = 6) -> list[list[float]]:
        """The lowest contact-free natural frequencies.

        ``count``: how many for each nodal diameter, 1 to 1000.

        Returns a list for each nodal diameter 0 to sectors/2, with ``count`` frequencies, Hz, in ascending order. A body that nothing holds has frequencies of nought.
        """
        if not 1 <= count <= 1000:
            raise ValueError(f"count = {count} is not accepted; accepted: 1 to 1000")
        return _native.bundle_frequencies(self.folder, count)

    def plot(self, count: int = 6, *, ax: Any = None) -> Any:
        """Draws the contact-free frequencies (Hz) over the nodal diameter.

        ``count``: how many for each nodal diameter, 1 to 1000.
        ``ax``: axes of matplotlib to draw into; new ones unless given.

        Returns the axes.
        """
        by_diameter = self.frequencies_hz(count)
        if ax is None:
            _, ax = needed("matplotlib.pyplot", "plot()").subplots()
        for mode in range(min(map(len, by_diameter))):
            ax.plot(range(len(by_diameter)), [own[mode] for own in by_diameter], marker="o", label=f"mode {mode + 1}")
        ax.set_xlabel("nodal diameter")
        ax.set_ylabel("natural frequency without contact, Hz")
        return ax

    def __repr__(self) -> str:
        return f"<blisk.Sector {self.name}: {self.sectors} sectors, {self.dofs} dofs, {self.folder}>"


def _with_files(
    ring: Optional[Mapping[str, Any]], damper: Optional[Mapping[str, Any]], keys: Sequence[str]
) -> list[tuple[str, Mapping[str, Any]]]:
    """The bodies beside the blisk that have files of their own."""
    found = []
    for body, table in (("ring", ring), ("damper", damper)):
        given = [] if table is None else [key for key in keys if key in table]
        if table is None or not given:
            continue
        if len(given) < len(keys):
            raise ValueError(
                f"{body} has {', '.join(given)}; accepted: {', '.join(keys)}, or `set` in the files of the blisk"
            )
        found.append((body, table))
    return found
