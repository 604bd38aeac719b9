"""Writes the site: plain files with relative links, for any static host or none.

index.html                 all runs
runs/<name>/index.html     the page of each run; data.js has its data for comparisons
compare/<a>-vs-<b>.html    a run and the previous run; index.html: any two runs of a sweep
history/<name>.html        the runs of one sweep on one machine
gallery/index.html         pages of `beambench explain`, if the program to write them is given
site.json                  the files of the site, so that the next version can remove old ones
"""

import json
import os
import re
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from beambench_operations.site.changes import Repository
from beambench_operations.site.comparison import Comparison, compare
from beambench_operations.site.entry import Entry, as_script, entry_of, read_script, stamp_of
from beambench_operations.site.gallery import make_gallery
from beambench_operations.site.history_page import page_values, read_mismatches
from beambench_operations.site.machine_history import MachineHistory, history_of
from beambench_report.base.files import Problem, read_json, write_text
from beambench_report.base.quantities import DASH
from beambench_report.base.records import read_run
from beambench_report.run.html import environment
from beambench_report.run.page import render
from beambench_report.run.plots import KINDS

_TEMPLATES = Path(__file__).with_name("templates")
_DRAWN = KINDS[:1]
"""The plot drawn for runs without plots; drawing all kinds would take a second for each run."""
_FILES = "site.json"
_RUN_FILES = {"results.csv", "manifest.json"}
_HISTORY = "history.sqlite"
_BRAND = re.compile(r'(<p class="brand">)([^<]*)(</p>)')


@dataclass
class _Run:
    """A run of the site, and the links in its line."""

    name: str
    folder: Path
    entry: Entry
    changed: bool
    """Whether the run has changed since the site was last written."""
    history: str = ""
    comparisons: list[tuple[str, str]] = field(default_factory=list)

    @property
    def order(self) -> tuple[str, str]:
        return (self.entry.time, self.name)


@dataclass
class _Site:
    """The site while it is written; `written` has its files, relative to `target`."""

    target: Path
    repository: Repository
    written: set[str] = field(default_factory=set)

    def write(self, place: str, text: str) -> None:
        path = self.target / place
        path.parent.mkdir(parents=True, exist_ok=True)
        write_text(path, text)
        self.written.add(place)

    def page(self, place: str, template: str, **values: object) -> None:
        made = environment(_TEMPLATES).get_template(template)
        shared = {"top": "../" * place.count("/"), "repository": self.repository, "dash": DASH}
        self.write(place, made.render(**shared, **values))


def write_site(
    folders: Iterable[Path],
    target: Path,
    published: Path | None = None,
    beambench: Path | None = None,
) -> Path:
    """Writes the site of all runs below the folders; returns its first page.

    The newest run of the sweep of the run `published` is also compared with that run. The program
    `beambench` writes the pages of the gallery; without it, the site has none. Raises Problem if
    nothing is found, if `target` contains other files, or if the program cannot write a page.
    """
    found, histories = _find_runs([*folders, *([published] if published else [])])
    site = _Site(target, Repository())
    former = _former_files(target)
    runs, broken, doubles = _write_runs(site, found)
    _write_comparisons(site, runs, published)
    listed = _write_histories(site, runs, histories)
    if beambench:
        _write_gallery(site, beambench)
    site.page("compare/index.html", "any.html.j2", runs=_choices(runs))
    site.page(
        "index.html",
        "index.html.j2",
        runs=sorted(runs, key=lambda run: run.order, reverse=True),
        histories=listed,
        broken=broken,
        doubles=doubles,
        has_gallery=beambench is not None,
        sweeps=len({run.entry.sweep for run in runs}),
        machines=len({str(run.entry.machine) for run in runs}),
    )
    for gone in former - site.written:
        (target / gone).unlink(missing_ok=True)
    write_text(target / _FILES, json.dumps(sorted(site.written), indent=0) + "\n")
    return target / "index.html"


