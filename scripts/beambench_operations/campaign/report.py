"""The record as a table: Markdown for people, CSV for programs."""

import csv
import io
from collections import defaultdict
from pathlib import Path

from beambench_operations.campaign.record import as_json
from beambench_report.base.files import Problem, write_text

_COUNTS = ("executions", "scenes", "rays", "kills", "runs")
_COVERAGE = ("cov", "ft", "corpus")
_COLUMNS = (
    *("command", "subject", "pieces", *_COUNTS, "cpu_seconds", *_COVERAGE),
    *("findings", "first_utc", "last_utc", "commits"),
)
_INTRODUCTION = """\
# Robustness campaigns

<!-- Written by `scripts/campaign --report`. -->

Inputs, rays and kills at random, as `scripts/campaign` makes them; each row is the sum of the
pieces of one subject. `fuzz`: readers, by mutated inputs under the address and undefined-behavior
sanitizers (`bsp`: by a loop in Python); edges and features are libFuzzer's of the last piece.
`rays`: the self-test of a structure over random scenes and the scenes that are made to be hard, by
single rays, images, and batches with pencils, from cameras anywhere.
`kills`: a sweep, nightly runs and the cluster program, by signals at random moments.

"""


def write_report(pieces: list[dict], folder: Path) -> list[Path]:
    """Writes campaigns.md, campaigns.csv, and the record, from which other campaigns continue.

    Raises Problem where no piece was recorded.
    """
    if not pieces:
        raise Problem("there is no record yet; scripts/campaign fuzz, rays or kills makes one")
    folder.mkdir(parents=True, exist_ok=True)
    rows = summed(pieces)
    return [
        write_text(folder / "campaigns.md", as_markdown(pieces)),
        write_text(folder / "campaigns.csv", _csv(rows)),
        write_text(folder / "record.json", as_json(merged(pieces))),
    ]


def merged(pieces: list[dict]) -> list[dict]:
    """Merges pieces of one subject, commit and machine, except those with findings.

    The published record does not list the time of each of thousands of pieces.
    """
    groups: dict[tuple[object, ...], list[dict]] = defaultdict(list)
    for number, piece in enumerate(pieces):
        one = number if piece["findings"] else None
        key = (piece["command"], piece["subject"], piece["commit"], piece["machine"], one)
        groups[key].append(piece)
    return [_as_one(ours) if len(ours) > 1 else ours[0] for ours in groups.values()]


def _as_one(pieces: list[dict]) -> dict:
    what = dict.fromkeys(name for piece in pieces for name in piece["counts"])
    return pieces[-1] | {
        "seed": pieces[0]["seed"],
        "counts": {name: sum(piece["counts"].get(name, 0) for piece in pieces) for name in what},
        "cpu_seconds": round(sum(piece["cpu_seconds"] for piece in pieces), 1),
        "pieces": sum(_pieces(piece) for piece in pieces),
        "first_utc": min(_first(piece) for piece in pieces),
    }


def _pieces(piece: dict) -> int:
    return piece.get("pieces", 1)


def _first(piece: dict) -> str:
    return piece.get("first_utc", piece["time_utc"])


def summed(pieces: list[dict]) -> list[dict[str, object]]:
    """Returns a row for each command and subject."""
    groups: dict[tuple[str, str], list[dict]] = defaultdict(list)
    for piece in pieces:
        groups[piece["command"], piece["subject"]].append(piece)
    for ours in groups.values():
        ours.sort(key=lambda piece: piece["time_utc"])
    return [
        {
            "command": command,
            "subject": subject,
            "pieces": sum(_pieces(piece) for piece in ours),
            **{what: sum(piece["counts"].get(what, 0) for piece in ours) for what in _COUNTS},
            "cpu_seconds": round(sum(piece["cpu_seconds"] for piece in ours), 1),
            **{what: ours[-1]["coverage"].get(what, "") for what in _COVERAGE},
            "findings": sum(len(piece["findings"]) for piece in ours),
            "first_utc": min(_first(piece) for piece in ours),
            "last_utc": ours[-1]["time_utc"],
            "commits": " ".join(dict.fromkeys(piece["commit"][:7] for piece in ours)),
        }
        for (command, subject), ours in sorted(groups.items())
    ]


def _csv(rows: list[dict[str, object]]) -> str:
    text = io.StringIO()
    writer = csv.DictWriter(text, _COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def as_markdown(pieces: list[dict]) -> str:
    """Returns the table of all subjects, and every finding."""
    rows = summed(pieces)
    lines = [
        "| campaign | subject | pieces | amount | hours of processor time | edges | features "
        "| corpus | findings |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        amount = ", ".join(f"{row[what]:,} {what}" for what in _COUNTS if row[what])
        numbers = (*(row[what] for what in _COVERAGE), row["findings"])
        cells = (
            *(row["command"], f"`{row['subject']}`", row["pieces"], amount),
            *(f"{float(str(row['cpu_seconds'])) / 3600:.2f}", *numbers),
        )
        lines.append("| " + " | ".join(str(cell) for cell in cells) + " |")
    lines += [
        "",
        "In all: " + "; ".join(_total(command, rows) for command in _commands(rows)) + ".",
    ]
    machines = "; ".join(dict.fromkeys(piece["machine"] for piece in pieces))
    commits = ", ".join(dict.fromkeys(piece["commit"][:7] for piece in pieces))
    lines += ["", f"Machines: {machines}. Commits: {commits}.", "", "## Findings", ""]
    findings = [
        f"- `{piece['subject']}` at {piece['commit'][:7]}: {_plain(finding['message'])}  \n"
        f"  `{finding['command']}`"
        for piece in pieces
        for finding in piece["findings"]
    ]
    lines += findings or ["None."]
    return _INTRODUCTION + "\n".join(lines) + "\n"


def _commands(rows: list[dict[str, object]]) -> list[str]:
    return list(dict.fromkeys(str(row["command"]) for row in rows))


def _total(command: str, rows: list[dict[str, object]]) -> str:
    """Returns the sentence on the subjects of a command."""
    ours = [row for row in rows if row["command"] == command]

    def total(what: str) -> float:
        return sum(float(str(row[what])) for row in ours)

    amount = ", ".join(f"{total(what):,.0f} {what}" for what in _COUNTS if total(what))
    return f"{command}, {amount} in {total('cpu_seconds') / 3600:.2f} hours of processor time"


def _plain(text: str) -> str:
    """Returns a program's message about an untrusted input as plain text in Markdown."""
    printable = "".join(letter if letter.isprintable() else " " for letter in text)
    return "`" + printable.replace("`", "'") + "`"
