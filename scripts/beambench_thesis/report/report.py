"""Gathers the contents of the report from the runs of a folder."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from beambench.analysis import MARGIN
from beambench_report.base.files import Problem, read_json
from beambench_report.base.machine import Manifest, read_manifest
from beambench_thesis.chapter5.best import BestTable, best_table
from beambench_thesis.chapter5.cost import cost_section
from beambench_thesis.chapter5.facts import CENSUS, camera_section, scenes_section, visits_section
from beambench_thesis.chapter5.grid_beams import grid_beams_section
from beambench_thesis.chapter5.levels import levels_section
from beambench_thesis.chapter5.mirrors import mirrors_section, read_mirrors
from beambench_thesis.chapter5.sampling import read_comparisons, sampling_section
from beambench_thesis.chapter6.results import is_cluster_folder
from beambench_thesis.claims.register import (
    ALL_CLAIMS,
    SWEPT_CLAIMS,
    JudgedClaim,
    judge_claims,
    named,
)
from beambench_thesis.claims.variants_file import NAME as VARIANTS_FILE
from beambench_thesis.claims.variants_file import with_variants
from beambench_thesis.claims.verdict import Outcome, Verdict
from beambench_thesis.paper.cells import Cell, Cells, read_cells
from beambench_thesis.paper.evidence import Evidence, one_level_less
from beambench_thesis.paper.measured import SPREAD_OF_PARTS, is_census_folder, measured_evidence
from beambench_thesis.paper.printed import parts_of
from beambench_thesis.paper.section import Section
from beambench_thesis.report.drawing import FigureData
from beambench_thesis.report.figures import make_figures
from beambench_thesis.report.pictures import PictureFigure, octree_figures
from beambench_thesis.report.plan import LEVELS, LOW_RESOLUTIONS, TABLES, Plan, Sweep, Table
from beambench_thesis.report.runner import state_of
from beambench_thesis.report.tables import PartTable, WorkTable, fill, work_of_lines

SAMPLING = "sampling"
"""The folder with output of `beambench sampling SCENE --json`."""
MIRRORS = "mirrors"
"""The folder with output of `beambench mirrors SCENE --json`."""
CLUSTER = "cluster"
"""The folder of the simulated cluster, beside that of the report."""
GRID_BEAMS = "grid-beams"
"""The folder of the run of harness/measure/sweeps/grid-beams.json."""


@dataclass(frozen=True)
class Part:
    """A part of a table as in the thesis, with memory and work, and best against best."""

    table: PartTable
    best: BestTable | None

    @cached_property
    def work(self) -> WorkTable:
        """Returns memory and work of every cell of the table."""
        return work_of_lines(self.table.lines)


@dataclass(frozen=True)
class RunSummary:
    """A run and its state."""

    name: str
    description: str
    state: str
    planned: int
    cells: tuple[Cell, ...]
    manifest: Manifest

    @property
    def wrong(self) -> int:
        """The number of cells without times."""
        return sum(cell.time is None for cell in self.cells)


@dataclass(frozen=True)
class Report:
    """The contents of a report in any format."""

    directory: Path
    plan: Plan
    cells: Cells
    tables: tuple[tuple[Table, tuple[Part, ...]], ...]
    figures: tuple[FigureData, ...]
    pictures: tuple[PictureFigure, ...]
    claims: tuple[JudgedClaim, ...]
    sections: tuple[Section, ...]
    """Sections beyond the thesis's own tables and figures."""
    runs: tuple[RunSummary, ...]


