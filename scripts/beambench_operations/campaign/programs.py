"""Programs that are run, measured, killed and ended together."""

import contextlib
import os
import signal
import subprocess
import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryFile

from beambench_report.base.files import ROOT, Problem

PYTHON = {
    "PYTHONPATH": ":".join(filter(None, (str(ROOT / "scripts"), os.environ.get("PYTHONPATH"))))
}
"""An environment in which Python finds the packages of scripts/, even without .venv."""
_POLL = 0.005  # seconds
_PATIENCE = 3.0  # seconds from SIGTERM to SIGKILL


class Stopped(Exception):  # noqa: N818 (a user's wish is not an error)
    """The campaign has ended; pieces in progress are not counted."""


@dataclass(frozen=True)
class Ended:
    """How a program ended; a negative code is a signal."""

    code: int
    output: str
    errors: str
    cpu_seconds: float

    def last_words(self) -> str:
        """Returns the last line of its output, as the reason."""
        lines = (self.errors.strip() or self.output.strip()).splitlines()
        return lines[-1] if lines else f"it ended with {self.code} and printed nothing"


class Program:
    """A process in its own session, which a keyboard interrupt does not reach."""

    def __init__(
        self, command: Sequence[str | Path], cwd: Path | None, env: Mapping[str, str]
    ) -> None:
        """Starts the program. Raises Problem if it cannot be run."""
        self._output, self._errors = TemporaryFile(), TemporaryFile()  # noqa: SIM115
        try:
            self._process = subprocess.Popen(
                [str(word) for word in command],
                stdin=subprocess.DEVNULL,
                stdout=self._output,
                stderr=self._errors,
                cwd=cwd,
                env={**os.environ, **env},
                start_new_session=True,
            )
        except OSError as error:
            raise Problem(f"{command[0]} cannot be run: {error.strerror}") from None
        self.pid = self._process.pid
        self._ended: Ended | None = None
        self._reaping = threading.Lock()

    def wait(self, seconds: float = float("inf")) -> Ended | None:
        """Waits for the program to end; returns None if it runs longer than `seconds`."""
        end = time.monotonic() + seconds
        while (ended := self._reaped()) is None and time.monotonic() < end:
            time.sleep(_POLL)
        return ended

    def _reaped(self) -> Ended | None:
        """Returns how the program ended, or None; several threads may call it."""
        with self._reaping:
            if self._ended is None:
                done, status, usage = os.wait4(self.pid, os.WNOHANG)
                if done:
                    self._process.returncode = os.waitstatus_to_exitcode(status)
                    texts = []
                    for file in (self._output, self._errors):
                        with file:
                            file.seek(0)
                            texts.append(file.read().decode(errors="replace"))
                    seconds = usage.ru_utime + usage.ru_stime
                    self._ended = Ended(self._process.returncode, *texts, seconds)
            return self._ended

    def send(self, number: signal.Signals, *, to_all: bool = False) -> None:
        """Sends a signal to the process, or to all of its group."""
        if self._ended is None:
            with contextlib.suppress(ProcessLookupError):
                (os.killpg if to_all else os.kill)(self.pid, number)

    def end(self) -> None:
        """Kills the process and its whole group."""
        self.send(signal.SIGTERM, to_all=True)
        self.wait(_PATIENCE)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.pid, signal.SIGKILL)
        self.wait()


class Programs:
    """All programs of a campaign, started by any of its threads."""

    def __init__(self) -> None:
        """Creates an empty group."""
        self._lock = threading.Lock()
        self._begun: list[Program] = []
        self._stopped = False

    def start(
        self,
        command: Sequence[str | Path],
        cwd: Path | None = None,
        env: Mapping[str, str] | None = None,
    ) -> Program:
        """Starts a program. Raises Stopped once the campaign ends."""
        with self._lock:
            if self._stopped:
                raise Stopped
            program = Program(command, cwd, env or {})
            self._begun = [one for one in self._begun if one.wait(0) is None] + [program]
            return program

    def run(
        self,
        command: Sequence[str | Path],
        seconds: float = float("inf"),
        cwd: Path | None = None,
        env: Mapping[str, str] | None = None,
    ) -> Ended:
        """Runs a program, and ends it after the given time. Raises Stopped like `start`."""
        program = self.start(command, cwd, env)
        ended = program.wait(seconds)
        if ended is None:
            program.end()
            ended = program.wait()
        assert ended is not None
        if self._stopped:
            raise Stopped
        return ended

    def stop(self) -> None:
        """Ends all programs and prevents new ones."""
        with self._lock:
            self._stopped = True
            for program in self._begun:
                if program.wait(0) is None:
                    program.end()
