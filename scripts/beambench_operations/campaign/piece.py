"""The pieces of a campaign, each of which counts completely or not at all."""

from collections.abc import Callable
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Finding:
    """A fault that was found."""

    file: str
    """The file in the folder of findings that reproduces the fault or was left by it."""
    message: str
    command: str
    """The command that repeats it, run at the top of the repository."""


@dataclass(frozen=True)
class Piece:
    """A finished piece of work and its result."""

    command: str
    """`fuzz`, `rays` or `kills`."""
    subject: str
    """The target, the structure, or the program that was killed."""
    seed: int
    counts: dict[str, int]
    """Executions, or scenes and rays, or kills and runs."""
    cpu_seconds: float
    coverage: dict[str, int] = field(default_factory=dict)
    """libFuzzer's figures: edges (`cov`), features (`ft`), inputs of the corpus (`corpus`)."""
    findings: list[Finding] = field(default_factory=list)

    def __str__(self) -> str:
        """Returns one line that reports the piece."""
        counts = ", ".join(f"{count:,} {what}" for what, count in self.counts.items())
        findings = f", {len(self.findings)} FINDINGS" if self.findings else ""
        return f"{self.command} {self.subject}, seed {self.seed}: {counts}{findings}"


@dataclass(frozen=True)
class Task:
    """A piece of work to do."""

    subject: str
    run: Callable[[], Piece]
