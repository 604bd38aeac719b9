"""scripts/campaign: its records, kept findings and reports, and a short run of each command."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import threading
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from random import Random

import pytest

from beambench_operations.campaign import night_kills, quake3_maps
from beambench_operations.campaign import rays as random_rays
from beambench_operations.campaign.__main__ import main
from beambench_operations.campaign.libfuzzer import status
from beambench_operations.campaign.piece import Finding, Piece, Task
from beambench_operations.campaign.pool import do_pieces
from beambench_operations.campaign.programs import Programs
from beambench_operations.campaign.record import Record
from beambench_operations.campaign.report import summed, write_report
from beambench_operations.campaign.rows import cells_of, difference
from beambench_report.base.files import Problem
from program import BINARY
from synthetic_bsp import small_map

CLANG = shutil.which("clang++-16")

needs_binary = pytest.mark.skipif(not BINARY.exists(), reason="beambench is not built")
needs_clang = pytest.mark.skipif(CLANG is None, reason="clang 16 is not installed")


@pytest.fixture
def record(tmp_path: Path) -> Record:
    return Record(tmp_path / "robustness")


def piece(subject: str, rays: int, scenes: int = 1) -> Piece:
    return Piece("rays", subject, 7, {"scenes": scenes, "rays": rays}, 1.5)


def campaign(record: Record, *arguments: str | Path) -> int:
    return main([str(word) for word in (*arguments, "--home", record.folder)])


# The record


def test_the_record_adds_up(record: Record) -> None:
    for rays in (10, 20):
        record.add(piece("samet", rays))
    record.add(piece("beam", 5))
    assert record.total("rays", "samet", "rays") == 30
    assert Record(record.folder).total("rays", "samet", "scenes") == 2
    beam, samet = summed(record.pieces()).to_dict("records")
    assert (samet["subject"], samet["pieces"], samet["rays"]) == ("samet", 2, 30)
    assert (samet["cpu_seconds"], beam["rays"]) == (3.0, 5)


def test_several_campaigns_at_once_lose_no_piece(record: Record) -> None:
    def add_ten() -> None:
        for _ in range(10):
            Record(record.folder).add(piece("samet", 1))

    threads = [threading.Thread(target=add_ten) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert record.total("rays", "samet", "rays") == 40


def test_a_file_that_is_no_record_is_refused(record: Record) -> None:
    record.folder.mkdir()
    record.file.write_text('{"version": 99}')
    with pytest.raises(Problem, match="not a record of version 1"):
        record.pieces()


def test_a_piece_that_is_cut_off_is_not_counted(record: Record) -> None:
    programs = Programs()

    def begun() -> Piece:
        # Like the user's Ctrl-C, once the piece is under way.
        threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        programs.run(["sleep", "60"])
        return piece("samet", 99)

    subjects: list[str] = []

    def choose(busy: object) -> Task:
        subjects.append(str(busy))
        return Task("samet", begun if len(subjects) == 2 else lambda: piece("samet", 1))

    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        do_pieces(choose, record, programs, 60, 1)
    assert time.monotonic() - begin < 10
    assert record.total("rays", "samet", "rays") == 1


def test_pieces_are_done_at_once_and_at_least_one(record: Record) -> None:
    done = do_pieces(lambda _: Task("x", lambda: piece("x", 1)), record, Programs(), 0, 2)
    assert len(done) == 1


def test_the_report_has_a_row_for_each_subject_and_each_finding(record: Record) -> None:
    record.add(piece("samet", 1234567))
    source = record.folder / "input"
    source.write_text("x")
    command = ["beambench", "selftest", source]
    finding = record.keep(source, "samet 1", "wrong | `hit`\n", command)
    assert finding.command.endswith("findings/samet-1")
    record.add(Piece("rays", "beam", 1, {"rays": 2}, 0.5, {}, [finding]))
    markdown, table, again = write_report(record.pieces(), record.folder / "report")
    assert "| rays | `samet` | 1 | 1 scenes, 1,234,567 rays | 0.00 |" in markdown.read_text()
    assert "wrong | 'hit'" in markdown.read_text()
    assert "In all: rays, 1 scenes, 1,234,569 rays in 0.00 hours" in markdown.read_text()
    assert Record(again.parent).pieces() == record.pieces()
    assert table.read_text().splitlines()[1].startswith("rays,beam,1,0,0,2,0,0,0.5,")


def test_a_published_record_has_one_piece_of_a_subject_and_goes_on_from_there(
    record: Record,
) -> None:
    finding = Finding("case", "wrong", "repeat it")
    record.add(piece("samet", 5))
    record.add(piece("beam", 7))
    record.add(replace(piece("samet", 1), findings=[finding]))
    record.add(piece("samet", 6))
    *_, again = write_report(record.pieces(), record.folder / "report")
    published = Record(again.parent)
    assert [one["counts"]["rays"] for one in published.pieces()] == [11, 7, 1]
    assert summed(published.pieces()).equals(summed(record.pieces()))
    assert published.total("rays", "samet", "scenes") == record.total("rays", "samet", "scenes")


# Sweeps


def write_results(path: Path, *rows: str) -> Path:
    header = (
        "scene,camera,structure,parameters,width,height,samples,ray_kind,verdict,"
        "tests_per_ray,a_ns_per_ray\n"
    )
    path.write_text(header + "".join(f"{row}\n" for row in rows))
    return path


def test_rows_are_compared_by_what_repeats(tmp_path: Path) -> None:
    cell = "balls,default,samet,,8,8,1,primary"
    first, damage = cells_of(write_results(tmp_path / "a.csv", f"{cell},ok,2.5,100"))
    slower, _ = cells_of(write_results(tmp_path / "b.csv", f"{cell},ok,2.5,200"))
    other, _ = cells_of(write_results(tmp_path / "c.csv", f"{cell},ok,2.6,100"))
    assert (damage, difference(first, slower)) == ("", "")
    assert "tests_per_ray" in difference(first, other)
    assert "is missing" in difference(first, first.iloc[:0])
    _, twice = cells_of(write_results(tmp_path / "d.csv", *[f"{cell},ok,2.5,100"] * 2))
    assert "twice" in twice


# Fuzzing


def test_the_last_status_of_libfuzzer_is_read() -> None:
    log = (
        "#2 INITED cov: 11 ft: 12 corp: 1/1b exec/s: 0 rss: 30Mb\n"
        "#100: cov: 20 ft: 33 corp: 5 exec/s 50 oom/timeout/crash: 0/0/0 time: 2s job: 1\n"
        "#90 NEW    cov: 15 ft: 18 corp: 3/9b lim: 4 exec/s: 0 rss: 31Mb\n"
    )
    assert status(log) == (100, {"cov": 15, "ft": 18})
    assert status("no fuzzer") == (0, {})


PLANTED = """
#include <cstddef>
#include <cstdint>
#include <stdexcept>
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 1 && data[0] == 'b' && data[1] == 'u') throw std::runtime_error("planted");
  return 0;
}
"""


@pytest.fixture
def planted(tmp_path: Path) -> Path:
    """A folder with one target, which fails."""
    folder = tmp_path / "targets"
    folder.mkdir()
    source = tmp_path / "planted.cpp"
    source.write_text(PLANTED)
    command = [CLANG, "-fsanitize=fuzzer,address", source, "-o", folder / "fuzz_planted"]
    subprocess.run(command, check=True)
    return folder


@needs_clang
def test_a_planted_fault_is_found_and_kept(
    record: Record, planted: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["--targets", planted, "--only", "planted", "--minutes", "0.05", "--jobs", "1"]
    assert campaign(record, "fuzz", *arguments) == 1
    (found,) = record.pieces()
    assert found["counts"]["executions"] > 0
    assert found["coverage"]["corpus"] > 0
    (finding,) = found["findings"]
    assert "planted" in finding["message"]
    kept = record.findings / finding["file"]
    assert kept.read_bytes().startswith(b"bu")
    repeated = subprocess.run(finding["command"].split(), capture_output=True, check=False)
    assert repeated.returncode != 0
    assert finding["command"] in capsys.readouterr().err


def test_an_input_that_was_slow_only_once_is_no_finding(record: Record, tmp_path: Path) -> None:
    """Uses a program that, like libFuzzer, leaves failing inputs behind.

    It does not fail when it is run on one of them again.
    """
    program = tmp_path / "fuzz_slow"
    program.write_text(
        """#!/bin/sh
