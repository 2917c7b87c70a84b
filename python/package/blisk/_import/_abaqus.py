"""Abaqus: the deck and the text files of ``*MATRIX OUTPUT``."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, Optional

from .._needed import needed
from ._run import Held, Matrices, Path_, Run, held_nodes, refused, symmetric, text_of_file

_SOLID = re.compile(r"C3D(4|6|8|10|15|20)", re.IGNORECASE)
"""Solid elements by their number of nodes; letters after it say how they are integrated."""


class Deck:
    """Nodes, solid elements and sets of an input file, of one part at most."""

    def __init__(self, path: Path_) -> None:
        self.path = path
        self.positions: dict[int, tuple[float, float, float]] = {}
        self.elements: dict[int, list[int]] = {}
        self.kinds: dict[int, str] = {}
        self.node_sets: dict[str, set[int]] = {}
        self.element_sets: dict[str, set[int]] = {}
        instances = 0
        for keyword, parameters, data in _cards(text_of_file(path)):
            if keyword == "*NODE":
                self._nodes(parameters, data)
            elif keyword == "*ELEMENT":
                self._elements(parameters, data)
            elif keyword in ("*NSET", "*ELSET"):
                self._set(keyword[1:], parameters, data)
            elif keyword == "*INSTANCE":
                instances += 1
                if (
                    data
                    and re.match(r"\s*[-+.\d]", data[0])
                    and any(float(word) for word in data[0].split(",") if word.strip())
                ):
                    raise refused(f"{path}: the instance is moved by {data[0].strip()}; accepted: one that is not")
            elif keyword == "*INCLUDE":
                raise refused(f"{path}: *INCLUDE is not followed; accepted: one input file")
        if instances > 1:
            raise refused(f"{path} has {instances} instances; accepted: one, or a flat input file")
        if not self.positions or not self.elements:
            raise refused(f"{path} has no nodes or no solid elements; accepted: the input file of the sector")

    def _nodes(self, parameters: Mapping[str, str], data: Sequence[str]) -> None:
        numbers = []
        for line in data:
            number, *xyz = (word.strip() for word in line.split(","))
            values = [float(word) if word else 0.0 for word in xyz[:3]]
            x, y, z = values + [0.0] * (3 - len(values))
            self.positions[int(number)] = (x, y, z)
            numbers.append(int(number))
        if "NSET" in parameters:
            self.node_sets.setdefault(parameters["NSET"].upper(), set()).update(numbers)

    def _elements(self, parameters: Mapping[str, str], data: Sequence[str]) -> None:
        kind = parameters.get("TYPE", "").upper()
        known = _SOLID.match(kind)
        if known is None:
            raise refused(f"{self.path} has elements of type {kind}; accepted: C3D4, C3D6, C3D8, C3D10, C3D15, C3D20")
        length = int(known.group(1)) + 1
        numbers = [int(word) for line in data for word in line.split(",") if word.strip()]
        if len(numbers) % length:
            raise refused(f"{self.path}: elements of type {kind} have {length - 1} nodes each; one has another number")
        own = [numbers[at : at + length] for at in range(0, len(numbers), length)]
        for number, *nodes in own:
            self.elements[number], self.kinds[number] = nodes, known.group(0).upper()
        if "ELSET" in parameters:
            self.element_sets.setdefault(parameters["ELSET"].upper(), set()).update(number for number, *_ in own)

    def _set(self, kind: str, parameters: Mapping[str, str], data: Sequence[str]) -> None:
        sets = self.node_sets if kind == "NSET" else self.element_sets
        members: set[int] = set()
        for line in data:
            words = [word.strip() for word in line.split(",") if word.strip()]
            if "GENERATE" in parameters:
                first, last, *step = map(int, words)
                members.update(range(first, last + 1, step[0] if step else 1))
                continue
            for word in words:
                # A node of an instance is INSTANCE.NUMBER.
                word = word.rpartition(".")[2]
                members.update([int(word)] if word.isdecimal() else sets.get(word.upper(), ()))
        there = self.positions if kind == "NSET" else self.elements
        sets.setdefault(parameters.get(kind, "").upper(), set()).update(members.intersection(there))

    def sets(self) -> dict[str, set[int]]:
        """Node sets, and nodes of element sets."""
        found = {name: set(nodes) for name, nodes in self.node_sets.items()}
        for name, numbers in self.element_sets.items():
            found.setdefault(name, {node for number in numbers for node in self.elements[number]})
        return found

    def text(self) -> str:
        """A flat deck of nodes, elements and node sets."""
        return deck_text(
            self.positions, ((number, self.kinds[number], own) for number, own in self.elements.items()), self.sets()
        )


def deck_text(
    positions: Mapping[int, Sequence[float]],
    elements: Iterable[tuple[int, str, Sequence[int]]],
    sets: Mapping[str, Iterable[int]],
) -> str:
    """A deck of nodes, elements and node sets, with every digit of the positions."""
    lines = ["*NODE"]
    lines += [", ".join([str(node), *(repr(float(x)) for x in xyz)]) for node, xyz in positions.items()]
    for number, kind, nodes in elements:
        lines.append(f"*ELEMENT, TYPE={kind}")
        words = list(map(str, (number, *nodes)))
        # A comma at the end says that the element goes on.
        lines += [
            ", ".join(words[at : at + 8]) + ("," if at + 8 < len(words) else "") for at in range(0, len(words), 8)
        ]
    for name, members in sets.items():
        own = list(map(str, sorted(members)))
        if own:
            lines.append(f"*NSET, NSET={name}")
            lines += [", ".join(own[at : at + 8]) for at in range(0, len(own), 8)]
    return "\n".join(lines) + "\n"


def _cards(text: str) -> Iterator[tuple[str, dict[str, str], list[str]]]:
    """Keyword, parameters and data lines of each card of a deck."""
    keyword, parameters, data = "", {}, []  # type: str, dict[str, str], list[str]
    continued = False
    for line in text.splitlines():
        if not line.strip() or line.startswith("**"):
            continue
        if line.startswith("*") or continued:
            words = [word.strip() for word in line.split(",")]
            if not continued:
                yield keyword, parameters, data
                keyword, parameters, data = words.pop(0).upper(), {}, []
            for word in words:
                name, _, value = word.partition("=")
                if name.strip():
                    parameters[name.strip().upper()] = value.strip().strip('"')
            continued = line.rstrip().endswith(",")
        else:
            data.append(line)
    yield keyword, parameters, data


def matrix(path: Path_) -> tuple[Optional[list[tuple[int, int]]], Any]:
    """A matrix of ``*MATRIX OUTPUT``, and its rows by node and direction where the file says them.

    ``COORDINATE`` has row, column and value, ``MATRIX INPUT`` and ``LABELS`` have node, dof, node, dof and value.
    """
    numpy, sparse = needed("numpy", "reading matrices of Abaqus"), needed("scipy.sparse", "reading matrices of Abaqus")
    lines = (line for line in text_of_file(path).splitlines() if line.strip() and not line.lstrip().startswith("*"))
    words = [line.replace(",", " ").replace("D", "e").split() for line in lines]
    widths = {len(own) for own in words}
    if widths == {3}:
        table = numpy.array(words, dtype=float)
        row, column = table[:, 0].astype(int) - 1, table[:, 1].astype(int) - 1
        if row.min() < 0 or column.min() < 0:
            raise refused(
                f"{path} has rows that are no displacements of nodes; accepted: a model without internal dofs"
            )
        size = int(max(row.max(), column.max())) + 1
        return None, sparse.coo_matrix((table[:, 2], (row, column)), shape=(size, size)).tocsr()
    if widths != {5}:
        raise refused(
            f"{path} has {sorted(widths)} columns; accepted: 3 (FORMAT=COORDINATE), or 5 (FORMAT=MATRIX INPUT or LABELS)"
        )
    table = numpy.array(words, dtype=float)
    first, second = table[:, :2].astype(int), table[:, 2:4].astype(int)
    both = numpy.vstack([first, second])
    if both[:, 0].min() <= 0:
        raise refused(
            f"{path} has internal nodes (numbers below 1); accepted: a model whose rows are displacements of nodes"
        )
    rows, place = numpy.unique(both, axis=0, return_inverse=True)
    place, half, size = numpy.ravel(place), len(table), len(rows)
    if rows[:, 1].max() > 3:
        raise refused(f"{path} has the dof {rows[:, 1].max()}; accepted: 1, 2 and 3, as solid elements have")
    own = sparse.coo_matrix((table[:, 4], (place[:half], place[half:])), shape=(size, size)).tocsr()
    return [(int(node), int(dof) - 1) for node, dof in rows.tolist()], own


def matrices(deck: Deck, stiffness: Path_, mass: Optional[Path_]) -> Matrices:
    """Stiffness and mass over the same rows."""
    used = sorted({node for own in deck.elements.values() for node in own})
    by_deck = [(node, direction) for node in used for direction in range(3)]
    named, own = _named(matrix(stiffness), by_deck, stiffness)
    own = symmetric(own, f"the stiffness of {stiffness}")
    if mass is None:
        return Matrices(named, own)
    numpy, sparse = needed("numpy", "an import"), needed("scipy.sparse", "an import")
    of_mass, other = _named(matrix(mass), by_deck, mass)
    other = symmetric(other, f"the mass of {mass}")
    place = {row: at for at, row in enumerate(named)}
    missing = next((row for row in of_mass if row not in place), None)
    if missing is not None:
        raise refused(
            f"{mass} has node {missing[0]}, dof {missing[1] + 1}, which {stiffness} has not; accepted: one job"
        )
    # A row without mass is in no line of the file.
    to = numpy.array([place[row] for row in of_mass])
    put = sparse.csr_matrix((numpy.ones(len(to)), (to, numpy.arange(len(to)))), shape=(len(named), len(to)))
    return Matrices(named, own, (put @ other @ put.T).tocsr())


def _named(
    read: tuple[Optional[list[tuple[int, int]]], Any], by_deck: list[tuple[int, int]], path: Path_
) -> tuple[list[tuple[int, int]], Any]:
    """The rows of a matrix; those of the deck where the file does not say them."""
    rows, own = read
    if rows is not None:
        return rows, own
    if own.shape[0] > len(by_deck):
        raise refused(
            f"{path} has {own.shape[0]} rows, and the deck {len(by_deck)} displacements of nodes of elements; accepted:"
            " the deck of the same job, or FORMAT=MATRIX INPUT, which names the rows"
        )
    own.resize((len(by_deck), len(by_deck)))
    return by_deck, own


def run(
    inp: Path_, stiffness: Path_, mass: Path_, held: Held, more: Optional[Mapping[str, Iterable[int]]] = None
) -> Run:
    """Mesh and matrices of a job of Abaqus."""
    deck = Deck(inp)
    own = matrices(deck, stiffness, mass)
    unknown = next((node for node, _ in own.rows if node not in deck.positions), None)
    if unknown is not None:
        raise refused(f"{stiffness} has node {unknown}, which is not in {inp}; accepted: files of one job")
    elements, sets = list(deck.elements.values()), deck.sets()
    return Run("calculix", deck.text(), deck.positions, elements, sets, own.without_held(held_nodes(held, sets, more)))
