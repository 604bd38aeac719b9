"""The steps of a Dockerfile, replayed in bare systems where there is no container engine."""

import json
import re
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from beambench_operations.release.bare_system import BareSystem
from beambench_report.base.files import ROOT, Problem

DOCKERFILE = ROOT / "scripts/container/Dockerfile"


@dataclass
class Stage:
    """A stage whose steps have been executed."""

    system: BareSystem
    folder: str = "/"
    user: str = "root"
    entry: tuple[str, ...] = ()

    def run(self, *arguments: str, network: bool = True) -> str:
        """Runs the entry point in the image's folder, as the image's user."""
        words = (*self.entry, *arguments)
        return self.system.run(*words, folder=self.folder, user=self.user, network=network)


def instructions(text: str) -> Iterator[tuple[str, str]]:
    """Yields the instructions of a Dockerfile with their arguments on one line."""
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    for line in re.sub(r"\\\n\s*", "", "\n".join(lines)).splitlines():
        if line:
            name, _, rest = line.partition(" ")
            yield name, rest


def replay(make: Callable[[str], BareSystem], archive: Path | None = None) -> dict[str, Stage]:
    """Builds every stage of the Dockerfile in a system that `make` returns for its suite.

    Returns the stages by name; the name of the last stage is empty. The context is the source
    archive or, by default, the working tree. Raises Problem for an instruction that cannot be
    replayed.
    """
    stages: dict[str, Stage] = {}
    stage: Stage | None = None
    for name, rest in instructions(DOCKERFILE.read_text("utf-8")):
        if name == "FROM":
            image, _, alias = rest.partition(" AS ")
            suite = re.fullmatch(r"debian:(\w+)-slim", image)
            if not suite:
                raise Problem(f"{DOCKERFILE}: {image}: only debian:<suite>-slim is replayed")
            stage = Stage(make(suite[1]))
            stages[alias] = stage
            continue
        if stage is None:
            raise Problem(f"{DOCKERFILE}: {name} before FROM")
        match name:
            case "COPY":
                _copy(stage, rest, stages, archive)
            case "RUN":
                stage.system.run("sh", "-ec", rest, folder=stage.folder, user=stage.user)
            case "USER":
                stage.user = rest
            case "WORKDIR":
                stage.folder = rest
                stage.system.path(rest).mkdir(parents=True, exist_ok=True)
            case "ENTRYPOINT":
                stage.entry = tuple(json.loads(rest))
            case _:
                raise Problem(f"{DOCKERFILE}: {name} is not replayed")
    return stages


def _copy(stage: Stage, words: str, stages: dict[str, Stage], archive: Path | None) -> None:
    """Executes a COPY instruction; copies only files known to git from the repository."""
    *sources, target = words.split()
    into = stage.system.path(str(Path(stage.folder) / target))
    into.mkdir(parents=True, exist_ok=True)
    if sources[0].startswith("--from="):
        origin = stages[sources.pop(0).removeprefix("--from=")].system
        for source in sources:
            for path in origin.path("/").glob(source.lstrip("/")):
                shutil.copy(path, into)
    elif sources == ["."]:
        folder = str(Path(stage.folder) / target)
        if archive:
            stage.system.unpack(archive, folder)
        else:
            stage.system.copy_repository(folder)
    else:
        for source in sources:
            shutil.copy(ROOT / source, into)
