"""The page of a run, parsed by a program; test_page_in_browser.py uses a browser."""

from __future__ import annotations

import json
import re
import shutil
from html.parser import HTMLParser
from pathlib import Path

import pytest
from PIL import Image
from work import calls_during

from beambench_report.__main__ import main
from beambench_report.base.analysis import read_analysis
from beambench_report.base.records import read_run
from beambench_report.run.all_cells import pack
from beambench_report.run.page import render
from beambench_report.run.plots import KINDS
from synthetic_analysis import write_analysis
from synthetic_run import synthetic_rows, without_times, write_cell, write_manifest, write_run

VOID = {"meta", "link", "img", "input", "br", "wbr", "hr"}
# These elements end where the next of their kind begins.
OPEN_ENDED = {"option"}


class Reader(HTMLParser):
    """Checks that elements are properly nested, and collects what the tests need."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.ids: list[str] = []
        self.addresses: list[str] = []
        self.words: list[str] = []
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        known = dict(attributes)
        if "id" in known:
            self.ids.append(known["id"] or "")
        self.addresses += [known[name] or "" for name in ("src", "href") if name in known]
        if tag not in VOID | OPEN_ENDED:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag, f"{self.getpos()}: </{tag}> closes another element"

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] not in ("style", "script"):
            self.words.append(data)

    @property
    def text(self) -> str:
        """Returns the text of the page."""
        return " ".join(" ".join(self.words).split())


def page_of(folder: Path, *options: str) -> Reader:
    """Writes the page of a run as users do, and parses it."""
    assert main(["page", str(folder), *options]) == 0
    return Reader((folder / "report.html").read_text("utf-8"))


def reader_of(folder: Path) -> Reader:
    """Parses a run's page without figures, which take most of the time."""
    return Reader(render(read_run(folder), drawn_kinds=()))


def text_of(folder: Path) -> str:
    """Returns the text of a run's page without figures."""
    return reader_of(folder).text


def links_of(reader: Reader) -> set[str]:
    """Returns the links within the page; links to single cells are opened by a script."""
    here = {at[1:] for at in reader.addresses if at.startswith("#")}
    return {place for place in here if not place.startswith("cell-")}


def test_a_right_run_says_so_first(run_folder: Path) -> None:
    write_manifest(run_folder)
    text = text_of(run_folder)
    assert "The hits of all 30 cells are correct" in text
    assert "Sweep made-up" in text
    assert "measured for 4 min 10 s" in text
    places = [text.index(words) for words in ("cells are correct", "is fastest?", "Total time,")]
    assert places == sorted(places)


def test_the_fastest_is_named_with_its_margin(run_folder: Path) -> None:
    text = text_of(run_folder)
    best = read_analysis(run_folder).views[0]
    assert f"Least time: {best.fastest.contender} ; whether" in text, "nothing has an interval"
    table = text[text.index("pays off from") :]
    assert best.fastest.contender in table[:300]
    assert "430 primitives 1280x1024 embree 78.6 ms, 16.7 Mrays/s" in table[:300]
    assert "Over all 2 views of primary rays" in text


def test_a_build_pays_off_over_a_contender_that_is_named(run_folder: Path) -> None:
    rows = [{**row, "trace_ms_ci_low": 0.99 * row["trace_ms_median"]} for row in synthetic_rows()]
    rows = [{**row, "trace_ms_ci_high": 1.01 * row["trace_ms_median"]} for row in rows]
    for row in rows:
        if row["structure"] == "embree":
            row["build_ms_median"] = 2.5
    text = text_of(write_run(run_folder, rows))
    # samet max_level=5 takes 1 ms more to build, and 160 ns less per ray.
    assert "6.25 k rays with fewer, samet max_level=5 is ahead" in text
    ahead = "samet max_level=5 is ahead, build included."
    assert f"Its build pays off from 6.25 k rays on; with fewer, {ahead}" in text
    rows = [{**row, "build_ms_median": 0.0} for row in rows]
    text = text_of(write_run(run_folder, rows))
    assert "the first ray" in text
    assert "the first ray (" not in text


