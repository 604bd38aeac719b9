"""Plots within pages: well-formed, in the page's colors, and side by side."""

from __future__ import annotations

import re
from itertools import combinations
from pathlib import Path
from xml.etree import ElementTree

import pytest

from beambench_report.__main__ import main
from beambench_report.base.palette import TINTS, structure_color
from beambench_report.run.inline_svg import dark_variables, inline_svg
from synthetic_run import synthetic_rows, write_run


def element_of(path: Path) -> str:
    return inline_svg(path.read_text("utf-8"), path.stem)


@pytest.fixture(scope="module")
def plots(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    folder = write_run(tmp_path_factory.mktemp("run"), synthetic_rows())
    assert main(["plots", str(folder)]) == 0
    return sorted((folder / "plots").glob("*.svg"))


def test_all_plots_of_a_page_are_well_formed_and_share_no_id(plots: list[Path]) -> None:
    seen: list[str] = []
    for path in plots:
        svg = element_of(path)
        root = ElementTree.fromstring(svg)
        assert svg.startswith("<svg ")
        assert not {"width", "height"} & set(root.keys())
        assert "max-width: 100%" in root.get("style", "")
        assert root.get("viewBox")
        assert not re.search("<!|<\\?|<metadata|<style|xlink", svg)
        own = [element.get("id") for element in root.iter() if element.get("id")]
        used = set(re.findall(r'(?:url\(#|href="#)([^")]+)', svg))
        assert used
        assert used <= set(own)
        seen += own
    assert len(seen) == len(set(seen))


def test_colors_are_variables_of_the_page(plots: list[Path]) -> None:
    together = "".join(element_of(path) for path in plots)
    for name in ("ink", "grid", "card", "embree", "samet", "exhaustive"):
        color = next(tint.light for tint in TINTS if tint.name == name)
        assert f"var(--{name}, {color})" in together
    bare = re.sub(r"var\([^)]*\)", "", " ".join(re.findall(r'style="[^"]*"', together)))
    assert not re.search(r"#[0-9a-f]{3,6}", bare)
    assert structure_color("embree") == "#0a0a0a"


def test_hover_titles_are_in_the_page_too(plots: list[Path]) -> None:
    assert all("<title>" in element_of(path) for path in plots)


def luminance(color: str) -> float:
    parts = [int(color[place : place + 2], 16) / 255 for place in (1, 3, 5)]
    linear = [
        part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts
    ]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    high, low = sorted((luminance(one), luminance(other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def test_every_structure_can_be_seen_on_white_and_on_dark_pages() -> None:
    dark = dark_variables()
    for tint in TINTS:
        if tint.name in ("grid", "card"):
            continue
        assert contrast(tint.light, "#ffffff") > 2, tint
        assert contrast(dark[f"--{tint.name}"], "#161616") > 4, tint


def test_no_two_structures_look_alike() -> None:
    for scheme in ("light", "dark"):
        for one, other in combinations(TINTS[4:], 2):
            a, b = getattr(one, scheme), getattr(other, scheme)
            apart = sum(abs(int(a[k : k + 2], 16) - int(b[k : k + 2], 16)) for k in (1, 3, 5))
            assert apart > 50, (one, other)
