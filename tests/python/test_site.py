"""The site over all runs, as files: its contents, its refusals, and the work of writing it."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections import Counter
from functools import partial
from pathlib import Path
from urllib.parse import unquote

import pytest
from work import calls_during, count_calls_of

from beambench_operations.__main__ import main
from beambench_operations.site import write
from beambench_operations.site.changes import Repository, _output_of, web_address
from beambench_operations.site.comparison import compare
from beambench_operations.site.entry import Entry, as_script, entry_of, read_script
from beambench_operations.site.write import write_site
from beambench_report.__main__ import main as draw
from beambench_report.base.files import Problem
from beambench_report.base.records import read_run
from synthetic_run import synthetic_rows, write_manifest, write_run
from synthetic_site import break_run, write_small_run

HREF = re.compile(r'(?:href|src)="([^"]*)"')


def broken_links(site: Path) -> list[str]:
    """Returns relative links on any page that are broken, and links that are not relative."""
    found = []
    for page in site.rglob("*.html"):
        for address in HREF.findall(page.read_text("utf-8")):
            path, _, _ = address.partition("#")
            if address.startswith(("data:", "https://github.com/")) or not path:
                continue
            if ":" in path or not (page.parent / unquote(path)).is_file():
                found.append(f"{page}: {address}")
    return found


def entry(folder: Path) -> Entry:
    return entry_of(read_run(folder))


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two sweeps, two machines, one duplicate run, and one broken run."""
    folder = tmp_path_factory.mktemp("runs")
    for place in range(3):
        write_small_run(folder / f"deep/er/{place}", place, factor=1 + 0.5 * place, cells=True)
    write_small_run(folder / "deep/other", 1, machine="b", factor=3.0)
    write_small_run(folder / "alone", 1, sweep="alone")
    shutil.copytree(folder / "alone", folder / "copied")
    break_run(folder / "broken")
    (folder / "abandoned-20260101").mkdir()
    break_run(folder / "abandoned-20260101/run")
    return folder