def test_an_embree_that_is_the_next_has_its_figures_once(tmp_path: Path) -> None:
    rows = [
        {**row, "trace_ms_median": 1e-5 * row["rays"]} if "=5" in row["parameters"] else row
        for row in synthetic_rows()
    ]
    for row in rows:
        row["trace_ms_ci_low"] = 0.99 * row["trace_ms_median"]
        row["trace_ms_ci_high"] = 1.01 * row["trace_ms_median"]
    text = text_of(write_run(tmp_path, rows))
    assert re.search(r"embree 6\.00 \S+ to \S+ not paired the same", text)
    assert "6x faster than the next (embree, Embree's best)" in text
    assert "Embree's best (embree) takes" not in text


def test_ratios_of_rounds_are_said_to_differ_from_those_of_medians(
    run_folder: Path, full_run: Path
) -> None:
    words = "it can differ from the ratio of the medians in results.csv"
    assert words not in text_of(run_folder)
    assert words in text_of(full_run)


def test_what_was_traced_stands_at_the_head(tmp_path: Path) -> None:
    text = text_of(write_run(tmp_path, synthetic_rows()))
    line = "Primary rays · 320x200, 640x480, 1280x1024 · 1 sample per pixel · 1 thread"
    assert text.index(line) < text.index("cells are correct")
    rows = synthetic_rows()
    more = [
        {**row, "samples": 4, "ray_kind": "shadow", "width": 8 + place, "threads": 2}
        for place, row in enumerate(rows)
    ]
    text = text_of(write_run(tmp_path, rows + more))
    assert "Primary and shadow rays · 33 resolutions from " in text
    assert "1 and 4 samples per pixel · 1 and 2 threads" in text


def test_references_are_counted_apart_and_explained(tmp_path: Path) -> None:
    paths = {"samet": "image-own", "embree": "image-simd"}
    rows = [
        {**row, "query_path": paths.get(row["structure"], "image-single")}
        for row in synthetic_rows()
    ]
    text = text_of(write_run(tmp_path, rows))
    assert "3 contenders 2 references (exhaustive, null)" in text
    assert (
        "References do not compete: null makes every ray one by one and finds nothing; "
        "exhaustive tests every primitive with every ray. The time of null is not a lower limit "
        "for samet, whose own samples replace these rays (query path image-own), or for "
        "embree, whose rays are made in packets by SIMD."
    ) in text
    alike = [{**row, "query_path": "image-single"} for row in rows]
    assert "not a lower limit" not in text_of(write_run(tmp_path, alike))
    without = [row for row in alike if row["structure"] not in ("null", "exhaustive")]
    text = text_of(write_run(tmp_path, without))
    assert "References do not compete" not in text
    assert "2 references" not in text


def test_the_kinds_of_primitives_are_told_where_embree_tells_them(tmp_path: Path) -> None:
    rows = [
        {**row, "library_geometry": "triangles+points" if row["structure"] == "embree" else ""}
        for row in synthetic_rows()
    ]
    (tmp_path / "pictures").mkdir()
    Image.new("RGB", (8, 6), "teal").save(tmp_path / "pictures/escena1.png")
    reader = reader_of(write_run(tmp_path, rows))
    assert "430 primitives: polygons and spheres · picture" in reader.text
    assert "#pictures-view-tetra-n-5" not in reader.addresses
    assert "#pictures-view-escena1" in reader.addresses


def test_words_of_this_project_lead_to_what_they_mean(tmp_path: Path) -> None:
    rows = synthetic_rows()
    for row in rows:
        write_cell(tmp_path, row, dict.fromkeys(range(7), 1.0))
    reader = reader_of(write_run(tmp_path, rows))
    for word in ("cell", "contender", "oracle", "reference", "round", "view"):
        assert f"#term-{word}" in reader.addresses
        assert f"term-{word}" in reader.ids


