"""The data dictionary explains every column, and lists no other columns."""

from __future__ import annotations

import csv
import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from beambench_report.base.columns import Column, as_markdown, dictionary
from beambench_report.base.records import NEEDED_COLUMNS
from program import BINARY

HINT = "say what it means in scripts/beambench_report/columns.json"


@pytest.fixture(scope="module")
def real_columns(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """The header of a results.csv written by beambench."""
    if not BINARY.exists():
        pytest.skip("beambench is not built; run scripts/setup")
    folder = tmp_path_factory.mktemp("real")
    sweep = {
        "name": "columns",
        "description": "The smallest sweep there is.",
        "scenes": ["tetra:n=1"],
        "structures": ["null", "samet"],
        "resolutions": ["8x8"],
        "precision": 0.5,
        "repetitions": {"minimum": 2, "maximum": 2},
        "budget_seconds": 5,
    }
    (folder / "sweep.json").write_text(json.dumps(sweep))
    command = [BINARY, "run", folder / "sweep.json", "-o", folder / "run"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    with (folder / "run" / "results.csv").open(newline="", encoding="utf-8") as file:
        return next(csv.reader(file))


def test_every_column_of_a_real_run_is_in_the_dictionary(real_columns: list[str]) -> None:
    unknown = [name for name in real_columns if dictionary().find(name) is None]
    assert not unknown, HINT


def test_every_column_of_the_dictionary_is_in_a_real_run(real_columns: list[str]) -> None:
    named = [column.name for column in dictionary().columns if not column.is_pattern]
    assert [name for name in named if name not in real_columns] == []
    common = [name for name in real_columns if name in named]
    assert common == named, "the dictionary keeps the order of the file"


def test_the_version_comes_first(real_columns: list[str]) -> None:
    assert real_columns[0] == dictionary().columns[0].name == "schema_version"


def test_what_plots_and_pages_need_is_known() -> None:
    assert all(dictionary().find(name) for name in NEEDED_COLUMNS)


@pytest.mark.parametrize("column", dictionary().columns, ids=lambda column: column.name)
def test_each_entry_says_all_there_is_to_say(column) -> None:  # noqa: ANN001 (shown by the id)
    assert column.meaning.endswith(".")
    assert column.measured.endswith(".")
    assert column.type in ("text", "flag", "integer", "number")
    assert "|" not in column.meaning + column.measured + column.unit, "it would end a table's field"
    if column.type == "number":
        assert column.unit


def test_each_column_is_there_once_and_in_a_group() -> None:
    source = json.loads(
        (Path(__file__).parents[2] / "scripts/beambench_report/columns.json").read_text()
    )
    names = [entry["name"] for entry in source["columns"]]
    assert len(names) == len(set(names)) == len(dictionary().columns)


def test_every_counter_is_explained_as_the_program_explains_it() -> None:
    done = subprocess.run([BINARY, "list", "--json"], capture_output=True, text=True, check=True)
    listed = json.loads(done.stdout)
    text = as_markdown(dictionary())
    for structure in listed["structures"]:
        for counter in structure["counters"]:
            name, meaning = counter["name"], counter["meaning"]
            assert f"| `{structure['name']}` | `{name}` | {meaning} |" in text
    for counter in listed["counters"]:
        column = dictionary().find(f"{counter['name']}_per_ray")
        assert column is not None
        assert not column.is_pattern
        assert column.meaning.lower() == counter["meaning"].lower() + "."


def _entry(name: str) -> Column:
    return next(column for column in dictionary().columns if column.name == name)


def test_a_counter_of_a_family_s_own_is_covered_by_the_pattern() -> None:
    assert dictionary().find("beams_per_ray") is _entry("<counter>_per_ray")
    assert dictionary().find("beams") is None


def test_a_kind_of_rays_of_a_whole_picture_has_patterns_of_its_own() -> None:
    assert dictionary().find("shadow_rays") is _entry("<kind>_rays")
    by_kind = dictionary().find("shadow_box_tests_per_ray")
    assert by_kind is _entry("<kind>_<counter>_per_ray")
    assert dictionary().find("rays").name == "rays"
    assert dictionary().find("primary_rays") is None
    assert dictionary().find("box_tests_per_ray").name == "box_tests_per_ray"


def examples(text: str) -> list[str]:
    """Returns the Python examples of a Markdown text."""
    return re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


def test_the_example_of_reading_draws_a_plot_and_keeps_the_rows_of_null(
    repository: Path, run_folder: Path
) -> None:
    [example] = examples((repository / "results/README.md").read_text())
    done = subprocess.run(
        [sys.executable, "-c", example], cwd=run_folder, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    [null] = [line.split() for line in done.stdout.splitlines() if line.startswith("null")]
    assert float(null[-1]) == pytest.approx(4.0, rel=1e-3)  # ns per ray
    assert (run_folder / "structures.png").stat().st_size > 5000
    assert len(example.strip().splitlines()) <= 10
    by_default = example.replace(', keep_default_na=False, na_values=[""]', "")
    assert by_default != example
    program = by_default + 'assert not (rows["structure"] == "null").any()'
    subprocess.run([sys.executable, "-c", program], cwd=run_folder, check=True)  # the former error


def test_every_example_and_reader_of_results_keeps_the_name_null(repository: Path) -> None:
    """Only results.csv contains that name; other CSV files are read with pandas's defaults."""
    texts = subprocess.run(
        ["git", "ls-files", "*.md", "*.j2", "tests/python/*.py", "scripts/*.py"],
        cwd=repository,
        capture_output=True,
        text=True,
        check=False,
    ).stdout.split()
    if not texts:
        pytest.skip("this is not a repository")
    calls = [
        call
        for name in texts
        if (repository / name).is_file()
        for call in re.findall(r"read_csv\([^)]*\)", (repository / name).read_text())
    ]
    of_results = [call for call in calls if "results.csv" in call or "dtype=texts" in call]
    assert len(of_results) >= 3
    assert [call for call in of_results if "keep_default_na=False" not in call] == []


def test_the_written_dictionary_is_up_to_date(repository: Path) -> None:
    assert (repository / "results" / "README.md").read_text() == as_markdown(dictionary()), (
        "write it again: .venv/bin/python -m beambench_report columns > results/README.md"
    )
