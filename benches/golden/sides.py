"""What a binary makes of the cases, and what differs between two."""

import os
import shlex
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from itertools import zip_longest
from pathlib import Path

from masks import build_of, masked

# Commands that take every core where nothing is said.
THREADED = ("run", "plan", "optimum", "estimate", "tradeoff", "verify")
WRONG_USE = 2
TIMEOUT_S = 600
# Characters that are shown of a line that differs.
SHOWN = 100


class Failed(Exception):
    """A case did not run as it is meant to."""


class Side:
    """A binary. Both run under one name in the same folders, so that no path in what they write tells them apart."""

    def __init__(self, binary, folder):
        self.program, self.places = folder / "blisk", folder / "places"
        shutil.copy(binary, self.program)
        # Neither a scheduler's variables nor those of a terminal.
        self.environment = {"PATH": os.environ["PATH"]}
        self.build = build_of(self.ended(["--version"], folder).stdout)

    def ended(self, words, place):
        return subprocess.run(
            [self.program, *words],
            cwd=place,
            env=self.environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=TIMEOUT_S,
        )

    def found(self, case):
        """Masked streams and files of a case by their names; words where it failed."""
        place = self.places / case.name
        try:
            write_files(case, place)
            return masked({**self.streams(case, place), **files_below(place)}, self.build)
        except (Failed, OSError, subprocess.TimeoutExpired) as failure:
            return str(failure)
        finally:
            shutil.rmtree(place, ignore_errors=True)

    def streams(self, case, place):
        found = {}
        for number, line in enumerate(case.lines, start=1):
            words = shlex.split(line)
            if words[0] in DAMAGES:
                DAMAGES[words[0]](place / words[1])
                continue
            expected = int(words.pop(0)) if words[0].isdigit() else 0
            # Wrong use is compared as it is typed.
            if expected != WRONG_USE and words[0] in THREADED:
                words += ["--threads", "1"]
            ended = self.ended(words, place)
            if ended.returncode != expected:
                told = ended.stderr.decode(errors="replace").strip().split("\n")[-1]
                raise Failed(f"{line}: ended with {ended.returncode}, not with {expected} {told}".rstrip())
            found[f"{number}. {line}: stdout"] = ended.stdout
            found[f"{number}. {line}: stderr"] = ended.stderr
        return found


def flip(path):
    """Changes the byte in the middle of a file."""
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


DAMAGES = {"flip": flip, "remove": Path.unlink}


def write_files(case, place):
    place.mkdir(parents=True)
    for name, content in case.files.items():
        path = place / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(content)


def files_below(place):
    paths = sorted(path for path in place.rglob("*") if path.is_file())
    return {path.relative_to(place).as_posix(): path.read_bytes() for path in paths}


def all_found(binary, cases, scratch, jobs=1):
    """What a binary makes of every case, in their order."""
    folder = scratch / "side"
    folder.mkdir()
    try:
        side = Side(binary, folder)
    except (OSError, ValueError, subprocess.TimeoutExpired) as failure:
        yield from (f"{binary} does not start: {failure}" for _ in cases)
    else:
        with ThreadPoolExecutor(jobs) as pool:
            yield from pool.map(side.found, cases)
    finally:
        shutil.rmtree(folder)


def difference(before, after):
    """What differs first, in words; none where all is the same."""
    for side, found in (("before", before), ("after", after)):
        if isinstance(found, str):
            return f"{side}: {found}"
    for name in {**before, **after}:
        if name not in before or name not in after:
            return f"{name}: only {'before' if name in before else 'after'}"
        if before[name] != after[name]:
            return f"{name}: {first_difference(before[name], after[name])}"
    return None


def first_difference(before, after):
    """A line of both sides; the place of a byte in what is no text."""
    try:
        old_lines, new_lines = before.decode().split("\n"), after.decode().split("\n")
    except UnicodeDecodeError:
        place = len(os.path.commonprefix([before, after]))
        return f"byte {place}, of {len(before)} before and {len(after)} after"
    lines = enumerate(zip_longest(old_lines, new_lines, fillvalue=""), start=1)
    number, old, new = next((number, old, new) for number, (old, new) in lines if old != new)
    start = max(len(os.path.commonprefix([old, new])) - SHOWN // 2, 0)
    return f"line {number}: {old[start:start + SHOWN]!r} before, {new[start:start + SHOWN]!r} after"