def test_references_never_win_and_stand_last(run_folder: Path) -> None:
    for view in read_analysis(run_folder).views:
        assert {"null", "exhaustive"}.isdisjoint(one.structure for one in view.ranked)
    page = text_of(run_folder)
    table = page[page.index("escena1 2") if "escena1 2" in page else 0 :]
    assert "reference" in table


def test_who_was_left_out_has_a_row_with_the_reason(run_folder: Path) -> None:
    rows = [
        row
        for row in synthetic_rows()
        if not (row["structure"] == "exhaustive" and row["scene"] == "escena1")
    ]
    write_run(run_folder, rows)
    exclude = [{"structure": "exhaustive", "scene": "escena1"}]
    (run_folder / "config.json").write_text(json.dumps({"exclude": exclude}))
    write_analysis(run_folder)
    assert "exhaustive left out by the sweep (this scene)" in text_of(run_folder)
    (run_folder / "config.json").unlink()
    write_analysis(run_folder)
    assert "exhaustive not in the record" in text_of(run_folder)


def test_times_that_are_worth_little_say_why(run_folder: Path) -> None:
    write_manifest(run_folder, measurement={"noise": 0.01, "other_work": 0.1})
    assert "Equal work" not in text_of(run_folder)
    write_manifest(run_folder, measurement={"noise": 0.31, "other_work": 2.5}, machine={"cpu": "x"})
    text = text_of(run_folder)
    assert "Take the times with care" in text
    assert "Equal work took up to 31% longer than usual" in text
    assert "Other work kept 2.50 processors busy" in text


def test_times_of_a_throttled_run_say_so(run_folder: Path) -> None:
    counts = {"periods": 14, "throttled_periods": 12, "throttled_seconds": 0.96}
    write_manifest(run_folder, measurement={"noise": 0.01, "throttling": counts})
    text = text_of(run_folder)
    assert "Take the times with care" in text
    assert "The kernel throttled the process in 12 of 14 periods of its CPU quota" in text
    for harmless in (counts | {"throttled_periods": 0}, None):
        write_manifest(run_folder, measurement={"noise": 0.01, "throttling": harmless})
        assert "throttled the process" not in text_of(run_folder)


def test_times_less_precise_than_wanted_say_so(run_folder: Path) -> None:
    write_run(run_folder, [{**row, "stop_reason": "budget"} for row in synthetic_rows()])
    assert re.search(r"\d+ of \d+ timed cells less precise than requested", text_of(run_folder))


def test_a_wrong_cell_is_shown_with_its_reason_and_how_to_replay_it(
    full_run: Path,
) -> None:
    text = text_of(full_run)
    assert "3 of 30 cells were wrong" in text
    assert (
        "mismatch samet max_level=6 in tetra:n=5 at 320x200, 640x480, 1280x1024: "
        "wrong hits 3 of 64000 hits were wrong"
    ) in text
    assert "pixel (3, 4) sample 0: structure_error" in text
    replay = "beambench trace 'tetra:n=5' --accel samet:max_level=6 --pixel 3,4"
    assert f"See this ray's path: {replay}" in text
    assert f"replay {replay}" not in text


def test_everything_is_on_the_page_and_nothing_is_fetched(full_run: Path) -> None:
    reader = page_of(full_run)
    assert all(at.startswith(("#", "data:")) for at in reader.addresses), reader.addresses
    images = [at.split(";")[0] for at in reader.addresses if at.startswith("data:image")]
    assert images.count("data:image/webp") == 3
    body = (full_run / "report.html").read_text("utf-8").split("</main>")[0]
    assert body.count("<svg ") == 9
    assert len(reader.ids) == len(set(reader.ids))
    assert links_of(reader) <= set(reader.ids)
    for part in ("result", "fastest", "comparison", "view-escena1", "cells", "manifest"):
        assert part in reader.ids
    for words in (
        "samet, traversal steps",
        "What could not be controlled",
        "16.0 GiB",
        "not reported",
    ):
        assert words in reader.text
    page = (full_run / "report.html").read_text("utf-8")
    assert "default-src 'none'" in page
    without_scripts = re.sub(r"<script>.*?</script>", "", page, flags=re.DOTALL)
    assert not re.search(r"@import|url\((?!data:|#)", without_scripts)