def _write_gallery(site: _Site, beambench: Path) -> None:
    folder = site.target / "gallery"
    gallery = make_gallery(beambench, folder)
    site.written |= {f"gallery/{page.name}" for page in folder.glob("*.html")}
    site.page("gallery/index.html", "gallery.html.j2", gallery=gallery)


def _find_runs(folders: Iterable[Path]) -> tuple[list[Path], list[Path]]:
    """Returns the run folders below the given ones, each once, and the histories of nightly runs.

    Abandoned runs and hidden folders are left out. Raises Problem if a folder does not exist or no
    run is found.
    """
    runs: dict[Path, Path] = {}
    histories: dict[Path, Path] = {}
    for folder in (wanted := list(folders)):
        if not folder.is_dir():
            raise Problem(f"{folder}: is not a folder; give runs, or folders that contain runs")
        for place, names, files in os.walk(folder):
            here = Path(place)
            if _RUN_FILES & set(files):
                runs.setdefault(here.resolve(), here)
                names.clear()
            if _HISTORY in files:
                histories.setdefault(here.resolve(), here / _HISTORY)
            names[:] = sorted(name for name in names if not name.startswith((".", "abandoned-")))
    if not runs:
        raise Problem(f"{', '.join(map(str, wanted))}: holds no run; `beambench run` writes runs")
    return list(runs.values()), list(histories.values())


def _former_files(target: Path) -> set[str]:
    """Returns the files of the existing site. Raises Problem if the folder is not a site."""
    files = read_json(target / _FILES)
    if files is None and target.exists() and (not target.is_dir() or any(target.iterdir())):
        raise Problem(f"{target}: is neither empty nor a site; give a new folder")
    return {one for one in files or [] if ".." not in one and not one.startswith("/")}


def _write_runs(
    site: _Site, folders: Sequence[Path]
) -> tuple[list[_Run], list[tuple[Path, str]], list[str]]:
    """Writes the runs; returns them, the unreadable ones with the reason, and duplicate ids."""
    runs, broken, doubles = [], [], []
    names: dict[str, Path] = {}
    for run_id, folder in sorted((_run_id(folder), folder) for folder in folders):
        first = _slug(run_id)
        free = (first, *(f"{first}-{number}" for number in range(2, len(names) + 3)))
        name = next(one for one in free if one not in names)
        try:
            entry, changed = _write_run(site, name, folder)
        except Exception as error:  # whatever one record contains, the other runs get their pages
            prefix = "" if isinstance(error, Problem) else f"{type(error).__name__}: "
            broken.append((folder, f"{prefix}{error}"))
            continue
        if name != first:
            doubles.append(
                f"The run {run_id} exists twice: {names[first]} is {first}, {folder} is {name}."
            )
        names[name] = folder
        runs.append(_Run(name, folder, entry, changed))
    return sorted(runs, key=lambda run: run.order), broken, doubles


def _run_id(folder: Path) -> str:
    """Returns the id in the run's last row; whether the run is valid is checked later."""
    path = folder / "results.csv"
    try:
        rows = pd.read_csv(path, usecols=["run_id"], dtype=str, keep_default_na=False)
        return str(rows["run_id"].iloc[-1])
    except (OSError, ValueError, IndexError):  # these include pandas' errors
        return folder.name


def _slug(text: str) -> str:
    return re.sub(r"[^A-Za-z0-9._-]+", "-", text).strip(".-") or "run"


def _write_run(site: _Site, name: str, folder: Path) -> tuple[Entry, bool]:
    """Writes page and data of a run if they changed; returns the entry and whether they did."""
    page, data = f"runs/{name}/index.html", f"runs/{name}/data.js"
    stamp = stamp_of(folder)
    entry = read_script(site.target / data, name, stamp)
    if entry and (site.target / page).is_file():
        site.written |= {page, data}
        return entry, False
    run = read_run(folder)
    entry = entry_of(run)
    text = _BRAND.sub(
        r'\1<a href="../../index.html">\2</a>\3', render(run, drawn_kinds=_DRAWN), count=1
    )
    site.write(page, text)
    site.write(data, as_script(name, entry, stamp))
    return entry, True


