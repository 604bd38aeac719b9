"""A sweep in shards: the rows are those of one run; wrong requests are refused."""

from __future__ import annotations

import fcntl
import json
import os
import shutil
import subprocess
from pathlib import Path
from random import Random

import pytest

from beambench_operations.campaign.killed import Tally, ended_as_killed, finished, killed
from beambench_operations.campaign.programs import Programs
from beambench_operations.campaign.rows import cells_of, difference
from beambench_report.base.records import read_run
from beambench_report.run.page import render
from beambench_report.run.plots import KINDS
from program import BINARY, beambench, refused
from run_logs import Event, begun_cells, change_events, change_manifest, cut_off, forget_cell

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
COUNT = 4
SWEEP = {
    "name": "tiny",
    "scenes": ["tetra:n=1", "balls:n=1"],
    "structures": ["null", "exhaustive", "samet:max_level=3", "beam:max_level=3", "embree"],
    "resolutions": ["8x8", "16x10"],
    "rays": ["primary", "shadow"],
    "repetitions": {"minimum": 2, "maximum": 2},
    "budget_seconds": 0,
    "warm_up_seconds": 0,
}


def write_sweep(folder: Path, **changes: object) -> Path:
    path = folder / "tiny.json"
    path.write_text(json.dumps(SWEEP | changes), "utf-8")
    return path


def run(*arguments: str | Path) -> None:
    done = beambench("run", *arguments)
    assert done.returncode == 0, done.stderr


def same_rows(wanted: Path, found: Path) -> None:
    (one, fault), (other, damage) = (cells_of(run / "results.csv") for run in (wanted, found))
    assert not fault
    assert not damage
    assert not difference(one, other)


