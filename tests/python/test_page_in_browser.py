"""The page of a run in headless Chromium: it sorts, filters, prints, and reports no errors.

DataTables sorts and filters the tables; the tests check that our pages pass their tables correctly.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from beambench_report.base.records import read_run
from beambench_report.run import html
from beambench_report.run.page import render, write_page
from browser import Browser
from program import sorts_tables
from synthetic_run import synthetic_rows, write_run

pytestmark = pytest.mark.skipif(not sorts_tables(), reason="DataTables was not fetched")

ENTER = ("Enter", 13, "\r")
TAB = ("Tab", 9)

COLUMN = "[...document.querySelectorAll('{} tbody tr')].map(row => row.cells[{}].innerText.trim())"
CELLS = "#cells-table"


@pytest.fixture(scope="module")
def page(full_run: Path) -> Path:
    """The page of an invented run."""
    return write_page(full_run)[0]


@pytest.fixture
def opened(chromium: Browser, page: Path) -> Browser:
    """The browser with the page freshly opened, at the table of all cells."""
    chromium.open(page)
    chromium.scroll_to(CELLS)
    return chromium


def column(browser: Browser, table: str, place: int) -> list[str]:
    """Returns the texts of one column of a table, from top to bottom."""
    return browser.evaluate(COLUMN.format(table, place))


def type_filter(browser: Browser, text: str) -> str:
    """Types into the filter of all cells; returns the displayed number of rows."""
    browser.evaluate("document.querySelector('#cells .dt-search input').select()")
    if text:
        browser.call("Input.insertText", text=text)
    else:
        browser.press("Backspace", 8)
    return shown(browser)


def shown(browser: Browser) -> str:
    """Returns the displayed number of rows of all cells."""
    return browser.evaluate("document.querySelector('#cells .dt-info').innerText")


def press_heading(browser: Browser, table: str, place: int) -> None:
    """Sorts by a column, counted from 1."""
    browser.scroll_to(table)
    browser.evaluate(
        f"document.querySelector('{table} th:nth-child({place}) .dt-column-order').click()"
    )
    browser.settle()


def open_filter(browser: Browser, place: int) -> None:
    """Opens the filter of a column of all cells, counted from 1."""
    browser.evaluate(f"document.querySelector('{CELLS} th:nth-child({place}) button').click()")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_nothing_is_complained_of_and_nothing_is_fetched(
    chromium: Browser, page: Path, scheme: str
) -> None:
    chromium.open(page, scheme=scheme)
    assert chromium.complaints == []
    assert [at for at in chromium.requests if not at.startswith("data:")] == [page.as_uri()]
    background = chromium.evaluate("getComputedStyle(document.body).backgroundColor")
    brightness = int(background.removeprefix("rgb(").split(",")[0])
    assert (brightness < 60) == (scheme == "dark")


def test_complaints_and_requests_would_be_noticed(chromium: Browser, tmp_path: Path) -> None:
    bad = tmp_path / "bad.html"
    bad.write_text("<img src='missing.png'><script>console.error('x'); nothing.here</script>")
    chromium.open(bad)
    assert len(chromium.complaints) >= 2
    assert any("missing.png" in address for address in chromium.requests)


def test_a_heading_sorts_a_table_of_a_view(opened: Browser) -> None:
    table = "#view-escena1 > .wide table"
    opened.scroll_to(table)
    before = column(opened, table, 0)
    reference = "\nreference"
    assert before[0] == "embree"
    assert {name.removesuffix(reference) for name in before[-2:]} == {"null", "exhaustive"}
    press_heading(opened, table, 10)  # memory
    assert column(opened, table, 0)[-1] == "samet max_level=6"
    press_heading(opened, table, 10)
    assert column(opened, table, 0)[0] == "samet max_level=6"
    sorts = f"document.querySelector('{table} th:nth-child(10)').getAttribute('aria-sort')"
    assert opened.evaluate(sorts) == "descending"
    press_heading(opened, table, 1)
    assert column(opened, table, 0) == sorted(before)


def test_a_link_opens_one_cell(opened: Browser) -> None:
    link = "#view-escena1 tbody th a"
    opened.evaluate(f"document.querySelector('{link}').click()")
    opened.settle()
    text = opened.evaluate("document.getElementById('one-cell').innerText")
    assert text.startswith("embree, escena1, 1280x1024")
    assert "trace ms median" in text
    opened.evaluate("location.hash = '#cell-nobody'; dispatchEvent(new Event('hashchange'))")
    assert "no cell" in opened.evaluate("document.getElementById('one-cell').innerText")


def test_a_column_compares_its_figures(opened: Browser) -> None:
    open_filter(opened, 6)
    opened.evaluate(
        "(() => { const kind = document.querySelector('.dtcc-dropdown select');"
        " kind.value = 'less';"
        " for (const name of ['input', 'change']) kind.dispatchEvent(new Event(name)); })()"
    )
    opened.evaluate("document.querySelector('.dtcc-dropdown input').focus()")
    opened.call("Input.insertText", text="1")
    traces = [float(text) for text in column(opened, CELLS, 5)]
    assert traces == [0.256, 0.256]


def test_a_column_of_texts_offers_them(opened: Browser) -> None:
    open_filter(opened, 10)
    labels = "[...document.querySelectorAll('.dtcc-list .dtcc-button')].map(one => one.innerText)"
    assert opened.evaluate(labels) == ["ok", "baseline", "mismatch"]
    opened.evaluate("document.querySelectorAll('.dtcc-list .dtcc-button')[2].click()")
    assert column(opened, CELLS, 0) == ["samet max_level=6"] * 3
    assert shown(opened) == "Rows 1 to 3 of 3 (of 30 in all)"


def test_what_was_not_measured_stays_last(opened: Browser) -> None:
    table = "#view-tetra-n-5 > .wide table"
    for _ in range(2):
        press_heading(opened, table, 3)
        assert column(opened, table, 0)[-1].startswith("samet max_level=6")


def test_the_keyboard_sorts(opened: Browser) -> None:
    order = f"document.querySelector('{CELLS} th:nth-child(5) .dt-column-order')"
    opened.evaluate(f"{order}.focus()")
    opened.press(*ENTER)
    opened.settle()
    sorts = f"[...document.querySelectorAll('{CELLS} th')].map(th => th.getAttribute('aria-sort'))"
    assert opened.evaluate(sorts).count("ascending") == 1
    assert opened.evaluate(sorts)[4] == "ascending"
    figures = [float(text.replace(",", "")) for text in column(opened, CELLS, 4)]
    assert figures == sorted(figures)
    assert opened.evaluate(f"document.activeElement === {order}")
    opened.press(*ENTER)
    opened.settle()
    assert opened.evaluate(sorts)[4] == "descending"


def test_the_keyboard_passes_a_table_at_once(opened: Browser) -> None:
    opened.evaluate("document.querySelector('a[href=\"#past-all-cells\"]').focus()")
    assert opened.evaluate("document.activeElement.getBoundingClientRect().left") >= 0
    opened.press(*ENTER)
    opened.press(*TAB)
    after = (
        "!!(document.getElementById('past-all-cells').compareDocumentPosition"
        "(document.activeElement) & Node.DOCUMENT_POSITION_FOLLOWING)"
    )
    assert opened.evaluate(after)
    tables = opened.evaluate("document.querySelectorAll('main table').length")
    assert opened.evaluate("document.querySelectorAll('a.past').length") == tables


@pytest.mark.parametrize(
    ("words", "count"),
    [
        ("samet", "Rows 1 to 12 of 12 (of 30 in all)"),
        ("SAMET escena1", "Rows 1 to 6 of 6 (of 30 in all)"),
        ("max_level=5 320x200", "Rows 1 to 2 of 2 (of 30 in all)"),
        ("!samet escena1", "Rows 1 to 9 of 9 (of 30 in all)"),
        ("nothing-of-the-sort", "No row matches (of 30 in all)"),
        ("", "Rows 1 to 25 of 30"),
    ],
)
def test_words_filter(opened: Browser, words: str, count: str) -> None:
    assert type_filter(opened, words) == count


def test_the_address_keeps_the_filter(opened: Browser) -> None:
    count = type_filter(opened, "embree !tetra")
    assert opened.evaluate("decodeURIComponent(location.hash)") == "#filter=embree !tetra"
    type_filter(opened, "")
    assert opened.evaluate("location.hash") == "#cells"
    opened.evaluate("location.hash = '#filter=embree%20!tetra'")
    opened.settle()
    assert shown(opened) == count


def test_the_card_of_a_cell_closes_with_the_way_back(opened: Browser) -> None:
    opened.evaluate("location.hash = '#cell-nobody'; dispatchEvent(new Event('hashchange'))")
    assert not opened.evaluate("document.getElementById('one-cell').hidden")
    opened.evaluate("location.hash = '#cells'; dispatchEvent(new Event('hashchange'))")
    assert opened.evaluate("document.getElementById('one-cell').hidden")


def test_a_filter_keeps_the_order(opened: Browser) -> None:
    press_heading(opened, CELLS, 7)
    type_filter(opened, "embree")
    totals = [float(text.replace(",", "")) for text in column(opened, CELLS, 6)]
    assert len(totals) == 6
    assert totals == sorted(totals)


def test_pages_turn(opened: Browser) -> None:
    first = column(opened, CELLS, 0)
    opened.evaluate("document.querySelector('.dt-paging-button.next').click()")
    assert len(column(opened, CELLS, 0)) == 5
    assert (
        opened.evaluate("document.querySelector('.dt-paging-button.next').ariaDisabled") == "true"
    )
    opened.evaluate("document.querySelector('.dt-paging-button.previous').click()")
    assert column(opened, CELLS, 0) == first


def test_groups_of_columns_can_be_shown(opened: Browser) -> None:
    heads = f"[...document.querySelectorAll('{CELLS} th')].map(head => head.innerText)"
    assert "total_ms_ci_low" not in opened.evaluate(heads)
    opened.evaluate("document.querySelector('[name=group][value=times]').click()")
    assert "total_ms_ci_low" in opened.evaluate(heads)


def test_texts_of_a_record_are_no_code(chromium: Browser, tmp_path: Path) -> None:
    evil = "a&b <img src=x onerror=console.error(1)>"
    rows = [{**row, "scene": row["scene"].replace("escena1", evil)} for row in synthetic_rows()]
    chromium.open(write_page(write_run(tmp_path, rows))[0])
    chromium.scroll_to(CELLS)
    type_filter(chromium, "onerror")
    open_filter(chromium, 2)
    assert evil in column(chromium, CELLS, 1)[0]
    labels = "[...document.querySelectorAll('.dtcc-list .dtcc-button')].map(one => one.innerText)"
    assert any(evil in label for label in chromium.evaluate(labels))
    assert chromium.complaints == []
    assert chromium.evaluate("document.querySelectorAll('img[src=x]').length") == 0


def test_tables_are_shown_without_javascript(chromium: Browser, page: Path) -> None:
    chromium.call("Emulation.setScriptExecutionDisabled", value=True)
    try:
        chromium.open(page)
    finally:
        chromium.call("Emulation.setScriptExecutionDisabled", value=False)
    assert len(column(chromium, CELLS, 0)) == 30
    assert len(column(chromium, "#view-escena1 > .wide table", 0)) == 5
    assert chromium.evaluate("document.querySelector('.dt-search')") is None


def test_tables_are_shown_without_the_library(
    chromium: Browser, full_run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(html, "LIBRARY", tmp_path)
    html.environment.cache_clear()
    text = render(read_run(full_run), drawn_kinds=())
    html.environment.cache_clear()
    assert "fetch it with scripts/viewer" in text
    bare = tmp_path / "bare.html"
    bare.write_text(text)
    chromium.open(bare)
    assert chromium.complaints == []
    assert len(column(chromium, CELLS, 0)) == 30
    chromium.evaluate("document.querySelector('a[href^=\"#cell-\"]').click()")
    chromium.settle()
    assert not chromium.evaluate("document.getElementById('one-cell').hidden")


@pytest.mark.parametrize("width", [400, 1400])
def test_it_fits_the_screen_with_all_tables_prepared(
    chromium: Browser, page: Path, width: int
) -> None:
    chromium.open(page, width=width)
    chromium.evaluate("document.querySelectorAll('details').forEach(one => one.open = true)")
    tables = chromium.evaluate("document.querySelectorAll('table.sortable').length")
    for place in range(tables):
        chromium.evaluate(
            f"document.querySelectorAll('table.sortable')[{place}].scrollIntoView("
            "{behavior: 'instant'})"
        )
        chromium.settle()
    chromium.scroll_to(CELLS)
    assert chromium.evaluate("DataTable.tables().length") == tables + 1
    assert chromium.evaluate("document.documentElement.scrollWidth") <= width
    assert chromium.complaints == []


def test_it_prints_with_everything_opened(opened: Browser, tmp_path: Path) -> None:
    opened.evaluate(
        "addEventListener('beforeprint', () => {"
        "  window.closed_ones = document.querySelectorAll('details:not([open])').length; })"
    )
    closed = opened.evaluate("document.querySelectorAll('details:not([open])').length")
    opened.pdf(tmp_path / "page.pdf")
    assert (tmp_path / "page.pdf").read_bytes().startswith(b"%PDF")
    assert opened.evaluate("window.closed_ones") == 0 < closed
    assert opened.evaluate("document.querySelectorAll('details:not([open])').length") == closed
