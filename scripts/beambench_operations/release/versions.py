"""The versions that the files of a tree state."""

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

from beambench_report.base.files import ROOT

_STATED = {
    "CMakeLists.txt": r"project\(beambench VERSION ([\d.]+)",
    "CITATION.cff": r"version: ([\d.]+)$",
    ".github/CHANGELOG.md": r"## (\S.*)$",
}
_PROJECTS = ("pyproject.toml", "harness/cli/wheel/pyproject.toml")


def stated_versions(root: Path = ROOT) -> dict[str, str]:
    """Returns the version that each file states, by path; empty if it states none.

    For the change log, it is that of the first section; for a wheel, the one its build reads.
    """
    stated = {file: _found(pattern, root / file) for file, pattern in _STATED.items()}
    stated[".github/CHANGELOG.md"] = stated[".github/CHANGELOG.md"].partition(" (")[0]
    return stated | {file: _of_project(root / file) for file in _PROJECTS}


def disagreements(version: str, root: Path = ROOT) -> Iterator[str]:
    """Yields a sentence for each file that states a different version."""
    for file, stated in stated_versions(root).items():
        if stated != version:
            yield f"{file} states version '{stated}', not '{version}'"


def release_date(root: Path = ROOT) -> str:
    """Returns the date of the release that CITATION.cff states; empty if it states none."""
    return _found(r"date-released: \"?(\d{4}-\d\d-\d\d)\"?$", root / "CITATION.cff")


def _of_project(file: Path) -> str:
    project = tomllib.loads(file.read_text("utf-8"))
    if version := project["project"].get("version"):
        return str(version)
    source = project["tool"]["scikit-build"]["metadata"]["version"]
    return _found(source["regex"].replace("?P<value>", ""), file.parent / source["input"])


def _found(pattern: str, file: Path) -> str:
    """Returns the first group of a pattern at the beginning of a line; empty without one."""
    found = re.search(f"^{pattern}", file.read_text("utf-8"), re.MULTILINE)
    return found[1] if found else ""
