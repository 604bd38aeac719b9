"""The Python module: types, docstrings, its README and its example."""

from __future__ import annotations

import ast
import dataclasses
import inspect
import itertools
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from module import ENVIRONMENT, PACKAGE, bb

SOURCE = Path(__file__).resolve().parents[2] / "harness/python"


def public_members(owner: object) -> list[tuple[str, object]]:
    """Returns the public functions, classes, methods and properties."""
    return [
        (name, member)
        for name, member in vars(owner).items()
        if not name.startswith("_") or name in ("__init__", "__str__")
    ]


def callables() -> dict[str, object]:
    """Returns every public function, method and property getter by its dotted name."""
    found: dict[str, object] = {}
    for name in bb.__all__:
        thing = getattr(bb, name)
        if inspect.isclass(thing) and not issubclass(thing, Exception):
            for member_name, member in public_members(thing):
                function = getattr(member, "__func__", getattr(member, "fget", member))
                generated = dataclasses.is_dataclass(thing) and member_name == "__init__"
                if inspect.isfunction(function) and not generated:
                    found[f"{name}.{member_name}"] = function
        elif inspect.isfunction(thing):
            found[name] = thing
    return found


CALLABLES = callables()


def test_every_public_name_is_exported_and_sorted() -> None:
    assert len(bb.__all__) == len(set(bb.__all__)) > 15
    assert set(dir(bb)) >= set(bb.__all__)
    assert len(CALLABLES) > 30


@pytest.mark.parametrize("name", CALLABLES)
def test_every_function_has_types_and_a_docstring(name: str) -> None:
    function = CALLABLES[name]
    signature = inspect.signature(function)
    for parameter in signature.parameters.values():
        if parameter.name not in ("self", "cls"):
            assert parameter.annotation is not inspect.Parameter.empty, parameter
    assert signature.return_annotation is not inspect.Signature.empty
    text = inspect.getdoc(function)
    assert text
    given = [p for p in signature.parameters if p not in ("self", "cls")]
    if given and "arguments are those of `" not in text:
        described = re.findall(r"^    (\w+): ", text.split("Args:")[1], re.MULTILINE)
        assert described[: len(given)] == given, "every argument, in their order"
    takes_arrays = any("ArrayLike" in str(p.annotation) for p in signature.parameters.values())
    if takes_arrays:
        assert "Raises:" in text
        assert re.search(r"shape \(|see `closest_hits`", text, re.IGNORECASE)


@pytest.mark.parametrize("name", [n for n in bb.__all__ if inspect.isclass(getattr(bb, n))])
def test_every_class_and_attribute_has_a_docstring(name: str) -> None:
    thing = getattr(bb, name)
    assert inspect.getdoc(thing)
    if not dataclasses.is_dataclass(thing):
        return
    tree = ast.parse(Path(inspect.getsourcefile(thing) or "").read_text("utf-8"))
    (body,) = [n.body for n in tree.body if isinstance(n, ast.ClassDef) and n.name == name]
    for field, next_ in itertools.pairwise(body):
        if isinstance(field, ast.AnnAssign):
            described = isinstance(next_, ast.Expr) and isinstance(next_.value, ast.Constant)
            assert described, ast.unparse(field)


def test_the_stub_has_every_name_of_the_extension() -> None:
    from beambench import _beambench

    assert (PACKAGE / "beambench/py.typed").exists()
    tree = ast.parse((PACKAGE / "beambench/_beambench.pyi").read_text("utf-8"))
    told: dict[str, ast.stmt] = {}
    for node in tree.body:
        if isinstance(node, ast.ClassDef | ast.FunctionDef):
            told[node.name] = node
        elif isinstance(node, ast.AnnAssign):
            told[ast.unparse(node.target)] = node
    for name, thing in vars(_beambench).items():
        if name.startswith("__"):
            continue
        node = told[name]
        if isinstance(node, ast.ClassDef | ast.FunctionDef):
            assert ast.get_docstring(node), name
        if isinstance(node, ast.FunctionDef):
            arguments = [*node.args.args, *node.args.kwonlyargs]
            assert node.returns is not None, name
            assert all(a.annotation is not None for a in arguments), name
        if isinstance(node, ast.ClassDef) and not issubclass(thing, Exception):
            members = {n.name for n in node.body if isinstance(n, ast.FunctionDef)}
            assert {n for n in vars(thing) if not n.startswith("_")} <= members, name


