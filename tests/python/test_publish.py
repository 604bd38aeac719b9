"""scripts/publish: folder by folder, resumed after an interruption, complete or not at all."""

from __future__ import annotations

import csv
import json
import os
import re
import shutil
import subprocess
from argparse import Namespace
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from importlib import import_module
from pathlib import Path

import pytest
from PIL import Image

from bare_figures import bare_figures
from beambench_operations.publish.__main__ import main
from beambench_operations.publish.documents import write_documents
from beambench_operations.publish.make import Interrupted, Place, make_folder, run_program
from beambench_operations.publish.needs import missing
from beambench_operations.publish.plan import Command, Folder, Sweep, as_table, read_plan
from beambench_operations.publish.progress import (
    RECORD,
    Extent,
    extent_of,
    is_published,
    progress_of,
)
from beambench_operations.publish.provenance import (
    Provenance,
    preflight,
    require_clean,
    same_sources,
)
from beambench_operations.publish.small import make_small, size
from beambench_report.base.files import Problem, read_json
from beambench_report.base.run_log import logged_cells
from program import BINARY
from synthetic_run import synthetic_rows, write_cell, write_run

HERE = Provenance("c0ffee", False, "machine-1", "A Xeon", 2, "3.13.5", 0.01, 0.0)
ELSEWHERE = replace(HERE, machine_id="machine-2")

needs_binary = pytest.mark.skipif(not BINARY.exists(), reason="beambench is not built")


def given(**own: object) -> Namespace:
    """Returns options of scripts/publish, with defaults for those that are not given."""
    usual = {"tinybvh": None, "madmann91_bvh": None, "debian_13": None, "only": []}
    return Namespace(**{**usual, "beambench": BINARY, **own})


# The plan


def test_all_of_it_fits_into_the_time() -> None:
    plan = read_plan()
    assert plan.minutes <= plan.most_minutes == 240
    assert all(step.seconds > 0 for folder in plan.folders for step in folder.steps)


def test_the_plan_names_everything_that_is_to_be_published() -> None:
    names = {folder.name for folder in read_plan().folders}
    assert names >= {
        *("default", "thesis", "beat-embree", "embree-4", "structures", "pictures", "pencils"),
        *("real", "threads", "cluster", "census", "nightly", "libraries"),
    }


@needs_binary
def test_every_planned_sweep_can_be_run(tmp_path: Path) -> None:
    here = preflight(BINARY)
    options = given(debian_13=tmp_path, only=[folder.name for folder in read_plan().folders])
    for folder in read_plan().folders:
        if missing(folder, options, here):
            continue
        for step in folder.steps:
            if isinstance(step, Sweep):
                file = tmp_path / "sweep.json"
                file.write_text(json.dumps(step.config()))
                done = subprocess.run(
                    [BINARY, "run", file, "--dry-run"], capture_output=True, text=True, check=False
                )
                assert done.returncode == 0, (folder.name, step.into, done.stderr)
                assert done.stdout.count("\n") >= 2


def planned_commands() -> Iterator[list[str]]:
    names = {"beambench": "beambench", "python": "python", "folder": "F", "bin": "bin"}
    for folder in read_plan().folders:
        for step in folder.steps:
            for words in (step.words_of, step.resume) if isinstance(step, Command) else ():
                if words:
                    yield [word.format_map(names) for word in words]


def test_every_planned_report_can_be_called() -> None:
    reports = [words[2:] for words in planned_commands() if words[0] == "python"]
    assert len(reports) > 8
    for package, *words in reports:
        assert import_module(f"{package}.__main__")._parser().parse_args(words).handler


@needs_binary
def test_every_planned_command_has_its_options() -> None:
    given: dict[str, set[str]] = {}
    for words in planned_commands():
        if words[0] == "beambench":
            options = {word for word in words if word.startswith("--")}
            given.setdefault(words[1], set()).update(options)
    assert set(given) == {"census", "mirrors"}
    for command, options in given.items():
        printed = subprocess.run(
            [BINARY, command, "--help"], capture_output=True, text=True, check=True
        ).stdout
        assert all(option in printed for option in options), command