def _write_comparisons(site: _Site, runs: Sequence[_Run], published: Path | None) -> None:
    """Compares each run with the previous run of its sweep, and with the previous one on its
    machine.
    """
    known = published.resolve() if published else None
    by_sweep: dict[str, list[_Run]] = defaultdict(list)
    for run in runs:
        by_sweep[run.entry.sweep].append(run)
    by_sweep.pop("", None)
    for own in by_sweep.values():
        for place, run in enumerate(own):
            earlier = [
                one for one in own[:place][::-1] if one.entry.in_blocks == run.entry.in_blocks
            ]
            here = (one for one in earlier if not one.entry.machine.differs_from(run.entry.machine))
            before = next(here, None)
            others = [("the run before", before)] if before else []
            if earlier and earlier[0] is not before:
                others.append(("another machine", earlier[0]))
            if run is own[-1]:
                others += [
                    ("the published run", one)
                    for one in earlier
                    if one.folder.resolve() == known and one not in [other for _, other in others]
                ]
            for words, other in others:
                run.comparisons.append((_write_comparison(site, other, run), words))


def _write_comparison(site: _Site, before: _Run, after: _Run) -> str:
    place = f"compare/{before.name}-vs-{after.name}.html"
    if not before.changed and not after.changed and (site.target / place).is_file():
        site.written.add(place)
        return place
    comparison = compare(before.entry, after.entry)
    change = site.repository.change(before.entry.commit, after.entry.commit)
    names = (before.name, after.name)
    site.page(place, "compare.html.j2", comparison=comparison, names=names, change=change)
    return place


def _write_histories(
    site: _Site, runs: Sequence[_Run], known: Sequence[Path]
) -> list[dict[str, object]]:
    """Writes a page for each sweep and machine with two or more runs; returns their index lines."""
    groups: dict[tuple[str, str], list[_Run]] = defaultdict(list)
    for run in runs:
        if run.entry.sweep and not run.entry.cut_off:
            groups[run.entry.sweep, str(run.entry.machine)].append(run)
    listed = []
    for (sweep, machine), own in groups.items():
        history = history_of([(run.entry.run_id, run.folder) for run in own], known)
        if history is None:
            continue
        href = f"history/{_slug(f'{sweep}-{machine}')}.html"
        for run in own:
            run.history = href
        labels = {"sweep": sweep, "machine": machine}
        _write_history(site, href, labels, history, runs)
        counts = {"count": len(history.nights.nights), "alarms": len(history.tonight)}
        listed.append({"href": href} | labels | counts)
    return listed


def _write_history(
    site: _Site,
    href: str,
    labels: dict[str, str],
    history: MachineHistory,
    runs: Sequence[_Run],
) -> None:
    by_id = {run.entry.run_id: run for run in reversed(runs)}

    def address(run_id: str) -> str:
        return f"../runs/{by_id[run_id].name}/index.html" if run_id in by_id else ""

    newest = by_id.get(history.nights.nights.iloc[-1]["run_id"])
    site.page(
        href,
        "history.html.j2",
        **labels,
        comparisons=_comparisons_of(newest, runs) if newest else [],
        mismatches=read_mismatches(newest.folder) if newest else [],
        **page_values(history, address, site.repository),
    )


def _comparisons_of(run: _Run, runs: Sequence[_Run]) -> list[tuple[str, str, Comparison]]:
    found = []
    for place, words in run.comparisons:
        before = next(one for one in runs if place == f"compare/{one.name}-vs-{run.name}.html")
        found.append((f"../{place}", words, compare(before.entry, run.entry)))
    return found


def _choices(runs: Sequence[_Run]) -> str:
    """Returns JSON for any.js: the runs that can be chosen."""
    choices = [
        {
            "name": run.name,
            "sweep": run.entry.sweep,
            "date": run.entry.date,
            "machine": run.entry.machine_title,
            "commit": run.entry.commit[:12],
        }
        for run in runs
        if run.entry.sweep
    ]
    return json.dumps(choices, separators=(",", ":")).replace("<", "\\u003c")
