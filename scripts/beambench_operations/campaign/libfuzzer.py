"""Fuzzes a target with libFuzzer for some time, then minimizes its corpus."""

import os
import re
import shutil
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from beambench_operations.campaign.piece import Finding, Piece
from beambench_operations.campaign.programs import Ended, Programs
from beambench_operations.campaign.record import Record
from beambench_report.base.files import ROOT, Problem

SOURCES = ROOT / "tests/fuzz"
_DICTIONARIES = dict.fromkeys(
    ("sweep", "run_log", "manifest", "rays", "hits", "gltf", "mesh_entry"), "json"
)
"""Targets without a dictionary named after them, each with the one to use."""
_LIMITS = ("-max_len=4096", "-timeout=20", "-rss_limit_mb=3000")
_GO_ON = ("-fork=1", "-ignore_crashes=1", "-ignore_timeouts=1", "-ignore_ooms=1")
_ENVIRONMENT = {"ASAN_OPTIONS": "detect_leaks=0", "UBSAN_OPTIONS": "print_stacktrace=1"}
_STATUS = re.compile(r"^#(\d+):? .*?cov: (\d+) ft: (\d+) corp: (\d+)", re.MULTILINE)
_FAULTS = ("crash-*", "timeout-*", "oom-*")
_REPEATING = 60.0  # most seconds to repeat one input
_MOST_REPEATED = 100
"""The most failing inputs that are repeated: a target that always fails leaves thousands."""


@dataclass(frozen=True)
class Target:
    """A libFuzzer program and the sources of its inputs."""

    name: str
    program: Path

    def seeds(self) -> list[Path]:
        """Returns the folders of inputs in the repository."""
        folders = [SOURCES / kind / self.name for kind in ("corpus", "regressions")]
        return [folder for folder in folders if folder.is_dir()]

    def dictionary(self) -> list[str]:
        """Returns the option that names the target's dictionary, if it has one."""
        file = SOURCES / f"{_DICTIONARIES.get(self.name, self.name)}.dict"
        return [f"-dict={file}"] if file.exists() else []


def targets_in(folder: Path) -> list[Target]:
    """Returns the targets that were built. Raises Problem if there is none."""
    programs = sorted(path for path in folder.glob("fuzz_*") if os.access(path, os.X_OK))
    if not programs:
        raise Problem(f"{folder}: there is no fuzz target; scripts/setup fuzz builds them")
    return [Target(path.name.removeprefix("fuzz_"), path) for path in programs]


def fuzz(target: Target, seed: int, seconds: float, record: Record, programs: Programs) -> Piece:
    """Fuzzes a target, continues after each finding, and keeps one input for each message."""
    corpus = record.corpus(target.name)
    corpus.mkdir(parents=True, exist_ok=True)
    memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with TemporaryDirectory(dir=memory, prefix="beambench-campaign-") as name:
        scratch = Path(name)
        faults = scratch / "faults"
        faults.mkdir()
        environment = {**_ENVIRONMENT, "TMPDIR": name}
        command = [
            *(target.program, *_GO_ON, *_LIMITS, *target.dictionary()),
            *(f"-seed={seed}", f"-max_total_time={max(1, round(seconds))}"),
            *(f"-artifact_prefix={faults}/", corpus, *target.seeds()),
        ]
        fuzzed = programs.run(command, seconds + 120, scratch, environment)
        executions, coverage = status(fuzzed.errors)
        if not executions:
            raise Problem(f"{target.program} did not run any input: {fuzzed.last_words()}")
        merged = _minimize(target, corpus, scratch, programs, environment)
        coverage["corpus"] = sum(1 for _ in corpus.iterdir())
        findings = list(_findings(target, faults, record, programs, environment))
    counts = {"executions": executions, "seconds": round(seconds)}
    cpu_seconds = round(fuzzed.cpu_seconds + merged.cpu_seconds, 1)
    return Piece("fuzz", target.name, seed, counts, cpu_seconds, coverage, findings)


def status(log: str) -> tuple[int, dict[str, int]]:
    """Returns the number of inputs and the final coverage, from libFuzzer's messages."""
    numbers = [[int(text) for text in one] for one in _STATUS.findall(log)]
    if not numbers:
        return 0, {}
    return max(numbers)[0], {"cov": numbers[-1][1], "ft": numbers[-1][2]}


def _minimize(
    target: Target, corpus: Path, scratch: Path, programs: Programs, environment: dict[str, str]
) -> Ended:
    """Keeps only inputs that add to the coverage; keeps all inputs if minimizing fails."""
    fresh = scratch / "fresh"
    fresh.mkdir()
    folders: Sequence[Path] = (fresh, corpus, *target.seeds())
    ended = programs.run(
        [target.program, "-merge=1", *_LIMITS, *folders], 300, scratch, environment
    )
    if ended.code == 0 and any(fresh.iterdir()):
        for former in corpus.iterdir():
            if not (fresh / former.name).exists():
                former.unlink()
        shutil.copytree(fresh, corpus, dirs_exist_ok=True)
    return ended


def _findings(
    target: Target, faults: Path, record: Record, programs: Programs, environment: dict[str, str]
) -> Iterator[Finding]:
    """Yields a finding for each message with which the target fails again on the same input.

    An input that timed out only because the machine was busy is left out.
    """
    messages = set()
    for file in sorted(path for kind in _FAULTS for path in faults.glob(kind))[:_MOST_REPEATED]:
        ended = programs.run([target.program, *_LIMITS, file], _REPEATING, faults, environment)
        if ended.code == 0 and file.name.startswith("timeout-"):
            continue
        message = _message(ended)
        if message not in messages:
            messages.add(message)
            command = [target.program, file]
            yield record.keep(file, f"{target.name}-{file.name}", message, command)


def _message(ended: Ended) -> str:
    """Returns the error message without the parts that vary from run to run."""
    if ended.code == 0:
        return "it did not fail when it was repeated"
    lines = ended.errors.splitlines()
    for words in ("what():", "runtime error:", "SUMMARY:", "ERROR:"):
        found = [line for line in lines if words in line]
        if found:
            return re.sub(r"==\d+==|0x[0-9a-f]+", "", found[0]).strip()
    return f"no answer within {_REPEATING:.0f} s" if ended.code < 0 else ended.last_words()