def test_what_is_kept_is_there(repository: Path) -> None:
    for folder in read_plan().folders:
        for name in folder.keep:
            assert (repository / "results/published" / folder.name / name).is_file(), name


def test_changes_replace_members_of_the_sweep() -> None:
    (sweep,) = (
        step
        for folder in read_plan().folders
        if folder.name == "threads"
        for step in folder.steps
        if isinstance(step, Sweep) and step.into == "1"
    )
    assert sweep.config()["threads"] == 1
    assert "$schema" not in sweep.config()


def test_some_folders_alone() -> None:
    assert [one.name for one in read_plan().only(["census", "default"]).folders] == [
        "default",
        "census",
    ]
    with pytest.raises(Problem, match="no folder 'defualt' is planned, only default, thesis"):
        read_plan().only(["defualt"])


def test_the_table_states_minutes_and_what_is_apart() -> None:
    text = as_table(read_plan(), {"census": "complete"}, {"census": Extent(90.0, 12, 3)})
    (line,) = (line for line in text.splitlines() if line.startswith("| census | "))
    assert line.endswith("| 1.5 | 12 | 3 | complete |")
    assert "(apart)" in text


def test_the_extent_of_a_folder_is_known_from_its_record_or_manifests_and_its_rows(
    tmp_path: Path,
) -> None:
    for name, blocks in (("a", "3,\n4,x"), ("b", ",x"), ("nested", "2,x")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "results.csv").write_text(f"blocks,scene\n{blocks}\n")
    times = {"time_utc": "2026-11-24T00:00:00Z", "finished_utc": "2026-11-24T00:01:30Z"}
    (tmp_path / "a/manifest.json").write_text(json.dumps(times))
    (tmp_path / "nested" / RECORD).write_text('{"seconds": [7]}')
    assert extent_of(tmp_path) == Extent(90, 3, 3)
    (tmp_path / RECORD).write_text('{"seconds": [1.5, 2]}')
    assert extent_of(tmp_path) == Extent(3.5, 3, 3)
    assert extent_of(tmp_path / "nested") == Extent(7, 1, 2)


# Making a folder


@dataclass
class Fake:
    """Replaces beambench: writes a run, or stops at a call."""

    stops_at: int | None = None
    fails_at: int | None = None
    wrong_at: int | None = None
    calls: list[list[str]] = field(default_factory=list)

    def __call__(self, command: Sequence[str], into: Path | None) -> int:
        self.calls.append([str(word) for word in command])
        number = len(self.calls)
        if "run" in command:
            folder = Path(command[-1])
            folder.mkdir(parents=True, exist_ok=True)
            if number == self.stops_at:
                (folder / "run.jsonl").write_text("")
            else:
                (folder / "config.json").write_text("{}")
                (folder / "manifest.json").write_text("{}")
        if into is not None:
            into.parent.mkdir(parents=True, exist_ok=True)
            into.write_text("{}")
        if number == self.stops_at:
            return 130
        if number == self.fails_at:
            return 2
        return 1 if number == self.wrong_at else 0


FOLDER = Folder(
    "small",
    "a small one",
    (
        Sweep(read_plan().folders[0].steps[0].source, "first", 10.0, {"repetitions": 1}),
        Command(("{beambench}", "census", "--json"), 2.0, into="census.json"),
        Sweep(read_plan().folders[0].steps[0].source, "second", 10.0),
    ),
    keep=("kept.csv",),
)


@pytest.fixture
def place(tmp_path: Path) -> Place:
    published = tmp_path / "published"
    (published / "small").mkdir(parents=True)
    for name in ("README.md.j2", "kept.csv", "old.csv"):
        (published / "small" / name).write_text(name)
    return Place(tmp_path / "aside", published, Path("/built/beambench"), run=Fake())