def test_what_is_not_there_is_left_out(run_folder: Path) -> None:
    reader = page_of(run_folder)
    assert not any(at.startswith("data:image") for at in reader.addresses)
    assert "manifest" not in reader.ids
    assert links_of(reader) <= set(reader.ids)
    for words in (
        "There is no manifest.json",
        "There is no config.json",
        "The repetitions of the cells are not in this folder: ratios compare medians",
        "There is no figure 'distributions'; it needs repetitions",
        "The record has no 95% confidence intervals of the trace times",
        "There are no pictures of the scenes",
    ):
        assert words in reader.text


def figures_on(page: str) -> int:
    """Returns the number of a page's figures that have accessible names."""
    return len(re.findall(r'<div role="img" aria-label="[^"]+"><svg', page))


def figures_of_page(folder: Path) -> int:
    return figures_on((folder / "report.html").read_text("utf-8"))


def test_a_folder_without_plots_has_the_same_figures_as_one_with_them(run_folder: Path) -> None:
    reader = page_of(run_folder)
    drawn = (run_folder / "report.html").read_text("utf-8")
    assert figures_of_page(run_folder) == 7
    assert len(reader.ids) == len(set(reader.ids))
    assert not (run_folder / "plots").exists()
    assert main(["plots", str(run_folder)]) == 0
    page_of(run_folder)
    assert (run_folder / "report.html").read_text("utf-8") == drawn


@pytest.mark.parametrize("left", ["no index", "no figure", "a broken index", "another index"])
def test_plots_that_are_not_all_there_are_drawn_on_the_page(
    full_run: Path, tmp_path: Path, left: str
) -> None:
    """One drawn kind of figure suffices: the plots of the folder would be nine figures."""
    run = shutil.copytree(full_run, tmp_path / "run")
    index = run / "plots/index.json"
    assert figures_on(render(read_run(run))) == 9
    if left == "no index":
        index.unlink()
    elif left == "no figure":
        (run / "plots/overall.svg").unlink()
    else:
        index.write_text("[" if left == "a broken index" else '{"stems": 3}')
    (overall,) = (kind for kind in KINDS if kind.name == "overall")
    assert figures_on(render(read_run(run), drawn_kinds=[overall])) == 1


def test_of_a_folder_with_intervals_but_no_repetitions_the_page_has_intervals(
    tmp_path: Path,
) -> None:
    rows = [
        {
            **row,
            "trace_ms_ci_low": 0.99 * float(str(row["trace_ms_median"])),
            "trace_ms_ci_high": 1.01 * float(str(row["trace_ms_median"])),
        }
        for row in synthetic_rows()
    ]
    text = page_of(write_run(tmp_path, rows)).text
    assert "The repetitions of the cells are not in this folder" in text
    assert "has no 95% confidence intervals" not in text
    assert (
        "95% confidence interval of the first trace" in text
    )  # below the figures of the trace times
    assert "95% confidence interval of the measurement" in text


def test_repetitions_of_some_cells_only_are_counted(run_folder: Path) -> None:
    for row in synthetic_rows()[:10]:
        write_cell(run_folder, row, dict.fromkeys(range(7), 1.0))
    text = text_of(run_folder)
    assert "The repetitions of 20 of 30 timed cells are not in this folder" in text


def test_why_cells_were_wrong_is_missed_where_the_folder_does_not_say(tmp_path: Path) -> None:
    rows = [without_times(row, "mismatch") for row in synthetic_rows()[:3]] + synthetic_rows()[3:]
    assert "This folder does not state why cells were wrong" in text_of(write_run(tmp_path, rows))


