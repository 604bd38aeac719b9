"""The history's page and the index, as text and in headless Chromium."""

from __future__ import annotations

import base64
import json
import struct
from pathlib import Path

import numpy as np
import pytest

from beambench_operations.__main__ import main
from beambench_operations.nightly.home import Home
from beambench_operations.nightly.mismatches import picture_mismatches
from beambench_operations.site import write
from beambench_operations.site.history_page import pack_ratios
from beambench_operations.site.write import write_site
from beambench_report.base.records import read_run
from browser import Browser
from program import sorts_tables
from synthetic_nights import add_all, counting, nothing, slower, write_nights, wrong

needs_tables = pytest.mark.skipif(not sorts_tables(), reason="DataTables was not fetched")

DOWN = ("ArrowDown", 40)
DOT = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
)


def a_program_that_renders(folder: Path) -> Path:
    """A stand-in for beambench that draws one dot and records its arguments."""
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


def history_of(home: Home) -> Path:
    [page] = (home.site / "history").glob("*.html")
    return page


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Home:
    """Three nights; in the last one, one structure was wrong and another counted more."""
    folder = tmp_path_factory.mktemp("nightly")
    home = Home(folder / "home")
    more = counting("samet", "escena1", [1, 1, 1.5])
    bad = wrong("exhaustive", "tetra:n=5", 2)
    folders = write_nights(home, 3, lambda night, row: bad(night, more(night, row)))
    add_all(home, folders)
    picture_mismatches(read_run(folders[-1]), a_program_that_renders(folder))
    asked = (folder / "asked").read_text().splitlines()
    assert asked[1].startswith("render tetra:n=5 --accel exhaustive -o ")
    assert asked[1].endswith(
        "--resolution 320x200 --samples 1 --camera default --difference oracle"
    )
    assert (
        main(["nightly", "page", "--home", str(home.folder), "--published", str(folders[0])]) == 0
    )
    return home


@pytest.fixture(scope="module")
def page(home: Home) -> Path:
    return history_of(home)


def column(browser: Browser, table: str, place: int) -> list[str]:
    return browser.evaluate(
        f"[...document.querySelectorAll('{table} tbody tr:not([hidden])')]"
        f".map(row => row.cells[{place}].innerText.trim())"
    )


def test_it_says_first_what_is_wrong(page: Path, home: Home) -> None:
    text = page.read_text()
    head = text[text.index('<header id="result">') : text.index("</header>")]
    assert "9 alarms" in head
    assert "exhaustive in tetra:n=5 at 320x200: wrong hits (mismatch)" in head
    assert "samet max_level=5 in escena1 at 640x480: traversal steps per ray from 11.5 to" in head
    assert "Times are not tested yet: this machine has 3 runs" in head
    assert "Since the run before" in head
    assert "Since the published run" in head
    assert "6 cells have different counters" in head
    assert "9 alarms in the newest run of made-up" in (home.site / "index.html").read_text()


def test_a_fine_night_says_so(tmp_path: Path) -> None:
    home = Home(tmp_path)
    add_all(home, write_nights(home, 2, nothing))
    write_site([home.folder], home.site)
    assert "No regression, all hits are correct" in history_of(home).read_text()
    assert "in the newest" not in (home.site / "index.html").read_text()


def test_nights_from_before_blocks_are_shown_and_marked(chromium: Browser, tmp_path: Path) -> None:
    home = Home(tmp_path)
    add_all(home, write_nights(home, 4, nothing, old=2))
    write_site([home.folder], home.site)
    page = history_of(home)
    text = page.read_text()
    assert "2 of the 4 runs were not measured in blocks: shown, but not" in text
    assert "this machine has 2 runs in blocks" in text
    assert text.count("<small>not measured in blocks: not compared</small>") == 2
    assert len(list((home.site / "compare").glob("*-vs-*.html"))) == 2, "none across the change"
    chromium.open(page)
    points = "[...document.querySelectorAll('#series circle')].map(dot => dot.getAttribute('fill'))"
    hollow = [fill == "none" for fill in chromium.evaluate(points)]
    assert hollow == [True, True, False, False] * 4
    chromium.open(home.site / "compare/index.html")
    chromium.evaluate(
        "(() => { const one = document.querySelector('[name=before]'); one.selectedIndex = 0;"
        " one.dispatchEvent(new Event('input', { bubbles: true })); })()"
    )
    status = "document.getElementById('status').innerText"
    for _ in range(50):
        if "not measured in blocks" in chromium.evaluate(status):
            break
    assert "One of these runs was not measured in blocks" in chromium.evaluate(status)
    assert chromium.evaluate("document.querySelectorAll('#any-table tbody tr').length") == 0
    assert chromium.complaints == []


