"""Writes a summary in Markdown and a badge from the output of `beambench verify --kit --json`."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

COUNTS = ("rays", "graze", "structure_error", "leaks")
HEADER = "| family | query | cases | right | rays | graze | wrong | leaks | verdict |"
FAILED_SHOWN = 10


def families(cases: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Returns a row for each family and query; the failed ones come last."""
    rows: dict[tuple[str, str], dict[str, Any]] = {}
    for case in cases:
        key = (case["family"], case["query"])
        row = rows.setdefault(key, {"cases": 0, "right": 0, "verdict": "unsupported",
                                    **dict.fromkeys(COUNTS, 0)})  # fmt: skip
        row["cases"] += 1
        row["right"] += case["passed"]
        for name in COUNTS:
            row[name] += case[name]
        row["graze"] -= case["leaks"]  # leaks are misses at edges, so they also count as grazes
        if row["verdict"] in ("ok", "unsupported") and case["verdict"] != "unsupported":
            row["verdict"] = case["verdict"]
    listed = [{"family": family, "query": query, **row} for (family, query), row in rows.items()]
    return sorted(listed, key=lambda row: row["verdict"] not in ("ok", "unsupported"))


def summary(found: dict[str, Any]) -> str:
    """Returns the verdict, the table by family, and the first failures."""
    cases = found["cases"]
    supported = [case for case in cases if case["verdict"] != "unsupported"]
    right = sum(case["passed"] for case in supported)
    left_out = len(cases) - len(supported)
    lines = [
        f"## Hits: {right} of {len(supported)} cases right",
        "",
        f"Verified by beambench {found['beambench']} against an exact oracle"
        + (f"; {left_out} cases are unsupported." if left_out else "."),
        "",
        HEADER,
        "|---|---|" + "---:|" * 6 + "---|",
    ]
    for row in families(cases):
        cells = [row["family"], row["query"], row["cases"], row["right"],
                 *(row[name] for name in COUNTS), row["verdict"]]  # fmt: skip
        lines.append("| " + " | ".join(map(str, cells)) + " |")
    failed = [case for case in supported if not case["passed"]]
    if failed:
        lines += ["", "### Failures", ""]
        for case in failed[:FAILED_SHOWN]:
            what = case["message"] or case.get("minimal") or case["verdict"]
            lines.append(f"- `{case['name']}`: {what.splitlines()[0]}")
        if len(failed) > FAILED_SHOWN:
            lines.append(f"- and {len(failed) - FAILED_SHOWN} more in verdict.json")
    return "\n".join(lines) + "\n"


def badge(found: dict[str, Any]) -> dict[str, Any]:
    """Returns the JSON of a badge, for https://img.shields.io/endpoint."""
    supported = [case for case in found["cases"] if case["verdict"] != "unsupported"]
    right = sum(case["passed"] for case in supported)
    return {
        "schemaVersion": 1,
        "label": "hits verified",
        "message": f"{right} of {len(supported)} cases",
        "color": "brightgreen" if found["passed"] else "red",
    }


def main() -> None:
    """Writes the summary and the badge."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("verdict", type=Path, help="the output of verify --json")
    parser.add_argument("--summary", type=Path, required=True)
    parser.add_argument("--badge", type=Path, required=True)
    arguments = parser.parse_args()
    found = json.loads(arguments.verdict.read_text("utf-8"))
    arguments.summary.write_text(summary(found), "utf-8")
    arguments.badge.write_text(json.dumps(badge(found), indent=1) + "\n", "utf-8")


if __name__ == "__main__":
    main()