@pytest.fixture(scope="module")
def site(runs: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    target = tmp_path_factory.mktemp("site")
    assert main(["site", str(runs), "-o", str(target)]) == 0
    return target


def test_of_a_run_without_plots_a_page_has_the_figure_over_all_views(tmp_path: Path) -> None:
    folder = write_small_run(tmp_path / "run", 0)
    name = read_run(folder).rows["run_id"].iloc[0]
    page = write_site([folder], tmp_path / "site").parent / f"runs/{name}/index.html"
    text = page.read_text("utf-8")
    assert text.split("</main>")[0].count("<svg ") == 1
    remedy = f"draw them: <code>beambench report {folder}</code>"
    assert remedy in text
    assert draw(["plots", str(folder)]) == 0
    write_site([folder], tmp_path / "site")
    text = page.read_text("utf-8")
    assert text.split("</main>")[0].count("<svg ") == 4
    assert remedy not in text


def test_every_run_has_a_line_and_a_page(site: Path) -> None:
    text = (site / "index.html").read_text()
    assert "6 runs of 2 sweeps on 2 machines" in text
    pages = sorted(path.parent.name for path in site.glob("runs/*/index.html"))
    assert len(pages) == 6
    for name in pages:
        assert f'href="runs/{name}/index.html"' in text
        page = (site / f"runs/{name}/index.html").read_text()
        assert re.search(r"The hits of all 5 <a [^>]*>cells</a> are correct", page)
        assert '<p class="brand"><a href="../../index.html">' in page
    assert "exhaustive" not in text, "a reference is never the fastest"
    assert "embree (1 of 1)" in text
    assert "Processor A" in text
    assert "0000002def56" in text


def test_links_lead_somewhere(site: Path) -> None:
    assert broken_links(site) == []


def test_a_broken_run_is_named_with_the_reason(runs: Path, site: Path) -> None:
    text = (site / "index.html").read_text()
    assert "1 run could not be read" in text
    assert f"<b>{runs / 'broken'}</b>: " in text
    assert "there is no column schema_version" in text
    assert "abandoned" not in text


def test_a_run_that_is_there_twice_is_kept_twice_and_named(runs: Path, site: Path) -> None:
    name = "20260102T030000Z-alone-a"
    text = (site / "index.html").read_text()
    assert f"The run {name} exists twice: {runs / 'alone'} is {name}" in text
    assert f"{runs / 'copied'} is {name}-2." in text
    assert (site / f"runs/{name}-2/index.html").is_file()


def test_each_run_is_compared_with_the_one_before_on_its_sweep(site: Path) -> None:
    names = {path.stem for path in (site / "compare").glob("*-vs-*.html")}
    quick = "{}T030000Z-quick-{}"
    first, second, third = (quick.format(day, "a") for day in (20260101, 20260102, 20260103))
    other = quick.format(20260102, "b")
    assert f"{first}-vs-{second}" in names
    assert f"{second}-vs-{third}" in names
    assert f"{other}-vs-{third}" in names, "the run before it is of another machine"
    assert len([name for name in names if name.startswith(f"{second}-vs-{other}")]) == 1
    text = (site / f"compare/{first}-vs-{second}.html").read_text()
    assert "ms before" in text
    assert "+50.0%" in text


def test_paired_ratios_are_compared_with_intervals(runs: Path) -> None:
    comparison = compare(entry(runs / "deep/er/0"), entry(runs / "deep/er/1"))
    slow = [pair for pair in comparison.pairs if pair.after.contender.startswith("samet")]
    assert [pair.side for pair in slow] == ["slower", "slower"]
    assert all(pair.ratio.value == pytest.approx(1.5, rel=1e-3) for pair in slow)
    assert all(pair.ms.value == pytest.approx(1.5, rel=1e-3) for pair in slow)
    assert comparison.reference_label == "embree"
    assert (comparison.compared, comparison.count("slower"), comparison.count("faster")) == (
        3,
        2,
        0,
    )


def test_two_machines_are_never_compared_by_milliseconds(runs: Path, site: Path) -> None:
    comparison = compare(entry(runs / "deep/er/0"), entry(runs / "deep/other"))
    assert "aaaaaaaaaaaaaaaa (Processor A) before, bbbbbbbbbbbbbbbb (Processor B) after" in (
        comparison.warning
    )
    assert {pair.ms for pair in comparison.pairs} == {None}
    assert comparison.compared == 3
    pages = list((site / "compare").glob("*-quick-*-vs-*.html"))
    apart = [page for page in pages if page.stem[-1] != page.stem.split("-vs-")[0][-1]]
    assert len(apart) == 2
    for page in apart:
        text = page.read_text()
        assert "Two machines" in text
        assert "ms before" not in text
    [history] = (site / "history").iterdir()
    assert "3 runs · the newest" in history.read_text(), "the other machine's is not in it"


def test_other_references_are_replaced_by_a_contender_of_both(tmp_path: Path) -> None:
    def other_embree(folder: Path) -> Path:
        rows = [
            row | {"parameters": "mode=single,isa=best"} if row["structure"] == "embree" else row
            for row in synthetic_rows()
        ]
        folder.mkdir()
        write_manifest(folder)
        return write_run(folder, rows)

    (tmp_path / "a").mkdir()
    write_manifest(tmp_path / "a")
    before = entry(write_run(tmp_path / "a", synthetic_rows()))
    comparison = compare(before, entry(other_embree(tmp_path / "b")))
    assert comparison.reference.startswith("samet max_level=6")
    assert comparison.compared == 12
    assert comparison.count("slower") == comparison.count("faster") == 0
    assert "6 cells are new." in comparison.sentences


def test_other_rays_other_work_and_wrong_hits_are_told(tmp_path: Path) -> None:
    before = synthetic_rows()
    after = [dict(row) for row in before]
    after[0]["verdict"] = "mismatch"
    after[3]["traversal_steps_per_ray"] = 99
    after[6]["rays_hash"] = "7"
    folders = []
    for name, rows in (("b", before), ("c", after)):
        (tmp_path / name).mkdir()
        folders.append(write_run(tmp_path / name, rows))
    comparison = compare(*map(entry, folders))
    assert comparison.sentences == (
        "exhaustive in escena1 at 320x200: ok before, mismatch now.",
        "1 cell has different counters.",
        "1 cell has different rays or scenes; they are not compared.",
    )


def test_an_entry_is_read_back_as_it_was(runs: Path, tmp_path: Path) -> None:
    known = entry(runs / "deep/er/0")
    path = tmp_path / "data.js"
    path.write_text(as_script("one", known, "stamp"))
    assert read_script(path, "one", "stamp") == known
    assert read_script(path, "one", "another") is None
    path.write_text("beambench.add({);")
    assert read_script(path, "one", "stamp") is None


def test_what_did_not_change_is_not_made_again_and_what_has_gone_goes(tmp_path: Path) -> None:
    for place in range(3):
        write_small_run(tmp_path / f"runs/{place}", place)
    target = tmp_path / "site"
    write_site([tmp_path / "runs"], target)
    pages = sorted(target.glob("runs/*/index.html"))
    times = [page.stat().st_mtime_ns for page in pages]
    (tmp_path / "runs/1/manifest.json").unlink()
    shutil.rmtree(tmp_path / "runs/2")
    write_site([tmp_path / "runs"], target)
    assert [page.exists() for page in pages] == [True, True, False]
    assert pages[0].stat().st_mtime_ns == times[0]
    assert pages[1].stat().st_mtime_ns > times[1]
    assert broken_links(target) == []


def test_a_run_that_was_cut_off_has_a_page_but_no_place_in_a_history(tmp_path: Path) -> None:
    for place in range(3):
        folder = write_small_run(tmp_path / f"runs/{place}", place)
    manifest = json.loads((folder / "manifest.json").read_text())
    (folder / "manifest.json").write_text(json.dumps(manifest | {"finished_utc": None}))
    write_site([tmp_path / "runs"], tmp_path / "site")
    [history] = (tmp_path / "site/history").iterdir()
    assert "· 2 runs ·" in history.read_text()
    assert "cut off" in (tmp_path / "site/index.html").read_text()
    assert len(list((tmp_path / "site/runs").iterdir())) == 3


def test_wrong_requests_are_one_sentence(
    runs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "full").mkdir()
    (tmp_path / "full/mine.txt").write_text("mine")
    for folder, target, message in (
        ("no/such", "site", "no/such: is not a folder"),
        (tmp_path / "empty", "site", "holds no run"),
        (runs, "full", "is neither empty nor a site"),
    ):
        assert main(["site", str(folder), "-o", str(tmp_path / target)]) == 2
        assert message in capsys.readouterr().err
    assert [path.name for path in (tmp_path / "full").iterdir()] == ["mine.txt"]


def test_what_stands_in_a_record_cannot_become_script(tmp_path: Path) -> None:
    bad = "</script><script>alert(1)</script>"
    for place in range(2):
        folder = write_small_run(tmp_path / f"runs/{place}", place, scene=bad)
        run_id = read_run(folder).rows["run_id"][0]
        write_manifest(folder, sweep=bad, machine={"cpu": bad}, run_id=run_id)
    write_site([tmp_path / "runs"], tmp_path / "site")
    pages = [*(tmp_path / "site").rglob("*.html")]
    assert len(pages) == 6
    assert all("<script>alert" not in page.read_text() for page in pages)


@pytest.mark.parametrize(
    ("origin", "address"),
    [
        ("https://github.com/someone/thing.git", "https://github.com/someone/thing"),
        ("git@github.com:someone/thing.git", "https://github.com/someone/thing"),
        ("https://me:secret@github.com/someone/thing", "https://github.com/someone/thing"),
        ("ssh://git@gitlab.example.org:2222/a/b/c.git", "https://gitlab.example.org/a/b/c"),
        ("/srv/git/thing.git", ""),
        ("https://example.org/thing.git", ""),
        ("", ""),
    ],
)
def test_addresses_of_repositories(origin: str, address: str) -> None:
    assert web_address(origin) == address


def git(folder: Path, *arguments: str) -> str:
    command = ["git", "-C", folder, "-c", "user.name=a", "-c", "user.email=a@b", *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


def test_changes_are_told_by_git(tmp_path: Path) -> None:
    git(tmp_path, "init", "-q")
    hashes = []
    for subject in ("First", "Second <b>", "Third"):
        git(tmp_path, "commit", "-q", "--allow-empty", "-m", subject)
        hashes.append(git(tmp_path, "rev-parse", "HEAD"))
    here = Repository(tmp_path)
    change = here.change(hashes[0], hashes[2])
    assert [text.split(" ", 1)[1] for text in change.subjects] == ["Third", "Second <b>"]
    assert change.url == here.commit_url(hashes[0]) == ""
    assert change.command == f"git log -p {hashes[0][:12]}..{hashes[2][:12]}"
    assert here.change(hashes[0], "0123456789") is not None, "it may be known elsewhere"
    assert here.change(hashes[0], "--output=x") is None
    git(tmp_path, "remote", "add", "origin", "git@github.com:someone/thing.git")
    _output_of.cache_clear()
    there = Repository(tmp_path)
    assert there.subject(hashes[1]) == "Second <b>"
    assert there.commit_url(hashes[1]) == f"https://github.com/someone/thing/commit/{hashes[1]}"
    assert there.change(*hashes[:2]).url == (
        f"https://github.com/someone/thing/compare/{hashes[0]}...{hashes[1]}"
    )


def test_the_work_of_a_site_grows_with_its_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Counts calls, because seconds vary by a factor of two even on one machine."""
    counts: Counter[str] = Counter()
    count_calls_of(monkeypatch, counts, write, "read_run")
    count_calls_of(monkeypatch, counts, write, "render")
    calls = {}
    for turn, runs in enumerate((4, 4, 8)):  # the first time imports more modules
        folder = tmp_path / f"{turn}"
        for place in range(runs):
            sweep, machine = (("quick", "a"), ("slow", "b"))[2 * place // runs]
            write_small_run(folder / f"runs/{place}", place, sweep=sweep, machine=machine)
        counts.clear()
        calls[runs] = calls_during(partial(write_site, [folder / "runs"], folder / "site"))
        assert counts == {"read_run": runs, "render": runs}
        assert len(list((folder / "site/runs").iterdir())) == runs
        assert len(list((folder / "site/history").iterdir())) == 2
        assert broken_links(folder / "site") == []
    assert calls[8] < 8 * 600_000, "most of them draw the plot of each run"
    assert calls[8] < 2.1 * calls[4], "and nothing grows with pairs of runs"


def test_a_site_of_nothing_readable_is_still_a_site(tmp_path: Path) -> None:
    break_run(tmp_path / "runs/one")
    page = write_site([tmp_path / "runs"], tmp_path / "site")
    assert "1 run could not be read" in page.read_text()
    with pytest.raises(Problem, match="holds no run"):
        write_site([tmp_path / "site"], tmp_path / "another")
