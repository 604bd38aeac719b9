"""The page of a run: one HTML file that holds everything and loads nothing from a network."""

import json
import re
import shlex
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from math import log2
from pathlib import Path

import pandas as pd

from beambench_report.base.cell_files import CellFile, Identity, ratio_of, read_cell_files
from beambench_report.base.columns import COUNTER_SUFFIX, dictionary
from beambench_report.base.files import Problem, write_text
from beambench_report.base.machine import (
    Manifest,
    read_description,
    read_exclusions,
    read_manifest,
)
from beambench_report.base.names import PLOT_INDEX, file_stems
from beambench_report.base.palette import css_color
from beambench_report.base.quantities import number, size_in_words
from beambench_report.base.ratio import Ratio
from beambench_report.base.records import BASELINE, OK, Run, read_run, size_of
from beambench_report.run.all_cells import pack
from beambench_report.run.html import environment, thumbnail_uri
from beambench_report.run.inline_svg import dark_variables, inline_svg
from beambench_report.run.outcome import doubts_about_times, summarize_verdicts
from beambench_report.run.standings import REFERENCES, Standings, in_words, overall, standings


@dataclass(frozen=True)
class Heading:
    """The head of a column; `column` names its entry in the data dictionary."""

    title: str
    unit: str = ""
    column: str = ""
    is_number: bool = True


@dataclass(frozen=True)
class Field:
    """A field: what is read, what it sorts by, and smaller words behind it."""

    text: str
    value: float | str | None
    note: str = ""


@dataclass(frozen=True)
class Line:
    """A contender's line; the shares are those of its bar, 1 being the whole width."""

    contender: str
    color: str
    verdict: str
    fields: tuple[Field, ...]
    anchor: str = ""
    """Of its row among all cells."""
    is_reference: bool = False
    """Is it `null` or `exhaustive`, which stand apart?"""
    build_share: float = 0.0
    trace_share: float = 0.0
    off_the_scale: bool = False


@dataclass(frozen=True)
class Table:
    """Headings and lines; lines beyond what a page can show are counted only."""

    caption: str
    headings: tuple[Heading, ...]
    lines: tuple[Line, ...]
    unshown: int = 0
    left_out: tuple[tuple[str, str], ...] = ()
    """Contenders without a row here, each with the reason."""


@dataclass(frozen=True)
class Image:
    """An image that is part of the page: a picture by its address, or a plot by its element."""

    caption: str
    subject: str
    """The scene (of a picture) or the view (of a plot) it belongs to; empty: the whole run."""
    uri: str = ""
    svg: str = ""


def read_pictures(directory: Path, scenes: Iterable[str]) -> list[Image]:
    """The pictures of DIRECTORY/pictures: `<scene>.png` and `<scene>-<what it shows>.png`."""
    stems = {stem: scene for scene, stem in file_stems(dict.fromkeys(scenes)).items()}
    images = []
    for path in sorted(directory.glob("pictures/*.png"), key=lambda path: path.stem):
        # The longest stem that fits: `tetra-n-6` is not the scene `tetra`.
        fitting = [s for s in stems if path.stem == s or path.stem.startswith(f"{s}-")]
        stem = max(fitting, key=len, default="")
        what = path.stem.removeprefix(stem).strip("-").replace("-", ", ").replace("_", " ")
        images.append(Image(what or "the scene", stems.get(stem, ""), thumbnail_uri(path)))
    return images


def read_plots(directory: Path) -> list[Image]:
    """The plots of DIRECTORY/plots, by the index that was written with them."""
    index = directory / "plots" / PLOT_INDEX
    if not index.exists():
        return []
    return [
        Image(entry["summary"], entry["view"], svg=inline_svg(path))
        for entry in json.loads(index.read_text("utf-8"))
        if (path := index.with_name(f"{entry['stem']}.svg")).exists()
    ]


@dataclass(frozen=True)
class Compared:
    """The rows of one view at one resolution, and each contender's ratio to the reference."""

    rows: pd.DataFrame
    ratios: Mapping[str, Ratio]


def choose_reference(run: Run, wanted: str | None = None) -> str | None:
    """The contender that others are compared with: correct in the most views, of equals Embree.

    None where no contender has correct hits. Raises Problem for a name the run does not have.
    """
    right = run.rows[run.rows["timed"] & (run.rows["verdict"] == OK)]
    contenders = list(dict.fromkeys(right["contender"]))
    if wanted is not None:
        return _chosen(wanted, contenders)
    views = right.groupby("contender")["view"].nunique()
    return max(
        contenders, key=lambda name: (views[name], name.split()[0] == "embree"), default=None
    )