def test_a_folder_is_published_whole(place: Place) -> None:
    made = make_folder(FOLDER, place, HERE)
    folder = place.published / "small"
    files = {str(file.relative_to(folder)) for file in folder.rglob("*") if file.is_file()}
    assert files == {
        *("first/config.json", "first/manifest.json", "second/config.json"),
        *("second/manifest.json", "census.json", "README.md.j2", "kept.csv", RECORD),
    }
    assert len(made.seconds) == 3
    assert is_published(folder, HERE)
    assert not is_published(folder, ELSEWHERE)
    assert not list(place.published.glob(".*"))
    assert not progress_of(place.aside / "small", HERE)


def test_the_changes_reach_the_program(place: Place) -> None:
    make_folder(FOLDER, place, HERE)
    calls = place.run.calls
    assert calls[0][:2] == ["/built/beambench", "run"]
    assert calls[0][-1] == str(place.aside / "small/first")
    assert calls[1] == ["/built/beambench", "census", "--json"]


def test_what_nothing_published_needs_is_left_out(place: Place) -> None:
    make_folder(replace(FOLDER, leave_out=("second", "census.*", "first/con*")), place, HERE)
    folder = place.published / "small"
    files = {str(file.relative_to(folder)) for file in folder.rglob("*") if file.is_file()}
    assert files == {"first/manifest.json", "README.md.j2", "kept.csv", RECORD}


def test_nothing_is_published_before_all_is_done(place: Place) -> None:
    with pytest.raises(Interrupted):
        make_folder(FOLDER, replace(place, run=Fake(stops_at=3)), HERE)
    assert (place.published / "small/old.csv").is_file()
    assert not (place.published / "small/first").exists()


def test_what_was_cut_off_here_is_resumed(place: Place) -> None:
    with pytest.raises(Interrupted):
        make_folder(FOLDER, replace(place, run=Fake(stops_at=3)), HERE)
    again = Fake()
    make_folder(FOLDER, replace(place, run=again), HERE)
    (call,) = again.calls
    assert call == ["/built/beambench", "run", "--resume", str(place.aside / "small/second")]
    assert is_published(place.published / "small", HERE)


def test_a_sweep_that_changed_since_is_begun_again(place: Place) -> None:
    with pytest.raises(Interrupted):
        make_folder(FOLDER, replace(place, run=Fake(stops_at=3)), HERE)
    *before, last = FOLDER.steps
    changed = replace(FOLDER, steps=(*before, replace(last, changes={"repetitions": 2})))
    again = Fake()
    make_folder(changed, replace(place, run=again), HERE)
    (call,) = again.calls
    assert "--resume" not in call
    assert call[-1] == str(place.aside / "small/second")
    assert not (place.published / "small/second/run.jsonl.gz").exists()


def test_what_was_cut_off_elsewhere_is_repeated_whole(place: Place) -> None:
    with pytest.raises(Interrupted):
        make_folder(FOLDER, replace(place, run=Fake(stops_at=3)), ELSEWHERE)
    again = Fake()
    make_folder(FOLDER, replace(place, run=again), HERE)
    assert len(again.calls) == 3
    assert "--resume" not in again.calls[0]


def test_a_step_that_fails_is_named_and_done_again(place: Place) -> None:
    with pytest.raises(Problem, match="small: exit code 2 of: beambench census --json"):
        make_folder(FOLDER, replace(place, run=Fake(fails_at=2)), HERE)
    again = Fake()
    make_folder(FOLDER, replace(place, run=again), HERE)
    assert [call[1] for call in again.calls] == ["census", "run"]


def test_wrong_hits_are_published_and_reported(place: Place) -> None:
    made = make_folder(FOLDER, replace(place, run=Fake(wrong_at=1)), HERE)
    assert made.wrong == [0]
    assert read_json(place.published / "small" / RECORD)["wrong"] == [0]


