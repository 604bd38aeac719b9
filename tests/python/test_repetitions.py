"""The repetitions of a run in one file, and reading them without the cells."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from beambench_operations.nightly.calibration import noise_of_samples
from beambench_report.__main__ import main
from beambench_report.base.cell_files import read_cell_files
from beambench_report.base.files import Problem
from beambench_report.base.records import read_run
from beambench_report.embree_comparison.pairings import pairings
from program import BINARY, output_of
from synthetic_run import synthetic_rows, write_run


def published(run: Path, folder: Path) -> Path:
    """A run as published: without its log."""
    assert main(["repetitions", str(run)]) == 0
    shutil.copytree(
        run, folder, ignore=shutil.ignore_patterns("run.jsonl", "google-benchmark.json")
    )
    return folder


@pytest.fixture(scope="module")
def real_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    if not BINARY.exists():
        pytest.skip("beambench is not built; run scripts/setup")
    folder = tmp_path_factory.mktemp("real")
    (folder / "sweep.json").write_text(
        """{"name": "small", "description": "Three structures.", "scenes": ["tetra:n=2"],
            "structures": ["null", "tile-beam", "samet", "embree"], "resolutions": ["32x20"],
            "precision": 0.5, "repetitions": {"minimum": 9, "maximum": 9}, "budget_seconds": 1,
            "warm_up_seconds": 0}"""
    )
    output_of("run", str(folder / "sweep.json"), "-o", str(folder / "run"))
    return folder / "run"


def test_what_is_read_of_the_file_is_what_the_cells_hold(real_run: Path, tmp_path: Path) -> None:
    cells = read_cell_files(real_run)
    there = read_cell_files(published(real_run, tmp_path / "published"))
    assert cells.keys() == there.keys()
    assert len(cells) == 4
    for key, cell in cells.items():
        assert len(cell.trace_ms) == 9
        assert len(cell.warm_ms) == 6
        for name in ("total_ms", "trace_ms", "warm_ms"):
            mine, theirs = getattr(cell, name), getattr(there[key], name)
            assert mine.keys() == theirs.keys()
            assert [*mine.values()] == pytest.approx([theirs[turn] for turn in mine], rel=1e-5)


def test_a_published_run_has_paired_ratios(real_run: Path, tmp_path: Path) -> None:
    [mine] = pairings([read_run(real_run)])
    [theirs] = pairings([read_run(published(real_run, tmp_path / "published"))])
    assert theirs.ratio.paired
    assert theirs.ratio.interval == pytest.approx(mine.ratio.interval, rel=1e-4)
    assert theirs.second_ratio.interval == pytest.approx(mine.second_ratio.interval, rel=1e-4)


def test_noise_can_be_drawn_from_a_published_run(real_run: Path, tmp_path: Path) -> None:
    [mine] = noise_of_samples([real_run]).scenes
    [theirs] = noise_of_samples([published(real_run, tmp_path / "published")]).scenes
    # The same nights; the order of contenders may differ.
    assert np.sort(theirs.std(axis=0)) == pytest.approx(np.sort(mine.std(axis=0)), rel=0.3)


def test_a_file_of_another_run_is_refused(tmp_path: Path) -> None:
    run = write_run(tmp_path, synthetic_rows())
    (run / "repetitions.csv").write_text("line,round,build_ms,trace_ms\n2,0,1,123\n")
    with pytest.raises(Problem, match=r"does not belong to the results\.csv beside it"):
        read_cell_files(run)
    (run / "repetitions.csv").write_text("line,round,build_ms,trace_ms\n999,0,1,123\n")
    with pytest.raises(Problem, match="repetitions RUN"):
        read_cell_files(run)


def test_a_run_without_repetitions_is_refused(
    run_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["repetitions", str(run_folder)]) == 2
    assert "holds no log with repetitions" in capsys.readouterr().err
