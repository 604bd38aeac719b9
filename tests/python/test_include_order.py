"""The include order of the C++ modules: as listed below, without cycles."""

from __future__ import annotations

import re
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from typing import NamedTuple

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
# Each module includes itself and modules listed before it. The namespace is within `beambench`.
MODULES = {
    "scenes/base": "",
    "scenes": "scenes",
    "scenes/modelling": "scenes::modelling",
    "scenes/formats/nff": "scenes::nff",
    "scenes/formats/mesh": "scenes::mesh",
    "scenes/generators": "scenes::generators",
    "accel/core": "accel",
    "accel/embree_api": "accel::embree",
    "accel/oracle": "accel::oracle",
    "accel/exhaustive": "accel::exhaustive",
    "accel/octree": "accel::octree",
    "accel/grid": "accel::grid",
    "accel/hierarchical_grid": "accel::hierarchical_grid",
    "accel/bvh": "accel::bvh",
    "accel/kd_tree": "accel::kd_tree",
    "accel/beam": "accel::beam",
    "accel/grid_beam": "accel::grid_beam",
    "accel/tile_beam": "accel::tile_beam",
    "accel/ray_classification": "accel::ray_classification",
    "accel/z_buffer": "accel::z_buffer",
    "accel/polygon_beam": "accel::polygon_beam",
    "accel/embree": "accel::embree",
    "accel/null": "accel::null",
    "harness/base": "base",
    "harness/rays": "rays",
    "harness/verify": "verify",
    "harness/plugin": "plugin",
    "harness/render": "render",
    "harness/explain": "explain",
    "harness/measure": "measure",
    "harness/analysis": "analysis",
    "harness/python": "python",
    "harness/thesis": "thesis",
    "harness/thesis/cluster": "cluster",
    "harness/cli": "cli",
}
ORDER = {module: place for place, module in enumerate(MODULES)}
INCLUDE = re.compile(r'^[ \t]*#\s*(?:include|define HWY_TARGET_INCLUDE)\s+"([^"]+)"', re.MULTILINE)
NAMESPACE = re.compile(r"^namespace ([\w:]+)\s*\{", re.MULTILINE)


class Include(NamedTuple):
    file: str
    line: int
    included: str

    def __str__(self) -> str:
        return f'{self.file}:{self.line}: #include "{self.included}"'


def module_of(file: str) -> str | None:
    """Returns the module with the longest path that contains a file."""
    return max((m for m in MODULES if file.startswith(f"{m}/")), key=len, default=None)


def sources(root: Path) -> dict[str, str]:
    """Returns the texts of the program's C++ files, by path; adapters are separate programs."""
    return {
        str(path.relative_to(root)): path.read_text("utf-8")
        for folder in ("scenes", "accel", "harness")
        for path in sorted((root / folder).rglob("*.[ch]pp"))
        if "adapters" not in path.parts
    }


def includes(texts: dict[str, str]) -> list[Include]:
    """Returns every include of one file of the program by another."""
    return [
        Include(file, text.count("\n", 0, found.start()) + 1, found[1])
        for file, text in texts.items()
        for found in INCLUDE.finditer(text)
        if found[1] in texts and found[1] != file
    ]


def faults(texts: dict[str, str]) -> list[str]:
    """Returns a sentence for each violation of the order of modules and headers."""
    found = [
        f"{file}: stands in no module of {list(MODULES)}" for file in texts if not module_of(file)
    ]
    if found:
        return found
    graph: dict[str, set[str]] = {}
    for include in includes(texts):
        upper, lower = module_of(include.file), module_of(include.included)
        assert upper is not None
        assert lower is not None
        if ORDER[lower] > ORDER[upper]:
            found.append(f"{include}: {lower} comes after {upper}")
        if include.file.endswith(".hpp"):
            graph.setdefault(include.file, set()).add(include.included)
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        found.append("a circle: " + " -> ".join(error.args[1]))
    return found


def test_modules_include_only_what_stands_before_them() -> None:
    texts = sources(REPOSITORY)
    assert len(includes(texts)) > 1000
    assert faults(texts) == []


def box_of(file: str) -> str:
    """Returns the box in the module diagram of harness/README.md that a file belongs to."""
    module = module_of(file)
    assert module is not None
    if module in ("scenes/base", "accel/core") or module.startswith("harness/"):
        return module
    if module in ("accel/embree_api", "accel/oracle"):
        return "accel/oracle"
    return "structures" if module.startswith("accel/") else "scenes"


def arrows(edges: dict[str, set[str]]) -> set[tuple[str, str]]:
    """Returns the edges of an acyclic graph that do not follow from others."""

    def reached(box: str) -> set[str]:
        return set().union(*({after} | reached(after) for after in edges.get(box, set())), set())

    return {
        (box, after)
        for box, all_after in edges.items()
        for after in all_after
        if not any(after in reached(other) for other in all_after)
    }


def test_the_module_picture_shows_the_includes() -> None:
    edges: dict[str, set[str]] = {}
    for include in includes(sources(REPOSITORY)):
        upper, lower = box_of(include.file), box_of(include.included)
        if upper != lower:
            edges.setdefault(upper, set()).add(lower)
    text = (REPOSITORY / "harness/README.md").read_text("utf-8")
    drawn = set(re.findall(r"^ +(\S+) -(?:\.-|-)> (\S+)$", text, re.MULTILINE))
    assert drawn == arrows(edges)


def test_each_module_has_its_namespace() -> None:
    for file, text in sources(REPOSITORY).items():
        module = module_of(file)
        assert module is not None
        own = "::".join(["beambench", *filter(None, [MODULES[module]])])
        for name in NAMESPACE.findall(text):
            within = name == own or name.startswith(f"{own}::")
            assert within or not name.startswith("beambench"), (
                f"{file}: namespace {name}, not {own}"
            )


@pytest.mark.parametrize(
    ("texts", "fault"),
    [
        (
            {"scenes/scene.hpp": '\n#include "accel/core/ray.hpp"\n', "accel/core/ray.hpp": ""},
            'scenes/scene.hpp:2: #include "accel/core/ray.hpp": accel/core comes after scenes',
        ),
        (
            {"harness/base/a.cpp": '#include "harness/cli/b.hpp"\n', "harness/cli/b.hpp": ""},
            'harness/base/a.cpp:1: #include "harness/cli/b.hpp": harness/cli comes after harness/b',
        ),
        (
            {
                "scenes/a.hpp": '#include "scenes/b.hpp"\n',
                "scenes/b.hpp": '#include "scenes/a.hpp"\n',
            },
            "a circle: scenes/a.hpp -> scenes/b.hpp -> scenes/a.hpp",
        ),
        ({"harness/more/a.hpp": ""}, "harness/more/a.hpp: stands in no module"),
    ],
)
def test_a_fault_is_named(texts: dict[str, str], fault: str) -> None:
    assert any(found.startswith(fault) for found in faults(texts))
