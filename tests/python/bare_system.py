"""A minimal Debian system in a folder, and commands that run inside it."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
_BASES = REPOSITORY / "build/bare"
_CACHE = _BASES / "cache"
"""Root's caches, shared by all systems, among them that of the compiler."""
_OWN_MOUNTS = ("unshare", "--mount", "--pid", "--fork")
_ENTER = """
mkdir --parents "$1/root/.cache" "$2" &&
  mount --types proc proc "$1/proc" &&
  mount --rbind /dev "$1/dev" &&
  mount --bind "$2" "$1/root/.cache" || exit 125
system=$1 folder=$3 user=$4
shift 4
exec chroot "$system" su --shell /bin/sh "$user" --command 'cd "$0" && exec "$@"' -- "$folder" "$@"
"""


class BareSystem:
    """A separate system: changes in it affect nothing else."""

    def __init__(self, suite: str, packages: str, folder: Path) -> None:
        """Copies a suite of Debian with these packages, which takes a minute the first time.

        Skips the test if that is impossible.
        """
        if os.geteuid() != 0 or not shutil.which("debootstrap"):
            pytest.skip("only root with debootstrap can make a bare system")
        base = _BASES / f"{suite}-{packages}".rstrip("-")
        if not base.is_dir():
            pending = base.with_name(f".pending-{base.name}")
            shutil.rmtree(pending, ignore_errors=True)
            _BASES.mkdir(parents=True, exist_ok=True)
            include = [f"--include={packages}"] if packages else []
            subprocess.run(
                ["debootstrap", "--variant=minbase", *include, suite, pending],
                check=True,
                stdout=subprocess.DEVNULL,
            )
            pending.rename(base)
        subprocess.run(["cp", "--archive", f"{base}/.", folder], check=True)
        shutil.copy("/etc/resolv.conf", folder / "etc/resolv.conf")
        self.folder = folder

    def path(self, inside: str) -> Path:
        """Returns the path of a file of the system for programs outside it."""
        return self.folder / inside.lstrip("/")

    def copy_repository(self, folder: str) -> None:
        """Copies the files known to git in this working tree into a folder of the system."""
        self.path(folder).mkdir(parents=True, exist_ok=True)
        subprocess.run(
            "git ls-files -z --cached --others --exclude-standard "
            f"| tar --create --null --files-from=- "
            f"| tar --extract --directory={shlex.quote(str(self.path(folder)))}",
            shell=True,
            cwd=REPOSITORY,
            check=True,
        )

    def run(
        self,
        *command: str,
        folder: str = "/root",
        user: str = "root",
        environment: Mapping[str, str] | None = None,
    ) -> str:
        """Runs a command inside; returns its output. Fails the test if the command fails."""
        done = subprocess.run(
            [*_OWN_MOUNTS, "sh", "-c", _ENTER, "sh", self.folder, _CACHE, folder, user, *command],
            env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "LC_ALL": "C.UTF-8"}
            | dict(environment or {}),
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, f"{command}: {done.stdout[-2000:]}{done.stderr[-4000:]}"
        return done.stdout
