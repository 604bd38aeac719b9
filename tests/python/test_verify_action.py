"""The GitHub action for `verify --kit`: the three worked examples run its steps here."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from plugins import SOURCES
from program import BINARY

REPOSITORY = Path(__file__).resolve().parents[2]
TRACER = (Path(__file__).parent / "own_tracer.py").read_text()
ACTION = REPOSITORY / ".github/actions/verify-hits"
PATHS = f"{BINARY.resolve().parent}{os.pathsep}{Path(sys.executable).parent}{os.pathsep}"


def inputs(example: Path) -> dict[str, str]:
    """Returns the inputs that the example passes to the action, by the names of their environment
    variables.
    """
    found = re.search(r"verify-hits\n        with:\n((?:          .*\n)+)", example.read_text())
    assert found is not None
    pairs = (line.split(":", 1) for line in found[1].splitlines())
    return {name.strip().upper(): value.strip() for name, value in pairs}


def run_step(folder: Path, **given: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PATH": PATHS + os.environ["PATH"],
                   "GITHUB_STEP_SUMMARY": str(folder / "step.md"), **given}  # fmt: skip
    return subprocess.run([ACTION / "verify"], cwd=folder, env=environment, capture_output=True,
                          text=True, check=False)  # fmt: skip


def prepare(folder: Path, language: str) -> None:
    """Puts the user's project where the example's steps expect it, and runs them."""
    (folder / "beambench").symlink_to(REPOSITORY)
    if language == "c":
        shutil.copy(SOURCES / "c/mine.c", folder)
    elif language == "rust":
        if shutil.which("cargo") is None:
            pytest.skip("the example in Rust needs cargo, which is not installed")
        shutil.copytree(SOURCES / "rust", folder, dirs_exist_ok=True)
    else:
        (folder / "tracer.py").write_text(TRACER.replace("hits, fault =", "hits =")
                                          .replace("fault ==", "None =="))  # fmt: skip
        return  # NumPy is there
    for command in re.findall(r"^      - run: (.*)$", (ACTION / f"examples/{language}.yml")
                              .read_text(), re.MULTILINE):  # fmt: skip
        subprocess.run(command, shell=True, cwd=folder, check=True, capture_output=True)


@pytest.mark.parametrize("language", ["c", "rust", pytest.param("python", marks=pytest.mark.full)])
def test_an_example_passes_and_writes_summary_and_badge(tmp_path: Path, language: str) -> None:
    prepare(tmp_path, language)
    given = inputs(ACTION / f"examples/{language}.yml")
    done = run_step(tmp_path, **{**given, "SCENES": "2"})
    assert done.returncode == 0, done.stdout + done.stderr
    output = tmp_path / "beambench-verdict"
    badge = json.loads((output / "badge.json").read_text())
    assert badge["schemaVersion"] == 1
    assert badge["color"] == "brightgreen"
    right, of = re.fullmatch(r"(\d+) of (\d+) cases", badge["message"]).groups()
    assert right == of
    assert int(of) > 20
    summary = (output / "summary.md").read_text()
    assert summary.startswith(f"## Hits: {of} of {of} cases right\n")
    assert "| closed mesh | closest |" in summary
    assert (tmp_path / "step.md").read_text() == summary


def test_failures_are_named_and_fail_the_step(tmp_path: Path) -> None:
    (tmp_path / "tracer.py").write_text(TRACER)
    done = run_step(tmp_path, SCENES="2",
                    COMMAND="python3 tracer.py {obj} {rays} {hits} epsilon")  # fmt: skip
    assert done.returncode == 1, done.stdout + done.stderr
    output = tmp_path / "beambench-verdict"
    assert json.loads((output / "badge.json").read_text())["color"] == "red"
    table, failures = (output / "summary.md").read_text().split("### Failures\n")
    assert "tiny-scale" in failures or "tiny" in failures or "closed-mesh" in failures
    verdicts = [line.split("|")[-2].strip() for line in table.splitlines() if line[:2] == "| "][1:]
    assert verdicts[-1] not in ("ok", "unsupported")
    assert verdicts == sorted(verdicts, key=lambda verdict: verdict not in ("ok", "unsupported"))
    assert list((output / "failures").iterdir())


def test_a_step_without_a_subject_says_what_to_give(tmp_path: Path) -> None:
    done = run_step(tmp_path)
    assert done.returncode == 2
    assert "give a command, or a plugin" in done.stderr


def test_the_action_passes_each_input_on() -> None:
    text = (ACTION / "action.yml").read_text()
    used = set(re.findall(r"\$\{\{ inputs\.(\w+) \}\}", text))
    declared = set(re.findall(r"^  (\w+):\n    description", text, re.MULTILINE))
    assert used == declared == {"command", "plugin", "accel", "scenes", "output"}


def test_a_leak_is_not_counted_among_the_grazes(tmp_path: Path) -> None:
    case = {"name": "closed mesh", "family": "closed mesh", "query": "closest", "rays": 600,
            "graze": 40, "structure_error": 0, "leaks": 23, "verdict": "mismatch",
            "passed": False, "message": ""}  # fmt: skip
    verdict, table = tmp_path / "verdict.json", tmp_path / "summary.md"
    verdict.write_text(json.dumps({"beambench": "0.3.0", "passed": False, "cases": [case]}))
    words = [verdict, "--summary", table, "--badge", tmp_path / "badge.json"]
    subprocess.run([sys.executable, ACTION / "report.py", *words], check=True)
    assert "| closed mesh | closest | 1 | 0 | 600 | 17 | 0 | 23 | mismatch |" in table.read_text()
