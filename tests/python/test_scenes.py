"""`beambench scene --json` of every scene of the catalogue, and its row in scenes/README.md."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path

import pytest

from program import output_of

REPOSITORY = Path(__file__).resolve().parents[2]
NAMES = [scene["name"] for scene in json.loads(output_of("list", "--json"))["scenes"]]
with (REPOSITORY / "results/thesis/scenes.csv").open() as table:
    THESIS = list(csv.DictReader(table))


def scene(name: str) -> dict:
    return json.loads(output_of("scene", name, "--json"))


@pytest.mark.parametrize("row", THESIS, ids=lambda row: row["scene"])
def test_a_scene_of_the_thesis_has_its_counts(row: dict[str, str]) -> None:
    about = scene(row["scene"])
    assert about["polygons"] == int(row["polygons"])
    assert about["spheres"] == int(row["spheres"])
    assert about["primitives"] == int(row["polygons"]) + int(row["spheres"])


@pytest.mark.parametrize("name", NAMES)
def test_a_scene_tells_all_of_itself(name: str) -> None:
    about = scene(name)
    assert about["name"].split(":")[0] in (name, "tetra")  # stetra is a tetra
    assert about["primitives"] == about["polygons"] + about["spheres"] + about["cones"] > 0
    assert about["smooth_polygons"] <= about["polygons"] <= about["triangles"]
    lower, upper = about["bounds"]["lower"], about["bounds"]["upper"]
    assert all(low < high for low, high in zip(lower, upper, strict=True))
    assert about["cameras"]
    assert about["lights"]
    assert about["surfaces"] > 0
    assert re.fullmatch(r"[0-9a-f]{16}", about["hash"])
    # The printed name loads the same scene.
    assert scene(about["name"])["hash"] == about["hash"]


def test_the_readme_names_every_scene() -> None:
    readme = (REPOSITORY / "scenes/README.md").read_text()
    section = readme.split("\n## Catalogue\n")[1].split("\n## ")[0]
    named = {name.split(":")[0] for name in re.findall(r"`([^`]+)`", section)}
    assert set(NAMES) <= named
