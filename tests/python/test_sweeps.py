"""Every committed sweep keeps to the committed schema, and the schema refuses what it should."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
SWEEPS = sorted((REPOSITORY / "harness" / "sweeps").glob("*.json"))


@pytest.fixture(scope="module")
def validator() -> jsonschema.Draft202012Validator:
    """The schema, itself checked."""
    schema = json.loads((REPOSITORY / "harness" / "sweep" / "sweep.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def structures_of(sweep: dict) -> dict[str, list[dict]]:
    """The bare names of a sweep's structures, each with the parameters of its entries."""
    found: dict[str, list[dict]] = {}
    for entry in sweep["structures"]:
        if isinstance(entry, str):
            name, _, text = entry.partition(":")
            parameters = dict(item.split("=") for item in text.split(",") if item)
        else:
            name, parameters = entry["structure"], entry.get("parameters", {})
        found.setdefault(name, []).append(parameters)
    return found


def test_the_default_sweep_has_every_structure_and_the_modes_of_embree() -> None:
    sweep = json.loads((REPOSITORY / "harness" / "sweeps" / "default.json").read_text())
    structures = structures_of(sweep)
    assert set(structures) == {
        "null", "exhaustive", "samet", "samet-net", "voxel-grid", "goldsmith-salmon",
        "beam", "tile-beam", "sah-bvh", "embree",
    }  # fmt: skip
    (embree,) = structures["embree"]
    assert embree["mode"] == ["single", "packet4", "packet8", "packet16"]
    assert {"structure": "exhaustive", "primitives_above": 1000} in sweep["exclude"]
    assert sweep["budget_seconds"] < 5 * 60


@pytest.mark.parametrize("path", SWEEPS, ids=lambda path: path.name)
def test_a_committed_sweep_is_valid(path: Path, validator: jsonschema.Draft202012Validator) -> None:
    validator.validate(json.loads(path.read_text()))


@pytest.mark.parametrize(
    "change",
    [
        {"scenes": "escena1"},
        {"resolutions": ["wide"]},
        {"repetitions": {"minimum": -1}},
        {"structurs": ["samet"]},
        {"precision": "good"},
    ],
)
def test_the_schema_refuses(change: dict, validator: jsonschema.Draft202012Validator) -> None:
    sweep = json.loads((REPOSITORY / "harness" / "sweeps" / "default.json").read_text())
    assert not validator.is_valid(sweep | change)