def snippet() -> str:
    (code, *others) = re.findall(
        r"```python\n(.*?)```", (SOURCE / "README.md").read_text("utf-8"), re.DOTALL
    )
    assert others == []
    return code


def write_arrays(file: Path, mistake: float) -> None:
    """Writes random triangles, rays at them, and hits; the t of one ray is off by `mistake`."""
    random = np.random.default_rng(4)
    vertices = random.random((300, 3))
    triangles = np.arange(300).reshape(-1, 3)
    origins = np.full((500, 3), 3.0)
    directions = random.random((500, 3)) - origins
    scene = bb.Scene.from_triangles(vertices, triangles)
    hits = bb.Structure(scene, "exhaustive").closest_hits(bb.rays(origins, directions))
    t = hits.t.copy()
    t[int(np.argmax(hits.hit))] += mistake
    np.savez(
        file,
        vertices=vertices,
        triangles=triangles,
        origins=origins,
        directions=directions,
        t=t,
        ids=hits.primitive,
    )


@pytest.mark.parametrize(("mistake", "verdict"), [(0.0, "ok: 500 rays"), (0.01, "mismatch: 500")])
def test_from_arrays_to_a_verdict_in_less_than_ten_lines(
    tmp_path: Path, mistake: float, verdict: str
) -> None:
    code = snippet()
    assert len([line for line in code.splitlines() if line.strip()]) < 10
    write_arrays(tmp_path / "hits.npz", mistake)
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env=ENVIRONMENT,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(verdict)


def test_functions_of_the_readme_exist() -> None:
    text = (SOURCE / "README.md").read_text("utf-8")
    (table,) = re.findall(r"\| function \| result \|\n(.*?)\n\n", text, re.DOTALL)
    (scene, structure) = (bb.Scene("tetra:n=1"), bb.Structure(bb.Scene("tetra:n=1"), "samet"))
    owners = {"scene": scene, "structure": structure, "Scene": bb.Scene}
    named = re.findall(r"`(?:(\w+)\.|\.)?(\w+)\(", table)
    assert len(named) > 12
    for owner, name in named:
        holder = owners[owner] if owner else (bb if hasattr(bb, name) else structure)
        assert hasattr(holder, name), (owner, name)


def example(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, SOURCE / "examples/verify_mesh.py", *arguments],
        cwd=cwd,
        env={**ENVIRONMENT, "MPLCONFIGDIR": os.environ.get("MPLCONFIGDIR", str(cwd))},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def test_the_example_goes_from_a_mesh_to_a_verdict_and_a_plot(tmp_path: Path) -> None:
    from PIL import Image

    right = example("--size", "48", cwd=tmp_path)
    assert right.returncode == 0, right.stderr
    assert right.stdout.startswith("ok: 2304 rays")
    with Image.open(tmp_path / "verify_mesh.png") as picture:
        assert picture.size == (1200, 600)
        assert len(picture.convert("RGB").getcolors(1 << 20)) > 100
    wrong = example("--size", "48", "--epsilon", "0.003", "-o", "wrong.png", cwd=tmp_path)
    assert wrong.returncode == 1, wrong.stderr
    assert "structure_error, " in wrong.stdout
    with Image.open(tmp_path / "wrong.png") as picture:
        colors = {color for _, color in picture.convert("RGB").getcolors(1 << 20)}
    assert (0xD5, 0x5E, 0x00) in colors, "the color of structure_error"


def test_the_example_has_help_and_refuses_what_it_cannot_read(tmp_path: Path) -> None:
    assert "--epsilon" in example("--help", cwd=tmp_path).stdout
    refused = example("--scene", "nowhere", cwd=tmp_path)
    assert refused.returncode == 2
    assert refused.stderr.startswith("verify_mesh.py: there is no scene 'nowhere'")
    assert len(refused.stderr.splitlines()) == 1
