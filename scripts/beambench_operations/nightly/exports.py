"""The figures of a run in the formats of other people's tools.

customBiggerIsBetter: https://github.com/benchmark-action/github-action-benchmark
Google Benchmark: https://github.com/google/benchmark/blob/main/docs/tools.md (compare.py)
"""

import json
from pathlib import Path

import pandas as pd

from beambench_report.base.cell_files import repetitions_of
from beambench_report.base.files import write_text
from beambench_report.base.records import Run, contenders_with_times, size_of
from beambench_report.base.run_log import logged_cells

BIGGER_IS_BETTER = "benchmark-bigger-is-better.json"
GOOGLE_BENCHMARK = "benchmark-google.json"


def write_exports(run: Run) -> list[Path]:
    """Writes both files into the folder of a run."""
    return [
        write_text(run.directory / BIGGER_IS_BETTER, bigger_is_better(run)),
        write_text(run.directory / GOOGLE_BENCHMARK, google_benchmark(run)),
    ]


def bigger_is_better(run: Run) -> str:
    """Returns million rays per second, build included, in the format customBiggerIsBetter."""
    entries = []
    for _, row in contenders_with_times(run.rows).iterrows():
        total = row["total_ms_median"]
        entry = {
            "name": benchmark_name(row),
            "unit": "Mrays/s",
            "value": _speed(row["rays"], total),
            "extra": f"commit {row['commit'][:12]}, verdict {row['verdict']}, "
            f"build {row['build_ms_median']:.4g} ms, trace {row['trace_ms_median']:.4g} ms",
        }
        low, high = row["total_ms_ci_low"], row["total_ms_ci_high"]
        if pd.notna(low) and pd.notna(high) and low > 0:
            half = (_speed(row["rays"], low) - _speed(row["rays"], high)) / 2
            entry["range"] = f"± {half:.4g}"
        entries.append(entry)
    return json.dumps(entries, indent=1, ensure_ascii=False) + "\n"


def google_benchmark(run: Run) -> str:
    """The repetitions as Google Benchmark writes them, so that compare.py can test them.

    From the raw samples where the run still has them; a run whose samples were pruned has its
    median as its only repetition.
    """
    samples = _samples(run.directory)
    entries = []
    for index, (_, row) in enumerate(contenders_with_times(run.rows).iterrows()):
        name = benchmark_name(row)
        times = samples.get(name) or [
            (row["total_ms_median"], _cpu_time(row)),
        ]
        for repetition, (real, cpu) in enumerate(times):
            entries.append(
                {
                    "name": name,
                    "family_index": index,
                    "per_family_instance_index": 0,
                    "run_name": name,
                    "run_type": "iteration",
                    "repetitions": len(times),
                    "repetition_index": repetition,
                    "threads": int(row["threads"]),
                    "iterations": 1,
                    "real_time": real,
                    "cpu_time": cpu,
                    "time_unit": "ms",
                }
            )
    first = run.rows.iloc[0]
    context = {
        "date": first.get("time_utc", ""),
        "executable": "beambench",
        "library_build_type": str(first.get("build_type", "")).lower(),
        "commit": first["commit"],
        "machine_id": first["machine_id"],
    }
    return json.dumps({"context": context, "benchmarks": entries}, indent=1) + "\n"


def benchmark_name(row: pd.Series) -> str:
    """The name of a cell: as Google Benchmark's, parts between slashes, no blanks."""
    accel = f"{row['structure']}:{row['parameters']}".rstrip(":")
    parts = (
        row["scene"],
        row["camera"],
        size_of(row),
        str(int(row["samples"])),
        row["ray_kind"],
        accel,
    )
    return "/".join(part.replace(" ", "_") for part in parts)


def _speed(rays: float, milliseconds: float) -> float:
    return rays / milliseconds / 1000


def _cpu_time(row: pd.Series) -> float:
    cpu = row.get("build_cpu_ms_median", float("nan")) + row.get(
        "trace_cpu_ms_median", float("nan")
    )
    return row["total_ms_median"] if pd.isna(cpu) else cpu


def _samples(directory: Path) -> dict[str, list[tuple[float, float]]]:
    samples = {}
    for cell in logged_cells(directory):
        samples[benchmark_name(pd.Series(cell.facts))] = [
            (
                one["build_ms"] + one["trace_ms"],
                one.get("build_cpu_ms", one["build_ms"]) + one.get("trace_cpu_ms", one["trace_ms"]),
            )
            for one in repetitions_of(cell)
        ]
    return samples
