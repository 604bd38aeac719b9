"""The commit and machine that make a folder, and checks that the working tree is clean."""

import json
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

from beambench_report.base.files import ROOT, Problem, output_of, read_json

_KEPT_APART = "results/published"
_MEASURES = ("accel", "harness", "scenes", "CMakeLists.txt", "scripts/beambench_thesis", ":!*.md")
"""Sources that affect times. Texts, plots and tests may change between two folders."""
_LOOKS_BUSY = 0.05
QUIET = 0.1
"""Other work that keeps more processors busy than this disturbs times (kQuiet of the harness)."""
_SWEEP = {
    "name": "preflight",
    "scenes": ["escena2"],
    "structures": ["null"],
    "resolutions": ["64x48"],
    "repetitions": {"minimum": 1, "maximum": 1},
    "budget_seconds": 1,
}


@dataclass(frozen=True)
class Provenance:
    """The provenance of measurements by the built program."""

    commit: str
    dirty: bool
    machine_id: str
    cpu: str
    cores: int
    embree: str
    noise: float
    """How much longer than usual the slowest 5% of equal work took just now."""
    other_work: float | None
    """The processors that other processes kept busy just now; None if the system does not tell."""
    cpu_quota: float | None = None
    """The quota of processor time, in processors; None without a quota."""

    @property
    def warnings(self) -> list[str]:
        """Reasons to distrust the times."""
        found = []
        if self.noise > _LOOKS_BUSY:
            found.append(f"equal work takes up to {self.noise:.0%} longer than usual")
        if self.other_work is not None and self.other_work > QUIET:
            found.append(f"other work keeps {self.other_work:.2f} processors busy")
        if self.cpu_quota is not None and self.cpu_quota < self.cores:
            found.append(f"a CPU quota of {self.cpu_quota:.3g} CPUs is set")
        return found

    def is_of(self, other: dict[str, object]) -> bool:
        """Returns whether a record is from this machine and the same sources."""
        return other.get("machine_id") == self.machine_id and same_sources(
            str(other.get("commit", "")), self.commit
        )


def preflight(beambench: Path) -> Provenance:
    """Measures a cell that takes a second, and reads the provenance from its manifest.

    Raises Problem if the program cannot be run.
    """
    with tempfile.TemporaryDirectory() as folder:
        sweep, run = Path(folder) / "preflight.json", Path(folder) / "run"
        sweep.write_text(json.dumps(_SWEEP), "utf-8")
        output_of([str(beambench), "run", str(sweep), "-o", str(run)], remedy="run scripts/setup")
        source = read_json(run / "manifest.json")
    try:
        program, machine, measured = (source[key] for key in ("program", "machine", "measurement"))
        return Provenance(
            program["commit"],
            bool(program["dirty"]),
            machine["id"],
            machine["cpu"],
            machine["cores"],
            program["libraries"]["embree"],
            float(measured["noise"]),
            measured["other_work"],
            machine["cpu_quota"],
        )
    except (TypeError, KeyError) as error:
        raise Problem(f"{beambench}: its manifest lacks {error}; run scripts/setup") from None


def require_clean(provenance: Provenance, root: Path = ROOT) -> None:
    """Raises Problem for uncommitted changes, and for a program built from different sources.

    results/published may change, since a publication writes there.
    """
    changed = git("status", "--porcelain", "--", ".", f":!{_KEPT_APART}", root=root)
    if changed:
        raise Problem(
            f"there are changes that are not committed: {changed.splitlines()[0].strip()}"
        )
    if provenance.dirty:
        raise Problem("the program was built from a changed tree; run scripts/setup")
    head = git("rev-parse", "HEAD", root=root)
    if not same_sources(provenance.commit, head, root):
        raise Problem(
            f"the program is of commit {provenance.commit[:7]} and the tree of {head[:7]}, which "
            "differ in what is measured; run scripts/setup"
        )


def same_sources(one: str, other: str, root: Path = ROOT) -> bool:
    """Returns whether two commits have the same sources that affect times."""
    if one == other:
        return True
    command = ["git", "-C", str(root), "diff", "--quiet", one, other, "--", *_MEASURES]
    return subprocess.run(command, capture_output=True, check=False).returncode == 0


def git(*arguments: str, root: Path = ROOT) -> str:
    """Returns the output of git. Raises Problem if it fails."""
    return output_of(["git", "-C", str(root), *arguments], remedy="install git").strip()
