"""Holds what README.md and docs/questions.md show of commands against a fresh run of them.

    python readme.py README.md docs/questions.md results/quickstart report.txt

The folder is that of the README's main command, `report.txt` what `blisk report` printed for it. Every line of the
README's excerpts must be one of the fresh output, in the same order: words as they are, numbers within 0.2 %, since
another processor may round the last digit the other way. `--write` puts fresh lines into the README. Every quoted
sentence (`> `) of docs/questions.md must stand in the report likewise.
"""

import re
import sys
from pathlib import Path

WITHIN = 2e-3
NUMBER = re.compile(r"[-+−]?\d+(?:\.\d+)?")
EXCERPT = re.compile(r"(<!-- output of (\w+) -->\n```text\n)(.*?)(```)", re.DOTALL)
# What the excerpts show, by the beginnings of lines.
SHOWN = {
    "run": ["study quickstart:", "load N  tuned", "   320 ", "   480 ", "   800 ", "lowest P95 amplitude"],
    "report": ["Which normal load should I choose for the 99th", "  480 N per sector", "  99 % of such", "How much of that", "  At most"],
}


def words(line):
    return NUMBER.sub("#", " ".join(line.split()))


def numbers(line):
    return [float(number.replace("−", "-")) for number in NUMBER.findall(line)]


def alike(shown, fresh):
    if words(shown) != words(fresh):
        return False
    return near(numbers(shown), numbers(fresh))


def near(shown, fresh):
    # Percentages of a few thousandths are rounded to two places.
    pairs = zip(shown, fresh, strict=True)
    return all(abs(a - b) <= max(WITHIN * abs(b), 0.0101 if abs(b) < 3 else 0.0) for a, b in pairs)


def stands_in(quote, line):
    """Whether a quoted sentence is part of a line."""
    place = words(line).find(words(quote))
    before = words(line)[: max(place, 0)].count("#")
    wanted = numbers(quote)
    return place >= 0 and near(wanted, numbers(line)[before : before + len(wanted)])


def excerpt(name, fresh):
    found, rest = [], iter(fresh)
    for start in SHOWN[name]:
        found.append(next(line for line in rest if line.startswith(start)).rstrip())
    return found


def main(readme, questions, results, report, *options):
    path = Path(readme)
    text = path.read_text(encoding="utf-8")
    fresh = {
        "run": (Path(results) / "summary.txt").read_text(encoding="utf-8").splitlines(),
        "report": Path(report).read_text(encoding="utf-8").splitlines(),
    }
    if options == ("--write",):
        block = lambda match: match[1] + "".join(f"{line}\n" for line in excerpt(match[2], fresh[match[2]])) + match[4]
        path.write_text(EXCERPT.sub(block, text), encoding="utf-8")
        return 0
    wrong, count = [], 0
    shown = {match[2]: match[3].splitlines() for match in EXCERPT.finditer(text)}
    if set(shown) != set(fresh):
        wrong.append(f"excerpts of {sorted(shown)}, expected of {sorted(fresh)}")
    for name, lines in shown.items():
        rest = iter(fresh[name])
        for line in lines:
            count += 1
            if not any(alike(line, other) for other in rest):
                wrong.append(f"blisk {name} does not print (or not here): {line}")
                rest = iter(fresh[name])
    quotes = [line[2:] for line in Path(questions).read_text(encoding="utf-8").splitlines() if line.startswith("> ")]
    for quote in quotes:
        if not any(stands_in(quote, line) for line in fresh["report"]):
            wrong.append(f"{questions} quotes what blisk report does not print: {quote}")
    if count < 10 or len(quotes) < 8:
        wrong.append(f"only {count} lines are shown, and {len(quotes)} quoted")
    for line in wrong:
        print("readme:", line)
    if not wrong:
        print(f"readme: {count} lines of the README and {len(quotes)} quotes are those of a fresh run")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
