"""Registers meshes by their recipes."""

from __future__ import annotations

import hashlib
import sys
from pathlib import Path

from beambench_meshes import ac3d, quake3_bsp, room
from beambench_meshes.entry import load, sha256, write_entry
from beambench_meshes.packages import Packages
from beambench_meshes.problem import Problem
from beambench_meshes.recipes import AC3D, AS_IT_IS, QUAKE3, Recipe
from beambench_meshes.say import say

_PROGRAMS = Path(__file__).parent


class Registry:
    """The cache folder of beambench: packages, converted meshes, and entries."""

    def __init__(self, cache: Path, beambench: Path) -> None:
        """Creates the folders `packages`, `converted` and `registered`."""
        self._packages = Packages(cache / "packages")
        self._converted = cache / "converted"
        self._entries = cache / "registered"
        self._beambench = beambench

    def register(self, recipe: Recipe) -> bool:
        """Fetches, converts and registers a mesh; prints the reason if that fails."""
        self._packages.fetch(recipe.package)
        folder = self._packages.folder / recipe.package.name
        for source in recipe.sources:
            if not (folder / source.path).is_file():
                say(f"mesh:{recipe.name} is not registered: there is no {folder / source.path}")
                return False
        try:
            self._compare_sources(recipe, folder)
            path = self._mesh_file(recipe, folder)
            write_entry(
                self._entries / f"{recipe.name}.json",
                {
                    "path": f"../{path.relative_to(self._entries.parent)}",
                    "up": recipe.up,
                    "front": recipe.front,
                    "about": recipe.about,
                    "license": recipe.package.license,
                    "cameras": [camera.as_json() for camera in recipe.cameras],
                    "lights": recipe.lights,
                },
            )
            loaded = load(self._beambench, recipe.name)
        except (Problem, OSError) as problem:
            print(f"mesh:{recipe.name} is not registered: {problem}", file=sys.stderr)
            return False
        left_out = loaded.without_area
        if loaded.triangles + left_out == recipe.triangles:
            also = f" (and {left_out} without area, left out)" if left_out else ""
            say(f"mesh:{recipe.name} has {loaded.triangles} triangles{also}")
        else:
            also = f" and {left_out} without area" if left_out else ""
            say(
                f"mesh:{recipe.name} has {loaded.triangles} triangles{also}, not "
                f"{recipe.triangles}: the mesh in the package has changed"
            )
        return True

    def _compare_sources(self, recipe: Recipe, folder: Path) -> None:
        """Warns if a package's files differ from those of its recipe.

        This is not an error: a later version of a package may have the same mesh, as its number of
        triangles shows.
        """
        for source in recipe.sources:
            if source.member:
                data = quake3_bsp.read_map(folder / source.path, source.member)
                found = hashlib.sha256(data).hexdigest()
            else:
                found = sha256(folder / source.path)
            if found != source.sha256:
                name = f"{source.path}, {source.member}" if source.member else source.path
                say(
                    f"{name} of {recipe.package.name} has changed "
                    f"(SHA-256 {found}, not {source.sha256}); its triangles are compared, too"
                )

    def _mesh_file(self, recipe: Recipe, folder: Path) -> Path:
        """Returns the file that beambench reads; converts the package's file if needed."""
        source = folder / recipe.sources[0].path
        if recipe.conversion == AS_IT_IS:
            return source
        target = self._converted / f"{recipe.name}.obj"
        inputs = [*(folder / one.path for one in recipe.sources), *_PROGRAMS.glob("*.py")]
        newest = max(file.stat().st_mtime for file in inputs)
        if target.is_file() and target.stat().st_mtime > newest:
            return target
        if recipe.conversion == QUAKE3:
            member = recipe.sources[0].member
            say(f"Converting {member} of {recipe.package.name}")
            try:
                level = quake3_bsp.convert(quake3_bsp.read_map(source, member), recipe.level)
            except Problem as problem:
                raise Problem(f"{source}: {member}: {problem}; {_again(recipe)}") from None
            _report(level.report())
            level.mesh.write(target)
        elif recipe.conversion == AC3D:
            say(f"Converting {source.name} of {recipe.package.name}")
            try:
                model = ac3d.convert(source.read_text("latin-1"))
            except Problem as problem:
                raise Problem(f"{source}: {problem}; {_again(recipe)}") from None
            _report(model.report())
            model.mesh.write(target)
        else:
            say("Furnishing the room")
            room.write(room.furnish(source.parent), target)
        return target


def _again(recipe: Recipe) -> str:
    return f"delete the folder {recipe.package.name} beside it, and run scripts/meshes again"


def _report(text: str) -> None:
    for line in text.splitlines():
        print(f"   {line}")
