"""Registers meshes that the user downloaded."""

from __future__ import annotations

import contextlib
import json
from pathlib import Path

from beambench_meshes.downloads import DOWNLOADS, Download, Version
from beambench_meshes.entry import Camera, Loaded, load, sha256, write_entry
from beambench_meshes.problem import Problem
from beambench_meshes.say import say


def find(name: str) -> Download:
    """Returns the scene with that name. Raises Problem if there is none, with the known names."""
    for download in DOWNLOADS:
        if download.name == name:
            return download
    names = ", ".join(download.name for download in DOWNLOADS)
    raise Problem(f"--from has no scene '{name}', only {names}")


def find_file(folder: Path, download: Download) -> Path:
    """Returns the scene's file in the folder or below.

    Raises Problem if there is no such file, with the place to get it from.
    """
    expected = " or ".join(download.files)
    get = f"{download.name} is from {download.where}"
    if not folder.is_dir():
        raise Problem(f"{folder} is not a folder; give the one that holds {expected}: {get}")
    wanted = [file.lower() for file in download.files]
    found = [file for file in folder.rglob("*") if file.name.lower() in wanted and file.is_file()]
    if not found:
        raise Problem(f"{folder} holds no {expected}; unpack it there: {get}")
    return min(found, key=lambda file: (wanted.index(file.name.lower()), len(file.parts), file))


def register(download: Download, file: Path, cache: Path, beambench: Path) -> None:
    """Registers a file and compares it with the published facts about it. Raises Problem."""
    entry = cache / "registered" / f"{download.name}.json"
    former = _former(entry)
    checksum = sha256(file)
    if former.get("path") == str(file) and former.get("sha256", checksum) != checksum:
        say(f"{file} has changed since it was registered (SHA-256 {former['sha256']})")
    content: dict[str, object] = {
        "path": str(file),
        "up": download.up,
        "front": download.front,
        "about": f"{download.what} ({file.name}, downloaded)",
        "license": download.license,
        "sha256": checksum,
    }
    # Without cameras first: the right cameras depend on the contents of the file.
    write_entry(entry, content)
    try:
        loaded = load(beambench, download.name)
    except Problem:
        entry.unlink()
        raise
    total = loaded.triangles + loaded.without_area
    say(f"{file}: {total} triangles, SHA-256 {checksum}")
    version = _version(download, total)
    _compare(download, version, checksum)
    if version is not None:
        content |= {"up": version.up or download.up, "front": version.front or download.front}
        content["about"] = f"{download.what}, {total:,} triangles ({file.name}, {version.which})"
        content["cameras"] = _cameras(version, loaded)
        write_entry(entry, content)
        load(beambench, download.name)
    say(f"mesh:{download.name} has {loaded.triangles} triangles")


def _former(entry: Path) -> dict[str, object]:
    """Returns the entry written by an earlier call; empty if there is none or it cannot be read."""
    with contextlib.suppress(OSError, ValueError):
        content = json.loads(entry.read_text())
        if isinstance(content, dict):
            return content
    return {}


def _version(download: Download, triangles: int) -> Version | None:
    for version in download.versions:
        if abs(triangles - version.triangles) <= version.within:
            return version
    return None


def _compare(download: Download, version: Version | None, checksum: str) -> None:
    if version is None:
        known = ", or ".join(f"{one.triangles:,} ({one.which})" for one in download.versions)
        say(f"No published version has as many triangles: there are {known}; this is another one")
    elif version.sha256 and version.sha256 != checksum:
        say(
            f"As many triangles as {version.which} has, but the SHA-256 is not the published one, "
            f"{version.sha256}: the file may be cut off or edited"
        )
    else:
        checked = (
            "and the SHA-256 is the published one" if version.sha256 else "no SHA-256 is published"
        )
        say(f"As many triangles as {version.which} has; {checked}")


def _cameras(version: Version, loaded: Loaded) -> list[dict[str, object]]:
    """Returns the cameras whose eyes are within the mesh, because a copy may be scaled."""
    inside = [camera for camera in version.cameras if _holds(loaded, camera)]
    if version.cameras:
        say(
            f"Cameras by {version.cameras_by}: {len(inside)} of {len(version.cameras)}"
            + (
                ""
                if len(inside) == len(version.cameras)
                else "; the others are outside of this mesh, whose coordinates differ"
            )
        )
    return [camera.as_json() for camera in inside]


def _holds(loaded: Loaded, camera: Camera) -> bool:
    parts = zip(loaded.lower, camera.eye, loaded.upper, strict=True)
    return all(low <= part <= high for low, part, high in parts)
