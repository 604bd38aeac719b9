"""The steps of a Dockerfile, replayed in bare systems where there is no container engine."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from bare_system import REPOSITORY, BareSystem


@dataclass
class Stage:
    """A stage whose steps have been executed."""

    system: BareSystem
    folder: str = "/"
    user: str = "root"
    entry: tuple[str, ...] = ()

    def run(self, *arguments: str) -> str:
        """Runs the entry point as the image's user, whom a volume allows to write."""
        return self.system.run(*self.entry, *arguments, folder=self.folder, user=self.user)


def instructions(text: str) -> Iterator[tuple[str, str]]:
    """Yields the instructions of a Dockerfile with their arguments on one line."""
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    for line in re.sub(r"\\\n\s*", "", "\n".join(lines)).splitlines():
        if line:
            name, _, rest = line.partition(" ")
            yield name, rest


def replay(dockerfile: Path, make: Callable[[str], BareSystem]) -> Stage:
    """Builds every stage in a system that `make` returns for its suite; returns the last one."""
    stages: dict[str, Stage] = {}
    stage = None
    for name, rest in instructions(dockerfile.read_text("utf-8")):
        if name == "FROM":
            image, _, alias = rest.partition(" AS ")
            suite = re.fullmatch(r"debian:(\w+)-slim", image)
            assert suite, f"{image}: only debian:<suite>-slim is replayed"
            stage = Stage(make(suite[1]))
            stages[alias] = stage
            continue
        assert stage, f"{name} before FROM"
        match name:
            case "COPY":
                _copy(stage, rest, stages)
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
                raise AssertionError(f"{name} is not replayed")
    assert stage
    return stage


def _copy(stage: Stage, words: str, stages: dict[str, Stage]) -> None:
    """Executes COPY [--from=STAGE] SOURCE...

    TARGET; from the repository, only files known to git.
    """
    *sources, target = words.split()
    into = stage.system.path(str(Path(stage.folder) / target))
    into.mkdir(parents=True, exist_ok=True)
    if sources[0].startswith("--from="):
        origin = stages[sources.pop(0).removeprefix("--from=")].system
        for source in sources:
            for path in origin.path("/").glob(source.lstrip("/")):
                shutil.copy(path, into)
    elif sources == ["."]:
        stage.system.copy_repository(str(Path(stage.folder) / target))
    else:
        for source in sources:
            shutil.copy(REPOSITORY / source, into)