def test_a_machine_that_nothing_is_known_of_was_not_quiet(run_folder: Path) -> None:
    write_run(run_folder, [{**row, "repetitions": 9} for row in synthetic_rows()])
    path = run_folder / "analysis.json"

    def text_without_care() -> str:
        path.write_text(json.dumps(json.loads(path.read_text()) | {"reasons_for_care": []}))
        return text_of(run_folder)

    text = text_without_care()
    assert "Whether the machine was quiet is not recorded" in text
    assert "The machine was quiet" not in text
    write_manifest(run_folder, measurement={"noise": 0.01, "other_work": 0.1})
    assert "The machine was quiet" in text_without_care()


def test_a_run_of_plug_ins_has_a_whole_page(tmp_path: Path) -> None:
    rows = [
        {**row, "structure": "my/tree", "parameters": "depth=3"}
        if row["structure"] == "samet" and "=5" in str(row["parameters"])
        else row
        for row in synthetic_rows()
    ]
    plugins = [{"path": "/home/me/tree.so", "hash": "12ab", "structures": ["my/tree"]}]
    write_manifest(write_run(tmp_path, rows), plugins=plugins)
    reader = page_of(tmp_path)
    assert figures_of_page(tmp_path) == 7
    assert "my/tree" in reader.text
    assert "/home/me/tree.so" in reader.text


def test_a_run_in_which_nothing_was_right_has_a_page(tmp_path: Path) -> None:
    rows = [without_times(row, "error") for row in synthetic_rows()]
    reader = page_of(write_run(tmp_path, rows))
    assert "30 of 30 cells were wrong" in reader.text
    assert "comparison" not in reader.ids


def test_cells_without_rays_are_not_wrong(tmp_path: Path) -> None:
    rows = synthetic_rows()
    rows[:3] = [{**without_times(row, "no_rays"), "ray_kind": "shadow"} for row in rows[:3]]
    for row in rows[:3]:
        row["rays"] = 0
    text = text_of(write_run(tmp_path, rows))
    assert "The hits of all 27 cells are correct" in text
    assert "3 cells have no rays" in text
    assert "were wrong" not in text


def test_a_run_without_any_rays_has_a_page(tmp_path: Path) -> None:
    rows = [{**without_times(row, "no_rays"), "rays": 0} for row in synthetic_rows()]
    assert "No cell was measured" in page_of(write_run(tmp_path, rows)).text


def test_one_cell_is_enough(tmp_path: Path) -> None:
    assert (
        "The hits of the only cell are correct"
        in page_of(write_run(tmp_path, synthetic_rows()[3:4])).text
    )


def test_a_run_that_was_cut_off_says_so(run_folder: Path) -> None:
    write_manifest(run_folder, finished_utc=None)
    text = text_of(run_folder)
    assert "The run was cut off" in text
    assert "Scenes without any cell" not in text


def test_a_run_that_was_cut_off_is_compared_where_two_contenders_were_measured(
    tmp_path: Path,
) -> None:
    rows = [
        row
        for row in synthetic_rows()
        if row["scene"] == "escena1"
        and (row["width"] == 320 or (row["width"] == 640 and row["structure"] == "exhaustive"))
    ]
    write_run(tmp_path, rows)
    scenes = [{"name": "escena1"}, {"name": "tetra:n=5"}]
    write_manifest(tmp_path, finished_utc=None, scenes=scenes)
    text = page_of(tmp_path).text
    assert "Scenes without any cell: tetra:n=5." in text
    assert "Least time: embree" in text
    assert "escena1 430 primitives 320x200 embree" in text
    assert "no contender has a time" not in text
    assert "1 other resolution" in text
    assert "contender not measured" not in text
    missing = {**rows[0], "scene": "tetra:n=5"}
    write_run(tmp_path, [*rows, missing])
    assert "320x200, 4 contenders not measured" in text_of(tmp_path)


