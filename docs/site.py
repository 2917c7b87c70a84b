"""Builds the pages of the repository as a site with mdBook.

    python3 docs/site.py FOLDER [MDBOOK]

`docs/SUMMARY.md` names the pages and their order, `book.toml` the settings. Pages keep their places relative to each
other below FOLDER/source. Other pages that they link to come last, other files are copied beside them. The site is
FOLDER/html. Ends with 1 if mdBook warns, or if a link of the site leads to no file or to no heading.
"""

import html.parser
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from urllib.parse import unquote, urlsplit

ROOT = Path(__file__).resolve().parent.parent
LINK = re.compile(r"(\]\()([^)\s]+)(\))")


def inside(path):
    """Where a page or file of the repository has its place in the book. mdBook copies no hidden folders."""
    parts = ["ci" if part == ".ci" else part for part in path.parts]
    name = "index.md" if parts[-1] == "README.md" else parts[-1]
    return Path(*parts[:-1], name)


def pages():
    summary = (ROOT / "docs" / "SUMMARY.md").read_text(encoding="utf-8")
    named = [match[2] for match in LINK.finditer(summary)]
    return summary, [Path(os.path.normpath(Path("docs") / name)) for name in named]


def relative(target, page):
    return os.path.relpath(inside(target), inside(page).parent).replace(os.sep, "/")


def laid_out(page, book, source):
    """The text of a page with its links as they are in the book. Adds pages that they lead to, and copies files."""
    wrong = []

    def link(match):
        address, _, heading = match[2].partition("#")
        if "://" in address or address.startswith("mailto:") or not address:
            return match[0]
        target = Path(os.path.normpath(page.parent / address))
        if not (ROOT / target).exists():
            wrong.append(f"{page}: {address}: no such file")
        elif (ROOT / target).is_dir():
            wrong.append(f"{page}: {address}: a folder, not a file")
        elif target.suffix == ".md":
            if target not in book:
                book.append(target)
        else:
            place = source / inside(target)
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / target, place)
        anchor = f"#{heading}" if heading else ""
        return f"{match[1]}{relative(target, page)}{anchor}{match[3]}"

    lines, code = [], False
    for line in (ROOT / page).read_text(encoding="utf-8").split("\n"):
        fence = line.lstrip().startswith("```")
        code ^= fence
        if code or fence or line.startswith("    "):
            lines.append(line)
            continue
        # Odd parts stand between backticks.
        parts = line.split("`")
        outside = [part if place % 2 else f"\0{part}" for place, part in enumerate(parts)]
        joined = "`".join(outside)
        # A link whose text has code spans several parts: only its target is changed, and that holds no backtick.
        lines.append(LINK.sub(link, joined).replace("\0", ""))
    return "\n".join(lines), wrong


class Reader(html.parser.HTMLParser):
    """Links and anchors of a page of the site."""

    def __init__(self, text):
        super().__init__()
        self.links, self.anchors = [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name") and tag != "meta":
                self.anchors.add(value)
            elif name in ("href", "src") and value:
                self.links.append(value)


def broken(site):
    """Links of the site that lead nowhere, and how many there are."""
    read = {path: Reader(path.read_text(encoding="utf-8")) for path in site.rglob("*.html")}
    found, count = [], 0
    for path, page in read.items():
        # Its links are relative to wherever a visitor was lost.
        if path.name == "404.html":
            continue
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            count += 1
            target = Path(os.path.normpath(path.parent / unquote(parts.path))) if parts.path else path
            if not target.is_file():
                found.append(f"{path.relative_to(site)}: {link}: no such file")
            elif parts.fragment and target in read and unquote(parts.fragment) not in read[target].anchors:
                found.append(f"{path.relative_to(site)}: {link}: no such heading")
    return sorted(set(found)), count


def main(folder, mdbook="mdbook"):
    folder = Path(folder)
    source, site = folder / "source", folder / "html"
    for old in (source, site):
        shutil.rmtree(old, ignore_errors=True)
    source.mkdir(parents=True)
    shutil.copyfile(ROOT / "book.toml", folder / "book.toml")
    summary, book = pages()
    wrong = [f"docs/SUMMARY.md names {page} twice" for page in set(book) if book.count(page) > 1]
    listed, titles = len(book), {}
    for page in book:  # which grows by the pages that its pages link to
        text, faults = laid_out(page, book, source)
        titles[page] = text.partition("\n")[0].lstrip("# ")
        wrong += faults
        place = source / inside(page)
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(text, encoding="utf-8")
    named, others = iter(book), book[listed:]
    inner = LINK.sub(lambda match: f"{match[1]}{inside(next(named)).as_posix()}{match[3]}", summary)
    if others:
        inner += "\n# Others\n\n" + "".join(f"- [{titles[page]}]({inside(page).as_posix()})\n" for page in others)
    (source / "SUMMARY.md").write_text(inner, encoding="utf-8")
    ended = subprocess.run([mdbook, "build", str(folder)], capture_output=True, text=True, check=False)
    said = ended.stdout + ended.stderr
    wrong += [line for line in said.splitlines() if re.search(r"\b(WARN|ERROR)\b", line)]
    if ended.returncode:
        wrong.append(said)
    else:
        faults, count = broken(site)
        wrong += faults
        print(f"site: {len(book)} pages, {count} links in {site}")
    for line in wrong:
        print("site:", line)
    return 1 if wrong else 0


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3) or sys.argv[1].startswith("-"):
        # A folder named like an option would be made in the repository.
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