def gather(directory: Path, plan: Plan, beambench: Path | None = None) -> Report:
    """Reads the runs; parts that were not measured are left out and listed."""
    sweeps = [*plan.sweeps, *_extra_sweeps(directory, plan)]
    every = read_cells(directory, (sweep.name for sweep in sweeps))
    # LEVELS has no cells of tables, figures and claims.
    cells = every.without(LEVELS)
    sections, unread = sections_of(directory, every)
    pictures = ()
    if beambench is not None and cells.cells:
        pictures = tuple(octree_figures(plan.figures, directory, beambench))
    censuses = [folder] if is_census_folder(folder := directory / CENSUS) else []
    clusters = [folder] if is_cluster_folder(folder := directory.parent / CLUSTER) else []
    return Report(
        directory,
        plan,
        replace(every, unread=(*every.unread, *unread)),
        tuple(
            (table, _parts(table, cells, directory, plan))
            for table in TABLES
            if table.number in plan.tables
        ),
        tuple(make_figures(plan.figures, cells)),
        pictures,
        tuple(_judged(directory, plan, [*cells.runs, *censuses, *clusters], bool(clusters))),
        tuple(sections),
        tuple(_summary(directory, sweep, every) for sweep in sweeps),
    )


def _judged(
    directory: Path, plan: Plan, runs: Sequence[Path], with_clusters: bool
) -> list[JudgedClaim]:
    """Judges the claims by the runs, and by variants or the table that replaces them."""
    claims = judge_claims(
        runs,
        ALL_CLAIMS if with_clusters else SWEPT_CLAIMS,
        variants=variants_of(directory, plan),
        deeper=deeper_of(directory, plan),
    )
    return claims if plan.variants else with_variants(claims, directory / VARIANTS_FILE)


def variants_of(directory: Path, plan: Plan) -> list[Evidence]:
    """Returns the evidence from each variant of the scenes whose sweeps are all finished."""
    found = (_at_low_resolutions(directory, sweeps) for sweeps in plan.variants)
    return [evidence for evidence in found if evidence is not None]


def deeper_of(directory: Path, plan: Plan) -> Evidence | None:
    """Returns the evidence by the other reading of the levels, if its sweeps are all finished."""
    found = _at_low_resolutions(directory, plan.deeper)
    return one_level_less(found) if found else None


def _at_low_resolutions(directory: Path, sweeps: Sequence[Sweep]) -> Evidence | None:
    folders = [directory / sweep.name for sweep in sweeps]
    if not folders or any(state_of(folder) != "finished" for folder in folders):
        return None
    return measured_evidence(folders, LOW_RESOLUTIONS)


def sections_of(directory: Path, cells: Cells) -> tuple[list[Section], list[str]]:
    """Returns the measured sections, and a sentence for each file that could not be read."""
    comparisons, unread = read_comparisons(sorted((directory / SAMPLING).glob("*.json")))
    mirrors, unread_mirrors = read_mirrors(sorted((directory / MIRRORS).glob("*.json")))
    grid_beams = read_cells(directory, [GRID_BEAMS])
    sections = (
        scenes_section(directory),
        visits_section(directory),
        camera_section(directory),
        cost_section(cells.cells),
        levels_section(cells.cells),
        sampling_section(comparisons),
        mirrors_section(mirrors),
        grid_beams_section(grid_beams.cells),
    )
    shown = [section for section in sections if section is not None]
    return shown, [*unread, *unread_mirrors, *grid_beams.unread]


def _extra_sweeps(directory: Path, plan: Plan) -> list[Sweep]:
    """Returns the sweep of levels, if it was run in DIRECTORY/levels without being planned."""
    if any(sweep.name == LEVELS for sweep in plan.sweeps):
        return []
    try:
        source = read_json(directory / LEVELS / "config.json")
    except (OSError, Problem):
        return []
    return [Sweep(LEVELS, source)] if isinstance(source, dict) else []


def _parts(table: Table, cells: Cells, directory: Path, plan: Plan) -> tuple[Part, ...]:
    sweeps = [sweep for sweep in plan.sweeps if sweep.name in table.first]

    def why(resolution: str) -> str:
        wanted = [sweep for sweep in sweeps if resolution in sweep.source["resolutions"]]
        if not wanted:
            return "quick run" if plan.is_quick else "not selected"
        states = {state_of(directory / sweep.name) for sweep in wanted}
        return {"waiting": "not run", "begun": "run cut off"}.get(states.pop(), "not measured")

    return tuple(
        Part(fill(part, cells, why), best_table(part, cells)) for part in parts_of(table.number)
    )


