"""Unusual names and texts from files: in messages, records, tables and pages."""

from __future__ import annotations

import csv
import json
import os
import resource
import subprocess
from pathlib import Path

import pytest

from beambench_report.__main__ import main
from beambench_report.base.files import Problem, read_json
from beambench_report.base.names import path_of_name
from beambench_report.base.printable import printable
from beambench_report.base.records import read_run
from beambench_report.run.page import write_page
from beambench_report.run.pictures import write_pictures
from program import BINARY, beambench, refused
from run_logs import begun_cells, forget_cell

SCENE = b"""v
from 0 0 -5
at 0 0 0
up 0 1 0
angle 40
hither 1
resolution 8 8
l 3 3 -5
f 1 1 1 1 0 0 0 1
s 0 0 0 1
s 1 0 0 0.5
"""
SMALL = ("--resolution", "8x8")
ESCAPED = "esc\x1b.nff"
LATIN = "bad\udcff.nff"  # contains the byte FF, as Python represents it


def run_bytes(
    *arguments: str | bytes | Path, cwd: Path, **options: object
) -> subprocess.CompletedProcess[bytes]:
    """Runs the program, whose output need not be UTF-8."""
    return subprocess.run(
        [BINARY, *arguments], cwd=cwd, capture_output=True, check=False, timeout=120, **options
    )


def sweep_of(*scenes: str, **more: object) -> str:
    return json.dumps(
        {
            "name": "names",
            "scenes": list(scenes),
            "structures": ["samet", "sah-bvh"],
            "resolutions": ["8x8"],
            "repetitions": {"minimum": 2, "maximum": 2},
            "budget_seconds": 0,
            "warm_up_seconds": 0,
            **more,
        }
    )


def is_plain(output: bytes) -> bool:
    """Returns whether a text is UTF-8 without control characters except line ends."""
    return all(c == "\n" or c.isprintable() for c in output.decode("utf-8"))


# Names of scenes


