"""Requirements of some folders beyond the built program."""

import os
import shlex
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

from beambench_operations.publish.plan import Folder
from beambench_operations.publish.provenance import Provenance
from beambench_report.base.command_line import Options
from beambench_report.base.files import ROOT, Problem, say

_MESH = "mesh:cat"
_CLONE = "root/beambench"
_ASIDE = "results/runs/aside"
"""The place of the folders that are being made, below the clone."""


def missing(folder: Folder, given: Options, provenance: Provenance) -> str:
    """Returns why a folder cannot be made here, with the remedy; empty if it can.

    `given` are the options of scripts/publish.
    """
    if folder.embree and not provenance.embree.startswith(f"{folder.embree}."):
        return f"it needs Embree {folder.embree}, but this program has {provenance.embree}"
    if folder.needs == "meshes" and not _knows(given.beambench, _MESH):
        return "the meshes are not registered; register them with scripts/meshes"
    if folder.needs == "its name" and folder.name not in given.only:
        return f"it takes long, so it must be named: --only {folder.name}"
    if folder.needs == "libraries" and not (given.tinybvh and given.madmann91_bvh):
        return "give --tinybvh DIR and --madmann91-bvh DIR; otherwise, the published table stays"
    if folder.needs == "debian-13" and not given.debian_13:
        return "give --debian-13 DIR, as root; otherwise, the published table stays"
    return ""


def _knows(beambench: Path, scene: str) -> bool:
    command = [str(beambench), "scene", scene]
    return subprocess.run(command, capture_output=True, check=False).returncode == 0


def plugins_for(given: Options) -> list[Path]:
    """Builds the adapters of the libraries. Raises Problem if that fails."""
    if not (given.tinybvh and given.madmann91_bvh):
        return []
    say("Building the adapters of the libraries")
    _run(
        "cmake",
        "--preset",
        "release",
        f"-DBEAMBENCH_TINYBVH={given.tinybvh.resolve()}",
        f"-DBEAMBENCH_MADMANN91_BVH={given.madmann91_bvh.resolve()}",
    )
    _run("cmake", "--build", "--preset", "release")
    names = ("libtinybvh.so", "libmadmann91_bvh.so")
    return [ROOT / "build/release/plugins" / name for name in names]


class Debian13:
    """A Debian 13 system in a folder, with a clone and build of this commit."""

    def __init__(self, root: Path, commit: str) -> None:
        """Creates or completes the system. Raises Problem on failure."""
        self.root = root.resolve()
        if os.geteuid() != 0:
            raise Problem("a Debian 13 in a folder needs root; leave --debian-13 out")
        if not (self.root / "etc/debian_version").is_file():
            self._bootstrap()
        self._clone(commit)
        self.build()

    def build(self) -> None:
        """Installs missing packages in the system, and builds. Raises Problem on failure."""
        say("Building in Debian 13")
        if code := self._shell("scripts/setup beambench", self.root):
            raise Problem(f"{self.root}: exit code {code} of: scripts/setup beambench")

    def run(self, command: Sequence[str], aside: Path) -> int:
        """Runs a beambench command with its folders below `aside`; returns its exit code."""
        inside = [word.replace(str(aside), _ASIDE) for word in command]
        return self._shell(shlex.join(["build/release/bin/beambench", *inside[1:]]), aside)

    def _shell(self, words: str, aside: Path) -> int:
        """Runs a command line in the clone, with /proc, /sys and /dev, and with `aside` as a folder
        of the clone.

        The mounts are in a separate namespace, so they end with the process.
        """
        line = (
            "set -e; "
            "for one in proc sys dev; do "
            'mkdir -p "$0/$one"; mount --rbind "/$one" "$0/$one"; done; '
            'mkdir -p "$0/$3/$4"; mount --bind "$2" "$0/$3/$4"; '
            'exec chroot "$0" /bin/bash -c "cd /$3 && $1"'
        )
        words_of = ["unshare", "--mount", "bash", "-c", line]
        paths = [str(self.root), words, str(aside), _CLONE, _ASIDE]
        return subprocess.run([*words_of, *paths], check=False).returncode

    def _bootstrap(self) -> None:
        if shutil.which("debootstrap") is None:
            raise Problem("debootstrap is not installed; install it, or name a Debian 13")
        say(f"Making a Debian 13 in {self.root}")
        _run("debootstrap", "--variant=minbase", "trixie", str(self.root))
        for name in ("resolv.conf", "apt/apt.conf.d"):
            self._copy_setting(Path("/etc") / name)

    def _copy_setting(self, file: Path) -> None:
        """Copies this machine's network settings, but not its package sources."""
        target = self.root / file.relative_to("/")
        if file.name == "resolv.conf" and file.is_file():
            shutil.copy(file, target)
        if file.is_dir():
            for own in file.glob("*proxy*"):
                shutil.copy(own, target / own.name)

    def _clone(self, commit: str) -> None:
        clone = self.root / _CLONE
        if not (clone / ".git").is_dir():
            _run("git", "clone", "--quiet", "--no-hardlinks", str(ROOT), str(clone))
        _run("git", "-C", str(clone), "fetch", "--quiet", str(ROOT), "HEAD")
        _run("git", "-C", str(clone), "checkout", "--quiet", "--detach", commit)


def _run(*command: str) -> None:
    done = subprocess.run(command, check=False, cwd=ROOT)
    if done.returncode:
        raise Problem(f"{command[0]}: exit code {done.returncode} of: {' '.join(command)}")
