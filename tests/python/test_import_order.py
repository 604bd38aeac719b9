"""The import order of the modules in the packages of scripts: as listed, without cycles."""

from __future__ import annotations

import ast
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from typing import NamedTuple

PACKAGES = ("beambench_report", "beambench_thesis", "beambench_operations")
# Each imports only itself and modules listed before it.
ORDER = (
    "beambench_report.base",
    "beambench_report.run",
    "beambench_report.embree_comparison",
    "beambench_report.havran",
    "beambench_report.haines",
    "beambench_report.__main__",
    "beambench_thesis.paper",
    "beambench_thesis.chapter5",
    "beambench_thesis.chapter6",
    "beambench_thesis.claims",
    "beambench_thesis.report",
    "beambench_thesis.__main__",
    "beambench_operations.history",
    "beambench_operations.site",
    "beambench_operations.nightly",
    "beambench_operations.campaign",
    "beambench_operations.publish",
    "beambench_operations.referee",
    "beambench_operations.release",
    "beambench_operations.__main__",
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
    """Returns the files of the packages by the names of their modules."""
    files = sorted(file for package in PACKAGES for file in (scripts / package).rglob("*.py"))
    return {
        ".".join(file.relative_to(scripts).with_suffix("").parts).removesuffix(".__init__"): file
        for file in files
    }


def imports(scripts: Path) -> list[Import]:
    """Returns every import of one module by another, those inside functions included."""
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
                # A name may itself be a module: `from beambench_report.run import page`.
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
    """Returns the module's place in ORDER; packages that only contain others come first."""
    for place, name in enumerate(ORDER):
        if f"{module}.".startswith(f"{name}."):
            return place
    assert any(name.startswith(f"{module}.") for name in ORDER), (
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


def write_modules(folder: Path, files: dict[str, str]) -> Path:
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder


def test_upward_imports_are_found_with_file_line_and_import(tmp_path: Path) -> None:
    inside = "def f():\n    from beambench_thesis.paper import cells\n    return cells\n"
    files = {
        "beambench_report/base/names.py": inside,
        "beambench_thesis/paper/cells.py": "import beambench_report.base.names",
    }
    sentence, circle = faults(write_modules(tmp_path, files))
    assert sentence == (
        f"{tmp_path}/beambench_report/base/names.py:2: from beambench_thesis.paper import cells: "
        "beambench_thesis.paper.cells stands above beambench_report.base.names"
    )
    assert circle.startswith("circle: ")
    assert "import beambench_report.base.names" in circle


def test_the_thesis_imports_no_operations(tmp_path: Path) -> None:
    files = {
        "beambench_operations/site/write.py": "",
        "beambench_thesis/report/write.py": "import beambench_operations.site.write",
    }
    (sentence,) = faults(write_modules(tmp_path, files))
    assert sentence.endswith(
        "beambench_operations.site.write stands above beambench_thesis.report.write"
    )


def test_circles_within_a_module_are_found(tmp_path: Path) -> None:
    run = "beambench_report/run"
    files = {
        f"{run}/page.py": "from beambench_report.run.plots import draw",
        f"{run}/plots.py": "from beambench_report.run.bars import bar",
        f"{run}/bars.py": "def f():\n    from .page import render\n    return render\n",
    }
    (sentence,) = faults(write_modules(tmp_path, files))
    for file, line in (("page", 1), ("plots", 1), ("bars", 2)):
        assert f"{tmp_path / run / file}.py:{line}: " in sentence


def test_an_order_that_is_kept_has_no_faults(tmp_path: Path) -> None:
    files = {
        "beambench_report/run/page.py": "from beambench_report.base import names",
        "beambench_report/base/names.py": "",
    }
    assert faults(write_modules(tmp_path, files)) == []
