"""Notebooks show pictures of scenes, tables of runs, examples of verdicts, and pages."""

from __future__ import annotations

import base64
import io
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from module import bb
from program import can_explain


def test_a_scene_is_shown_as_its_picture() -> None:
    html = bb.Scene("escena2")._repr_html_()
    assert "92 primitives" in html
    data = re.search(r'base64,([^"]+)"', html)
    assert data
    picture = np.asarray(Image.open(io.BytesIO(base64.b64decode(data[1]))))
    assert picture.shape[2] == 3
    assert picture.std() > 5, "it shows something"


def test_names_cannot_be_read_as_html() -> None:
    scene = bb.Scene.from_triangles(
        [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)], name='<b>&"quoted"'
    )
    assert "<b>&" not in scene._repr_html_()
    assert "<b>&" not in bb.Structure(scene, "samet")._repr_html_()


def test_a_structure_is_shown_in_a_line_and_a_table() -> None:
    structure = bb.Structure(bb.Scene("tetra:n=2"), "samet:max_level=4")
    assert repr(structure) == f"<beambench.Structure '{structure.name}' over 'tetra:n=2'>"
    html = structure._repr_html_()
    assert "max_level=4" in html
    assert "<th>leaves</th>" in html


def test_a_verdict_is_shown_with_its_examples() -> None:
    scene = bb.Scene("tetra:n=2")
    rays = scene.rays(resolution=(16, 16))
    hits = bb.Structure(scene, "samet").closest_hits(rays)
    good = bb.verify(scene, rays, hits)
    assert repr(good).startswith("<beambench.Report ok: 256 rays")
    assert "<pre>" not in good._repr_html_()
    bad = bb.verify(scene, rays, t=np.where(hits.hit, hits.t + 1, hits.t))
    assert "structure error" in bad._repr_html_()
    assert "<pre>ray " in bad._repr_html_()


def test_the_hits_of_an_image_can_be_verified_as_they_are() -> None:
    scene = bb.Scene("tetra:n=2")
    structure = bb.Structure(scene, "sah-bvh")
    hits = structure.trace_image(resolution=(16, 12))
    report = bb.verify(scene, scene.rays(resolution=(16, 12)), hits)
    assert report.ok
    assert report.rays == 16 * 12
    with pytest.raises(TypeError, match="cannot be combined"):
        bb.verify(scene, scene.rays(resolution=(16, 12)), hits, t=hits.t)


def test_a_run_is_shown_as_a_table_with_bars() -> None:
    sweep = {
        "name": "notebook",
        "scenes": ["tetra:n=1"],
        "structures": ["samet:max_level=3", "sah-bvh"],
        "resolutions": ["8x8"],
        "repetitions": {"minimum": 1, "maximum": 1},
        "budget_seconds": 1,
    }
    results = bb.sweep(sweep)
    html = results._repr_html_()
    assert html.count("<table>") == 1
    assert "samet" in html
    assert html.count("background:#2f6fb0") == 2
    assert "Hits:" in html
    assert type(results[["structure"]]).__name__ == "DataFrame"


@pytest.mark.skipif(not can_explain(), reason="built without three.js")
def test_explain_returns_a_page(tmp_path: Path) -> None:
    scene = bb.Scene("tetra:n=2")
    page = bb.explain(scene, "samet", "sah-bvh", resolution=(8, 8))
    assert page.html.startswith("<!doctype html>")
    assert page._repr_html_().startswith('<iframe srcdoc="&lt;!doctype html')
    assert page.save(tmp_path / "page.html").read_text(encoding="utf-8") == page.html
    assert "MB" in repr(page)
    with pytest.raises(bb.InputError, match="65536"):
        bb.explain(scene, "samet", resolution=(1000, 1000))
    with pytest.raises(bb.InputError, match="unknown structure"):
        bb.explain(scene, "nothing")
    with pytest.raises(TypeError, match="Scene"):
        bb.explain("tetra", "samet")
