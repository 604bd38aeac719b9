"""Writes a page that compares our tests with Haines's."""

from pathlib import Path

from beambench_report.base.files import write_text
from beambench_report.base.quantities import markdown_table
from beambench_report.haines.counts import KINDS, Tests, published_tests, read_tests

_HEAD = """# Haines's tests, counted again

Tests by kind of primitive over whole pictures of the Standard Procedural Databases (513x513 rays
through the corners of pixels and all rays that follow), in thousands, and our tests over his.
Goldsmith and Salmon's hierarchy, with primitives inserted in the scene's order and shuffled; rays
by Kay and Kajiya's queue. What his counts are and why ours are fewer:
[results/haines](../../haines/README.md). Made by `python -m beambench_report haines`.
"""


def write_report(folder: Path) -> Path:
    """Writes FOLDER/report.md from FOLDER/tests.csv."""
    his = published_tests()
    ours = read_tests(folder / "tests.csv")
    parts = [_HEAD, *(_table(name, tests, his) for name, tests in ours.items())]
    return write_text(folder / "report.md", "\n".join(parts))


def _table(contender: str, ours: Tests, his: Tests) -> str:
    rows = [
        (scene, *(_cell(tests[k], his[scene][k]) for k in KINDS)) for scene, tests in ours.items()
    ]
    lines = markdown_table(("scene", *KINDS), rows)
    return f"## {contender}\n" + "\n".join(lines) + "\n"


def _cell(ours: float, his: float) -> str:
    if his == 0:
        return "-" if ours == 0 else f"{ours / 1000:,.0f} / 0"
    return f"{ours / 1000:,.0f} / {his / 1000:,.0f} = {ours / his:.2f}"
