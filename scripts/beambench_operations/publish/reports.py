"""Reports in results/published that other commands write from the same rows."""

import shutil
import tempfile
from collections.abc import Callable, Sequence
from functools import cache, partial
from pathlib import Path

from beambench_operations.campaign.record import Record
from beambench_operations.campaign.report import as_markdown as as_campaigns
from beambench_operations.publish.layout import with_small_images
from beambench_report.base.records import read_run
from beambench_report.embree_comparison.pairings import pairings
from beambench_report.embree_comparison.report import as_markdown as as_comparison
from beambench_report.haines.report import write_report as write_haines
from beambench_report.havran.report import write_report as write_havran
from beambench_report.run.ratio_table import write_ratios
from beambench_report.run.winners import write_winners
from beambench_thesis.chapter6.report import report as report_on_cluster
from beambench_thesis.report.plan import read_plan
from beambench_thesis.report.report import gather
from beambench_thesis.report.write import MARKDOWN as THESIS_TEXTS
from beambench_thesis.report.write import as_markdown as as_thesis

WATERTIGHT = "embree robust=true"
BEAT_EMBREE = ("main", "scenes", "soup", "cones", "avx2", "scaling", "resolutions")
PENCILS = ("shadows", "mirrors", "pictures")


def _comparison(names: Sequence[str], folder: Path) -> str:
    """Returns the comparison, with the figures in its folder."""
    runs = [read_run(folder / name) for name in names if (folder / name).is_dir()]
    drawn = {path.stem: path.name for path in sorted(folder.glob("beat-embree*.[ps][nv]g"))}
    return as_comparison(pairings(runs), [drawn[stem] for stem in sorted(drawn)])


def _thesis(name: str, folder: Path) -> str:
    """Returns a text on the thesis. No octrees are drawn, since their pictures exist already."""
    return _thesis_texts(folder)[name]


@cache
def _thesis_texts(folder: Path) -> dict[str, str]:
    return as_thesis(gather(folder, read_plan(folder), Path()))


def _in_copy(write: Callable[[Path], object], folder: Path) -> str:
    """Runs the command that writes a report in a copy of the folder; returns the report."""
    with tempfile.TemporaryDirectory() as copy:
        for table in (*folder.glob("*.csv"), *folder.glob("*.json")):
            shutil.copy(table, copy)
        write(Path(copy))
        return (Path(copy) / "report.md").read_text("utf-8")


_REPORTS: dict[str, Callable[[Path], str]] = {
    "beat-embree/report.md": partial(_comparison, BEAT_EMBREE),
    "cluster/report.md": lambda folder: report_on_cluster(folder)[0],
    "haines/report.md": partial(_in_copy, write_haines),
    "havran/report.md": partial(_in_copy, write_havran),
    "libraries/to-embree.md": partial(write_ratios, base=WATERTIGHT),
    "libraries/to-tinybvh.md": partial(write_ratios, base="tinybvh"),
    "pencils/report.md": partial(_comparison, PENCILS),
    "robustness/campaigns.md": lambda folder: as_campaigns(Record(folder).pieces()),
    "structures/winners.md": write_winners,
    **{f"thesis/{name}": partial(_thesis, name) for name in THESIS_TEXTS},
}


def report_names() -> list[str]:
    """Returns the paths of the reports within results/published."""
    return list(_REPORTS)


def report(name: str, folder: Path) -> str:
    """Returns the text of a report on the rows in its folder."""
    return with_small_images(_REPORTS[name](folder), folder)