def test_a_camera_named_in_latin_1_is_measured(tmp_path: Path) -> None:
    named = SCENE.replace(b"hither 1\n", b"hither 1\n#beambench name C\xe1mara\n")
    (tmp_path / "latin.nff").write_bytes(named)
    (tmp_path / "sweep.json").write_text(sweep_of("./latin.nff"))
    done = run_bytes("run", "sweep.json", "-o", "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    rows = read_run(tmp_path / "out").rows
    assert set(rows["camera"]) == {"C\\xe1mara"}
    asked = ("scene", "render", "verify")
    for camera in ("C\\xe1mara", b"C\xe1mara"):
        done = run_bytes(
            "verify", "latin.nff", "--accel", "samet", "--camera", camera, cwd=tmp_path
        )
        assert done.returncode == 0, (asked, camera, done.stderr)


COMMANDS = [
    ["scene", "SCENE", "--json"],
    ["stats", "SCENE", "--accel", "samet", *SMALL, "--json"],
    ["rays", "SCENE", *SMALL, "--json"],
    ["rays", "SCENE", *SMALL, "-o", "a.rays"],
    ["hits", "SCENE", *SMALL, "--accel", "samet", "-o", "a.hits"],
    ["trace", "SCENE", *SMALL, "--accel", "samet", "--pixel", "4,4", "--json"],
    ["trace", "SCENE", *SMALL, "--accel", "samet", "--pixel", "4,4"],
    ["verify", "SCENE", *SMALL, "--accel", "samet", "--json", "verified.json"],
    ["census", "SCENE", *SMALL, "--json"],
    ["mirrors", "SCENE", *SMALL, "--json"],
    ["sampling", "SCENE", *SMALL, "--json"],
    ["render", "SCENE", *SMALL, "--accel", "samet", "-o", "a.png"],
    ["export", "SCENE", "-o", "copy.nff"],
    ["time", "SCENE", *SMALL, "--accel", "samet,sah-bvh", "--seconds", "0.1"],
]


@pytest.mark.parametrize("name", [ESCAPED, LATIN], ids=["escape", "latin"])
@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
def test_a_scene_may_have_any_file_name(tmp_path: Path, name: str, command: list[str]) -> None:
    (tmp_path / name).write_bytes(SCENE)
    done = run_bytes(*[name if word == "SCENE" else word for word in command], cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert is_plain(done.stdout)
    assert is_plain(done.stderr)


def test_a_sweep_of_a_path_that_json_cannot_hold_is_not_saved(tmp_path: Path) -> None:
    (tmp_path / LATIN).write_bytes(SCENE)
    done = beambench("time", f"./{LATIN}", "--save", "sweep.json", cwd=tmp_path)
    refused(done, ["--save", "bad\\xff.nff", "rename"])
    assert not (tmp_path / "sweep.json").exists()


def test_a_run_over_a_name_with_an_escape_is_whole(tmp_path: Path) -> None:
    (tmp_path / ESCAPED).write_bytes(SCENE)
    (tmp_path / "sweep.json").write_text(sweep_of(f"./{ESCAPED}"))
    out = tmp_path / "out"
    done = run_bytes("run", "sweep.json", "-o", "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert is_plain(done.stderr)
    assert json.loads((out / "manifest.json").read_text())["finished_utc"]
    named = json.loads((out / "google-benchmark.json").read_text())["benchmarks"]
    assert all("esc\\x1b.nff" in one["name"] for one in named)

    assert len(begun_cells(out)) == 2
    forget_cell(out, 0)
    done = run_bytes("run", "--resume", "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr

    rows = read_run(out).rows
    assert list(rows["scene"]) == ["./esc\\x1b.nff"] * 2
    assert "\x1b" not in (out / "results.csv").read_text()


def test_the_page_of_such_a_run_has_its_picture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    scene = tmp_path / "<b>\x1b.nff"
    scene.write_bytes(SCENE)
    (tmp_path / "sweep.json").write_text(sweep_of(str(scene)))
    assert run_bytes("run", "sweep.json", "-o", "out", cwd=tmp_path).returncode == 0
    pictures = write_pictures(tmp_path / "out", BINARY)
    assert all(picture.exists() for picture in pictures)
    write_page(tmp_path / "out")
    page = (tmp_path / "out" / "report.html").read_text("utf-8")
    assert "\x1b" not in page
    assert "<b>\\x1b" not in page
    assert "&lt;b&gt;\\x1b.nff" in page


@pytest.mark.parametrize("path", [b"balls.nff", b"esc\x1b.nff", b"back\\slash", b"\xff\\x1b"])
def test_a_name_leads_back_to_its_path(path: bytes) -> None:
    doubled = path.replace(b"\\", b"\\\\")
    name = "".join(chr(b) if 32 <= b < 127 else f"\\x{b:02x}" for b in doubled)
    assert os.fsencode(path_of_name(name)) == path


# Messages


def test_messages_hold_no_control_characters(tmp_path: Path) -> None:
    (tmp_path / "red.nff").write_bytes(SCENE + b"s \x1b[31mred\x07 0 0 1\n")
    refused(beambench("scene", "red.nff", cwd=tmp_path), ["red.nff:12", "\\x1b[31mred\\x07"])
    refused(beambench("scene", "no\x1b[31m\udcffscene"), ["no\\x1b[31m\\xffscene"])


def test_a_long_token_gives_a_short_message(tmp_path: Path) -> None:
    (tmp_path / "long.nff").write_bytes(SCENE + b"s " + b"x" * 20_000_000 + b" 0 0 1\n")
    done = beambench("scene", "long.nff", cwd=tmp_path)
    refused(done, ["long.nff:12", "xxx...'", "should be a number"])
    assert len(done.stderr) < 1000
    (tmp_path / "long.json").write_text(sweep_of("x" * 5_000_000))
    done = beambench("run", "long.json", cwd=tmp_path)
    refused(done, ["/scenes/0", "there is no scene"])
    assert len(done.stderr) < 5000
    (tmp_path / "key.json").write_text(sweep_of("tetra", **{"y" * 5_000_000: 1}))
    done = beambench("run", "key.json", cwd=tmp_path)
    refused(done, ["unknown key"])
    assert len(done.stderr) < 5000


# JSON that is read


DEEP = "[" * 400_000


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            sweep_of("tetra:n=1").replace('"budget_seconds": 0', '"budget_seconds": 1e400'),
            ["1e400"],
        ),
        (DEEP, ["64 levels"]),
        (DEEP + "]" * 400_000, ["64 levels"]),
        ('{"a":' * 100_000, ["64 levels"]),
        ('{"name": "\udcff"}', ["UTF-8"]),
    ],
    ids=["overflow", "lists", "closed", "objects", "latin"],
)
def test_json_that_cannot_be_read_is_refused(tmp_path: Path, text: str, words: list[str]) -> None:
    (tmp_path / "sweep.json").write_bytes(text.encode("utf-8", "surrogateescape"))
    refused(beambench("run", "sweep.json", cwd=tmp_path), ["sweep.json", *words])


@pytest.mark.parametrize("kind", ["rays", "hits"])
def test_a_deep_header_is_refused(tmp_path: Path, kind: str) -> None:
    assert beambench("rays", "tetra:n=1", *SMALL, "-o", "a.rays", cwd=tmp_path).returncode == 0
    file = tmp_path / f"deep.{kind}"
    file.write_text(f"beambench-{kind} 1\n{'[' * 300_000}\n")
    rays = file.name if kind == "rays" else "a.rays"
    done = beambench("verify", "tetra:n=1", "--rays", rays, "--hits", "deep.hits", cwd=tmp_path)
    refused(done, [file.name, "not a JSON object", "64 levels"])


def test_a_record_that_is_no_record_ends_in_one_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "sweep.json").write_text(sweep_of("tetra:n=1"))
    assert run_bytes("run", "sweep.json", "-o", "out", cwd=tmp_path).returncode == 0
    log = tmp_path / "out" / "run.jsonl"
    for text in (DEEP, '{"event": "repetition", "index": 0}'):
        log.write_text(text + "\n")
        assert main(["page", str(tmp_path / "out")]) == 2
        assert len(capsys.readouterr().err.splitlines()) == 1
    (tmp_path / "deep.json").write_text(DEEP)
    with pytest.raises(Problem, match=r"deep\.json: cannot be read as JSON"):
        read_json(tmp_path / "deep.json")


