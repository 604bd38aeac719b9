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


def test_there_is_a_default_sweep() -> None:
    assert "default.json" in {path.name for path in SWEEPS}


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
