"""Describes the parts that are missing from a run's folder, with remedies."""

import shlex
from collections.abc import Iterator, Mapping, Sequence

from beambench_report.base.cell_files import IDENTITY, CellFile, Identity, identity
from beambench_report.base.machine import Manifest
from beambench_report.base.records import FAULTLESS_VERDICTS, Run
from beambench_report.run.images import Figures, Image


def report_command(run: Run) -> str:
    """Returns the command that adds figures and pictures to the folder of the run."""
    return f"beambench report {shlex.quote(str(run.directory))}"


def not_begun(run: Run, manifest: Manifest) -> list[str]:
    """Returns the scenes without any cell in an interrupted run."""
    known = set(run.rows["scene"])
    return [scene for scene in manifest.scenes if manifest.cut_off and scene not in known]


def absent(
    run: Run,
    manifest: Manifest,
    files: Mapping[Identity, CellFile],
    figures: Figures,
    pictures: Sequence[Image],
) -> Iterator[str]:
    """Yields a sentence for each part that is missing from the folder, and so from the page."""
    if not manifest.run_id:
        yield "There is no manifest.json: the machine and its state are unknown."
    if not (run.directory / "config.json").is_file():
        yield (
            "There is no config.json: it is unknown whether the sweep left out the cells that are "
            "missing."
        )
    timed = run.rows.loc[run.rows["timed"], list(IDENTITY)]
    repeated = {cell for cell, file in files.items() if file.total_ms}
    without = sum(identity(row) not in repeated for row in timed[list(IDENTITY)].to_dict("records"))
    if not repeated:
        yield (
            "The repetitions of the cells are not in this folder: ratios compare medians and have "
            "wider intervals."
        )
    elif without:
        yield (
            f"The repetitions of {without:,} of {len(timed):,} timed cells are not in this folder: "
            "their ratios compare medians and have wider intervals."
        )
    wrong = ~run.rows["verdict"].isin(FAULTLESS_VERDICTS)
    if wrong.any() and not any(file.message for file in files.values()):
        yield "This folder does not state why cells were wrong; the run's run.jsonl does."
    for kind in figures.missing:
        yield f"There is no figure '{kind.name}'; it needs {kind.needs}."
    if not pictures:
        yield f"There are no pictures of the scenes; render them: {report_command(run)}"
