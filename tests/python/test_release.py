"""Releases: one version everywhere, a record of all releases, and steps that each run once."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from beambench_operations.release import __main__ as release
from beambench_operations.release import record, trials
from beambench_operations.release.bare_system import BareSystem, why_impossible
from beambench_operations.release.versions import disagreements, release_date, stated_versions
from beambench_report.base.files import ROOT, Problem

SCRIPT = ROOT / "scripts/release"
FILES = [*stated_versions(), "harness/measure/record/revision.cmake"]


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A repository with the files that state the version, all of them committed."""
    root = tmp_path / "tree"
    attributes = "harness/measure/record/.gitattributes"
    for file in [*FILES, attributes]:
        (root / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / file, root / file)
    git(root, "init", "--quiet")
    git(root, "config", "user.name", "Test")
    git(root, "config", "user.email", "test@localhost")
    git(root, "add", "--all")
    git(root, "commit", "--quiet", "-m", "First")
    return root


def git(root: Path, *arguments: str) -> str:
    command = ["git", "-C", str(root), *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


def test_every_file_states_one_version() -> None:
    stated = stated_versions()
    assert len(stated) == 5
    assert len(set(stated.values())) == 1, stated
    assert re.fullmatch(r"\d+\.\d+\.\d+", stated["CMakeLists.txt"])
    assert re.fullmatch(r"\d{4}-\d\d-\d\d", release_date())


@pytest.mark.parametrize(
    ("file", "before", "after"),
    [
        ("CMakeLists.txt", "beambench VERSION {}", "beambench VERSION 9.9.9"),
        ("CITATION.cff", "\nversion: {}", "\nversion: 9.9.9"),
        (".github/CHANGELOG.md", "\n## {} (", "\n## Not released\n- Something.\n\n## {} ("),
        ("pyproject.toml", 'name = "beambench"', 'name = "beambench"\nversion = "9.9.9"'),
        ("harness/cli/wheel/pyproject.toml", 'dynamic = ["version"]', 'version = "9.9.9"'),
    ],
)
def test_a_file_with_another_version_is_named(
    tree: Path, file: str, before: str, after: str
) -> None:
    version = stated_versions(tree)["CMakeLists.txt"]
    assert list(disagreements(version, tree)) == []
    text = (tree / file).read_text("utf-8")
    changed = text.replace(before.format(version), after.format(version), 1)
    assert changed != text
    (tree / file).write_text(changed, "utf-8")
    assert any(one.startswith(f"{file} states ") for one in disagreements(version, tree))


def test_a_committed_tree_of_the_version_is_accepted_and_any_other_refused(tree: Path) -> None:
    version = stated_versions(tree)["CMakeLists.txt"]
    with pytest.raises(Problem, match=r"CMakeLists\.txt states version .*, not '9\.9\.9'"):
        release.require_releasable("9.9.9", tree)
    (tree / "CITATION.cff").open("a").write("# changed\n")
    with pytest.raises(Problem, match=r"not committed.*CITATION\.cff"):
        release.require_releasable(version, tree)


@pytest.mark.parametrize("arguments", [[], ["--fast", "0.1.0"], ["0.0.1"], ["--check", "0.0.1"]])
def test_help_is_printed_and_other_arguments_are_refused(arguments: list[str]) -> None:
    helped = subprocess.run([SCRIPT, "--help"], capture_output=True, text=True, check=True)
    assert helped.stdout.startswith("usage: scripts/release")
    done = subprocess.run([SCRIPT, *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "scripts/release --help" in done.stderr


# The record


def test_the_record_is_well_formed_and_names_commits_of_this_repository() -> None:
    rows = record.read_record()
    assert {"0.1.0", "0.2.0"} <= {row["version"] for row in rows}
    if git(ROOT, "rev-parse", "--is-shallow-repository") == "true":
        return
    for row in rows:
        assert git(ROOT, "cat-file", "-t", row["commit"]) == "commit"


def test_a_release_is_put_first_and_replaces_its_own_rows(tmp_path: Path) -> None:
    path = tmp_path / "releases.csv"
    path.write_text(",".join(record.COLUMNS) + f"\n0.2.0,2026-11-24,{'a' * 40},,,\n")
    files = [tmp_path / name for name in ("b.whl", "a.tar.gz")]
    for file in files:
        file.write_text(file.name)
    for _ in range(2):
        record.write_release(record.rows_of("0.10.0", "2026-12-01", "b" * 40, files), path)
        rows = record.read_record(path)
        assert [(row["version"], row["file"]) for row in rows] == [
            ("0.10.0", "a.tar.gz"),
            ("0.10.0", "b.whl"),
            ("0.2.0", ""),
        ]
        assert rows[1]["bytes"] == "5"
    checked = subprocess.run(
        ["sha256sum", "--check"],
        cwd=tmp_path,
        input="".join(f"{row['sha256']}  {row['file']}\n" for row in rows[:2]),
        text=True,
        check=False,
        capture_output=True,
    )
    assert checked.returncode == 0, checked.stdout


RIGHT = f"0.2.0,2026-11-24,{'a' * 40},x.whl,7,{'b' * 64}\n"


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("version,commit\n", "1: the columns are version,commit"),
        (RIGHT.replace("0.2.0", "0.2"), "2: version is '0.2'"),
        (RIGHT.replace("a" * 40, "a" * 7), "2: commit is"),
        (RIGHT.replace(",7,", ",0,"), "2: bytes is '0'"),
        (RIGHT.replace("b" * 64, ""), "2: file, bytes and sha256 must be all"),
        (RIGHT + RIGHT, "3: x.whl is listed twice"),
        (RIGHT + RIGHT.replace("x.whl", "y.whl").replace("-24", "-25"), "3: version 0.2.0 has two"),
        (RIGHT + RIGHT.replace("0.2.0", "0.10.0").replace("x.", "y."), "3: versions are not in"),
    ],
)
def test_a_malformed_record_is_refused_with_its_line(tmp_path: Path, text: str, fault: str) -> None:
    path = tmp_path / "releases.csv"
    head = "" if text.startswith("version") else ",".join(record.COLUMNS) + "\n"
    path.write_text(head + text, "utf-8")
    with pytest.raises(Problem, match=re.escape(f"releases.csv:{fault}")):
        record.read_record(path)
    path.write_text(",".join(record.COLUMNS) + "\n" + RIGHT, "utf-8")
    assert len(record.read_record(path)) == 1


# Steps


def test_a_failed_step_is_repeated_and_a_complete_one_is_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    calls = []

    def make(name: str) -> Callable[[release.Release, Path], None]:
        def step(made: release.Release, work: Path) -> None:
            assert list(work.iterdir()) == []
            (work / "left").write_text("over")
            calls.append(name)
            if calls == ["one", "two"]:
                raise Problem("it does not work")
            (made.files / name).write_text(name)

        return step

    path = tmp_path / "releases.csv"
    path.write_text(",".join(record.COLUMNS) + "\n")
    monkeypatch.setattr(release, "ROOT", tmp_path)
    monkeypatch.setattr(release, "require_releasable", lambda version: None)
    monkeypatch.setattr(release, "why_impossible", lambda: "")
    monkeypatch.setattr(release, "git", lambda *words: "c" * 40)
    monkeypatch.setattr(release, "release_date", lambda: "2026-12-01")
    monkeypatch.setattr(
        release, "write_release", lambda rows: record.write_release(rows, path=path)
    )
    monkeypatch.setattr(release, "STEPS", [release.Step(n, n, make(n)) for n in ("one", "two")])
    assert release.main(["1.2.3"]) == 1
    assert "error: two: it does not work" in capsys.readouterr().err
    assert record.read_record(path) == []
    assert release.main(["1.2.3"]) == 0
    assert calls == ["one", "two", "two"]
    assert [row["file"] for row in record.read_record(path)] == ["one", "two"]
    (folder,) = (tmp_path / "build/releases").iterdir()
    assert sorted(entry.name for entry in folder.iterdir()) == ["files", "steps.json"]


def test_the_source_archive_has_its_commit(tree: Path, tmp_path: Path) -> None:
    def revision(source: Path) -> str:
        output = tmp_path / "revision.hpp"
        words = [f"-DOUTPUT={output}", f"-DSOURCE_DIR={source}"]
        script = source / "harness/measure/record/revision.cmake"
        subprocess.run(["cmake", *words, "-P", script], check=True)
        return output.read_text("utf-8")

    commit = git(tree, "rev-parse", "HEAD")
    archive = tmp_path / "a.tar.gz"
    git(tree, "archive", "--prefix=top/", f"--output={archive}", "HEAD")
    (tree / "CITATION.cff").write_text("changed")
    assert f'"{commit}"' in revision(tree)
    assert "kRevisionDirty = true" in revision(tree)
    subprocess.run(["tar", "--extract", "--file", archive, "--directory", tmp_path], check=True)
    assert f'"{commit}"' in revision(tmp_path / "top")
    assert "kRevisionDirty = false" in revision(tmp_path / "top")


# Trials


def sound_program(folder: Path) -> trials.Program:
    """Returns a program that passes try_program()."""

    def program(*arguments: str) -> str:
        if arguments[0] == "fingerprint":
            return trials.FINGERPRINT.read_text("utf-8")
        if "-o" in arguments:
            path = folder / arguments[arguments.index("-o") + 1]
            if arguments[0] == "run":
                path.mkdir()
                path /= "results.csv"
            path.write_text("x" * 1_000_000)
        return "samet embree"

    return program


def test_a_sound_program_passes_its_trial(tmp_path: Path) -> None:
    trials.try_program(sound_program(tmp_path), tmp_path)


@pytest.mark.parametrize(
    ("command", "change", "fault"),
    [
        ("fingerprint", lambda out, path: out.replace("1", "2"), "does not print .*fingerprint"),
        ("time", lambda out, path: "samet", "does not name its contenders"),
        ("render", lambda out, path: path.write_text(""), "wrote 0 bytes"),
        ("explain", lambda out, path: path.write_text("small"), "wrote 5 bytes"),
        (
            "explain",
            lambda out, path: path.write_text("<script src='https://x'>" + "x" * 1_000_000),
            "loads scripts from elsewhere",
        ),
        ("run", lambda out, path: (path / "results.csv").unlink(), "wrote 0 bytes"),
    ],
)
def test_what_a_trial_finds_wrong_is_reported(
    tmp_path: Path, command: str, change: Callable[[str, Path], object], fault: str
) -> None:
    sound = sound_program(tmp_path)

    def program(*arguments: str) -> str:
        output = sound(*arguments)
        if arguments[0] != command:
            return output
        path = tmp_path / arguments[arguments.index("-o") + 1] if "-o" in arguments else tmp_path
        changed = change(output, path)
        return changed if isinstance(changed, str) else output

    with pytest.raises(Problem, match=fault):
        trials.try_program(program, tmp_path)


@pytest.mark.full
def test_a_bare_system_has_no_network_where_none_is_wanted(bare_folder: Path) -> None:
    assert why_impossible() == ""
    system = BareSystem("trixie", "", bare_folder)
    interfaces = [
        system.run("grep", "--only-matching", r"\w*:", "/proc/net/dev", network=network).split()
        for network in (False, True)
    ]
    assert interfaces[0] == ["lo:"]
    assert len(interfaces[1]) > 1
    with pytest.raises(Problem, match="exit code 3 of: sh -c 'exit 3'"):
        system.run("sh", "-c", "exit 3")
