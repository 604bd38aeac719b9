"""The page of a run in headless Chromium: it sorts, filters, prints, and reports no errors."""

from __future__ import annotations

from pathlib import Path

import pytest

from beambench_report.run.page import write_page
from browser import Browser

ENTER = ("Enter", 13, "\r")
TAB = ("Tab", 9)

COLUMN = "[...document.querySelectorAll('{} tbody tr')].map(row => row.cells[{}].innerText.trim())"
CELLS = "#cells-table"


@pytest.fixture(scope="module")
def page(full_run: Path) -> Path:
    """The page of an invented run."""
    return write_page(full_run)[0]


def column(browser: Browser, table: str, place: int) -> list[str]:
    """Returns the texts of one column of a table, from top to bottom."""
    return browser.evaluate(COLUMN.format(table, place))


def type_filter(browser: Browser, text: str) -> str:
    """Types into the filter; returns the displayed number of rows."""
    browser.evaluate("document.querySelector('[name=filter]').select()")
    if text:
        browser.call("Input.insertText", text=text)
    else:
        browser.press("Backspace", 8)
    return browser.evaluate("document.getElementById('cells-count').innerText")


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
    before = column(opened, table, 0)
    reference = "\nreference"
    assert before[0] == "embree"
    assert {name.removesuffix(reference) for name in before[-2:]} == {"null", "exhaustive"}
    press = f"document.querySelector('{table} th:nth-child({{}}) button').click()"
    opened.evaluate(press.format(10))  # memory
    assert column(opened, table, 0)[-1] == "samet max_level=6"
    opened.evaluate(press.format(10))
    assert column(opened, table, 0)[0] == "samet max_level=6"
    sorts = f"document.querySelector('{table} th:nth-child(10)').getAttribute('aria-sort')"
    assert opened.evaluate(sorts) == "descending"
    opened.evaluate(press.format(1))
    assert column(opened, table, 0) == sorted(before)


def test_a_link_opens_one_cell(opened: Browser) -> None:
    link = "#view-escena1 tbody th a"
    opened.evaluate(f"document.querySelector('{link}').click()")
    opened.evaluate("new Promise(done => setTimeout(done, 50))")
    text = opened.evaluate("document.getElementById('one-cell').innerText")
    assert text.startswith("embree, escena1, 1280x1024")
    assert "trace ms median" in text
    opened.evaluate("location.hash = '#cell-nobody'; dispatchEvent(new Event('hashchange'))")
    assert "no cell" in opened.evaluate("document.getElementById('one-cell').innerText")


def test_the_filter_reports_what_it_does_not_understand(opened: Browser) -> None:
    problem = "document.getElementById('filter-problem').innerText"
    everything = type_filter(opened, "")
    assert type_filter(opened, "nosuch=3") == everything
    assert "there is no column 'nosuch'" in opened.evaluate(problem)
    type_filter(opened, "trace_ms_median<abc")
    assert "'abc' is not a number" in opened.evaluate(problem)
    type_filter(opened, "verdict<ok")
    assert "holds texts" in opened.evaluate(problem)
    assert type_filter(opened, "verdict=mismatch") != everything
    assert opened.evaluate("document.getElementById('filter-problem').hidden")
    assert type_filter(opened, "max_level=6") != everything  # a text in the row


def test_what_was_not_measured_stays_last(opened: Browser) -> None:
    table = "#view-tetra-n-5 > .wide table"
    for _ in range(2):
        opened.evaluate(f"document.querySelector('{table} th:nth-child(3) button').click()")
        assert column(opened, table, 0)[-1].startswith("samet max_level=6")


def test_the_keyboard_sorts(opened: Browser) -> None:
    opened.evaluate(f"document.querySelector('{CELLS} th:nth-child(4) button').focus()")
    opened.press(*TAB)
    opened.press(*ENTER)
    sorts = f"[...document.querySelectorAll('{CELLS} th')].map(th => th.getAttribute('aria-sort'))"
    assert opened.evaluate(sorts).count("ascending") == 1
    assert opened.evaluate(sorts)[4] == "ascending"
    shown = [float(text.replace(",", "")) for text in column(opened, CELLS, 4) if text[0].isdigit()]
    assert shown == sorted(shown)
    opened.press(*ENTER)  # the heading keeps the focus
    assert opened.evaluate(sorts)[4] == "descending"


