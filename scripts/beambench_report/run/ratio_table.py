"""Divides the times of a run's contenders by the times of one, or of a structure's fastest.

The table suits runs that compare programs over a few scenes: it has a row for each contender, a
column for each scene, and the geometric mean over the scenes. Only lists in their original order
count.
"""

from pathlib import Path

import pandas as pd
from scipy.stats import gmean

from beambench_report.base.files import Problem, write_text
from beambench_report.base.quantities import markdown_table, number
from beambench_report.base.records import OK, read_run

_VIEW = ["scene", "camera", "width", "height", "kind", "machine_id"]
_TIME = "trace_net_ms_median"


def write_ratios(run: Path, base: str, output: Path | None = None) -> str | list[Path]:
    """Returns the table as Markdown, or the file that was written.

    `base` is a contender, as plots name it, or a structure, which stands for its fastest contender
    with correct hits in each view. Raises Problem if the run has neither.
    """
    text = _text(read_run(run).rows, base)
    return [write_text(output, text)] if output else text


def _text(rows: pd.DataFrame, base: str) -> str:
    is_sorted = rows["ray_kind"].str.contains("order=sorted", regex=False)
    rows = rows[(rows["structure"] != "null") & ~is_sorted]
    correct = rows[rows["timed"] & (rows["verdict"] == OK) & (rows[_TIME] > 0)]
    ratios = _ratios(correct, base)
    kinds = list(dict.fromkeys(rows["kind"]))
    scenes = list(dict.fromkeys(rows["scene"]))
    contenders = list(dict.fromkeys(rows["contender"]))
    first_machine = correct.groupby("scene")["machine_id"].transform("first")
    on_one = correct[correct["machine_id"] == first_machine]
    build = on_one.groupby(["contender", "scene"])["build_ms_median"].first()
    body = []
    for contender in contenders:
        own = ratios[ratios["contender"] == contender]
        found = own.set_index(["scene", "kind"])["ratio"].groupby(level=[0, 1]).agg(gmean)
        cells = [
            f"{number(build[contender, scene]) if (contender, scene) in build else '-'}; "
            + ", ".join(
                f"{found[scene, kind]:.2f}" if (scene, kind) in found else "wrong" for kind in kinds
            )
            for scene in scenes
        ]
        means = [found[found.index.get_level_values(1) == kind] for kind in kinds]
        all_scenes = ", ".join(
            f"{gmean(of_kind):.3f}" if len(of_kind) == len(scenes) else "-" for of_kind in means
        )
        body.append((f"`{contender}`", *cells, all_scenes))
    heads = (f"build, ms; {', '.join(kinds)}", *(f"`{scene}`" for scene in scenes), "all scenes")
    wrong = rows[rows["timed"].isin([False]) | (rows["verdict"] != OK)]
    lines = [
        f"Median trace time, without the harness's share, over that of `{base}`, and geometric "
        "means over all scenes. Build times are in milliseconds, from the first kind of rays with "
        "correct hits.",
        "",
        *markdown_table(heads, body),
        "",
        f"{len(rows) - len(wrong)} of {len(rows)} cells have correct hits.",
        *(
            f"- `{row['contender']}` over `{row['scene']}`, {row['ray_kind']}: {row['verdict']}, "
            f"{row['structure_error']:.0f} of {row['rays']:.0f} rays"
            for _, row in wrong.iterrows()
        ),
    ]
    return "\n".join(lines) + "\n"


def _ratios(correct: pd.DataFrame, base: str) -> pd.DataFrame:
    """Returns the rows with `ratio`, the trace time over that of the base."""
    of_base = correct[(correct["contender"] == base) | (correct["structure"] == base)]
    if of_base.empty:
        names = ", ".join(sorted({*correct["contender"], *correct["structure"]}))
        raise Problem(f"no contender or structure '{base}' has correct hits; there are: {names}")
    fastest = of_base.groupby(_VIEW, as_index=False)[_TIME].min()
    both = correct.merge(fastest, on=_VIEW, suffixes=("", "_of_base"))
    return both.assign(ratio=both[_TIME] / both[f"{_TIME}_of_base"])
