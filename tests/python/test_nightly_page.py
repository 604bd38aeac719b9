"""The page of a night, as text and in headless Chromium."""

from __future__ import annotations

import base64
import json
import struct
from pathlib import Path

import numpy as np
import pytest

from beambench_report.base.records import read_run
from beambench_report.history.night import night_of
from beambench_report.history.store import History
from beambench_report.nightly.home import Home
from beambench_report.nightly.page import (
    compare_nights,
    pack_ratios,
    pareto_front,
    picture_mismatches,
    write_night_page,
)
from browser import Browser
from synthetic_nights import add_all, counting, nothing, write_nights, wrong

TAB, DOWN = ("Tab", 9), ("ArrowDown", 40)
DOT = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
)
CELLS = "#cells-table"


def a_program_that_renders(folder: Path) -> Path:
    """Stands in for beambench: draws one dot, and writes down what it was asked."""
    dot = folder / "dot.png"
    dot.write_bytes(DOT)
    program = folder / "beambench"
    program.write_text(
        f'#!/usr/bin/env bash\necho "$@" >> {folder}/asked\n'
        "while [[ $1 != -o ]]; do shift; done\n"
        f'cp {dot} "$2"\n'
    )
    program.chmod(0o755)
    return program


def page_of(home: Home, published: Path | None = None) -> Path:
    with History(home.history) as history:
        return write_night_page(home, history, published)


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three nights; in the last one a structure was wrong, and another counted more."""
    folder = tmp_path_factory.mktemp("nightly")
    home = Home(folder / "home")
    more = counting("samet", "escena1", [1, 1, 1.5])
    bad = wrong("exhaustive", "tetra:n=6", 2)
    folders = write_nights(home, 3, lambda night, row: bad(night, more(night, row)))
    add_all(home, folders)
    picture_mismatches(read_run(folders[-1]), a_program_that_renders(folder))
    asked = (folder / "asked").read_text().splitlines()
    assert asked[1].startswith("render tetra:n=6 --accel exhaustive -o ")
    assert asked[1].endswith(
        "--resolution 320x200 --samples 1 --camera default --difference oracle"
    )
    return page_of(home, folders[0])


def column(browser: Browser, table: str, place: int) -> list[str]:
    return browser.evaluate(
        f"[...document.querySelectorAll('{table} tbody tr')]"
        f".map(row => row.cells[{place}].innerText.trim())"
    )


def test_it_says_first_what_is_wrong(page: Path) -> None:
    text = page.read_text()
    head = text[text.index('<header id="result">') : text.index("</header>")]
    assert "9 alarms" in head
    assert "exhaustive in tetra:n=6 at 320x200: wrong hits (mismatch)" in head
    assert "samet max_level=5 in escena1 at 640x480: traversal steps per ray from 11.5 to" in head
    assert "Times are not tested yet: this machine has 3 nights" in head
    assert "6 cells have other counters" in text


def test_a_night_of_another_machine_is_named_as_such(tmp_path: Path) -> None:
    def elsewhere(_night: int, row: dict) -> dict:
        return row | {"machine_id": "feedfeedfeedfeed"}

    runs = {
        name: read_run(write_nights(Home(tmp_path / name), 1, plant)[0])
        for name, plant in (("here", nothing), ("again", nothing), ("there", elsewhere))
    }
    tonight, again, there = (night_of(run) for run in runs.values())
    sentences = compare_nights("the published run", tonight, there, runs["here"].rows).sentences
    assert "Of another machine: tonight 0123456789abcdef, then feedfeedfeedfeed." in sentences[0]
    assert compare_nights("yesterday", tonight, again, runs["here"].rows).sentences == []


def test_a_fine_night_says_so(tmp_path: Path) -> None:
    home = Home(tmp_path)
    add_all(home, write_nights(home, 1, nothing))
    text = page_of(home).read_text()
    assert "No regression, all hits are correct" in text
    assert "This is the first night" in text


def test_ratios_are_packed_in_two_bytes_each() -> None:
    packed = pack_ratios(np.array([1.0, 2.5, np.nan, 0.0, 1e9]))
    numbers = struct.unpack("<5h", base64.b64decode(packed))
    assert numbers == (0, round(2000 * np.log(2.5)), -32768, -32768, 32767)


def test_the_pareto_front_holds_what_nothing_beats(page: Path) -> None:
    rows = read_run(next(iter(sorted(page.parent.glob("2*"))))).rows
    one = rows[(rows["scene"] == "escena1") & (rows["width"] == 320)]
    front = set(one.loc[list(pareto_front(one)), "contender"])
    assert front == {"exhaustive", "embree"}


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_nothing_is_complained_of_and_nothing_is_fetched(
    chromium: Browser, page: Path, scheme: str
) -> None:
    chromium.open(page, scheme=scheme)
    assert chromium.evaluate("document.querySelectorAll('.js-plotly-plot').length") == 2
    assert chromium.complaints == []
    assert [at for at in chromium.requests if not at.startswith(("data:", "blob:"))] == [
        page.as_uri(),
        (page.parent / "plotly.min.js").as_uri(),
    ]
    background = chromium.evaluate("getComputedStyle(document.body).backgroundColor")
    brightness = int(background.removeprefix("rgb(").split(",")[0])
    assert (brightness < 60) == (scheme == "dark")


def test_the_charts_hold_every_night_and_contender(opened: Browser) -> None:
    lines = opened.evaluate("document.getElementById('series').data.map(line => line.name)")
    assert lines == ["exhaustive", "samet max_level=5", "samet max_level=6", "embree"]
    assert opened.evaluate("document.getElementById('series').data[1].y.length") == 3
    ratios = opened.evaluate("document.getElementById('series').data[3].y")
    assert ratios == [1, 1, 1]
    marks = opened.evaluate("document.getElementById('series').layout.shapes.length")
    assert marks == 1
    told = opened.evaluate("document.getElementById('front').innerText")
    assert told == "On the Pareto front: exhaustive, embree."


def test_the_keyboard_chooses_a_scene_and_the_table_follows(opened: Browser) -> None:
    opened.evaluate("document.querySelector('#pick [name=view]').focus()")
    opened.press(*DOWN)
    assert opened.evaluate("document.querySelector('#pick [name=view]').value") == "tetra:n=6"
    assert set(column(opened, CELLS, 1)) == {"tetra:n=6"}
    lines = opened.evaluate("document.getElementById('scatter').data.map(line => line.name)")
    assert "exhaustive" not in lines, "what was wrong has no time"


def test_the_table_sorts_and_filters(opened: Browser) -> None:
    assert set(column(opened, CELLS, 1)) == {"escena1"}
    opened.evaluate("document.querySelector('[name=filter]').select()")
    opened.call("Input.insertText", text="samet max_level=5 ratio>0")
    assert column(opened, CELLS, 0) == ["samet max_level=5"] * 6
    opened.evaluate(f"document.querySelector('{CELLS} th:nth-child(4) button').click()")
    ratios = [float(text) for text in column(opened, CELLS, 3)]
    assert ratios == sorted(ratios)
    opened.evaluate("document.querySelector('[name=filter]').select()")
    opened.press("Backspace", 8)
    opened.evaluate("document.querySelector('[name=wrong]').click()")
    assert column(opened, CELLS, 0) == ["exhaustive"] * 3


def test_the_changes_sort(opened: Browser) -> None:
    table = "#changes details[open] table"
    opened.evaluate(f"document.querySelector('{table} th:nth-child(6) button').click()")
    shares = [float(text.rstrip("%")) for text in column(opened, table, 5)]
    assert len(shares) > 5
    assert shares == sorted(shares)


def test_mismatches_are_shown_with_their_differences(opened: Browser) -> None:
    sizes = opened.evaluate(
        "[...document.querySelectorAll('#mismatches img')].map(image => image.naturalWidth)"
    )
    assert sizes == [1, 1]


def test_it_fits_a_narrow_screen(chromium: Browser, page: Path) -> None:
    chromium.open(page, width=400)
    assert chromium.evaluate("document.documentElement.scrollWidth") <= 400


def test_what_stands_in_a_record_cannot_become_script(tmp_path: Path) -> None:
    def plant(_night: int, row: dict) -> dict:
        return {**row, "scene": "</script><script>alert(1)</script>"}

    home = Home(tmp_path)
    rows_of_one = write_nights(home, 1, plant)
    with (rows_of_one[0] / "results.csv").open() as file:
        assert "<script>" in file.read()
    # Both scenes have one name now: keep one of each cell.
    path = rows_of_one[0] / "results.csv"
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join(lines[: 1 + (len(lines) - 1) // 2]))
    add_all(home, rows_of_one)
    text = page_of(home).read_text()
    assert "<script>alert(1)" not in text
    json.loads(text.split('id="chart-data">')[1].split("</script>")[0])
