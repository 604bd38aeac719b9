"""Writes a page that compares our tests with Haines's."""

from pathlib import Path

from beambench_report.base.files import write_text
from beambench_report.base.quantities import markdown_table
from beambench_report.haines.counts import KINDS, Tests, published_tests, read_tests

_HEAD = """# Haines's tests, counted again

Each cell is the number of our tests / Haines's tests, in thousands, and their ratio, by kind of
primitive. The tests are those of whole pictures of the Standard Procedural Databases: 513x513 rays
through pixel corners, and all rays that follow. Ours use Goldsmith and Salmon's hierarchy, with
primitives inserted in the scene's order or shuffled, and Kay and Kajiya's queue.
[results/haines](../../haines/README.md) explains his counts, and why ours are lower. Made by
`python -m beambench_report haines`.
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