def test_a_command_that_resumes_is_resumed(place: Place) -> None:
    step = Command(("{python}", "begin", "{folder}"), 1.0, ("{python}", "go-on", "{folder}"))
    folder = Folder("small", "", (Command(("{beambench}",), 1.0, into="a.json"), step))
    fake = Fake()
    make_folder(folder, replace(place, run=fake), HERE)
    assert fake.calls[1][1] == "go-on"


@needs_binary
def test_a_folder_that_is_new_gets_its_page(place: Place) -> None:
    """Uses a real run, as short as its page allows: with intervals and two groups of scenes."""
    (folder,) = read_plan().only(["embree-4"]).folders
    (sweep,) = folder.steps
    assert isinstance(sweep, Sweep)
    short = {"scenes": ["tetra:n=6", "balls:n=2"], "resolutions": ["320x200"], "budget_seconds": 1}
    short |= {"repetitions": {"minimum": 6, "maximum": 6}, "warm_up_seconds": 0}
    folder = replace(folder, steps=(replace(sweep, changes=sweep.changes | short),))
    make_folder(folder, replace(place, beambench=BINARY, run=run_program), HERE)
    published = place.published / "embree-4"
    files = {file.name for file in published.iterdir()}
    assert files >= {"README.md.j2", "config.json", "manifest.json", "run.jsonl.gz", RECORD}
    assert not files & {"run.jsonl", "google-benchmark.json"}
    assert read_json(published / "config.json")["name"] == "embree-4"
    assert published / "README.md" in write_documents(place.published)
    text = (published / "README.md").read_text("utf-8")
    assert re.search(r"\| tetra, 4 k \| [\d.]+ \([\d.]+ to [\d.]+\).*\|", text)
    assert list(bare_figures(published / "README.md.j2")) == []


# Requirements


def test_a_folder_that_lacks_something_says_so() -> None:
    libraries = Folder("libraries", "", (), needs="libraries")
    assert "--tinybvh DIR" in missing(libraries, given(), HERE)
    options = given(tinybvh=Path("tinybvh"), madmann91_bvh=Path("bvh"))
    assert not missing(libraries, options, HERE)
    once_more = Folder("thesis-again", "", (), needs="its name")
    assert "--only thesis-again" in missing(once_more, given(), HERE)
    assert not missing(once_more, given(only=["thesis-again"]), HERE)
    with_embree_3 = Folder("beat-embree", "", (), embree="3")
    embree_4 = replace(HERE, embree="4.3.3")
    assert missing(with_embree_3, given(), embree_4) == (
        "it needs Embree 3, but this program has 4.3.3"
    )


# The setting


def git(folder: Path, *arguments: str) -> str:
    names = {"GIT_AUTHOR_NAME": "a", "GIT_AUTHOR_EMAIL": "a@b"}
    names |= {"GIT_COMMITTER_NAME": "a", "GIT_COMMITTER_EMAIL": "a@b"}
    done = subprocess.run(
        ["git", "-C", folder, *arguments],
        capture_output=True,
        text=True,
        check=True,
        env=os.environ | names,
    )
    return done.stdout.strip()


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    tree = tmp_path / "tree"
    (tree / "results/published").mkdir(parents=True)
    (tree / "accel").mkdir()
    (tree / "accel/source.cpp").write_text("1")
    (tree / "results/published/rows.csv").write_text("1")
    git(tree, "init", "--quiet")
    git(tree, "add", "--all")
    git(tree, "commit", "--quiet", "-m", "first")
    return tree


def of_head(tree: Path) -> Provenance:
    return replace(HERE, commit=git(tree, "rev-parse", "HEAD"))


def test_a_clean_tree_of_the_programs_commit_is_taken(tree: Path) -> None:
    require_clean(of_head(tree), tree)


def test_changes_that_are_not_committed_are_refused(tree: Path) -> None:
    (tree / "accel/source.cpp").write_text("2")
    with pytest.raises(Problem, match=r"not committed: M accel/source\.cpp"):
        require_clean(of_head(tree), tree)


def test_a_program_of_a_changed_tree_is_refused(tree: Path) -> None:
    with pytest.raises(Problem, match="built from a changed tree"):
        require_clean(replace(of_head(tree), dirty=True), tree)


