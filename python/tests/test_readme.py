"""The lines of Python in the README run as they stand, on a small study in the place of theirs."""

import re

from conftest import ROOT, SMALL

import blisk


def test_the_lines_of_the_readme_run(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", text, flags=re.MULTILINE | re.DOTALL)
    assert len(blocks) == 1
    (tmp_path / "studies").mkdir()
    (tmp_path / "studies" / "quickstart.toml").write_text(blisk.Study(**SMALL).to_toml())
    exec(compile(blocks[0], "README.md", "exec"), {"__name__": "page"})
    assert re.search(r"^\d+ N: P95 .* 95 % bounds ", capsys.readouterr().out, flags=re.MULTILINE)
    assert (tmp_path / "results" / "small" / "report.html").exists()
