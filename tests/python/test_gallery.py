"""The gallery of the site: pages of `beambench explain`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from beambench_operations.site.gallery import make_gallery
from beambench_operations.site.write import write_site
from beambench_report.base.files import Problem
from program import BINARY, can_explain, output_of
from synthetic_run import synthetic_rows, write_run

pytestmark = pytest.mark.skipif(not can_explain(), reason="built without three.js")


def test_there_is_a_page_for_each_figure_and_each_structure(tmp_path: Path) -> None:
    (tmp_path / "runs").mkdir()
    write_run(tmp_path / "runs", synthetic_rows())
    index = write_site([tmp_path / "runs"], tmp_path / "site", beambench=BINARY)
    assert "gallery/index.html" in index.read_text()
    text = (tmp_path / "site/gallery/index.html").read_text()
    names = {one["name"] for one in json.loads(output_of("list", "--json"))["structures"]}
    for name in names - {"null", "embree", "exhaustive"}:
        assert f"{name}.html" in text
    for scene in ("escena2", "gato-bill", "habitacion"):
        assert f"{scene}-beam.html#map=beams&amp;only=2" in text
    listed = json.loads((tmp_path / "site/site.json").read_text())
    pages = {f"gallery/{page.name}" for page in (tmp_path / "site/gallery").iterdir()}
    assert pages <= set(listed), "the next site removes what it no longer has"


def test_without_a_program_there_is_no_gallery(tmp_path: Path) -> None:
    (tmp_path / "runs").mkdir()
    write_run(tmp_path / "runs", synthetic_rows())
    index = write_site([tmp_path / "runs"], tmp_path / "site")
    assert "gallery/index.html" not in index.read_text()


def test_what_the_program_cannot_do_is_reported(tmp_path: Path) -> None:
    program = tmp_path / "beambench"
    program.write_text("#!/bin/sh\necho 'beambench: no three.js' >&2\nexit 2\n")
    program.chmod(0o755)
    with pytest.raises(Problem, match=r"^no three\.js$"):
        make_gallery(program, tmp_path / "gallery")