def test_the_first_night_has_a_page_but_no_history(tmp_path: Path) -> None:
    home = Home(tmp_path)
    add_all(home, write_nights(home, 1, nothing))
    write_site([home.folder], home.site)
    assert not (home.site / "history").exists()
    assert len(list((home.site / "runs").glob("*/index.html"))) == 1


def test_alarms_are_found_without_the_history_of_the_nights_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(write, "render", lambda *_, **__: "")  # the page of each run has a plot
    home = Home(tmp_path / "home")
    write_nights(home, 30, slower("exhaustive", "tetra:n=5", 1.05, 16))
    write_site([home.folder], home.site)
    assert not home.history.exists()
    text = history_of(home).read_text()
    assert text.count("exhaustive in tetra:n=5: +") == 1
    assert "slower (+" in text
    assert "between the commits" in text


def test_a_broken_history_of_nights_stops_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    home = Home(tmp_path)
    write_nights(home, 2, nothing)
    home.history.write_bytes(b"this is no database, " * 100)
    write_site([home.folder], home.site)
    assert "nightly rebuild" in capsys.readouterr().err
    assert "2 runs" in history_of(home).read_text()


def test_ratios_are_packed_in_two_bytes_each() -> None:
    packed = pack_ratios(np.array([1.0, 2.5, np.nan, 0.0, 1e9]))
    numbers = struct.unpack("<5h", base64.b64decode(packed))
    assert numbers == (0, round(2000 * np.log(2.5)), -32768, -32768, 32767)


def test_data_of_charts_end_no_script(tmp_path: Path) -> None:
    def plant(_night: int, row: dict) -> dict:
        return {**row, "scene": f"</script><script>alert(1)//{row['scene']}"}

    home = Home(tmp_path)
    write_nights(home, 2, plant)
    write_site([home.folder], home.site)
    text = history_of(home).read_text()
    assert "<script>alert(1)" not in text
    json.loads(text.split('id="chart-data">')[1].split("</script>")[0])


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_nothing_is_complained_of_and_nothing_is_fetched(
    chromium: Browser, page: Path, scheme: str
) -> None:
    chromium.open(page, scheme=scheme)
    assert chromium.evaluate("document.querySelectorAll('#series svg').length") == 1
    assert chromium.complaints == []
    assert [at for at in chromium.requests if not at.startswith("data:")] == [page.as_uri()]
    background = chromium.evaluate("getComputedStyle(document.body).backgroundColor")
    brightness = int(background.removeprefix("rgb(").split(",")[0])
    assert (brightness < 60) == (scheme == "dark")


def test_the_chart_holds_every_night_and_contender(opened: Browser, page: Path) -> None:
    legend = "[...document.querySelectorAll('#legend li')].map(item => item.textContent)"
    names = ["embree", "exhaustive", "samet max_level=5", "samet max_level=6"]
    assert opened.evaluate(legend) == names
    points = "[...document.querySelectorAll('#series a:has(circle)')]"
    assert opened.evaluate(f"{points}.length") == 12
    titles = opened.evaluate(f"{points}.map(point => point.querySelector('title').textContent)")
    assert {title.split("\n")[0] for title in titles[:3]} == {"embree: 1 × Embree"}  # noqa: RUF001
    links = opened.evaluate(f"{points}.map(point => point.getAttribute('href'))")
    assert all((page.parent / link).is_file() for link in links)
    assert opened.evaluate("document.querySelectorAll('#series .alarm').length") == 1
    marks = "[...document.querySelectorAll('#series a:has(.commit)')]"
    assert opened.evaluate(f"{marks}.map(mark => mark.getAttribute('href'))") == [
        "#change-1",
        "#change-2",
    ]
    assert opened.evaluate("document.getElementById('change-2').innerText").count("git log -p") == 1


