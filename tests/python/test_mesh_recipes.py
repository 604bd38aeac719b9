"""The recipes of scripts/meshes: complete, documented, and converted if necessary."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import re
import subprocess
import zipfile
from pathlib import Path

import pytest

from beambench_meshes.entry import Camera
from beambench_meshes.fetched import Registry
from beambench_meshes.listing import licenses, rows
from beambench_meshes.packages import Package, Packages
from beambench_meshes.recipes import AC3D, QUAKE3, RECIPES, Recipe, Source
from program import BINARY, beambench
from synthetic_bsp import small_map
from synthetic_track import TRACK

CONVERTED = [recipe for recipe in RECIPES if recipe.conversion in (QUAKE3, AC3D)]
PACKAGE = Package("maps", "Debian", 1, "GPL-2+", "Nobody")


@pytest.mark.parametrize("recipe", RECIPES, ids=lambda recipe: recipe.name)
def test_a_recipe_says_what_it_needs(recipe: Recipe) -> None:
    assert re.fullmatch(r"[a-z0-9-]+", recipe.name)
    assert 10_000 <= recipe.triangles <= 5_000_000
    assert recipe.package.registry in ("Debian", "npm")
    assert recipe.package.megabytes <= 400
    assert recipe.package.license
    assert recipe.package.authors
    assert recipe.sources
    for source in recipe.sources:
        assert re.fullmatch(r"[0-9a-f]{64}", source.sha256)
    assert f"{recipe.triangles:,} triangles" in recipe.about


@pytest.mark.parametrize("recipe", CONVERTED, ids=lambda recipe: recipe.name)
def test_a_level_is_seen_by_two_to_four_cameras_as_a_person_would_stand_there(
    recipe: Recipe,
) -> None:
    names = [camera.name for camera in recipe.cameras]
    assert 2 <= len(set(names)) == len(names) <= 4
    assert not recipe.interior or recipe.lights


def test_there_are_enough_of_them() -> None:
    assert len({recipe.name for recipe in RECIPES}) == len(RECIPES)
    assert len(CONVERTED) >= 6
    assert len({recipe.package.name for recipe in CONVERTED}) >= 3
    assert sum(recipe.interior for recipe in CONVERTED) >= 2


def test_the_readme_has_a_row_for_each_mesh_and_each_package(repository: Path) -> None:
    readme = (repository / "scripts/README.md").read_text()
    for name, triangles, what, package, _ in rows():
        assert f"| `{name}` | {triangles} | {what} | `{package}` |\n" in readme
    for row in licenses():
        name, *rest = row
        assert f"| `{name}` | {' | '.join(rest)} |\n" in readme


def test_list_needs_nothing(repository: Path) -> None:
    done = subprocess.run(
        [repository / "scripts/meshes", "--list"],
        env={"PATH": "/usr/bin:/bin"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    for recipe in RECIPES:
        assert re.search(rf"^{recipe.name} +{recipe.triangles:,} ", done.stdout, re.MULTILINE)
    assert "power-plant: 12,759,246 triangles, in powerplant.obj" in done.stdout


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache with a downloaded package."""
    for name in ("packages/maps", "converted", "registered"):
        (tmp_path / name).mkdir(parents=True)
    monkeypatch.setenv("BEAMBENCH_CACHE", str(tmp_path))
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with zipfile.ZipFile(tmp_path / "packages/maps/all.pk3", "w") as archive:
        archive.writestr("maps/small.bsp", small_map().bytes())
        archive.writestr("maps/cut.bsp", small_map().bytes()[:-40])
    (tmp_path / "packages/maps/track.acc").write_text(TRACK)
    return tmp_path


def level(**changes: object) -> Recipe:
    source = Source("all.pk3", hashlib.sha256(small_map().bytes()).hexdigest(), "maps/small.bsp")
    recipe = Recipe(
        "small",
        "A small level",
        133,
        PACKAGE,
        (source,),
        QUAKE3,
        up="z",
        front="-y",
        cameras=(Camera("hall", (4.0, 4.0, 9.0), (0.0, 0.0, 0.0)),),
        lights=((3.0, 4.0, 5.0),),
    )
    return dataclasses.replace(recipe, **changes)


def test_a_level_is_converted_and_registered_with_its_cameras(
    cache: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert Registry(cache, BINARY).register(level())
    said = capfd.readouterr().out
    assert "== Converting maps/small.bsp of maps\n" in said
    assert "   patches: 1 faces, 128 triangles\n" in said
    assert said.endswith("== mesh:small has 133 triangles\n")
    entry = json.loads((cache / "registered/small.json").read_text())
    assert entry["path"] == "../converted/small.obj"
    assert entry["license"] == "GPL-2+"
    scene = json.loads(beambench("scene", "mesh:small", "--json").stdout)
    assert [camera["name"] for camera in scene["cameras"]][:2] == ["hall", "three-quarter"]
    assert [light["position"] for light in scene["lights"]] == [[3, 4, 5]]

    assert Registry(cache, BINARY).register(level())
    assert "Converting" not in capfd.readouterr().out


def test_a_track_is_converted(cache: Path, capfd: pytest.CaptureFixture[str]) -> None:
    source = Source("track.acc", hashlib.sha256(TRACK.encode()).hexdigest())
    recipe = level(name="track", triangles=5, sources=(source,), conversion=AC3D, up="", front="")
    assert Registry(cache, BINARY).register(recipe)
    assert capfd.readouterr().out.endswith("== mesh:track has 5 triangles\n")


def test_another_file_or_another_count_is_said_and_registered(
    cache: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    source = Source("all.pk3", "0" * 64, "maps/small.bsp")
    assert Registry(cache, BINARY).register(level(sources=(source,), triangles=9))
    said = capfd.readouterr().out
    assert "all.pk3, maps/small.bsp of maps has changed (SHA-256 " in said
    assert ", not 9: the mesh in the package has changed\n" in said


@pytest.mark.parametrize(
    ("source", "why"),
    [
        (Source("none.pk3", "", "maps/small.bsp"), "there is no "),
        (Source("all.pk3", "", "maps/none.bsp"), "it has no maps/none.bsp"),
        (Source("all.pk3", "", "maps/cut.bsp"), "it ends within lump"),
        (Source("track.acc", "", "maps/small.bsp"), "it cannot be read"),
    ],
)
def test_what_cannot_be_converted_is_named_and_not_registered(
    source: Source, why: str, cache: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert not Registry(cache, BINARY).register(level(sources=(source,)))
    said = capfd.readouterr()
    (line,) = [line for line in (said.out + said.err).splitlines() if "is not registered" in line]
    assert why in line
    assert source.path in line
    assert list((cache / "registered").iterdir()) == []


def test_a_package_that_cannot_be_unpacked_is_not_there(tmp_path: Path) -> None:
    package = Package("none", "Debian", 1, "", "", unpacked=("data.tar.gz", ("a.off",)))
    packages = Packages(tmp_path)
    packages._debian = lambda *_: True  # type: ignore[method-assign] # no Debian archive
    packages.fetch(package)
    assert list(tmp_path.iterdir()) == []
