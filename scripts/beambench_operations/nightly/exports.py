"""Exports the figures of a run in the formats of other tools.

customBiggerIsBetter: https://github.com/benchmark-action/github-action-benchmark
Google Benchmark: https://github.com/google/benchmark/blob/main/docs/tools.md (compare.py)
"""

import json
from pathlib import Path

import pandas as pd

from beambench_report.base.cell_files import name_of
from beambench_report.base.files import Problem, write_text
from beambench_report.base.records import Run, contenders_with_times

BIGGER_IS_BETTER = "benchmark-bigger-is-better.json"
GOOGLE_BENCHMARK = "benchmark-google.json"
_BY_BEAMBENCH = "google-benchmark.json"


def write_exports(run: Run) -> list[Path]:
    """Writes both files into the folder of a run; the second only if there are repetitions."""
    paths = [write_text(run.directory / BIGGER_IS_BETTER, bigger_is_better(run))]
    if (run.directory / _BY_BEAMBENCH).is_file():
        paths.append(write_text(run.directory / GOOGLE_BENCHMARK, google_benchmark(run)))
    return paths


def bigger_is_better(run: Run) -> str:
    """Returns millions of rays per second, build included, in the format customBiggerIsBetter."""
    entries = []
    for _, row in contenders_with_times(run.rows).iterrows():
        total = row["total_ms"]
        entry = {
            "name": benchmark_name(row),
            "unit": "Mrays/s",
            "value": row["rays"] / total / 1000,
            "extra": f"commit {row['commit'][:12]}, verdict {row['verdict']}, "
            f"build {row['build_ms_median']:.4g} ms, trace {row['trace_ms_median']:.4g} ms",
        }
        low, high = row["total_ms_ci_low"], row["total_ms_ci_high"]
        if pd.notna(low) and pd.notna(high) and low > 0:
            half = (row["rays"] / low - row["rays"] / high) / 2000
            entry["range"] = f"± {half:.4g}"
        entries.append(entry)
    return json.dumps(entries, indent=1, ensure_ascii=False) + "\n"


def google_benchmark(run: Run) -> str:
    """Returns the repetitions, as beambench wrote them for Google Benchmark's compare.py."""
    path = run.directory / _BY_BEAMBENCH
    if not path.is_file():
        raise Problem(f"{path}: is missing; write it: beambench analyze --write {run.directory}")
    return path.read_text("utf-8")


def benchmark_name(row: pd.Series) -> str:
    """Returns the name of a cell in Google Benchmark's style: parts between slashes, no spaces."""
    return name_of(row).replace(" ", "_")