@pytest.mark.parametrize(
    ("words", "count"),
    [
        ("samet", "Rows 1 to 12 of 12, of 30 in all"),
        ("SAMET escena1", "Rows 1 to 6 of 6, of 30 in all"),
        ("max_level=5 320x200", "Rows 1 to 2 of 2, of 30 in all"),
        ("trace_ms_median<1 null", "Rows 1 to 2 of 2, of 30 in all"),
        ("memory_bytes=150000", "Rows 1 to 6 of 6, of 30 in all"),
        ("nothing-of-the-sort", "No row has all of that"),
        ("", "Rows 1 to 25 of 30"),
    ],
)
def test_words_filter(opened: Browser, words: str, count: str) -> None:
    assert type_filter(opened, words) == count


def test_a_filter_excludes_words_and_values_and_takes_blanks(opened: Browser) -> None:
    embree = type_filter(opened, "embree")
    others = type_filter(opened, "-embree")
    assert others != embree
    assert not any("embree" in text for text in column(opened, CELLS, 0))
    assert type_filter(opened, "verdict!=ok") == type_filter(opened, "verdict != ok")
    assert type_filter(opened, "trace_ms_median < 10") == type_filter(opened, "trace_ms_median<10")
    assert opened.evaluate("document.getElementById('filter-problem').hidden")


def test_the_address_keeps_the_filter(opened: Browser) -> None:
    count = type_filter(opened, "embree -tetra")
    assert opened.evaluate("decodeURIComponent(location.hash)") == "#filter=embree -tetra"
    type_filter(opened, "")
    assert opened.evaluate("location.hash") == "#cells"
    opened.evaluate("location.hash = '#filter=embree%20-tetra'")
    opened.evaluate("new Promise(done => setTimeout(done, 50))")
    assert opened.evaluate("document.getElementById('cells-count').innerText") == count


def test_the_card_of_a_cell_closes_with_the_way_back(opened: Browser) -> None:
    opened.evaluate("location.hash = '#cell-nobody'; dispatchEvent(new Event('hashchange'))")
    assert not opened.evaluate("document.getElementById('one-cell').hidden")
    opened.evaluate("location.hash = '#cells'; dispatchEvent(new Event('hashchange'))")
    assert opened.evaluate("document.getElementById('one-cell').hidden")


def test_a_filter_keeps_the_order(opened: Browser) -> None:
    opened.evaluate(f"document.querySelector('{CELLS} th:nth-child(7) button').click()")
    type_filter(opened, "embree")
    totals = [float(text.replace(",", "")) for text in column(opened, CELLS, 6)]
    assert len(totals) == 6
    assert totals == sorted(totals)


def test_what_was_not_right_can_be_seen_alone(opened: Browser) -> None:
    opened.evaluate("document.querySelector('[name=wrong]').click()")
    assert column(opened, CELLS, 0) == ["samet max_level=6"] * 3


def test_pages_turn(opened: Browser) -> None:
    first = column(opened, CELLS, 0)
    opened.evaluate("document.querySelector('[name=next]').click()")
    assert len(column(opened, CELLS, 0)) == 5
    assert opened.evaluate("document.querySelector('[name=next]').disabled")
    opened.evaluate("document.querySelector('[name=previous]').click()")
    assert column(opened, CELLS, 0) == first


def test_groups_of_columns_can_be_shown(opened: Browser) -> None:
    heads = f"[...document.querySelectorAll('{CELLS} th')].map(head => head.innerText)"
    assert "total_ms_ci_low" not in opened.evaluate(heads)
    opened.evaluate("document.querySelector('[name=group][value=times]').click()")
    assert "total_ms_ci_low" in opened.evaluate(heads)


def test_it_fits_a_narrow_screen(chromium: Browser, page: Path) -> None:
    chromium.open(page, width=400)
    assert chromium.evaluate("document.documentElement.scrollWidth") <= 400


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