def _chosen(wanted: str, contenders: list[str]) -> str:
    """The contender of that name, or the only one of that structure."""
    if wanted in contenders:
        return wanted
    variants = [name for name in contenders if name.split()[0] == wanted]
    if len(variants) == 1:
        return variants[0]
    if variants:
        listed = " or ".join(f"'{name}'" for name in variants)
        raise Problem(f"'{wanted}' is the structure of {len(variants)} contenders; name {listed}")
    raise Problem(f"no contender '{wanted}' was right; there are: {', '.join(contenders)}")


def compared(
    run: Run, view: str, reference: str | None, files: Mapping[Identity, CellFile]
) -> list[Compared]:
    """A view at each of its resolutions, the finest first."""
    groups = [rows for _, rows in run.view(view).groupby(["rays", "width", "height"])]
    return [Compared(rows, _ratios(rows, reference, files)) for rows in reversed(groups)]


def _ratios(
    rows: pd.DataFrame, reference: str | None, files: Mapping[Identity, CellFile]
) -> dict[str, Ratio]:
    timed = rows[rows["timed"]].drop_duplicates("contender", keep="last").set_index("contender")
    if reference not in timed.index:
        return {}
    base = timed.loc[reference]
    result = {}
    for contender, row in timed.iterrows():
        if contender == reference:
            result[contender] = Ratio(1.0)
        elif base["total_ms_median"] > 0:
            result[contender] = ratio_of("total", row, base, files)
    return result


MISSING = Field("–", None)  # noqa: RUF001
_MOST_LINES = 60
_FAR = 12  # a time this many times the median one would flatten the others' bars


def view_table(
    caption: str,
    rows: pd.DataFrame,
    ratios: Mapping[str, Ratio],
    left_out: tuple[tuple[str, str], ...] = (),
) -> Table:
    """Times and memory, the quickest first; then those without times; references last."""
    ordered = _in_order(rows)
    headings = (
        Heading("trace", "ns per ray", "trace_ms_median"),
        Heading("trace", "ms", "trace_ms_median"),
        Heading("build", "ms", "build_ms_median"),
        Heading("total", "ms", "total_ms_median"),
        Heading("total", "to reference"),
        Heading("trace, net", "ms", "trace_net_ms_median"),
        Heading("speed", "Mrays/s", "mrays_per_s"),
        Heading("memory", "", "memory_bytes"),
    )
    scale = _scale(ordered.loc[ordered["timed"], "total_ms_median"])
    lines = tuple(
        _line(row, ratios.get(row["contender"]), scale)
        for _, row in ordered.head(_MOST_LINES).iterrows()
    )
    present = set(rows["contender"])
    absent = tuple(one for one in left_out if one[0] not in present)
    return Table(caption, headings, lines, len(ordered) - len(lines), absent)


def work_table(caption: str, rows: pd.DataFrame, counters: list[str]) -> Table | None:
    """Counters per ray; None where nothing was counted."""
    counters = [name for name in counters if rows[name].notna().any() and (rows[name] != 0).any()]
    counted = rows[rows[counters].notna().any(axis=1)] if counters else rows.iloc[:0]
    if counted.empty:
        return None
    headings = tuple(Heading(_counter_title(name), "", name) for name in counters)
    lines = tuple(
        _bare_line(row, tuple(_figure(row[name]) for name in counters))
        for _, row in _in_order(counted).head(_MOST_LINES).iterrows()
    )
    return Table(caption, headings, lines)


def _in_order(rows: pd.DataFrame) -> pd.DataFrame:
    """The quickest trace first, references last."""
    times = rows["trace_ms_median"].where(rows["timed"])
    keys = pd.DataFrame({"reference": rows["structure"].isin(REFERENCES), "time": times})
    return rows.loc[keys.sort_values(["reference", "time"], kind="stable").index]


def _bare_line(row: pd.Series, fields: tuple[Field, ...]) -> Line:
    return Line(
        row["contender"],
        css_color(row["structure"]),
        row["verdict"] or "no verdict",
        fields,
        cell_anchor(row),
        row["structure"] in REFERENCES,
    )