for word; do
  case $word in -artifact_prefix=*)
    touch "${word#*=}timeout-1" "${word#*=}crash-1"
    echo '#100: cov: 20 ft: 33 corp: 5 exec/s 50' >&2 ;;
  esac
done
"""
    )
    program.chmod(0o755)
    arguments = ["--targets", tmp_path, "--only", "slow", "--minutes", "0", "--jobs", "1"]
    assert campaign(record, "fuzz", *arguments) == 1
    ((finding,),) = [piece["findings"] for piece in record.pieces()]
    assert finding["file"] == "slow-crash-1"


@needs_clang
def test_maps_are_fuzzed(record: Record, planted: Path) -> None:
    arguments = ["--targets", planted, "--only", "bsp", "--minutes", "0.02"]
    assert campaign(record, "fuzz", *arguments) == 0
    (done,) = record.pieces()
    assert done["counts"]["executions"] > 100


def test_every_kept_map_is_read_or_refused(repository: Path) -> None:
    inputs = list((repository / "tests/fuzz").glob("*/bsp/*"))
    assert inputs
    assert {file.name: quake3_maps.fault(file.read_bytes()) for file in inputs} == {
        file.name: "" for file in inputs
    }


def test_a_fault_of_the_reader_of_maps_is_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def faulty(data: bytes, _level: int) -> None:
        raise ValueError(data[:1])

    monkeypatch.setattr(quake3_maps, "convert", faulty)
    assert quake3_maps.search(0.2, 1, tmp_path, [small_map().bytes()]) > 0
    assert len(list(tmp_path.iterdir())) == 1


def test_mutations_follow_from_the_seed() -> None:
    data = small_map().bytes()
    one, two = (quake3_maps.mutated(data, [data], Random(3)) for _ in range(2))
    assert one == two != data


# The commands


@needs_binary
def test_rays_are_counted_with_new_seeds(record: Record, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(random_rays, "RAYS", 100)
    arguments = ["--only", "samet", "--minutes", "0", "--beambench", BINARY]
    for _ in range(2):
        assert campaign(record, "rays", *arguments) == 0
    first, second = record.pieces()
    assert second["seed"] == first["seed"] + first["counts"]["scenes"]
    assert first["counts"]["rays"] > 1000


def test_a_wrong_hit_is_kept_as_it_was_reduced(record: Record, tmp_path: Path) -> None:
    """Uses a program that reports like `beambench selftest --minimize`."""
    program = tmp_path / "beambench"
    program.write_text(
        """#!/bin/sh