def test_the_keyboard_chooses_a_scene(opened: Browser) -> None:
    opened.evaluate("document.querySelector('#pick [name=view]').focus()")
    opened.press(*DOWN)
    assert opened.evaluate("document.querySelector('#pick [name=view]').value") == "tetra:n=5"
    label = "document.getElementById('series').getAttribute('aria-label')"
    assert opened.evaluate(label) == "Ratios to Embree, run by run, in tetra:n=5 at 1280x1024"
    opened.evaluate("document.querySelector('#pick [name=contender]').focus()")
    opened.press(*DOWN)
    opened.press(*DOWN)
    assert opened.evaluate("document.getElementById('legend').innerText") == "exhaustive"
    points = opened.evaluate("document.querySelectorAll('#series circle').length")
    assert points == 2, "what was wrong has no time"


def test_mismatches_are_shown_with_their_differences(opened: Browser) -> None:
    sizes = opened.evaluate(
        "[...document.querySelectorAll('#mismatches img')].map(image => image.naturalWidth)"
    )
    assert sizes == [1, 1]


@needs_tables
def test_the_index_sorts_and_filters(chromium: Browser, home: Home) -> None:
    chromium.open(home.page)
    table = "#runs-table"
    chromium.scroll_to(table)
    dates = ["2026-01-03 03:00", "2026-01-02 03:00", "2026-01-01 03:00"]
    assert column(chromium, table, 0) == dates
    chromium.evaluate(f"document.querySelector('{table} th .dt-column-order').click()")
    chromium.settle()
    assert column(chromium, table, 0) == dates[::-1]
    chromium.evaluate("document.querySelector('.dt-search input').focus()")
    chromium.call("Input.insertText", text="made-up 2026-01-03")
    assert column(chromium, table, 0) == dates[:1]
    told = chromium.evaluate("document.querySelector('.dt-info').innerText")
    assert told == "Rows 1 to 1 of 1 (of 3 in all)"
    assert chromium.complaints == []


@needs_tables
def test_two_runs_sort_and_filter(chromium: Browser, home: Home) -> None:
    [page] = (home.site / "compare").glob("20260102*-vs-*.html")
    chromium.open(page)
    table = "#cells-table"
    chromium.scroll_to(table)
    chromium.evaluate(f"document.querySelector('{table} th:nth-child(5) .dt-column-order').click()")
    chromium.settle()
    shares = [float(text.split("%")[0]) for text in column(chromium, table, 4) if text != "–"]  # noqa: RUF001
    assert len(shares) > 5
    assert shares == sorted(shares)
    chromium.evaluate("document.querySelector('.dt-search input').focus()")
    chromium.call("Input.insertText", text="max_level=5")
    assert column(chromium, table, 0) == ["samet max_level=5"] * 6


def test_any_two_runs_are_compared_as_the_pages_do(chromium: Browser, home: Home) -> None:
    [page] = (home.site / "compare").glob("20260102*-vs-*.html")
    chromium.open(page)
    cells = (
        "[...document.querySelectorAll('{} tbody tr')]"
        ".map(row => [0, 1, 4, 7].map(at => row.cells[at].innerText))"
    )
    by_python = chromium.evaluate(cells.format("#cells-table"))
    chromium.open(home.site / "compare/index.html")
    wait = "document.querySelectorAll('#any-table tbody tr').length"
    for _ in range(50):
        if chromium.evaluate(wait):
            break
    assert sorted(chromium.evaluate(cells.format("#any-table"))) == sorted(by_python)
    assert chromium.complaints == []
    assert chromium.evaluate("document.getElementById('warning').hidden")


@pytest.mark.parametrize("width", [390, 1400])
def test_no_page_scrolls_sideways(chromium: Browser, home: Home, width: int) -> None:
    pages = [home.page, history_of(home), *(home.site / "compare").glob("*.html")]
    for page in pages:
        chromium.open(page, width=width)
        assert chromium.evaluate("document.documentElement.scrollWidth") <= width, page