def test_a_program_of_another_commit_is_refused(tree: Path) -> None:
    setting = of_head(tree)
    (tree / "accel/source.cpp").write_text("2")
    git(tree, "commit", "--quiet", "--all", "-m", "second")
    with pytest.raises(Problem, match="differ in what is measured; run scripts/setup"):
        require_clean(setting, tree)
    assert not setting.is_of({"commit": "unknown", "machine_id": "machine-1"})


def test_texts_and_tests_change_no_measurement(tree: Path) -> None:
    setting = of_head(tree)
    for name in ("README.md", "accel/README.md"):
        (tree / name).write_text("2")
        git(tree, "add", name)
    git(tree, "commit", "--quiet", "--all", "-m", "text")
    require_clean(setting, tree)


def test_what_is_published_changes_no_sources(tree: Path) -> None:
    """If it did, every committed folder would require all other folders to be measured again."""
    setting = of_head(tree)
    (tree / "results/published/rows.csv").write_text("2")
    require_clean(setting, tree)
    git(tree, "commit", "--quiet", "--all", "-m", "published")
    require_clean(setting, tree)
    assert same_sources(setting.commit, git(tree, "rev-parse", "HEAD"), tree)


@needs_binary
def test_preflight_states_commit_machine_and_noise() -> None:
    setting = preflight(BINARY)
    assert len(setting.commit) == 40
    assert len(setting.machine_id) == 16
    assert setting.cores >= 1
    assert setting.noise >= 0
    assert replace(setting, noise=0.2).warnings[0] == "equal work takes up to 20% longer than usual"


# Small files


def test_what_is_committed_is_small(tmp_path: Path) -> None:
    run = write_run(tmp_path, synthetic_rows())
    with (run / "results.csv").open(encoding="utf-8") as table:
        row = next(row for row in csv.DictReader(table) if row["trace_ms_median"])
    write_cell(run, row, {1: 3.0})
    (run / "answers.jsonl").write_text("{}")
    (run / "tasks").mkdir()
    (run / "tasks/gato-bill-beams.csv").write_text("seconds")
    plots = run / "plots"
    plots.mkdir()
    for name in ("drawn.png", "drawn.svg", "rendered.png"):
        (plots / name).write_text("")
    picture = Image.effect_noise((200, 200), 60).convert("RGB")
    picture.save(plots / "drawn.png")
    picture.save(plots / "rendered.png")
    before = size(run)
    make_small(run)
    assert {"run.jsonl", "tasks", "answers.jsonl"}.isdisjoint(file.name for file in run.iterdir())
    (cell,) = logged_cells(run)
    assert [one["round"] for one in cell.repetitions] == [1]
    assert {file.name for file in plots.iterdir()} == {"drawn.svg", "rendered.png"}
    with Image.open(plots / "rendered.png") as small:
        assert (small.mode, small.size) == ("P", (200, 200))
    assert size(run) < before


# The command


def test_the_command_refuses_what_it_does_not_know(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--nothing"]) == 2
    assert "scripts/publish --help" in capsys.readouterr().err


def test_check_names_the_line_that_is_wrong(
    tmp_path: Path, repository: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(repository / "results/published/structures", tmp_path / "structures")
    assert main(["--check", "--published", str(tmp_path)]) == 0
    text = tmp_path / "structures/winners.md"
    stated = text.read_text("utf-8")
    figure = re.search(r"(?<=\| `tile-beam` \| )\d\.\d\d", stated)
    assert figure is not None
    wrong = f"{float(figure[0]) + 0.01:.2f}"
    text.write_text(stated[: figure.start()] + wrong + stated[figure.end() :])
    assert main(["--check", "--published", str(tmp_path)]) == 1
    line = stated.count("\n", 0, figure.start()) + 1
    found = capsys.readouterr().out
    assert f"structures/winners.md:{line}: states '| `tile-beam` | {wrong}" in found
