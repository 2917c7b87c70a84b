"""The keywords that every maker of a sector has beside those of its files."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import MISSING, dataclass, fields
from typing import Any, Callable, Optional, TypedDict, TypeVar, Union

from . import _faces
from ._run import Held, Path_, name_of
from ._steps import Steps

Tables = Union[Mapping[str, Any], Sequence[Mapping[str, Any]], None]


class _Needed(TypedDict):
    out: Path_
    sectors: int
    force: Tables
    observe: Tables


class Keywords(_Needed, total=False):
    """What every maker of a sector accepts beside its files; ``Wheel`` has the defaults."""

    held: Held
    name: Optional[str]
    low_face: Optional[str]
    high_face: Optional[str]
    ring: Optional[Mapping[str, Any]]
    damper: Optional[Mapping[str, Any]]
    contact: Tables
    sets: Optional[Mapping[str, Iterable[int]]]
    units: str
    axis: str
    position_tolerance_m: Optional[float]
    frequencies: int
    check: Union[bool, Iterable[int]]
    progress: bool


@dataclass
class Wheel:
    """What an import file says beside the files."""

    out: Path_
    sectors: int
    force: Tables
    observe: Tables
    held: Held = ()
    name: Optional[str] = None
    low_face: Optional[str] = None
    high_face: Optional[str] = None
    ring: Optional[Mapping[str, Any]] = None
    damper: Optional[Mapping[str, Any]] = None
    contact: Tables = None
    sets: Optional[Mapping[str, Iterable[int]]] = None
    units: str = "m-kg-s"
    axis: str = "z"
    position_tolerance_m: Optional[float] = None
    frequencies: int = 6
    check: Union[bool, Iterable[int]] = True
    progress: bool = True

    def __post_init__(self) -> None:
        self.steps = Steps(self.progress)

    @classmethod
    def of(cls, mesh: Path_, keywords: Keywords) -> Wheel:
        """As the keywords have it; named as the file of the mesh where they have no name."""
        wheel = cls(**keywords)
        wheel.name = name_of(wheel.name, mesh)
        return wheel

    def checked(self) -> None:
        """Refuses what would otherwise be found in the middle of the work."""
        if self.axis not in _faces.PLACES:
            raise ValueError(f"axis = {self.axis!r} is not accepted; accepted: x, y, z")
        if self.units not in ("m-kg-s", "mm-t-s"):
            raise ValueError(f"units = {self.units!r} is not accepted; accepted: m-kg-s, mm-t-s")
        if not 0 <= self.frequencies <= 1000:
            raise ValueError(f"frequencies = {self.frequencies} is not accepted; accepted: 0 to 1000")
        if (self.low_face is None) != (self.high_face is None):
            raise ValueError("low_face and high_face go together; accepted: both, or none and they are found")
        if self.sectors < 1:
            raise ValueError(f"sectors = {self.sectors} is not accepted; accepted: a whole number of at least 1")
        if not isinstance(self.check, bool):
            self.check = sorted({int(own) for own in self.check})
            last = self.sectors // 2
            if any(not 0 <= own <= last for own in self.check):
                raise ValueError(f"check = {self.check} is not accepted; accepted: nodal diameters from 0 to {last}")


SHARED = """``out``: the folder of the bundle to write. The import file and the matrices that it was made of are kept in
``out/import``; ``blisk import out/import/import.toml --out DIR`` makes the same bundle.
``sectors``: number of sectors of the wheel.
``force``, ``observe``: where the excitation acts, and whose displacement counts: tables of the import file as
dictionaries (docs/import.md), like ``force={"set": "TIP", "component": "z"}`` in N per newton of
``excitation.amplitude_n``, and ``observe={"name": "tip", "set": "TIP"}``.
``contact``: the surfaces that rub on each other, a dictionary or a list of them, like
``{"blisk": "FLANGE", "ring": "RING_TOP"}``; none unless given.
``ring``, ``damper``: a body in the same files (``{"set": "RING"}``) or in its own, which are named as those of the
blisk; none unless given.
``held``: nodes whose rows are taken out as well, like free ones on the axis: a set, or node numbers.
``name``: of the model; that of the mesh's file unless given.
``low_face``, ``high_face``: sets of the cut faces; the high one is the low one turned by +360/sectors degrees. Where
they are not named, they are found: the nodes that lie where other ones lie after that turn.
``sets``: further sets by node numbers, like ``{"TIP": [1204]}``.
``units``: of the files, ``m-kg-s`` (SI) or ``mm-t-s`` (mm, tonne, N).
``axis``: axis of rotation through the origin, ``x``, ``y`` or ``z``.
``position_tolerance_m``: how far the faces may be apart, m; 1e-6 of the largest distance from the origin unless
given.
``frequencies``: so many contact-free frequencies per nodal diameter are computed, Hz, 0 to 1000.
``check``: these frequencies are compared with a cyclic eigenproblem of the same matrices in SciPy, which shares
nothing with the program: at every nodal diameter (of a sector of more than 5000 rows at 0, 1 and the last one), at
those that are listed, or at none (``False``). A relative difference beyond 1e-6 is a ``BliskError`` with the exit code
11, that of a failed verification.
``progress``: each step is told as it begins, with the time since the import began, on the standard error stream or
below the cell of a notebook; ``False``: nothing is.

Returns the sector: ``report`` says what was found, ``check`` what was compared."""
"""The keywords of ``Wheel`` in the help of every maker."""


Maker = TypeVar("Maker", bound=Callable[..., Any])


def with_keywords(maker: Maker) -> Maker:
    """The maker with every keyword of ``Wheel`` by name in its signature, as ``help`` and notebooks show it."""
    own = inspect.signature(maker)
    kept = [parameter for parameter in own.parameters.values() if parameter.kind is not parameter.VAR_KEYWORD]
    shared = [
        inspect.Parameter(
            field.name,
            inspect.Parameter.KEYWORD_ONLY,
            default=inspect.Parameter.empty if field.default is MISSING else field.default,
            annotation=field.type,
        )
        for field in fields(Wheel)
    ]
    signature = own.replace(parameters=[*kept, *shared])

    @functools.wraps(maker)
    def made(*arguments: Any, **keywords: Any) -> Any:
        try:
            signature.bind(*arguments, **keywords)
        except TypeError as wrong:
            raise TypeError(f"{maker.__name__}(): {wrong}") from None
        return maker(*arguments, **keywords)

    made.__signature__ = signature  # type: ignore[attr-defined]
    made.__doc__ = f"{inspect.cleandoc(maker.__doc__ or '')}\n\n**As every maker.**\n\n{SHARED}"
    return made  # type: ignore[return-value]
