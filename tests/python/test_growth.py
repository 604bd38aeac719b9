"""Scenes that grow: the command, and the plot of its output."""

from __future__ import annotations

import csv
import io
import json
from itertools import pairwise
from pathlib import Path

import pytest

from beambench_report.__main__ import main
from program import beambench, output_of, refused
from svg_texts import missing_in

CSV = """generator,parameter,size,primitives,bytes,seconds,scene
tetra,n,1,4,1000,0.000001,"tetra:n=1"
tetra,n,2,16,2000,0.000000,"tetra:n=2"
tetra,n,3,64,5000,0.000100,"tetra:n=3"
"""


def sizes_of(*arguments: str) -> list[dict]:
    return json.loads(output_of("scene", *arguments, "--growth", "--json"))["sizes"]


@pytest.mark.parametrize(
    ("scene", "limit", "smallest", "largest"),
    [
        ("tetra", 20000, 4, 16384),
        ("balls", 20000, 2, 7382),
        ("bumpy", 20000, 12, 10000),
        ("escena1", 3000, 1, 2900),
        ("lattice", 20000, 20, 17000),
    ],
)
def test_a_scene_grows_up_to_the_limit(scene: str, limit: int, smallest: int, largest: int) -> None:
    rows = sizes_of(scene, "--growth-limit", str(limit))
    counts = [row["primitives"] for row in rows]
    assert counts[0] == smallest
    assert largest <= counts[-1] <= limit
    for (before, after), growth in zip(pairwise(rows), pairwise(counts), strict=True):
        assert before["size"] < after["size"]
        assert growth[0] < growth[1]
        assert before["bytes"] <= after["bytes"]
    assert len(rows) < 30


def test_every_row_is_the_scene_that_it_names() -> None:
    for row in sizes_of("escena1:seed=7", "--growth-limit", "100"):
        scene = json.loads(output_of("scene", row["scene"], "--json"))
        assert scene["name"] == row["scene"] == f"escena1:seed=7,spheres={row['size']}"
        assert scene["primitives"] == row["primitives"]
        assert row["bytes"] > 20 * row["primitives"]
        assert row["seconds"] >= 0


def test_the_same_as_text_and_csv() -> None:
    arguments = ("scene", "tetra", "--growth", "--growth-limit", "300")
    rows = list(csv.DictReader(io.StringIO(output_of(*arguments, "--csv"))))
    assert [row["primitives"] for row in rows] == ["4", "16", "64", "256"]
    assert [row["scene"] for row in rows] == [f"tetra:n={n}" for n in (1, 2, 3, 4)]
    text = output_of(*arguments)
    assert all(f" {row['primitives']} " in text for row in rows)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["stetra", "--growth"], ["'stetra' has no size", "tetra", "balls"]),
        (["tetra:n=3", "--growth"], ["'n' is the size", "remove it"]),
        (["some/file.nff", "--growth"], ["has no size"]),
        (["mesh:dragon", "--growth"], ["has no size"]),
        (["balls", "--growth", "--growth-limit", "1"], ["more than 1 primitives"]),
        (["balls", "--growth", "--growth-limit", "20000000"], ["growth-limit"]),
        (["balls", "--growth", "--csv", "--json"], ["excludes"]),
        (["balls", "--csv"], ["--growth"]),
        (["nosuch", "--growth"], ["no scene 'nosuch'"]),
    ],
)
def test_wrong_requests_are_one_sentence(arguments: list[str], words: list[str]) -> None:
    refused(beambench("scene", *arguments), words)


def test_the_plot_lies_beside_the_first_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    first = tmp_path / "tetra.csv"
    first.write_text(CSV)
    second = tmp_path / "balls.csv"
    second.write_text(CSV.replace("tetra", "balls"))
    assert main(["growth", str(first), str(second)]) == 0
    assert capsys.readouterr().out.split() == [str(tmp_path / f"tetra.{e}") for e in ("png", "svg")]
    assert (tmp_path / "tetra.png").read_bytes().startswith(b"\x89PNG")
    svg = (tmp_path / "tetra.svg").read_text()
    assert all(word in svg for word in ("tetra", "balls", "primitives", "KiB", "seconds"))
    assert main(["growth", str(first), "-o", str(tmp_path / "growth.png")]) == 0
    assert (tmp_path / "growth.png").exists()
    assert (tmp_path / "growth.svg").exists()
    assert missing_in(tmp_path) == {}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (None, "there is no such file"),
        ("", "not a CSV file"),
        ("a,b\n1,2\n", "no column 'generator'"),
        (CSV.splitlines()[0] + "\n", "it has no rows"),
        (CSV.replace("64,5000", "64,many"), "column 'bytes'"),
    ],
)
def test_a_wrong_file_is_named(
    text: str | None, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "wrong.csv"
    if text is not None:
        file.write_text(text)
    assert main(["growth", str(file)]) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"error: {file}: ")
    assert message in error
    assert error.count("\n") == 1
