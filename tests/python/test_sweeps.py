"""Every committed sweep conforms to the committed schema, which refuses invalid sweeps."""

from __future__ import annotations

import json
import math
from pathlib import Path

import jsonschema
import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
SWEEPS = sorted((REPOSITORY / "harness" / "measure" / "sweeps").glob("*.json"))
LIBRARIES = REPOSITORY / "harness" / "plugin" / "adapters" / "libraries.json"


@pytest.fixture(scope="module")
def validator() -> jsonschema.Draft202012Validator:
    """The schema, itself validated."""
    schema = json.loads((REPOSITORY / "harness" / "measure" / "sweep.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def structures_of(sweep: dict) -> dict[str, list[dict]]:
    """Returns the bare names of a sweep's structures, each with the parameters of its entries."""
    found: dict[str, list[dict]] = {}
    for entry in sweep["structures"]:
        if isinstance(entry, str):
            name, _, text = entry.partition(":")
            parameters = dict(item.split("=") for item in text.split(",") if item)
        else:
            name, parameters = entry["structure"], entry.get("parameters", {})
        found.setdefault(name, []).append(parameters)
    return found


def test_the_default_sweep_has_every_structure_and_embree_at_its_best() -> None:
    sweep = json.loads((REPOSITORY / "harness" / "measure" / "sweeps" / "default.json").read_text())
    structures = structures_of(sweep)
    assert set(structures) == {
        "null", "exhaustive", "samet", "samet-net", "voxel-grid", "goldsmith-salmon",
        "beam", "tile-beam", "sah-bvh", "embree",
    }  # fmt: skip
    assert structures["embree"] == [{"mode": "best"}]
    assert structures["beam"] == [{"leaf": ["exact", "simd"]}]
    assert {"structure": "exhaustive", "primitives_above": 1000} in sweep["exclude"]
    assert sweep["budget_seconds"] < 5 * 60


def test_every_contender_of_the_winners_table_is_tuned_with_the_same_budget() -> None:
    sweep = json.loads(
        (REPOSITORY / "harness" / "measure" / "sweeps" / "structures.json").read_text()
    )
    assert sweep["resolutions"] == ["1920x1080"]
    for entry in sweep["structures"]:
        if isinstance(entry, dict) and entry.get("tune"):
            lists = [value for value in entry["parameters"].values() if isinstance(value, list)]
            assert 1 < math.prod(len(one) for one in lists) <= 8, entry


@pytest.mark.parametrize("path", [*SWEEPS, LIBRARIES], ids=lambda path: path.name)
def test_a_committed_sweep_is_valid(path: Path, validator: jsonschema.Draft202012Validator) -> None:
    validator.validate(json.loads(path.read_text()))


def test_editors_find_the_schema_that_each_sweep_names() -> None:
    schema = REPOSITORY / "harness" / "measure" / "sweep.schema.json"
    for path in [*SWEEPS, *SWEEPS[0].parent.glob("*/*.json"), LIBRARIES]:
        named = path.parent / json.loads(path.read_text())["$schema"]
        assert named.resolve() == schema, path


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
    sweep = json.loads((REPOSITORY / "harness" / "measure" / "sweeps" / "default.json").read_text())
    assert not validator.is_valid(sweep | change)


def values_of(parameters: dict, name: str, default: object) -> list:
    """Returns the values that a parameter takes."""
    value = parameters.get(name, default)
    return value if isinstance(value, list) else [value]


def embree_modes(sweep: dict) -> set[tuple]:
    """Returns the modes of Embree in a sweep, each with its coherence flag."""
    return {
        (mode, coherent)
        for parameters in structures_of(sweep).get("embree", [])
        for mode in values_of(parameters, "mode", "single")
        for coherent in values_of(parameters, "coherent", True)
    }


@pytest.mark.parametrize("path", [*SWEEPS, LIBRARIES], ids=lambda path: path.name)
def test_few_sweeps_ask_for_streams_which_embree_4_has_not(path: Path) -> None:
    modes = {mode for mode, _ in embree_modes(json.loads(path.read_text()))}
    needs_embree_3 = path.name.startswith("beat-embree") or path.name == "pictures.json"
    needs_embree_3 &= path.stem != "beat-embree-everywhere"  # whose Embree is tuned
    assert ("stream" in modes) == needs_embree_3


@pytest.mark.parametrize(
    "path",
    [
        path
        for path in [*SWEEPS, LIBRARIES]
        if "shadow" in json.loads(path.read_text()).get("rays", [])
    ],
    ids=lambda path: path.name,
)
def test_of_lists_of_rays_embree_has_every_width_with_both_flags(path: Path) -> None:
    packets = {(f"packet{n}", coherent) for n in (4, 8, 16) for coherent in (True, False)}
    modes = embree_modes(json.loads(path.read_text()))
    assert modes >= packets | {("single", True)} or "best" in {mode for mode, _ in modes}


JUDGED = ("beat-embree", "beat-embree-scenes", "beat-embree-soup", "beat-embree-avx2")


def test_sweeps_whose_verdicts_are_judged_repeat_often_enough_for_an_interval() -> None:
    for path in SWEEPS:
        if path.name.startswith("beat-embree"):
            assert json.loads(path.read_text())["repetitions"]["minimum"] >= 6, path.name


def test_no_image_is_judged_twice_against_embree() -> None:
    seen: set[tuple] = set()
    for name in JUDGED:
        sweep = json.loads(
            (REPOSITORY / "harness" / "measure" / "sweeps" / f"{name}.json").read_text()
        )
        (tile_beam,) = structures_of(sweep)["tile-beam"]
        isa = tile_beam.get("isa", "best")
        for scene in sweep["scenes"]:
            for resolution in sweep["resolutions"]:
                assert (scene, resolution, isa) not in seen
                seen.add((scene, resolution, isa))
