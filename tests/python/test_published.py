"""Statements of the READMEs about the published runs."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path
from statistics import geometric_mean, median

import pytest

from beambench_operations.publish.figures.default import figures
from beambench_operations.publish.figures.formats import interval
from beambench_report.base.cell_files import identity, read_cell_files
from beambench_report.base.records import read_run


@pytest.fixture
def published(repository: Path) -> Path:
    return repository / "results/published"


def rows_of_folders(published: Path) -> dict[str, str]:
    """Returns the README's row for each folder."""
    rows = {}
    for line in (published / "README.md").read_text("utf-8").splitlines():
        if line.startswith("| `"):
            for folder in re.findall(r"`([a-z0-9-]+)/`", line.split("|")[1]):
                rows[folder] = line
    return rows


def test_every_folder_has_a_row(published: Path) -> None:
    folders = {entry.name for entry in published.iterdir() if entry.is_dir()}
    assert set(rows_of_folders(published)) == folders


def test_the_row_states_the_commit_of_each_run(published: Path) -> None:
    rows = rows_of_folders(published)
    manifests = sorted(published.rglob("manifest.json"))
    assert manifests
    for manifest in manifests:
        folder = manifest.relative_to(published).parts[0]
        program = json.loads(manifest.read_text("utf-8"))["program"]
        assert program["commit"][:7] in rows[folder], manifest
        assert not program["dirty"], manifest


def test_the_logs_have_the_repetitions_of_their_rows(published: Path) -> None:
    """The repetitions have six digits. Runs in blocks state the mean over the blocks."""
    logs = sorted(published.rglob("run.jsonl.gz"))
    assert len(logs) > 50
    for log in logs:
        cells = read_cell_files(log.parent)
        for row in read_run(log.parent).rows.to_dict("records"):
            cell = cells[identity(row)]
            if times := cell.trace_ms.values():
                middle = geometric_mean(times) if cell.in_blocks else median(times)
                stated = row["trace_ms" if cell.in_blocks else "trace_ms_median"]
                assert middle == pytest.approx(stated, rel=1e-5), log


def test_the_finding_of_the_root_readme(repository: Path, published: Path) -> None:
    speedups = figures(published / "default")["beams"]["tetra:n=6"]
    text = " ".join((repository / "README.md").read_text("utf-8").split())
    assert f"is {interval(speedups['320x200'])} at 320x200" in text
    assert f"but {interval(speedups['1280x1024'])} at 1280x1024" in text


def test_the_table_of_programs_has_the_sums_of_its_rows(published: Path) -> None:
    """The page has no template, so the sums are checked here."""
    sums: dict[str, dict[str, list[int]]] = {}
    with (published / "programs/summary.csv").open(encoding="utf-8") as table:
        for row in csv.DictReader(table):
            own = [int(row[name]) for name in ("rays", "graze", "structure_error", "scenes")]
            own.append(int(row["hits"]) - int(row["program_hits"]))
            sums.setdefault(row["program"], {})[row["ray_kinds"]] = own
    expected = []
    for program, kinds in sums.items():
        cells = [
            f"{rays:,}; {grazes:,}, {errors:,}"
            for rays, grazes, errors, *_ in (
                kinds[kind] for kind in ("scene's own", "edges", "axis")
            )
        ]
        rays, *_, lost = kinds.get("inside", [0, 0])
        cells.append(f"{rays:,}; {lost:,}" if rays else "-")
        expected.append(f"| {program} | {kinds['edges'][3]} | {' | '.join(cells)} |")
    lines = (published / "programs/README.md").read_text("utf-8").splitlines()
    start = next(place for place, line in enumerate(lines) if line.startswith("| program |"))
    assert lines[start + 2 : start + 2 + len(expected)] == expected


def test_the_findings_are_one_page(published: Path) -> None:
    assert len((published / "README.md").read_text("utf-8").splitlines()) <= 150


MOST_BYTES = 24_000_000
"""The limit for all published files, a second run of the thesis included: every clone has them."""


def test_what_is_published_is_small(published: Path) -> None:
    sizes = {file: file.stat().st_size for file in published.rglob("*") if file.is_file()}
    largest = sorted(sizes, key=lambda file: -sizes[file])[:5]
    assert sum(sizes.values()) <= MOST_BYTES, [str(file) for file in largest]


def test_no_plot_is_there_twice(published: Path) -> None:
    """Each plot is committed only as SVG, which is a fifth of the size of the PNG."""
    twice = [plot for plot in published.rglob("*.png") if plot.with_suffix(".svg").is_file()]
    assert twice == []


def test_a_report_shows_the_plots_beside_it(published: Path) -> None:
    """A page rewritten from too few of its tables would lack plots."""
    for report in published.rglob("report.md"):
        texts = "".join(text.read_text("utf-8") for text in report.parent.glob("*.md"))
        unshown = [plot for plot in report.parent.glob("*.svg") if plot.name not in texts]
        assert unshown == [], report
