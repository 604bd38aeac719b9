"""Makes one folder, step by step in a separate place, then moves it into results/published."""

import json
import shutil
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

from beambench_operations.nightly.home import is_finished
from beambench_operations.publish.plan import Command, Folder, Sweep
from beambench_operations.publish.progress import Progress, progress_of, state_file
from beambench_operations.publish.provenance import Provenance
from beambench_operations.publish.small import leave_out, make_small
from beambench_report.base.files import (
    INTERRUPTED,
    ROOT,
    Problem,
    run_in_foreground,
    say,
    write_text,
)
from beambench_report.base.quantities import duration_in_words
from beambench_report.base.run_log import has_log

WRONG_HITS = 1
_FIRST_TEMPLATES = Path(__file__).parent / "templates"
"""The templates of folders that were not published before."""

Run = Callable[[Sequence[str], Path | None], int]
"""A function that runs a program, with its output in a file or discarded; returns its exit code."""


class Interrupted(KeyboardInterrupt):
    """The user interrupted the work; finished steps are kept."""


@dataclass(frozen=True)
class Place:
    """The place where a folder is made, the programs that make it, and its destination."""

    aside: Path
    published: Path
    beambench: Path
    plugins: Sequence[Path] = ()
    run: Run = field(default=lambda command, into: run_program(command, into))

    def names(self, folder: Path) -> dict[str, str]:
        """Returns the names that arguments of commands may contain."""
        return {
            "beambench": str(self.beambench),
            "bin": str(self.beambench.parent),
            "python": sys.executable,
            "folder": str(folder),
            "root": str(ROOT),
        }


def make_folder(folder: Folder, place: Place, provenance: Provenance) -> Progress:
    """Runs the remaining steps and publishes the folder.

    Raises Problem if a step fails, Interrupted if the user interrupts it. A later call continues on
    the same machine, and starts over on a different one.
    """
    target = place.aside / folder.name_aside
    progress = progress_of(target, provenance)
    if progress is None:
        shutil.rmtree(target, ignore_errors=True)
        progress = Progress(target, asdict(provenance))
        progress.keep()
    target.mkdir(parents=True, exist_ok=True)
    for number, step in enumerate(folder.steps):
        if number < len(progress.seconds):
            continue
        say(f"== {folder.name}, {number + 1} of {len(folder.steps)}: {step.words}")
        begun = time.monotonic()
        work = _sweep if isinstance(step, Sweep) else _command
        code = work(step, target, place)
        if code in INTERRUPTED:
            raise Interrupted
        if code not in (0, WRONG_HITS):
            raise Problem(f"{folder.name}: exit code {code} of: {step.words}")
        took = time.monotonic() - begun
        progress.done(took, wrong=code == WRONG_HITS)
        say(f"   {duration_in_words(took)}, {duration_in_words(step.seconds)} planned")
    _publish(folder, progress, place.published / folder.name)
    return progress


def run_program(command: Sequence[str], into: Path | None) -> int:
    """Runs a program; its messages go to the terminal, its output to a file or nowhere."""
    if into is None:
        return run_in_foreground(command)
    into.parent.mkdir(parents=True, exist_ok=True)
    pending = into.with_name(f".pending-{into.name}")
    with pending.open("wb") as output:
        code = run_in_foreground(command, output=output)
    if code in (0, WRONG_HITS):
        pending.replace(into)
    else:
        pending.unlink()
    return code


def _sweep(step: Sweep, target: Path, place: Place) -> int:
    run = target / step.into
    beambench = [str(place.beambench), *(f"--plugin={one}" for one in place.plugins), "run"]
    config = target.with_name(f"{target.name}.sweep.json")
    wanted = json.dumps(step.config(), indent=1) + "\n"
    if has_log(run) and config.is_file() and config.read_text("utf-8") == wanted:
        if is_finished(run):  # it ended before that was recorded here
            return 0
        return place.run([*beambench, "--resume", str(run)], None)
    shutil.rmtree(run, ignore_errors=True)  # begun with a sweep that has changed since
    write_text(config, wanted)
    return place.run([*beambench, str(config), "-o", str(run)], None)


def _command(step: Command, target: Path, place: Place) -> int:
    was_begun = bool(step.resume) and any(target.iterdir())
    words = step.resume if was_begun else step.words_of
    command = [word.format_map(place.names(target)) for word in words]
    return place.run(command, target / step.into if step.into else None)


def _publish(folder: Folder, progress: Progress, published: Path) -> None:
    """Replaces the published folder, except templates and files to keep."""
    leave_out(progress.folder, folder.leave_out)
    make_small(progress.folder)
    progress.publish()
    written_by_hand = (*published.rglob("*.md.j2"), *published.glob("README.md"))
    for source in (*(published / name for name in folder.keep), *written_by_hand):
        target = progress.folder / source.relative_to(published)
        if source.is_file() and not target.is_file():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source, target)
    first = _FIRST_TEMPLATES / f"{folder.name}.md.j2"
    if first.is_file() and not (progress.folder / "README.md.j2").is_file():
        shutil.copy(first, progress.folder / "README.md.j2")
    former = published.with_name(f".former-{published.name}")
    shutil.rmtree(former, ignore_errors=True)
    if published.exists():
        published.rename(former)
    published.parent.mkdir(parents=True, exist_ok=True)
    shutil.move(str(progress.folder), published)
    shutil.rmtree(former, ignore_errors=True)
    state_file(progress.folder).unlink(missing_ok=True)
