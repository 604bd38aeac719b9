"""Beams of mirror images in the thesis report, from the output of `beambench mirrors --json`."""

from __future__ import annotations

import json
from pathlib import Path

from beambench_thesis.chapter5.mirrors import mirrors_section, read_mirrors
from beambench_thesis.paper.section import section_as_markdown
from program import output_of


def write(file: Path, *parts: tuple[int, int, float, float], **changes: str) -> Path:
    names = ("samples", "different", "rays_ms", "beams_ms")
    source = {
        "scene": "teapot:n=12",
        "structure": "beam",
        "resolution": "640x480",
        "seen": [dict(zip(names, part, strict=True)) for part in parts],
    } | changes
    file.write_text(json.dumps(source))
    return file


def test_the_mirrors_of_a_picture_add_up(tmp_path: Path) -> None:
    file = write(tmp_path / "a.json", (100, 0, 3.0, 2.0), (300, 1, 6.0, 1.0))
    (run,), unread = read_mirrors([file])
    assert not unread
    assert (run.mirrors, run.samples, run.different, run.ratio) == (2, 400, 1, 3.0)


def test_the_section_has_a_row_for_each_run(tmp_path: Path) -> None:
    files = [
        write(tmp_path / "large.json", (9, 0, 5.0, 10.0), resolution="1280x1024"),
        write(tmp_path / "small.json", (9, 0, 30.0, 10.0)),
    ]
    section = mirrors_section(read_mirrors(files)[0])
    assert section is not None
    text = section_as_markdown(section)
    assert "less time than single rays in 1 of 2 rows (0.500 to 3.00 times as fast; medians" in text
    assert "Hits that differ: 0 of 18." in text
    assert text.index("640x480") < text.index("1280x1024")
    assert mirrors_section([]) is None


def test_what_cannot_be_read_is_said(tmp_path: Path) -> None:
    (tmp_path / "bad.json").write_text("{}")
    still = write(tmp_path / "still.json", (9, 0, 0.0, 10.0))
    found, unread = read_mirrors([tmp_path / "bad.json", still])
    assert not found
    assert "bad.json: is not what `beambench mirrors --json` prints" in unread[0]
    assert "times must be positive" in unread[1]


def test_the_program_prints_what_is_read(tmp_path: Path) -> None:
    file = tmp_path / "teapot.json"
    small = ("--resolution", "64x48", "--repetitions", "1", "--json")
    file.write_text(output_of("mirrors", "teapot:n=2", *small))
    (run,), unread = read_mirrors([file])
    assert not unread
    assert run.different == 0
    assert run.samples > 0