def cell_anchor(row: Mapping[str, object]) -> str:
    """The name by which a link opens one cell; templates/cells.js makes the same."""
    words = f"{row['view']} {size_of(row)} {row['contender']}"
    return "cell-" + re.sub(r"[^a-z0-9]+", "-", words.lower()).strip("-")


def ratio_field(ratio: Ratio | None) -> Field:
    """A ratio with its interval; one that is not paired says so."""
    if ratio is None:
        return MISSING
    note = ""
    if ratio.interval:
        note = f"{number(ratio.low)} to {number(ratio.high)}"
        note += "" if ratio.paired else ", not paired"
    return Field(number(ratio.value), ratio.value, note)


def _line(row: pd.Series, ratio: Ratio | None, scale: float) -> Line:
    timed = bool(row["timed"])

    def time(part: str, factor: float = 1.0) -> Field:
        if not timed:
            return MISSING
        low, high = (
            row.get(f"{part}_ms_ci_{end}", float("nan")) * factor for end in ("low", "high")
        )
        note = f"{number(low)} to {number(high)}" if pd.notna(low) and pd.notna(high) else ""
        return _figure(row[f"{part}_ms_median"] * factor, note)

    build, trace = time("build"), time("trace")
    memory = row["memory_bytes"]
    shares = [(field.value or 0.0) / scale for field in (build, trace)]
    fields = (
        time("trace", 1e6 / row["rays"] if row["rays"] > 0 else float("nan")),
        trace,
        build,
        time("total"),
        ratio_field(ratio),
        _figure(row.get("trace_net_ms_median") if timed else None),
        _figure(row.get("mrays_per_s") if timed else None),
        MISSING if pd.isna(memory) else Field(size_in_words(memory), memory),
    )
    return replace(
        _bare_line(row, fields),
        build_share=min(shares[0], 1.0),
        trace_share=max(min(shares[1], 1.0 - shares[0]), 0.0),
        off_the_scale=sum(shares) > 1.0,
    )


def _figure(value: float | None, note: str = "") -> Field:
    if value is None or pd.isna(value):
        return MISSING
    return Field(number(value), value, note)


def _counter_title(name: str) -> str:
    return name.removesuffix(COUNTER_SUFFIX).replace("_", " ")


def _scale(totals: pd.Series) -> float:
    near = totals[totals <= _FAR * totals.median()]
    return near.max() if len(near) > 0 and near.max() > 0 else 1.0


@dataclass(frozen=True)
class View:
    """What is shown of one view; the first table is that of the finest resolution."""

    title: str
    anchor: str
    primitives: int
    pictures: tuple[Image, ...]
    plots: tuple[Image, ...]
    tables: tuple[Table, ...]
    work: Table | None
    standings: Standings


def make_views(
    resolutions: Mapping[str, list[Compared]],
    every: Mapping[str, Standings],
    counters: list[str],
    pictures: list[Image],
    plots: list[Image],
) -> list[View]:
    """A section for each view; `resolutions` has its rows, the finest first."""
    stems = file_stems(resolutions)
    views = []
    for title, groups in resolutions.items():
        first = groups[0].rows.iloc[0]
        views.append(
            View(
                title,
                f"view-{stems[title]}",
                0 if pd.isna(first["primitives"]) else int(first["primitives"]),
                tuple(image for image in pictures if image.subject == first["scene"]),
                tuple(image for image in plots if image.subject == title),
                tuple(
                    view_table(
                        _caption(group.rows), group.rows, group.ratios, every[title].left_out
                    )
                    for group in groups
                ),
                work_table(f"work per ray, {_caption(groups[0].rows)}", groups[0].rows, counters),
                every[title],
            )
        )
    return views


def _caption(rows: pd.DataFrame) -> str:
    first = rows.iloc[0]
    samples = f", {first['samples']:.0f} samples per pixel" if first["samples"] > 1 else ""
    return f"{size_of(first)}{samples}, {first['rays']:,.0f} rays"


_DEEPEST = 4.0  # doublings at which the shade is full


@dataclass(frozen=True)
class Mark:
    """A field of the overview, shaded by how far it is from the reference."""

    field: Field
    verdict: str
    side: str
    depth: float


@dataclass(frozen=True)
class Comparison:
    """Contenders down, views across."""

    reference: str
    views: tuple[str, ...]
    lines: tuple[tuple[str, str, tuple[Mark, ...]], ...]
    """Contender, its color, its marks in the order of the views."""