def test_the_report_prints_what_is_printable() -> None:
    assert printable("plain: \N{LATIN SMALL LETTER A WITH ACUTE}\n") == "plain: \xe1\n"
    assert printable("\x1b[31m \u202e\udcff") == "\\x1b[31m \\u202e\\udcff"
    assert len(printable("x" * 1_000_000)) < 5000


# CSV


def test_no_cell_of_results_csv_is_a_formula(tmp_path: Path) -> None:
    names = ["=1+1.nff", "-1.nff", "@SUM(1).nff", "+1.nff", "'x.nff"]
    for name in names:
        (tmp_path / name).write_bytes(
            SCENE.replace(b"hither 1\n", b'hither 1\n#beambench name =HYPERLINK("x","y")\n')
        )
    (tmp_path / "sweep.json").write_text(sweep_of(*names))
    assert run_bytes("run", "sweep.json", "-o", "out", cwd=tmp_path).returncode == 0
    path = tmp_path / "out" / "results.csv"
    with path.open(newline="", encoding="utf-8") as file:
        cells = [cell for row in csv.reader(file) for cell in row]
    for cell in cells:
        if cell.startswith(("=", "+", "-", "@", "\t", "\r")):
            float(cell)
    assert {f"'{name}" for name in names} <= set(cells)
    rows = read_run(tmp_path / "out").rows
    assert set(rows["scene"]) == set(names)
    assert set(rows["camera"]) == {'=HYPERLINK("x","y")'}
    assert run_bytes("run", "--resume", "out", cwd=tmp_path).returncode == 0
    assert main(["plots", str(tmp_path / "out"), "--kinds", "overall"]) == 0
    written = (tmp_path / "out" / "plots" / "break-even.csv").read_text()
    assert not [line for line in written.splitlines() if line.startswith(("=", "+", "-", "@"))]


