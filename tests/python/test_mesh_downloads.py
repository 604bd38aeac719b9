"""`scripts/meshes --from`, with small files structured like users' downloads."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import re
import subprocess
from pathlib import Path

import pytest

from beambench_meshes import downloaded
from beambench_meshes.downloads import DOWNLOADS, Version
from beambench_meshes.problem import Problem
from program import BINARY, beambench

# Like Crytek's file: a material library, groups, quads with texture coordinates, centimeters, y up.
SPONZA = """# The atrium, cut down to a floor and a wall
mtllib sponza.mtl
g floor
usemtl stone
v -1900 0 -1100
v 1800 0 -1100
v 1800 0 1100
v -1900 0 1100
vt 0 0
f 1/1 2/1 3/1 4/1
g wall
usemtl brick
v 1800 1400 1100
v -1900 1400 1100
f 4/1 3/1 5/1
f 4/1 5/1 6/1
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An unpacked archive with the scene in its own folder."""
    monkeypatch.setenv("BEAMBENCH_CACHE", str(tmp_path / "cache"))
    place = tmp_path / "downloads/crytek_sponza"
    place.mkdir(parents=True)
    (place / "Sponza.obj").write_text(SPONZA)
    (place / "sponza.mtl").write_text(
        "newmtl stone\nKd 0.6 0.6 0.5\nnewmtl brick\nKd 0.7 0.4 0.3\n"
    )
    return tmp_path / "downloads"


def register(
    repository: Path, folder: Path, name: str = "sponza"
) -> subprocess.CompletedProcess[str]:
    command = [repository / "scripts/meshes", "--beambench", BINARY, "--from", folder, name]
    return subprocess.run(
        [str(part) for part in command], capture_output=True, text=True, check=False
    )


def test_a_download_is_registered_where_it_lies(repository: Path, folder: Path) -> None:
    done = register(repository, folder)
    assert done.returncode == 0, done.stderr
    file = folder / "crytek_sponza/Sponza.obj"
    checksum = hashlib.sha256(SPONZA.encode()).hexdigest()
    assert f"== {file}: 4 triangles, SHA-256 {checksum}\n" in done.stdout
    assert (
        "No published version has as many triangles: there are 262,267 (Crytek's), or 66,450"
        in done.stdout
    )
    assert done.stdout.endswith("== mesh:sponza has 4 triangles\n")
    entry = json.loads((folder.parent / "cache/registered/sponza.json").read_text())
    assert (entry["path"], entry["sha256"]) == (str(file), checksum)
    assert "cameras" not in entry
    scene = json.loads(beambench("scene", "mesh:sponza", "--json").stdout)
    assert scene["surfaces"] == 2

    file.write_text(SPONZA.replace("1400", "1300"))
    again = register(repository, folder)
    assert again.returncode == 0
    assert f"has changed since it was registered (SHA-256 {checksum})" in again.stdout


def known(version: Version) -> downloaded.Download:
    return dataclasses.replace(downloaded.find("sponza"), versions=(version,))


def registered(folder: Path, version: Version) -> dict[str, object]:
    cache = folder.parent / "cache"
    (cache / "registered").mkdir(parents=True, exist_ok=True)
    download = known(version)
    downloaded.register(download, downloaded.find_file(folder, download), cache, BINARY)
    entry = json.loads((cache / "registered/sponza.json").read_text())
    assert isinstance(entry, dict)
    return entry


def test_a_published_version_gets_its_cameras(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    crytek = downloaded.find("sponza").versions[0]
    entry = registered(folder, dataclasses.replace(crytek, triangles=4))
    said = capsys.readouterr().out
    assert "As many triangles as Crytek's has; no SHA-256 is published\n" in said
    assert "Cameras by this project: 1 of 1\n" in said
    scene = json.loads(beambench("scene", "mesh:sponza", "--json").stdout)
    assert scene["cameras"][0]["name"] == "nave"
    assert (
        entry["about"]
        == "The atrium of the palace Sponza in Dubrovnik, 4 triangles (Sponza.obj, Crytek's)"
    )


def test_cameras_outside_of_the_mesh_are_left_out(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = folder / "crytek_sponza/Sponza.obj"
    file.write_text(re.sub(r"(\d)00\b", r"\1", SPONZA))  # in meters
    crytek = downloaded.find("sponza").versions[0]
    entry = registered(folder, dataclasses.replace(crytek, triangles=4))
    assert "0 of 1; the others are outside of this mesh" in capsys.readouterr().out
    assert "cameras" not in entry


def test_checksums_and_rounded_counts_are_compared(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    checksum = hashlib.sha256(SPONZA.encode()).hexdigest()
    registered(folder, Version(4, "this one", sha256=checksum))
    assert "and the SHA-256 is the published one" in capsys.readouterr().out
    registered(folder, Version(4, "this one", sha256="0" * 64))
    assert "but the SHA-256 is not the published one" in capsys.readouterr().out
    registered(folder, Version(6, "that of papers", within=2))
    assert "As many triangles as that of papers has" in capsys.readouterr().out
    registered(folder, Version(7, "that of papers", within=2))
    assert "No published version has as many" in capsys.readouterr().out


def test_a_file_that_cannot_be_read_is_named_and_not_registered(
    repository: Path, folder: Path
) -> None:
    (folder / "crytek_sponza/Sponza.obj").write_text("v 0 0 0\n")
    done = register(repository, folder)
    assert done.returncode == 2
    assert done.stderr.startswith("error: ")
    assert "Sponza.obj" in done.stderr
    assert done.stderr.count("\n") == 1
    assert list((folder.parent / "cache/registered").iterdir()) == []


def test_the_first_of_the_expected_files_is_taken_wherever_it_lies(tmp_path: Path) -> None:
    download = downloaded.find("san-miguel")
    for place in ("b/sanmiguel.obj", "deep/er/san-miguel.obj", "a/SAN-MIGUEL.OBJ"):
        (tmp_path / place).parent.mkdir(parents=True)
        (tmp_path / place).touch()
    assert downloaded.find_file(tmp_path, download) == tmp_path / "a/SAN-MIGUEL.OBJ"
    with pytest.raises(Problem, match=r"holds no powerplant.obj; unpack it there: power-plant is"):
        downloaded.find_file(tmp_path, downloaded.find("power-plant"))


@pytest.mark.parametrize("download", DOWNLOADS, ids=lambda download: download.name)
def test_a_download_says_what_is_known_of_it(download: downloaded.Download) -> None:
    assert download.where
    assert download.license
    assert download.files
    for version in download.versions:
        assert version.which
        assert not version.sha256 or re.fullmatch(r"[0-9a-f]{64}", version.sha256)
        assert bool(version.cameras) == bool(version.cameras_by)