def compare(reference: str, finest: Mapping[str, Compared]) -> Comparison:
    """The overview of all views, each at its highest resolution."""
    structures: dict[str, str] = {}
    verdicts: dict[tuple[str, str], str] = {}
    for view, shown in finest.items():
        for row in shown.rows.itertuples():
            structures.setdefault(row.contender, row.structure)
            verdicts[row.contender, view] = row.verdict
    structures = dict(sorted(structures.items(), key=lambda one: one[1] in REFERENCES))
    lines = tuple(
        (
            contender,
            css_color(structure),
            tuple(
                _mark(shown.ratios.get(contender), verdicts.get((contender, view)))
                for view, shown in finest.items()
            ),
        )
        for contender, structure in structures.items()
    )
    return Comparison(reference, tuple(finest), lines)


def _mark(ratio: Ratio | None, verdict: str | None) -> Mark:
    if verdict is None:
        return Mark(MISSING, "", "", 0.0)
    if ratio is None or ratio.value <= 0 or verdict == BASELINE:
        return Mark(ratio_field(ratio), verdict, "", 0.0)
    doublings = log2(ratio.value)
    side = "slower" if doublings > 0 else "faster"
    return Mark(ratio_field(ratio), verdict, side, min(abs(doublings) / _DEEPEST, 1.0))


PAGE = "report.html"


def write_page(directory: Path, reference: str | None = None) -> list[Path]:
    """Writes DIRECTORY/report.html from what the folder of a run holds.

    Ratios are to the contender named `reference`, or to one that suits (see `choose_reference`).
    """
    return [write_text(directory / PAGE, render(read_run(directory), reference))]


def render(run: Run, wanted_reference: str | None = None) -> str:
    """The text of the page."""
    manifest = read_manifest(run.directory) or Manifest()
    files = read_cell_files(run.directory)
    reference = choose_reference(run, wanted_reference)
    resolutions = {view: compared(run, view, reference, files) for view in run.views}
    finest = {view: groups[0] for view, groups in resolutions.items()}
    plots = read_plots(run.directory)
    pictures = read_pictures(run.directory, run.rows["scene"])
    every = standings(run, files, read_exclusions(run.directory))
    by_view = {one.view: one for one in every}
    return (
        environment()
        .get_template("page.html.j2")
        .render(
            manifest=manifest,
            description=read_description(run.directory),
            newest=run.rows.iloc[-1].to_dict(),
            outcome=summarize_verdicts(run, files),
            doubts=doubts_about_times(run, manifest),
            is_timed=bool(run.rows["timed"].any()),
            means=overall(every),
            absent=_absent(run, manifest, plots, pictures, files),
            color=css_color,
            dark=dark_variables(),
            interval=ratio_field,
            in_words=in_words,
            tiles=_tiles(run, manifest),
            comparison=compare(reference, finest) if reference else None,
            views=make_views(resolutions, by_view, run.counters, pictures, plots),
            plots=[plot for plot in plots if not plot.subject],
            cells=pack(run),
            dictionary=dictionary(),
        )
    )


def _absent(
    run: Run,
    manifest: Manifest,
    plots: list[Image],
    pictures: list[Image],
    files: Mapping[Identity, CellFile],
) -> list[str]:
    """What the folder lacks, and how it is made."""
    here = shlex.quote(str(run.directory))
    report = "python -m beambench_report"
    return [
        sentence
        for is_there, sentence in (
            (manifest.run_id, "There is no manifest.json: the machine and its state are unknown."),
            (
                files,
                "There are no single repetitions: ratios are of medians and have wider intervals.",
            ),
            (plots, f"There are no plots; draw them: {report} plots {here}"),
            (
                pictures,
                f"There are no pictures of the scenes; render them: {report} pictures {here} "
                "--beambench build/release/bin/beambench",
            ),
        )
        if not is_there
    ]


def _tiles(run: Run, manifest: Manifest) -> list[tuple[str, str]]:
    """A few figures that say how large the run was and how well it could measure."""
    tiles = [
        (f"{len(run.views):,}", "views" if len(run.views) != 1 else "view"),
        (f"{run.rows['contender'].nunique():,}", "contenders"),
    ]
    if manifest.overhead is not None:
        tiles.append(
            (f"{100 * manifest.overhead:.2g}%", "of the fastest trace is the harness's, at most")
        )
    return tiles