# Byte order marks


def test_a_byte_order_mark_is_skipped(tmp_path: Path) -> None:
    mark = b"\xef\xbb\xbf"
    (tmp_path / "marked.nff").write_bytes(mark + SCENE)
    done = beambench("scene", "marked.nff", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert json.loads(done.stdout)["cameras"][0]["angle"] == 40
    (tmp_path / "sweep.json").write_bytes(mark + sweep_of("./marked.nff").encode())
    assert beambench("run", "sweep.json", "--dry-run", cwd=tmp_path).returncode == 0


# Streams and limits


def test_a_limit_of_file_sizes_is_reported(tmp_path: Path) -> None:
    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 20, 1 << 20))

    command = ["export", "balls:n=5", "-o", "balls.nff"]
    done = run_bytes(*command, cwd=tmp_path, preexec_fn=limit)
    assert done.returncode == 2, done.stderr
    assert b"balls.nff" in done.stderr
    assert b"ulimit -f" in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("closed", ["2>&-", ">&- 2>&-", "<&- 2>&-", "<&- >&- 2>&-", "2>/dev/full"])
def test_closed_streams_change_no_exit_code(tmp_path: Path, closed: str) -> None:
    def code(arguments: str) -> int:
        line = f'"{BINARY}" {arguments} {closed}'
        return subprocess.run(["bash", "-c", line], cwd=tmp_path, check=False).returncode

    assert code("scene no-such-scene") == 2
    assert code("export tetra:n=1 -o tetra.nff") == 0
    assert (tmp_path / "tetra.nff").read_text().startswith("# tetra")


@pytest.mark.parametrize(
    "arguments",
    [
        "run sweep.json -o out",
        "verify tetra:n=1 --accel samet --resolution 8x8",
        "rays tetra:n=1 --resolution 8x8 -o a.rays",
        "hits tetra:n=1 --rays rays.rays -o a.hits",
        "render tetra:n=1 --accel samet --resolution 8x8 -o a.png",
        "stats tetra:n=1 --accel samet --resolution 8x8",
        "time tetra:n=1 --accel samet --resolution 8x8 --seconds 0.1",
        "census tetra:n=1 --resolution 8x8 --pictures pictures",
        "sampling tetra:n=1 --resolution 8x8 --repetitions 1",
        "mirrors tetra:n=1 --resolution 8x8",
        "selftest --accel samet --scenes 1",
        "scene skipped.nff",
    ],
    ids=lambda arguments: arguments.split()[0],
)
def test_progress_that_cannot_be_written_fails_nothing(tmp_path: Path, arguments: str) -> None:
    (tmp_path / "sweep.json").write_text(sweep_of("tetra:n=1"))
    (tmp_path / "skipped.nff").write_text("unknown\ns 0 0 0 1\n")
    line = f'"{BINARY}" rays tetra:n=1 --resolution 8x8 -o rays.rays && "{BINARY}" {arguments}'
    for end in ("", " 2>/dev/full"):
        command = line.replace(" out", f" out{len(end)}") + end
        done = subprocess.run(["bash", "-c", command], cwd=tmp_path, check=False)
        assert done.returncode == 0, end


# A log


def test_a_log_that_nests_too_deep_is_refused(tmp_path: Path) -> None:
    (tmp_path / "sweep.json").write_text(sweep_of("tetra:n=1"))
    assert run_bytes("run", "sweep.json", "-o", "out", cwd=tmp_path).returncode == 0
    for text in (DEEP, DEEP + "]" * 400_000):
        (tmp_path / "out" / "run.jsonl").write_text(text + "\n")
        done = beambench("run", "--resume", "out", cwd=tmp_path)
        refused(done, ["run.jsonl", "64 levels"])
