"""The lines of Python in the README run as they stand, on a small study in the place of theirs."""

import re
from importlib.metadata import distribution

from conftest import ROOT, SMALL

import blisk


def test_the_lines_of_the_readme_run(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", text, flags=re.MULTILINE | re.DOTALL)
    assert len(blocks) == 1
    init = blisk.init

    def small(**keywords):
        assert 'name = "quickstart"' in init(**keywords)
        return blisk.Study(**SMALL).to_toml()

    monkeypatch.setattr(blisk, "init", small)
    exec(compile(blocks[0], "README.md", "exec"), {"__name__": "page"})
    assert re.search(r"^\d+ N: P95 .* 95 % bounds ", capsys.readouterr().out, flags=re.MULTILINE)
    assert (tmp_path / "results" / "small" / "report.html").exists()


def test_the_page_of_the_package_stands_alone(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "python" / "README.md").read_text(encoding="utf-8")
    # A registry shows it without the files beside it.
    links = re.findall(r"\]\(([^)]*)\)", text)
    assert [link for link in links if not link.startswith("https://")] == []
    blocks = re.findall(r"^```python\n(.*?)^```", text, flags=re.MULTILINE | re.DOTALL)
    assert len(blocks) == 1
    exec(compile(blocks[0], "python/README.md", "exec"), {"__name__": "page"})
    assert "patterns" in capsys.readouterr().out


def test_the_package_packs_the_licences():
    for name in ("LICENSE-MIT", "LICENSE-APACHE"):
        own = (ROOT / "python" / name).read_bytes()
        assert own == (ROOT / name).read_bytes()
        assert own == next(path.read_binary() for path in distribution("blisk").files if path.name == name)
