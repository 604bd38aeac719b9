"""Writes the record as a table: Markdown for people, CSV for programs."""

from pathlib import Path

import pandas as pd

from beambench_operations.campaign.record import as_json
from beambench_report.base.files import Problem, write_text
from beambench_report.base.quantities import markdown_table

_COUNTS = ("executions", "scenes", "rays", "kills", "runs")
_COVERAGE = ("cov", "ft", "corpus")
_HEADS = (
    "campaign, subject, pieces, amount, hours of processor time, edges, features, corpus, findings"
).split(", ")
_INTRODUCTION = """\
# Robustness campaigns

<!-- Written by `scripts/campaign --report`. -->

Random inputs, rays and kills, as `scripts/campaign` makes them; each row is the sum of the pieces
of one subject. `fuzz` gives readers mutated inputs, under the address and undefined-behavior
sanitizers (`bsp`: in a loop in Python); edges and features are those that libFuzzer reported for
the last piece. `rays` runs the self-test of a structure over random scenes and over scenes that
are made to be hard, with single rays, images, and batches with pencils, from cameras anywhere.
`kills` kills a sweep, nightly runs and the cluster program by signals at random moments.
"""


def write_report(pieces: list[dict], folder: Path) -> list[Path]:
    """Writes campaigns.md, campaigns.csv, and the record, from which other campaigns continue.

    Raises Problem if no piece was recorded.
    """
    if not pieces:
        raise Problem("there is no record yet; scripts/campaign fuzz, rays or kills makes one")
    folder.mkdir(parents=True, exist_ok=True)
    table = summed(pieces).to_csv(index=False, lineterminator="\n")
    return [
        write_text(folder / "campaigns.md", as_markdown(pieces)),
        write_text(folder / "campaigns.csv", table),
        write_text(folder / "record.json", as_json(merged(pieces))),
    ]


def merged(pieces: list[dict]) -> list[dict]:
    """Merges pieces of one subject, commit and machine, except those with findings.

    Otherwise, the published record would list thousands of pieces.
    """
    groups: dict[tuple, dict] = {}
    for number, piece in enumerate(pieces):
        names = ("command", "subject", "commit", "machine")
        key = (*(piece[name] for name in names), number if piece["findings"] else None)
        if (whole := groups.get(key)) is None:
            groups[key] = piece
            continue
        both = [one["counts"] for one in (whole, piece)]
        groups[key] = piece | {
            "seed": whole["seed"],
            "counts": {what: sum(one.get(what, 0) for one in both) for what in both[0] | both[1]},
            "cpu_seconds": round(whole["cpu_seconds"] + piece["cpu_seconds"], 1),
            "pieces": whole.get("pieces", 1) + piece.get("pieces", 1),
            "first_utc": min(one.get("first_utc", one["time_utc"]) for one in (whole, piece)),
        }
    return list(groups.values())


def summed(pieces: list[dict]) -> pd.DataFrame:
    """Returns a row for each command and subject."""
    rows = pd.DataFrame(
        {
            "command": piece["command"],
            "subject": piece["subject"],
            "pieces": piece.get("pieces", 1),
            **{what: piece["counts"].get(what, 0) for what in _COUNTS},
            "cpu_seconds": piece["cpu_seconds"],
            **{what: piece["coverage"].get(what, "") for what in _COVERAGE},
            "findings": len(piece["findings"]),
            "first_utc": piece.get("first_utc", piece["time_utc"]),
            "last_utc": piece["time_utc"],
            "commits": piece["commit"][:7],
        }
        for piece in sorted(pieces, key=lambda piece: piece["time_utc"])
    )
    how = dict.fromkeys(rows.columns[2:], "sum") | dict.fromkeys((*_COVERAGE, "last_utc"), "last")
    how |= {"first_utc": "min", "commits": lambda own: " ".join(dict.fromkeys(own))}
    return rows.groupby(["command", "subject"], as_index=False).agg(how).round({"cpu_seconds": 1})


def as_markdown(pieces: list[dict]) -> str:
    """Returns the table of all subjects, and every finding."""
    rows = summed(pieces)
    table = (
        (
            *(row["command"], f"`{row['subject']}`", row["pieces"], _amount(row)),
            *(f"{row['cpu_seconds'] / 3600:.2f}", *row[list(_COVERAGE)], row["findings"]),
        )
        for _, row in rows.iterrows()
    )
    totals = rows.groupby("command")[[*_COUNTS, "cpu_seconds"]].sum()
    in_all = (
        f"{command}, {_amount(one)} in {one['cpu_seconds'] / 3600:.2f} hours of processor time"
        for command, one in totals.iterrows()
    )
    machines = "; ".join(dict.fromkeys(piece["machine"] for piece in pieces))
    commits = ", ".join(dict.fromkeys(piece["commit"][:7] for piece in pieces))
    findings = [
        f"- `{piece['subject']}` at {piece['commit'][:7]}: {_plain(finding['message'])}  \n"
        f"  `{finding['command']}`"
        for piece in pieces
        for finding in piece["findings"]
    ]
    lines = [
        *(_INTRODUCTION, *markdown_table(_HEADS, (map(str, cells) for cells in table)), ""),
        *(f"In all: {'; '.join(in_all)}.", "", f"Machines: {machines}. Commits: {commits}.", ""),
        *("## Findings", "", *(findings or ["None."])),
    ]
    return "\n".join(lines) + "\n"


def _amount(row: pd.Series) -> str:
    return ", ".join(f"{row[what]:,.0f} {what}" for what in _COUNTS if row[what])


def _plain(text: str) -> str:
    """Escapes a program's message about an untrusted input as plain text in Markdown."""
    printable = "".join(letter if letter.isprintable() else " " for letter in text)
    return "`" + printable.replace("`", "'") + "`"