while [ $# -gt 1 ]; do
  case $1 in --json) json=$2;; --minimize) dir=$2;; esac
  shift
done
mkdir -p "$dir/samet-views"
echo case > "$dir/samet-views/scene.nff"
cat > "$json" <<END
{"checks": [{"check": "views", "rays": 7, "passed": false, "failure": "a hit",
             "case": "$dir/samet-views"}]}
END
exit 1
"""
    )
    program.chmod(0o755)
    done = random_rays.trace(program, "samet", 5, record, Programs())
    (found,) = done.findings
    assert found.message == "views: a hit"
    assert (record.findings / found.file / "scene.nff").read_text() == "case\n"
    assert "--seed 5" in found.command


@needs_binary
@pytest.mark.parametrize("kind", ["sweep", pytest.param("nights", marks=pytest.mark.full)])
def test_kills_lose_nothing(record: Record, kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(night_kills, "_KILLS", 1)  # a night takes seconds
    arguments = ["--only", kind, "--minutes", "0", "--seed", "5", "--beambench", BINARY]
    assert campaign(record, "kills", *arguments) == 0, record.pieces()
    (done,) = record.pieces()
    assert done["counts"]["runs"] >= max(2, done["counts"]["kills"])


def faulty_program(folder: Path) -> Path:
    """Writes a program whose runs end at once; only the undisturbed run has no duplicate cell."""
    path = folder / "beambench"
    path.write_text(
        "#!/bin/sh\n"
        "trap '' INT TERM\n"
        'for folder; do :; done; mkdir -p "$folder"; exec >"$folder/results.csv"\n'
        "echo scene,camera,structure,parameters,width,height,samples,ray_kind,verdict\n"
        "echo a,b,c,d,8,8,1,primary,ok\n"
        '[ "${folder##*/}" = undisturbed ] || echo a,b,c,d,8,8,1,primary,ok\n'
    )
    path.chmod(0o755)
    return path


def test_a_doubled_cell_is_found_and_the_folder_kept(record: Record, tmp_path: Path) -> None:
    program = faulty_program(tmp_path)
    arguments = ["--only", "sweep", "--minutes", "0", "--seed", "5", "--beambench", program]
    assert campaign(record, "kills", *arguments) == 1
    (finding,) = record.pieces()[0]["findings"]
    assert "twice" in finding["message"]
    assert (record.findings / finding["file"] / "killed/results.csv").exists()
    assert finding["command"] == "scripts/campaign kills --minutes 0 --only sweep --seed 5"


# The command line


@pytest.fixture
def script(repository: Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    def call(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [str(repository / "scripts/campaign"), *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    return call


def test_help_names_every_option(
    script: Callable[..., subprocess.CompletedProcess[str]], repository: Path
) -> None:
    done = script("--help")
    assert done.returncode == 0
    source = (repository / "scripts/beambench_operations/campaign/__main__.py").read_text("utf-8")
    own = {"--beambench", "--targets"}  # for tests
    for line in source.splitlines():
        if 'add_argument("--' in line:
            option = line.split('"')[1]
            assert option in own or option in done.stdout, option


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], "name one of fuzz, rays and kills"),
        (["fire"], "invalid choice: 'fire'"),
        (["rays", "--minutes", "-1"], "'-1' is not a number from 0"),
        (["rays", "--jobs", "0"], "'0' is not a whole number of 1"),
        (["rays", "--report", "x"], "name one of"),
    ],
)
def test_invalid_arguments_are_refused(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == 2
    error = capsys.readouterr().err
    assert words in error
    assert error.count("\n") == 1


def test_a_dry_run_does_nothing(record: Record, capsys: pytest.CaptureFixture[str]) -> None:
    assert campaign(record, "kills", "--dry-run") == 0
    assert str(record.file) in capsys.readouterr().out
    assert not record.folder.exists()


def test_the_record_can_be_read_by_others(record: Record) -> None:
    record.add(piece("samet", 3))
    read = json.loads(record.file.read_text("utf-8"))
    assert read["version"] == 1
    assert set(read["pieces"][0]) >= {"command", "subject", "seed", "counts", "commit", "machine"}