def _summary(directory: Path, sweep: Sweep, cells: Cells) -> RunSummary:
    return RunSummary(
        sweep.name,
        sweep.description,
        state_of(directory / sweep.name),
        len(sweep.cells()),
        tuple(cell for cell in cells.cells if cell.run == sweep.name),
        read_manifest(directory / sweep.name) or Manifest(),
    )


# The report's texts, the same in Markdown and on the page

TABLE_WORDS = (
    "The tables have the thesis's seconds (a Pentium of 350 MHz, 1999) and our milliseconds, which "
    "cannot be compared, because the machines differ too much. The shapes in parentheses can be "
    "compared: a shape is a time relative to the first row of the same part at 320x200. Times "
    "include building the structure, as in the thesis; our build time follows the total. "
    "Parameters are the thesis's: octrees of level 6 unless the table says otherwise, 32 voxels "
    "per axis filled lazily, objects inserted as given beside terminal nodes (insert=terminal), "
    "Kay and Kajiya's queue, no handover. Rows marked (of today) or (Goldsmith and Salmon 1987) "
    "are not in the thesis."
)


def claim_words(claims: Sequence[JudgedClaim]) -> str:
    """Returns how claims are judged, and what the columns of their table mean."""
    varied = _VARIED_WORDS if any(one.variants for one in claims) else ""
    return f"{_CLAIM_WORDS}{varied}{_RANKING_WORDS}"


_CLAIM_WORDS = (
    "Each claim is tested by a rule that makes comparisons for each scene and resolution that the "
    "claim concerns. Supported: every comparison agrees; contradicted: most comparisons show the "
    "opposite; mixed: in between; undecided: the verdict depends on differences that chance may "
    "explain, or that were measured too seldom; not testable: the claim depends on something that "
    "the thesis does not state. The effect is the geometric mean, over the comparisons, of the "
    "quantity that should be larger divided by the quantity that should be smaller, or the median "
    "of a figure; the minimum and maximum in parentheses are not an interval. "
)
_VARIED_WORDS = (
    "Variants are perturbed scenes with other seeds, cameras and places of objects. They are "
    "judged only at 320x200 and 640x480; statements about 1280x1024 are judged at 640x480. Levels "
    "read otherwise: one line of section 5.4 seems to count levels from one less, so each octree "
    "is one level deeper, at the same resolutions. "
)
_RANKING_WORDS = (
    "Beams test the samples of a leaf one by one, as single rays are tested, without SIMD. Times "
    "of the same blocks are ranked by their paired ratio: they are equal if its 95% confidence "
    f"interval ends within {MARGIN:.0%} of 1; otherwise, one is below the other if the interval "
    "does not contain 1. Times of different blocks are compared by their 95% prediction intervals. "
    f"For the times of single tasks, intervals of {SPREAD_OF_PARTS:.0%} to either side are "
    "assumed, from two repeated runs. Formerly: the verdict in the words of version 0.2, which "
    "called every mixture of comparisons 'holds in part'."
)
STAND_IN_WORDS = (
    "The files of the thesis's scenes are lost. Ours have the same names and numbers of primitives "
    "and follow the thesis's descriptions. Figures of the lost objects themselves, such as the "
    "number of maceta's beams and the sizes of hierarchies, are compared but need not agree. The "
    "thesis's test of a cube and a polygon (section 3.3) is exact and puts the same objects into "
    "each leaf as ours (tests/accel/thesis_overlap_test.cpp). Until commit 7811fb1 bola-espacial, "
    "delfines and maceta were modeled after figures and sentences that they then tested; now they "
    "only follow the thesis's descriptions."
)
OTHER_SYSTEMS = (
    (
        "Cones (Amanatides 1984, Kirk 1987)",
        "are rays that widen and determine how much of a cone is covered by objects, so that one "
        "ray yields a smooth edge or a penumbra; the result is an estimate of coverage, not a hit "
        "that could be verified.",
    ),
    (
        "Paraxial pencils (Shinya, Takahashi and Naito 1987)",
        "follow the rays near an axial ray by a matrix, and compute the picture from this "
        "approximation; here, beams through glass use the linear approximation of neighboring "
        "rays, but the hits of the rays themselves.",
    ),
    (
        "Coherent rays in cylinders (Speer and others 1986)",
        "follow their neighbors as long as they stay in a cylinder that nothing else enters; "
        "section 2.2.1.2 already says that they cost more than single rays.",
    ),
    (
        "Ray coherence (Ohta and Maekawa 1987)",
        "lists for each object the objects that rays from it meet in each direction; the lists "
        "grow with the square of the number of objects, and ray classification, which is measured, "
        "keeps such lists for the rays that occur.",
    ),
    (
        "Octrees above bounding volumes (Scherson and Caspary 1987)",
        "end an octree early and put hierarchies of volumes into its leaves; both halves are "
        "measured, and the thesis does not say where to switch from one to the other.",
    ),
    (
        "Hierarchies from octrees (Glassner 1988)",
        "use the nodes of an octree over space and time as volumes that do not overlap; they are "
        "meant for scenes that move, and the thesis's scenes do not move.",
    ),
)
"""Systems surveyed in chapter 2 that are not measured here: a name, and the rest of a sentence."""
FIRST_FIGURES = ("5.7", "5.8", "5.12", "5.16")
"""The figures that show the thesis and ours side by side; the others are among the details."""
BEST_WORDS = (
    "Each contender with its fastest parameters, building included. In parentheses: its time "
    "relative to the first row, and the interval of this ratio."
)


