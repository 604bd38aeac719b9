"""The command line of scripts/release."""

import json
import os
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from beambench_operations.publish.provenance import git
from beambench_operations.release.bare_system import why_impossible
from beambench_operations.release.record import read_record, rows_of, write_release
from beambench_operations.release.trials import (
    PYTHON_OF_SUITE,
    download_dependencies,
    package_of,
    try_wheels,
)
from beambench_operations.release.versions import disagreements, release_date
from beambench_report.base.command_line import Options, ScriptParser
from beambench_report.base.files import (
    ROOT,
    Problem,
    read_json,
    run_in_foreground,
    say,
    write_text,
)
from beambench_report.base.quantities import size_in_words

_INTERRUPTED = "interrupted; the same command continues after the last complete step"


@dataclass(frozen=True)
class Release:
    """A release that is being made in its own folder."""

    version: str
    commit: str
    folder: Path

    @property
    def files(self) -> Path:
        """The folder of the released files."""
        return self.folder / "files"

    @property
    def archive(self) -> Path:
        """The source archive."""
        return self.files / f"beambench-{self.version}.tar.gz"


@dataclass(frozen=True)
class Step:
    """A part of the work, which is done completely or not at all."""

    name: str
    does: str
    make: Callable[[Release, Path], None]
    """The function that does the step in an empty folder, which is removed afterwards."""


def main(arguments: list[str]) -> int:
    """Runs the command line; returns the exit code."""
    parser = ScriptParser("release")
    parser.add_argument("version", metavar="VERSION")
    parser.add_argument("--check", action="store_true")
    return parser.run(_run, arguments, _INTERRUPTED)


def _run(options: Options) -> int:
    require_releasable(options.version)
    if options.check:
        say(f"the tree can be released as {options.version}")
        return 0
    if why := why_impossible():
        raise Problem(why)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    commit = git("rev-parse", "HEAD")
    folder = ROOT / f"build/releases/{options.version}-{commit[:12]}"
    release = Release(options.version, commit, folder)
    took = done_steps(release)
    for step in STEPS:
        if step.name in took:
            say(f"== {step.name} is complete ({took[step.name]:.0f} s)")
            continue
        say(f"== {step.name}: {step.does}")
        try:
            took[step.name] = perform(step, release)
        except Problem as problem:
            say(f"error: {step.name}: {problem}")
            return 1
        write_text(_state(release), json.dumps(took, indent=1) + "\n")
    files = list(release.files.iterdir())
    record = write_release(rows_of(release.version, release_date(), commit, files))
    for name, seconds in took.items():
        print(f"{name}\t{seconds:.0f} s")
    for file in sorted(files):
        print(f"{file.relative_to(ROOT)}\t{size_in_words(file.stat().st_size)}")
    words = f"Record release {release.version}"
    say(f'To finish: git tag v{release.version} {commit[:12]} && git commit {record} -m "{words}"')
    return 0


def require_releasable(version: str, root: Path = ROOT) -> None:
    """Raises Problem unless the tree has that version and everything is committed."""
    if found := next(disagreements(version, root), None):
        raise Problem(f"{found}; write the same version in all of them")
    if not release_date(root):
        raise Problem("CITATION.cff has no 'date-released: YEAR-MONTH-DAY'")
    if changed := git("status", "--porcelain", root=root):
        raise Problem(f"there are changes that are not committed: {changed.splitlines()[0]}")
    earlier = next((row for row in read_record() if row["version"] == version), None)
    if earlier and earlier["commit"] != git("rev-parse", "HEAD", root=root):
        raise Problem(f"{version} was released as {earlier['commit'][:12]}; choose a new version")


def done_steps(release: Release) -> dict[str, float]:
    """Returns the seconds that each complete step of the release took."""
    state = read_json(_state(release))
    return dict(state) if isinstance(state, dict) else {}


def perform(step: Step, release: Release) -> float:
    """Does a step; returns the seconds that it took."""
    release.files.mkdir(parents=True, exist_ok=True)
    begin = time.monotonic()
    work = Path(tempfile.mkdtemp(prefix=f"{step.name}-", dir=release.folder))
    try:
        step.make(release, work)
    finally:
        shutil.rmtree(work)
    return round(time.monotonic() - begin, 1)


def _state(release: Release) -> Path:
    return release.folder / "steps.json"


def _archive(release: Release, work: Path) -> None:
    pending = work / release.archive.name
    top = f"--prefix=beambench-{release.version}/"
    git("archive", "--format=tar.gz", top, f"--output={pending}", release.commit)
    pending.replace(release.archive)


def _wheels(release: Release, work: Path) -> None:
    if code := run_in_foreground([str(ROOT / "scripts/wheel"), str(work)]):
        raise Problem(f"exit code {code} of scripts/wheel")
    for wheel in work.glob("*.whl"):
        wheel.replace(release.files / wheel.name)


def _try_wheels(suite: str, release: Release, work: Path) -> None:
    house = work / "wheels"
    house.mkdir()
    for wheel in release.files.glob("*.whl"):
        os.link(wheel, house / wheel.name)
    download_dependencies(house, PYTHON_OF_SUITE[suite])
    system = work / "system"
    system.mkdir()
    seconds = try_wheels(suite, house, system)
    say(f"first results after {seconds:.1f} s of processor time")


def _package(suite: str, release: Release, work: Path) -> None:
    package = package_of(suite, release.archive, work)
    shutil.copy(package, release.files)


def _steps(suites: Sequence[str]) -> list[Step]:
    return [
        Step("source", "packing the files of the commit", _archive),
        Step("wheels", "building both wheels (scripts/wheel)", _wheels),
        *(
            Step(
                f"wheels-{suite}",
                f"using the wheels in a bare {suite}",
                partial(_try_wheels, suite),
            )
            for suite in suites
        ),
        *(
            Step(
                f"package-{suite}",
                f"building the Debian package from the source archive in a bare {suite}, "
                "and using it in another one",
                partial(_package, suite),
            )
            for suite in suites
        ),
    ]


STEPS = _steps(list(PYTHON_OF_SUITE))

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
