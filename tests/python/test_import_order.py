"""The import order of the package's modules: as listed below, without cycles."""

from __future__ import annotations

import ast
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from typing import NamedTuple

PACKAGE = "beambench_report"
# Each imports only itself and modules listed before it.
ORDER = (
    "base",
    "run",
    "history",
    "site",
    "nightly",
    "embree_comparison",
    "havran",
    "haines",
    "thesis.paper",
    "thesis.chapter5",
    "thesis.chapter6",
    "thesis.claims",
    "thesis.report",
    "__main__",
)


class Import(NamedTuple):
    file: Path
    line: int
    text: str
    importing: str
    imported: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.text}"


def modules(scripts: Path) -> dict[str, Path]:
    """Returns the files of the package by module name."""
    files = sorted((scripts / PACKAGE).rglob("*.py"))
    return {
        ".".join(file.relative_to(scripts).with_suffix("").parts).removesuffix(".__init__"): file
        for file in files
    }


def imports(scripts: Path) -> list[Import]:
    """Returns every import of one module of the package by another, even inside functions."""
    files = modules(scripts)
    found = []
    for importing, file in files.items():
        for node in ast.walk(ast.parse(file.read_text("utf-8"))):
            names: list[str] = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                base = node.module or ""
                if node.level:
                    inside = importing.split(".") + ["__init__"] * (file.name == "__init__.py")
                    base = ".".join([*inside[: -node.level], *([base] if base else [])])
                # A name may be a module of its own: `from beambench_report.run import page`.
                names = [
                    whole if (whole := f"{base}.{alias.name}") in files else base
                    for alias in node.names
                ]
            found += [
                Import(file, node.lineno, ast.unparse(node), importing, name)
                for name in dict.fromkeys(names)
                if name in files
            ]
    return found


def rank(module: str) -> int:
    """Returns the place of a module in ORDER; packages that only contain others come first."""
    inner = module.removeprefix(PACKAGE).removeprefix(".")
    for place, name in enumerate(ORDER):
        if f"{inner}.".startswith(f"{name}."):
            return place
    assert any(f"{name}.".startswith(f"{inner}.") for name in ORDER) or not inner, (
        f"{module} is not in ORDER: say there what it may import"
    )
    return -1


def faults(scripts: Path) -> list[str]:
    """Returns a sentence for each import in the wrong direction, and one for a cycle."""
    found = imports(scripts)
    upward = [one for one in found if rank(one.imported) > rank(one.importing)]
    sentences = [f"{one}: {one.imported} stands above {one.importing}" for one in upward]
    graph = {name: set() for name in modules(scripts)}
    for one in found:
        graph[one.importing].add(one.imported)
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        circle = error.args[1]
        steps = [
            str(next(one for one in found if (one.importing, one.imported) == pair))
            for pair in zip(circle[1:], circle, strict=False)
        ]
        sentences.append("circle: " + "; ".join(steps))
    return sentences


def test_imports_point_downward(repository: Path) -> None:
    scripts = repository / "scripts"
    assert len(imports(scripts)) > 100
    assert not faults(scripts), "\n".join(faults(scripts))


def write_package(folder: Path, files: dict[str, str]) -> Path:
    for name, text in files.items():
        path = folder / PACKAGE / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder


def test_upward_imports_are_found_with_file_line_and_import(tmp_path: Path) -> None:
    inside = "def f():\n    from beambench_report.thesis.paper import cells\n    return cells\n"
    files = {"base/names.py": inside, "thesis/paper/cells.py": "import beambench_report.base.names"}
    sentence, circle = faults(write_package(tmp_path, files))
    place = tmp_path / PACKAGE / "base/names.py"
    assert sentence == (
        f"{place}:2: from beambench_report.thesis.paper import cells: "
        "beambench_report.thesis.paper.cells stands above beambench_report.base.names"
    )
    assert circle.startswith("circle: ")
    assert "import beambench_report.base.names" in circle


def test_circles_within_a_module_are_found(tmp_path: Path) -> None:
    files = {
        "run/page.py": "from beambench_report.run.plots import draw",
        "run/plots.py": "from beambench_report.run.bars import bar",
        "run/bars.py": "def f():\n    from .page import render\n    return render\n",
    }
    (sentence,) = faults(write_package(tmp_path, files))
    for file, line in (("page", 1), ("plots", 1), ("bars", 2)):
        assert f"{tmp_path / PACKAGE / 'run' / file}.py:{line}: " in sentence


def test_an_order_that_is_kept_has_no_faults(tmp_path: Path) -> None:
    files = {"run/page.py": "from beambench_report.base import names", "base/names.py": ""}
    assert faults(write_package(tmp_path, files)) == []