def wait_until_unlocked(folder: Path) -> None:
    """Waits for the process of a block, which ends shortly after the killed run."""
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
    finally:
        os.close(descriptor)


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the sweep, one run of it, `whole`, and its shards `1` to `4`."""
    folder = tmp_path_factory.mktemp("shards")
    sweep = write_sweep(folder)
    run(sweep, "-o", folder / "whole")
    for number in range(1, COUNT + 1):
        run(sweep, "--shard", f"{number}/{COUNT}", "-o", folder / str(number))
    return folder


@pytest.fixture
def copy(measured: Path, tmp_path: Path) -> Path:
    """A copy of the measured folder that a test may change."""
    return Path(shutil.copytree(measured, tmp_path / "copy"))


def shards(folder: Path) -> list[Path]:
    return [folder / str(number) for number in range(1, COUNT + 1)]


def test_four_shards_have_the_rows_of_one_run(measured: Path, tmp_path: Path) -> None:
    done = beambench("merge", *reversed(shards(measured)), "-o", tmp_path / "merged")
    assert done.returncode == 0, done.stderr
    assert done.stdout == f"{tmp_path}/merged/results.csv\n"
    assert "Hits:  " in done.stderr
    same_rows(measured / "whole", tmp_path / "merged")
    assert [path.name for path in tmp_path.iterdir()] == ["merged"], "nothing is left beside it"
    one, merged = (read_run(path).rows for path in (measured / "whole", tmp_path / "merged"))
    keys = ["scene", "camera", "structure", "parameters", "width", "height", "samples", "ray_kind"]
    assert (one[keys] == merged[keys]).all(axis=None), "in the same order"
    assert (one["verdict"] == merged["verdict"]).all()
    assert merged["run_id"].nunique() == 1
    render(read_run(tmp_path / "merged"), drawn_kinds=())


def test_the_manifest_has_the_conditions_of_every_shard(measured: Path, tmp_path: Path) -> None:
    beambench("merge", *shards(measured), "-o", tmp_path / "merged")
    manifest = json.loads((tmp_path / "merged/manifest.json").read_text())
    begun = [json.loads((path / "manifest.json").read_text()) for path in shards(measured)]
    assert [one["number"] for one in manifest["shards"]] == [1, 2, 3, 4]
    for one, its in zip(manifest["shards"], begun, strict=True):
        assert one["run_id"] == its["run_id"]
        assert one["machine"] == its["machine"]
        assert its["run_id"].endswith(f"-tiny-shard-{one['number']}-of-4")
    assert manifest["run_id"] == begun[0]["run_id"].removesuffix("-shard-1-of-4")
    known = [noise for one in begun if (noise := one["measurement"]["noise"]) is not None]
    assert manifest["measurement"]["noise"] == max(known, default=None)
    assert manifest["machine"]["id"] == begun[0]["machine"]["id"]
    assert {cell["shard"] for cell in begun_cells(tmp_path / "merged")} == {1, 2, 3, 4}


def test_cells_that_are_compared_are_in_one_shard(measured: Path) -> None:
    seen: dict[tuple, int] = {}
    for number, shard in enumerate(shards(measured)):
        for _, row in read_run(shard).rows.iterrows():
            view = (row["scene"], row["camera"], row["width"], row["height"], row["ray_kind"])
            assert seen.setdefault(view, number) == number
    assert set(seen.values()) == {0, 1, 2, 3}


def test_a_dry_run_names_the_cells_of_a_shard(measured: Path) -> None:
    names = [
        beambench(
            "run", measured / "tiny.json", "--shard", f"{number}/{COUNT}", "--dry-run"
        ).stdout.splitlines()
        for number in range(1, COUNT + 1)
    ]
    whole = beambench("run", measured / "tiny.json", "--dry-run").stdout.splitlines()
    assert sorted(name for own in names for name in own) == sorted(whole)


def test_rows_keep_their_machines(copy: Path) -> None:
    """The third shard claims to be from another machine."""
    change_manifest(copy / "3", {"machine/id": "fedcba9876543210", "machine/cpu": "B"})
    done = beambench("merge", *shards(copy), "-o", copy / "merged")
    assert done.returncode == 0, done.stderr
    merged = read_run(copy / "merged")
    others = merged.rows["machine_id"] == "fedcba9876543210"
    assert others.sum() == len(begun_cells(copy / "3"))
    manifest = json.loads((copy / "merged/manifest.json").read_text())
    assert "fedcba9876543210" in manifest["machine"]["id"]
    assert manifest["machine"]["cpu"].endswith(" and B")
    # The program compares in the same way as the pages.
    summary = (copy / "merged/summary.txt").read_text()
    for view in merged.views:
        assert ", machine " in view
        assert f"{view} " in summary
    render(merged, drawn_kinds=KINDS[:1])
    refused(beambench("run", "--resume", copy / "merged"), ["merged from the shards"])


@pytest.mark.parametrize("seed", range(3))
def test_a_killed_shard_is_resumed_and_merged(measured: Path, tmp_path: Path, seed: int) -> None:
    """Kills and resumes a shard at random moments until its run is complete."""
    random, tally, programs = Random(seed), Tally(), Programs()
    number = random.randint(1, COUNT)
    lost = tmp_path / "lost"
    complete = False
    while not complete:
        begun = (lost / "run.jsonl").exists()
        sweep = [measured / "tiny.json", "--shard", f"{number}/{COUNT}", "-o", lost]
        program = programs.start(
            [BINARY, "run", *(["--resume", lost] if begun else sweep)], tmp_path
        )
        ended = killed(program, random, 1.0, tally) if tally.kills < 5 else finished(program, tally)
        complete = ended.code == 0
        assert complete or ended_as_killed(ended), ended.last_words()
        if not complete and (lost / "run.jsonl").exists():
            wait_until_unlocked(lost)
            others = [path for path in shards(measured) if path.name != str(number)]
            words = [f"shard {number}/4 in '{lost}' has", "finish it with: beambench run --resume"]
            merged = beambench("merge", lost, *others, "-o", tmp_path / "early")
            if merged.returncode != 0:
                refused(merged, words)
                continue
            same_rows(measured / "whole", tmp_path / "early")  # killed after its last cell
            shutil.rmtree(tmp_path / "early")
    others = [path for path in shards(measured) if path.name != str(number)]
    done = beambench("merge", lost, *others, "-o", tmp_path / "merged")
    assert done.returncode == 0, done.stderr
    same_rows(measured / "whole", tmp_path / "merged")


def test_a_killed_merge_leaves_nothing_in_the_way(measured: Path, tmp_path: Path) -> None:
    left = tmp_path / ".merged.partial-1234"
    left.mkdir()
    (left / "run.jsonl").write_text("")
    done = beambench("merge", *shards(measured), "-o", tmp_path / "merged")
    assert done.returncode == 0, done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["merged"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--shard", "0/4"], ["--shard", "K from 1 to N", "'0/4'"]),
        (["--shard", "5/4"], ["--shard", "K from 1 to N", "'5/4'"]),
        (["--shard", "-1/4"], ["--shard", "K from 1 to N", "'-1/4'"]),
        (["--shard", "2"], ["--shard", "K/N", "'2'"]),
        (["--shard", ""], ["--shard", "K/N"]),
        (["--shard", "1/9"], ["--shard 1/9", "8 groups", "at most 8"]),
        (["--shard", "1/4", "--benchmark_filter=samet"], ["--benchmark_filter", "completely"]),
    ],
)
def test_a_wrong_shard_is_refused(
    measured: Path, tmp_path: Path, arguments: list[str], words: list[str]
) -> None:
    refused(beambench("run", measured / "tiny.json", *arguments, "-o", tmp_path / "new"), words)
    assert not (tmp_path / "new").exists()


def test_a_shard_is_not_measured_into_the_folder_of_another(measured: Path) -> None:
    done = beambench("run", measured / "tiny.json", "--shard", "2/4", "-o", measured / "1")
    refused_after(done, ["already holds a run", f"{measured}/1"])


def test_the_shard_of_a_run_to_be_resumed_is_that_of_its_manifest(measured: Path) -> None:
    done = beambench("run", "--resume", measured / "1", "--shard", "2/4")
    assert done.returncode == 2
    assert "--resume" in done.stderr


def refused_after(done: subprocess.CompletedProcess[str], words: list[str]) -> None:
    """Expects a refusal as in `refused`, possibly after lines about the request."""
    *before, last = done.stderr.splitlines()
    assert all(line.startswith("shard ") for line in before)
    done.stderr = last + "\n"
    refused(done, words)


def merge_is_refused(folder: Path, names: list[str], words: list[str]) -> None:
    done = beambench("merge", *(folder / name for name in names), "-o", folder / "merged")
    refused(done, ["cannot merge: ", *words])
    assert not (folder / "merged").exists()
    assert not list(folder.glob(".merged*"))


def test_a_missing_shard_is_named(measured: Path) -> None:
    merge_is_refused(measured, ["1", "2", "4"], ["'tiny' is missing: 3/4", "--shard 3/4"])
    merge_is_refused(measured, ["2", "4"], ["'tiny' are missing: 1/4, 3/4"])


def test_a_doubled_shard_is_named(copy: Path) -> None:
    shutil.copytree(copy / "2", copy / "again")
    words = ["shard 2/4 appears twice", f"'{copy}/2'", f"'{copy}/again'"]
    merge_is_refused(copy, ["1", "2", "3", "4", "again"], words)
    merge_is_refused(copy, ["1", "2", "3", "4", "2"], ["are the same folder", f"'{copy}/2'"])


def test_a_cell_with_other_counters_is_named(copy: Path) -> None:
    shutil.copytree(copy / "2", copy / "again")

    def changed(event: Event) -> Event:
        if event.get("counters"):
            event["counters"]["primitive_tests"] = 1
        return event

    change_events(copy / "again", changed)
    words = ["the cell tetra", "primitive_tests_per_ray", f"'{copy}/2'", f"'{copy}/again'"]
    merge_is_refused(copy, ["1", "2", "3", "4", "again"], words)


def test_times_may_differ_where_a_shard_is_doubled(copy: Path) -> None:
    shutil.copytree(copy / "2", copy / "again")

    def changed(event: Event) -> Event:
        return event | {"trace_ms": 0.125} if event["event"] == "repetition" else event

    change_events(copy / "again", changed)
    merge_is_refused(copy, ["1", "2", "3", "4", "again"], ["shard 2/4 appears twice"])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"program/executable_hash": "0123456789abcdef"}, ["two builds of beambench"]),
        ({"program/commit": "0123456789"}, ["of commit", "0123456789"]),
        ({"scenes/0/hash": "0123456789abcdef"}, ['the scene "', "0123456789abcdef"]),
        ({"shard/count": 5}, ["shard 3/5", "one division"]),
        ({"shard/number": 2}, ["shard 2/4 appears twice"]),
        ({"plugins": [{"file": "mine.so", "hash": "01"}]}, ["different plug-ins"]),
        ({"shard": {}}, ["run.jsonl"]),
        ({"machine": 3}, ["run.jsonl", "not as it was written"]),
    ],
)
def test_a_shard_that_does_not_fit_is_named(copy: Path, change: dict, words: list[str]) -> None:
    change_manifest(copy / "3", change)
    done = beambench("merge", *shards(copy), "-o", copy / "merged")
    refused(done, [f"{copy}/3", *words])
    assert not (copy / "merged").exists()
    assert not list(copy.glob(".merged*"))


def test_a_scene_that_changed_between_machines_is_named(tmp_path: Path) -> None:
    """Simulates machines with different files under the same path."""
    scene = tmp_path / "scene.nff"
    text = (
        "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0.1\nresolution 8 8\n"
        "f 1 1 1 1 0 0 0 0\ns 0 0 0 {}\n"
    )
    sweep = write_sweep(tmp_path, scenes=[str(scene)], rays=["primary"])
    for number, radius in ((1, 1.0), (2, 1.5)):
        scene.write_text(text.format(radius))
        run(sweep, "--shard", f"{number}/2", "-o", tmp_path / str(number))
    merge_is_refused(tmp_path, ["1", "2"], ["scene.nff", f"'{tmp_path}/1'", f"'{tmp_path}/2'"])


def test_shards_of_two_sweeps_are_refused(copy: Path) -> None:
    sweep = write_sweep(copy, precision=0.5)
    shutil.rmtree(copy / "3")
    run(sweep, "--shard", "3/4", "-o", copy / "3")
    merge_is_refused(copy, ["1", "2", "3", "4"], ["two sweeps", "/precision", f"'{copy}/3'"])


def test_a_shard_without_its_end_is_unfinished(copy: Path) -> None:
    cut_off(copy / "3")
    words = [f"shard 3/4 in '{copy}/3'", "beambench run --resume"]
    merge_is_refused(copy, ["1", "2", "3", "4"], words)


def test_a_cell_that_is_gone_makes_a_shard_unfinished(copy: Path) -> None:
    cells = begun_cells(copy / "3")
    count = len(cells)
    forget_cell(copy / "3", cells[0]["index"])
    words = ["shard 3/4", f"has {count - 1} of {count} cells", "--resume"]
    merge_is_refused(copy, ["1", "2", "3", "4"], words)
    run("--resume", copy / "3")
    done = beambench("merge", *shards(copy), "-o", copy / "merged")
    assert done.returncode == 0, done.stderr
    same_rows(copy / "whole", copy / "merged")


def test_what_is_no_shard_is_refused(copy: Path) -> None:
    (copy / "empty").mkdir()
    merge_is_refused(copy, ["empty"], [f"'{copy}/empty' holds no run"])
    merge_is_refused(copy, ["no-such"], [f"'{copy}/no-such' holds no run"])
    merge_is_refused(copy, ["whole"], [f"'{copy}/whole' holds no shard but a whole run"])
    assert beambench("merge", *shards(copy), "-o", copy / "first").returncode == 0
    merge_is_refused(copy, ["first"], ["holds no shard but a run that was merged"])


def test_an_output_folder_that_is_there_is_refused(copy: Path) -> None:
    (copy / "empty").mkdir()
    for name in ("empty", "1", "tiny.json"):
        done = beambench("merge", *shards(copy), "-o", copy / name)
        refused(done, [f"'{copy}/{name}' already exists"])
    assert list((copy / "empty").iterdir()) == []


def test_a_shard_that_is_being_measured_is_refused(measured: Path, tmp_path: Path) -> None:
    sweep = write_sweep(tmp_path, repetitions={"minimum": 50_000})
    with subprocess.Popen(
        [BINARY, "run", sweep, "--shard", "1/4", "-o", tmp_path / "1"], stderr=subprocess.PIPE
    ) as program:
        assert program.stderr is not None
        while not (tmp_path / "1/run.jsonl").exists():
            assert program.poll() is None
        done = beambench("merge", tmp_path / "1", "-o", tmp_path / "merged")
        program.kill()
    refused(done, ["another beambench is at work", f"'{tmp_path}/1'"])


def test_a_shard_without_rays_is_no_failure(tmp_path: Path) -> None:
    """A shard without rays succeeds, because other shards may have rays."""
    sweep = write_sweep(tmp_path, scenes=["tetra:n=1"], rays=["primary", "mirror"])
    codes = []
    for number in range(1, 5):
        done = beambench("run", sweep, "--shard", f"{number}/4", "-o", tmp_path / str(number))
        codes.append(done.returncode)
    assert codes == [0, 0, 0, 0]
    done = beambench("merge", *shards(tmp_path), "-o", tmp_path / "merged")
    assert done.returncode == 0, done.stderr


def script(name: str, *arguments: str | Path, **variables: str) -> subprocess.CompletedProcess[str]:
    outside = {
        key: value for key, value in os.environ.items() if not key.startswith(("SLURM", "OMPI"))
    }
    return subprocess.run(
        [SCRIPTS / name, *map(str, arguments)],
        env={**outside, **variables},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def test_each_process_of_a_job_measures_its_shard(tmp_path: Path) -> None:
    """mpirun and srun set the rank of each process."""
    request = ["--sweep", write_sweep(tmp_path), "--output", tmp_path / "job"]
    ranks = [
        {"OMPI_COMM_WORLD_RANK": "0", "OMPI_COMM_WORLD_SIZE": "4", "SLURM_PROCID": "0"},
        {"PMI_RANK": "1", "PMI_SIZE": "4"},
        {"SLURM_PROCID": "2", "SLURM_NTASKS": "4"},
    ]
    for rank in ranks:
        done = script("shard", *request, **rank)
        assert done.returncode == 0, done.stderr
    done = script("shard", *request, "--shard", "4/4")
    assert done.returncode == 0, done.stderr
    folders = [tmp_path / f"job/shard-{number}" for number in range(1, 5)]
    done = beambench("merge", *folders, "-o", tmp_path / "merged")
    assert done.returncode == 0, done.stderr
    done = script("shard", *request, "--shard", "4/4")
    assert (done.returncode, done.stdout) == (0, f"shard 4/4 is finished: {folders[3]}\n")
    done = script("shard", *request, "--shard", "1/3")
    assert done.returncode == 2
    assert "is one of 4 shards, not of 3" in done.stderr


def test_a_job_array_is_submitted_merged_and_resumed(tmp_path: Path) -> None:
    """Uses a fake Slurm that runs each task at once; scripts/README.md covers the real one."""
    tools = tmp_path / "bin"
    tools.mkdir()
    (tools / "sbatch").write_text(
        "#!/usr/bin/env bash\n"
        f'printf "%s\\n" "$*" >>{tmp_path}/calls\n'
        'job=${!#}; tasks=$(sed -n "s/^#SBATCH --array=//p" "$job")\n'
        "for word; do [[ $word != --array=* ]] || tasks=${word#--array=}; done\n"
        "if [[ $tasks == *-* ]]; then tasks=$(seq ${tasks/-/ }); fi\n"
        "for task in ${tasks//,/ }; do\n"
        f"  [[ -e {tmp_path}/repaired || $task != 3 ]] || continue\n"
        '  SLURM_ARRAY_TASK_ID=$task SLURMD_NODENAME=node$task bash "$job" &>/dev/null\n'
        "done\n"
        '[[ -n $tasks ]] || bash "$job" &>/dev/null\n'
        "echo 17\n"
    )
    (tools / "sbatch").chmod(0o755)
    path = {"PATH": f"{tools}:{os.environ['PATH']}"}
    job = tmp_path / "job"
    request = ["--sweep", write_sweep(tmp_path), "--shards", "4", "--output", job]
    done = script("slurm", *request, "--", "--partition=long", "--time=1:00", **path)
    assert done.returncode == 0, done.stderr
    assert "#SBATCH --partition=long --time=1:00" in (job / "task").read_text()
    assert not (job / "merged").exists(), "the third shard was lost"
    done = script("slurm", *request, **path)
    assert done.returncode == 2
    assert "already exists" in done.stderr

    forget_cell(job / "shard-2", begun_cells(job / "shard-2")[0]["index"])  # killed
    (tmp_path / "repaired").touch()
    (tmp_path / "calls").unlink()
    done = script("slurm", "--resume", job, **path)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "calls").read_text().splitlines() == [
        f"--parsable --array=2 --nodelist=node2 {job}/task",
        f"--parsable --array=3 {job}/task",
        f"--parsable --dependency=afterany:17:17 {job}/merge",
    ]
    assert (job / "merged/results.csv").is_file()
    done = script("slurm", "--resume", job, **path)
    assert done.returncode == 2
    assert "is complete" in done.stderr


@pytest.mark.parametrize(
    ("name", "arguments", "message"),
    [
        ("shard", ["--sweep", "quick"], "--output is missing"),
        ("shard", ["--output", "x"], "--sweep is missing"),
        ("shard", ["--sweep", "quick", "--output", "x"], "neither mpirun nor srun"),
        ("shard", ["--sweep", "quick", "--output", "x", "--shard=2"], "'2' is not K/N"),
        ("shard", ["--sweep", "no-such", "--output", "x"], "no-such is not a file"),
        ("shard", ["--shards"], "unknown argument '--shards'"),
        ("shard", ["--shard"], "--shard needs a value"),
        ("slurm", ["--shards", "4", "--output", "x"], "--sweep is missing"),
        ("slurm", ["--sweep", "quick", "--output", "x"], "--shards '' is not a number"),
        ("slurm", ["--sweep", "quick", "--shards", "0", "--output", "x"], "'0' is not a number"),
        ("slurm", ["--sweep", "quick", "--shards", "4"], "--output is missing"),
        ("slurm", ["--sweep", "quick", "--shards", "4", "--output", "/"], "already exists"),
        ("slurm", ["--resume", "no/such"], "was not begun by scripts/slurm"),
        ("slurm", ["--resume", "x", "--shards", "4"], "--resume takes no other options"),
        ("slurm", ["--resume"], "--resume needs a value"),
        ("slurm", ["quick"], "unknown argument 'quick'"),
    ],
)
def test_a_wrong_request_of_a_script_is_one_sentence(
    name: str, arguments: list[str], message: str
) -> None:
    done = script(name, *arguments)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith("error: ")
    assert message in done.stderr
    assert done.stderr.count("\n") == 1