def test_a_run_without_a_finished_cell_is_one_sentence_and_exit_code_2(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "run.jsonl").write_text('{"event": "header"}\n')
    assert main(["page", str(tmp_path)]) == 2
    assert f"beambench analyze --write {tmp_path}" in capsys.readouterr().err


def test_names_from_a_record_cannot_become_part_of_the_page(tmp_path: Path) -> None:
    evil = "</script><script>alert(1)</script>&<b>"
    rows = [{**row, "scene": evil, "commit": evil, "rays_hash": evil} for row in synthetic_rows()]
    rows[0]["parameters"] = f"a={evil}"
    folder = write_run(tmp_path, rows)
    write_manifest(folder, sweep=evil, uncontrolled=[evil])
    assert "alert(1)" in page_of(folder).text  # Reader has checked that every element is closed
    assert "<script>alert" not in (folder / "report.html").read_text("utf-8")


def test_the_reference_can_be_chosen(run_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = text_of(run_folder)
    assert "Comparison with embree, build included" in text
    assert (
        "multiple of that of embree (Embree's fastest with correct hits in the most views)"
    ) in text
    text = page_of(run_folder, "--reference", "samet max_level=5").text
    assert "multiple of that of samet max_level=5 (chosen by --reference)" in text
    assert "total times samet max_level=5" in text
    assert main(["page", str(run_folder), "--reference", "smet"]) == 2
    assert "no contender 'smet'" in capsys.readouterr().err


def test_a_structure_names_its_only_contender_as_the_reference(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = synthetic_rows()
    names = {row["structure"]: set() for row in rows}
    for row in rows:
        names[row["structure"]].add(row["parameters"])
    assert len(names["samet"]) == 2
    folder = write_run(tmp_path, rows)
    assert main(["page", str(folder), "--reference", "samet"]) == 2
    message = capsys.readouterr().err
    assert "'samet' is the structure of 2 contenders; name 'samet max_level=" in message
    only = [row for row in rows if row["structure"] != "samet" or "=5" in row["parameters"]]
    (tmp_path / "one").mkdir()
    folder = write_run(tmp_path / "one", only)
    assert "multiple of that of samet" in page_of(folder, "--reference", "samet").text


def test_the_trace_of_which_the_harness_has_the_largest_part_is_named(run_folder: Path) -> None:
    path = run_folder / "analysis.json"
    one = {"query_path": "image-single", "cell": "a/b", "title": "samet in escena1 at 640x480"}
    for part, figure in ((0.071, "7.1%"), (3.71, "371%")):
        changes = {"harness_overheads": [one | {"part": part}]}
        path.write_text(json.dumps(json.loads(path.read_text()) | changes))
        words = f"{figure} is the harness's largest share of a trace: samet in escena1 at 640x480"
        assert words in text_of(run_folder)


def test_a_manifest_that_is_none_is_one_sentence_and_exit_code_2(
    run_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (run_folder / "manifest.json").write_text("[")
    assert main(["page", str(run_folder)]) == 2
    assert re.match(r"error: .*manifest\.json: cannot be read as JSON", capsys.readouterr().err)
    assert not (run_folder / "report.html").exists()


def test_packed_rows_say_what_the_file_says(run_folder: Path) -> None:
    run = read_run(run_folder)
    cells = pack(run)
    columns = {column["name"]: column for column in json.loads(cells.packed)["columns"]}
    assert cells.rows == 30
    assert columns["memory_bytes"]["figures"][3] == 200_000
    assert columns["traversal_steps_per_ray"]["figures"][9] is None, "Embree does not count"
    trace = columns["trace_ms_median"]["figures"]
    assert trace == [pytest.approx(t, rel=1e-4) for t in run.rows["trace_ms_median"]]
    contender = columns["contender"]
    assert contender["words"][contender["at"][9]] == "embree"
    assert ("machine_id", "0123456789abcdef") in cells.same_everywhere
    assert "machine_id" not in columns


def test_the_work_of_a_page_grows_little_with_its_rows(tmp_path: Path) -> None:
    """Counts calls, because seconds vary by a factor of two even on one machine."""
    rows = synthetic_rows()
    lines = write_run(tmp_path, rows).joinpath("results.csv").read_text().splitlines()
    pages: list[str] = []
    calls = []
    for count in (500, 4_500):
        copies = count // len(rows) + 1
        many = [lines[0], *(lines[1:] * copies)[:count]]
        (tmp_path / "results.csv").write_text("\n".join(many) + "\n")
        write_analysis(tmp_path)
        calls.append(calls_during(lambda: pages.append(render(read_run(tmp_path)))))
    assert (calls[1] - calls[0]) / 4_000 < 200, "of Python functions for each row"
    assert re.search(r"all 4,500 <a [^>]*>cells</a> are correct", pages[1])
    assert (len(pages[1]) - len(pages[0])) / 4_000 < 500, "characters for each row"


def changed_analysis(folder: Path, **changes: object) -> Path:
    """Changes analysis.json: facts of the run, and of the fastest contenders of its first view."""
    file = folder / "analysis.json"
    source = json.loads(file.read_text())
    source["steadiness"] = changes.get("steadiness")
    source["views"][0]["clock"] = changes.get("clock", "wall")
    source["views"][0]["ranked"][0] |= changes.get("fastest", {})
    source["views"][0]["ranked"][1] |= changes.get("second", {})
    source["means"][0]["means"][0] |= changes.get("mean", {})
    file.write_text(json.dumps(source))
    return folder


def test_an_unsteady_run_says_so_first(run_folder: Path) -> None:
    steady = text_of(changed_analysis(run_folder, steadiness={"shift": 0.01, "limit": 0.02}))
    assert "not steady" not in steady
    text = text_of(changed_analysis(run_folder, steadiness={"shift": -0.05, "limit": 0.02}))
    assert "The machine was not steady: take the times with care" in text


def test_a_view_compared_by_cpu_time_says_so(run_folder: Path) -> None:
    assert "CPU time" not in text_of(run_folder).partition("Data dictionary The columns")[0]
    text = text_of(changed_analysis(run_folder, clock="cpu"))
    assert "1280x1024, by CPU time" in text
    assert "Compared by CPU time, because other work interrupted too many" in text


def test_a_contender_that_may_be_as_fast_is_named(run_folder: Path) -> None:
    changed_analysis(run_folder, second={"rank": "undecided"})
    text = text_of(run_folder)
    second = read_analysis(run_folder).views[0].ranked[1].name
    assert f"; whether {second} is as fast is not decided." in text
    assert f"undecided: {second}" in text


def test_a_mean_has_the_intervals_of_measuring_and_of_the_scatter(run_folder: Path) -> None:
    text = text_of(changed_analysis(run_folder, mean={"scatter_low": 1.5, "scatter_high": 2.5}))
    assert "95% confidence interval of the measurement" in text
    assert "1.50 to 2.50" in text.partition("scatter between views")[2]


def test_a_tuned_contender_has_its_parameters_and_others_their_simd(tmp_path: Path) -> None:
    tuned = {"parameter_sets": 8, "structure_isa": "AVX512", "outpaced": "false"}
    rows = [row | tuned if row["structure"] == "embree" else row for row in synthetic_rows()]
    fastest = {"contender": "embree (best of 8)", "variant": "embree:mode=single"}
    text = text_of(changed_analysis(write_run(tmp_path, rows), fastest=fastest))
    assert "Least time: embree:mode=single (best of 8)" in text
    assert "embree (best of 8): mode=single" in text
    assert "memory SIMD" in text
    assert "AVX512" in text


def test_the_first_sentence_names_the_winner_and_its_margin(run_folder: Path) -> None:
    rows = synthetic_rows()
    for row in rows:
        row["trace_ms_median"] = 1.0 if row["structure"] == "embree" else 4.0
    text = text_of(write_run(run_folder, rows))
    assert re.search(r"embree[^.]* (is the fastest|takes the least time)[^.]*4x faster than", text)