def headline(report: Report) -> str:
    """Returns the number of measured cells, and whether the hits were correct."""
    cells, wrong = len(report.cells.cells), len(report.cells.wrong)
    if not cells:
        return "Nothing has been measured yet."
    right = f"{wrong} of them wrong, and without times" if wrong else "all with correct hits"
    return f"{cells:,} measurements in {len(report.cells.runs)} runs, {right}."


def notice(report: Report) -> str:
    """Returns warnings for the reader; empty if everything was measured completely."""
    sentences = []
    if any(run.state != "finished" for run in report.runs):
        sentences.append("Some planned runs are missing or incomplete (see Runs).")
    if report.plan.is_quick:
        decided = [
            one.claim.name for one in report.claims if one.ours.verdict is not Verdict.NOT_TESTED
        ]
        which = f": {', '.join(decided)}" if decided else ""
        sentences.append(
            "This was a quick run: low resolutions and few repetitions, for a first look, not "
            f"for verdicts. Its cells are enough for {len(decided)} of {len(report.claims)} claims"
            f"{which}; the others need cells that were not measured."
        )
    elif not report.plan.is_everything:
        sentences.append("Only some tables and figures were selected.")
    return " ".join(sentences)


def verdict_counts(report: Report) -> str:
    """Returns the number of claims by their verdicts."""
    counts = Counter(one.ours.verdict for one in report.claims)
    listed = ", ".join(f"{counts[v]} {v.value}" for v in Verdict if counts[v])
    return f"Of {len(report.claims)} claims: {listed}."


def undecided(report: Report) -> list[str]:
    """Returns a sentence for each undecided claim: the cells, and what would decide them."""
    return [
        f"{one.claim.says} ({one.claim.name}): {named(one.ours, Outcome.UNDECIDED)}"
        for one in report.claims
        if one.ours.verdict is Verdict.UNDECIDED
    ]
