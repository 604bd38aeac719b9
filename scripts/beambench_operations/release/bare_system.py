"""A minimal Debian system in a folder, and commands that run inside it."""

import os
import shlex
import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path

from beambench_report.base.files import ROOT, Problem

_BASES = ROOT / "build/bare"
_CACHE = _BASES / "cache"
"""Root's caches, including that of the compiler; all systems share them."""
_CERTIFICATES = "/etc/ssl/certs/ca-certificates.crt"
_OWN_CERTIFICATES = "/etc/ssl/outside.crt"
"""This machine's certificates: behind a proxy, those of the registries are not Debian's."""
_OWN_MOUNTS = ("unshare", "--mount", "--pid", "--kill-child")
_ENTER = """
mkdir --parents "$1/root/.cache" "$2" &&
  mount --types proc proc "$1/proc" &&
  mount --rbind /dev "$1/dev" &&
  mount --bind "$2" "$1/root/.cache" || exit 125
system=$1 folder=$3 user=$4
shift 4
exec chroot "$system" su --shell /bin/sh "$user" --command 'cd "$0" && exec "$@"' -- "$folder" "$@"
"""


def why_impossible() -> str:
    """Returns what this machine lacks for a bare system; empty if it can make one."""
    if os.geteuid() != 0:
        return "only root can make a bare system"
    return "" if shutil.which("debootstrap") else "a bare system needs debootstrap; install it"


class BareSystem:
    """A separate system: changes in it affect nothing else."""

    def __init__(self, suite: str, packages: str, folder: Path) -> None:
        """Copies a suite of Debian with these packages, which takes a minute the first time.

        Raises Problem if that is impossible.
        """
        if why := why_impossible():
            raise Problem(why)
        base = _BASES / f"{suite}-{packages}".rstrip("-")
        if not base.is_dir():
            pending = base.with_name(f".pending-{base.name}")
            shutil.rmtree(pending, ignore_errors=True)
            _BASES.mkdir(parents=True, exist_ok=True)
            include = [f"--include={packages}"] if packages else []
            _run("debootstrap", "--variant=minbase", *include, suite, str(pending))
            pending.rename(base)
        _run("cp", "--archive", f"{base}/.", str(folder))
        shutil.copy("/etc/resolv.conf", folder / "etc/resolv.conf")
        (folder / "etc/ssl").mkdir(exist_ok=True)
        shutil.copy(_CERTIFICATES, f"{folder}{_OWN_CERTIFICATES}")
        self.folder = folder

    def path(self, inside: str) -> Path:
        """Returns the path of a file of the system for programs outside it."""
        return self.folder / inside.lstrip("/")

    def copy_repository(self, folder: str) -> None:
        """Copies the files known to git in this working tree into a folder of the system."""
        self.path(folder).mkdir(parents=True, exist_ok=True)
        listed = "git ls-files -z --cached --others --exclude-standard"
        packed = "tar --create --null --files-from=-"
        unpacked = f"tar --extract --directory={shlex.quote(str(self.path(folder)))}"
        subprocess.run(f"{listed} | {packed} | {unpacked}", shell=True, cwd=ROOT, check=True)

    def unpack(self, archive: Path, folder: str) -> None:
        """Unpacks an archive with one folder at its top into a folder of the system."""
        self.path(folder).mkdir(parents=True, exist_ok=True)
        into = ["--directory", str(self.path(folder)), "--strip-components", "1"]
        _run("tar", "--extract", "--no-same-owner", "--file", str(archive), *into)

    def run(
        self,
        *command: str,
        folder: str = "/root",
        user: str = "root",
        network: bool = True,
        environment: Mapping[str, str] | None = None,
    ) -> str:
        """Runs a command inside; returns its output. Raises Problem if the command fails."""
        alone = () if network else ("--net",)
        paths = (str(self.folder), str(_CACHE), folder)
        return _run(
            *(*_OWN_MOUNTS, *alone, "sh", "-c", _ENTER, "sh", *paths, user, *command),
            shown=shlex.join(command),
            environment={
                "PATH": "/usr/sbin:/usr/bin:/sbin:/bin",
                "LC_ALL": "C.UTF-8",
                "SSL_CERT_FILE": _OWN_CERTIFICATES,
                **(environment or {}),
            },
        )


def _run(*command: str, shown: str = "", environment: Mapping[str, str] | None = None) -> str:
    """Returns the output of a command. Raises Problem with the output if it fails."""
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        words = done.stdout[-2000:] + done.stderr[-4000:]
        raise Problem(f"exit code {done.returncode} of: {shown or shlex.join(command)}\n{words}")
    return done.stdout
