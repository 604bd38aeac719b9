"""Labels of contenders, titles of views, names of files, colors of structures."""

from __future__ import annotations

import pandas as pd
import pytest

from beambench_report.base.figure import looks, structure_color
from beambench_report.base.names import contender_labels, file_stems, view_titles


def contenders(*pairs: tuple[str, str]) -> pd.DataFrame:
    return pd.DataFrame(pairs, columns=["structure", "parameters"])


def test_a_label_shows_only_the_parameters_that_vary() -> None:
    rows = contenders(
        ("samet", "max_level=5,max_objects=0"),
        ("samet", "max_level=6,max_objects=0"),
        ("embree", "mode=single"),
        ("null", ""),
    )
    assert list(contender_labels(rows)) == [
        "samet max_level=5",
        "samet max_level=6",
        "embree",
        "null",
    ]


def test_a_parameter_that_only_some_variants_have_is_shown() -> None:
    rows = contenders(("embree", "mode=single"), ("embree", "mode=packet,width=8"))
    assert list(contender_labels(rows)) == ["embree mode=single", "embree mode=packet width=8"]


def views(**columns: list[object]) -> pd.DataFrame:
    count = len(next(iter(columns.values())))
    plain = {"scene": "a", "camera": "default", "samples": 1.0, "ray_kind": "primary"}
    plain |= {"machine_id": "0123456789abcdef"}
    return pd.DataFrame({name: [value] * count for name, value in plain.items()} | columns)


@pytest.mark.parametrize(
    ("rows", "titles"),
    [
        (views(scene=["a", "b"]), ["a", "b"]),
        (views(camera=["front", "back"]), ["a, camera front", "a, camera back"]),
        (views(samples=[1.0, 5.0]), ["a, 1 samples", "a, 5 samples"]),
        (views(ray_kind=["primary", "shadow"]), ["a, primary rays", "a, shadow rays"]),
        (views(scene=["a", "b"], camera=["x", "y"]), ["a", "b"]),
        (
            views(machine_id=["0123456789abcdef", "fedcba9876543210"]),
            ["a, machine 01234567", "a, machine fedcba98"],
        ),
    ],
)
def test_a_title_says_what_tells_views_apart(rows: pd.DataFrame, titles: list[str]) -> None:
    assert list(view_titles(rows)) == titles


def test_file_stems_are_plain_and_never_collide() -> None:
    stems = file_stems(["tetra:n=6", "tetra n 6", "Über/x.nff", "...", "escena1"])
    assert list(stems.values()) == ["tetra-n-6", "tetra-n-6-2", "ber-x-nff", "scene", "escena1"]


def test_variants_share_the_color_of_their_structure_and_differ_otherwise() -> None:
    rows = contenders(("samet", "max_level=5"), ("samet", "max_level=6"), ("embree", ""))
    rows["contender"] = contender_labels(rows)
    found = looks(rows)
    five, six = found["samet max_level=5"], found["samet max_level=6"]
    assert five.color == six.color == structure_color("samet") != found["embree"].color
    assert (five.marker, five.dashes) != (six.marker, six.dashes)


def test_an_unknown_structure_has_a_lasting_color() -> None:
    assert structure_color("newcomer") == structure_color("newcomer")
