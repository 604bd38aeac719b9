"""Published rows, verified again by the current program."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import pytest

from beambench_operations.publish.verified_again import CLASSES, summary, verify_again
from program import BINARY

SCENE = "tetra:n=2"


def _row(structure: str, parameters: str, **others: object) -> dict[str, object]:
    row: dict[str, object] = {
        "scene": SCENE,
        "camera": "default",
        "width": 32,
        "height": 24,
        "samples": 1,
        "ray_kind": "primary",
        "rays_hash": "0123456789abcdef",
        "structure": structure,
        "parameters": parameters,
        "verdict": "ok",
        **dict.fromkeys(CLASSES, 0),
    }
    return {**row, **others}


def _publish(folder: Path, *rows: dict[str, object]) -> Path:
    run = folder / "published/run"
    run.mkdir(parents=True)
    with (run / "results.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    return folder / "published"


def _verified(folder: Path, *rows: dict[str, object]) -> dict[str, Any]:
    lines = verify_again(_publish(folder, *rows), BINARY, folder / "record.jsonl")
    return summary(lines, "c0ffee")


def test_a_new_hash_of_rays_is_listed_and_their_counts_are_not_compared(tmp_path: Path) -> None:
    found = _verified(tmp_path, _row("null", "rays=single", verdict="baseline"))
    (changed,) = found["hashes_changed"]
    assert changed["before"] == "0123456789abcdef" != changed["now"]
    assert found["verdicts_changed"] == found["classes_changed"] == []
    assert found["ray_kinds"] == {"primary": {"views": 1, "hashes_changed": 1}}


def test_changed_verdicts_and_counts_of_classes_are_listed(tmp_path: Path) -> None:
    first = _verified(tmp_path / "first", _row("exhaustive", ""))
    rays_hash = first["hashes_changed"][0]["now"]
    rays = 32 * 24
    found = _verified(
        tmp_path / "second",
        _row("exhaustive", "", rays_hash=rays_hash, agree=rays - 1, graze=1),
        _row("kd-tree", "", rays_hash=rays_hash, agree=rays, verdict="mismatch"),
        _row("samet", "", rays_hash=rays_hash, agree=rays),
    )
    assert found["cells"] == 3
    assert found["hashes_changed"] == []
    (verdict,) = found["verdicts_changed"]
    assert verdict["contender"].startswith("kd-tree")
    assert (verdict["before"]["verdict"], verdict["now"]["verdict"]) == ("mismatch", "ok")
    (classes,) = found["classes_changed"]
    assert classes["contender"] == "exhaustive"
    assert (classes["before"]["graze"], classes["now"]["graze"]) == (1, 0)


def test_an_interrupted_run_goes_on_where_it_stopped(tmp_path: Path) -> None:
    published = _publish(tmp_path, _row("samet", ""))
    record = tmp_path / "record.jsonl"
    first = verify_again(published, BINARY, record)
    record.write_text(record.read_text("utf-8") + '{"view": "cut o', "utf-8")
    assert verify_again(published, tmp_path / "no program", record) == first


def test_a_scene_that_is_not_here_is_named(tmp_path: Path) -> None:
    found = _verified(tmp_path, _row("samet", "", scene="mesh:unheard-of"))
    assert found["cells"] == 0
    ((view, problem),) = found["not_verified"].items()
    assert view.startswith("mesh:unheard-of")
    assert "unheard-of" in problem


@pytest.mark.parametrize("verdict", ["no_rays", "error"])
def test_rows_without_hits_are_left_out(tmp_path: Path, verdict: str) -> None:
    found = _verified(tmp_path, _row("samet", "", verdict=verdict))
    assert json.dumps(found["views"]) == "0"
