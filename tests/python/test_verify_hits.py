"""Verifying the hits of any program on the command line: files, commands, kits."""

from __future__ import annotations

import json
import re
import shutil
import struct
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from program import BINARY, beambench, output_of, refused, shell

SCENE = "tetra:n=3"
NONE = 0xFFFFFFFF


@dataclass
class Traced:
    """Rays over a scene and the hits of exhaustive search, in a folder."""

    folder: Path
    rays: NDArray[np.float32]  # (N, 8)
    t: NDArray[np.float32]
    primitive: NDArray[np.uint32]

    def points(self) -> NDArray[np.float32]:
        with np.errstate(invalid="ignore"):
            at = self.rays[:, :3] + self.t[:, None].astype("f8") * self.rays[:, 4:7]
        return np.where(np.isinf(self.t)[:, None], np.inf, at).astype("f4")


def read_binary(path: Path, dtype: object) -> NDArray:
    with path.open("rb") as file:
        assert file.readline().startswith(b"beambench-")
        json.loads(file.readline())
        return np.frombuffer(file.read(), dtype)


@pytest.fixture(scope="module")
def traced(tmp_path_factory: pytest.TempPathFactory) -> Traced:
    folder = tmp_path_factory.mktemp("traced")
    for name in ("a.rays", "a.csv"):
        output_of("rays", SCENE, "--resolution", "60x50", "-o", folder / name)
    for rays, hits in (("a.rays", "a.hits"), ("a.csv", "hits.csv")):
        chosen = ("--rays", folder / rays, "--accel", "exhaustive", "-o", folder / hits)
        output_of("hits", SCENE, *chosen)
    rays = read_binary(folder / "a.rays", "<f4").reshape(-1, 8)
    hits = read_binary(folder / "a.hits", [("t", "<f4"), ("primitive", "<u4")])
    return Traced(folder, rays, hits["t"].copy(), hits["primitive"].copy())


def write_hits(path: Path, columns: dict[str, NDArray]) -> None:
    """Writes a table of hits, as any program might."""
    if path.suffix == ".csv":
        rows = zip(*(column.tolist() for column in columns.values()), strict=True)
        text = ",".join(columns) + "\n" + "".join(",".join(map(repr, row)) + "\n" for row in rows)
        path.write_text(text)
        return
    kinds = {"primitive": "<u4", "triangle": "<u4", "occluded": "u1"}
    table = np.zeros(
        len(next(iter(columns.values()))), [(name, kinds.get(name, "<f4")) for name in columns]
    )
    for name, column in columns.items():
        table[name] = column
    header = {"hits": len(table), "columns": list(columns)}
    path.write_bytes(b"beambench-hits 1\n" + json.dumps(header).encode() + b"\n" + table.tobytes())


def columns_of(form: str, traced: Traced, t: NDArray, ids: NDArray) -> dict[str, NDArray]:
    """Returns the hits in one of the forms; the triangles of this scene are its primitives."""
    moved = Traced(traced.folder, traced.rays, t, ids)
    x, y, z = moved.points().T
    place = {"x": x, "y": y, "z": z} if "point" in form else {"t": t}
    if form == "occluded":
        return {"occluded": (ids != NONE).astype("u1")}
    if "primitive" in form:
        return {**place, "primitive": ids}
    return {**place, "triangle": ids} if "triangle" in form else place


def verify(traced: Traced, hits: Path, *more: str | Path, rays: str = "a.rays") -> dict:
    """Returns the JSON of a verification that must end with exit code 0 or 1."""
    out = hits.with_suffix(".json")
    done = beambench(
        "verify", SCENE, "--rays", traced.folder / rays, "--hits", hits, "--json", out, *more
    )
    assert done.returncode in (0, 1), done.stderr
    found = json.loads(out.read_text())
    assert found["passed"] == (done.returncode == 0)
    (case,) = found["cases"]
    assert case["verdict"] in done.stdout
    return case


FORMS = [
    "t, primitive",
    "t, triangle",
    "t",
    "point, primitive",
    "point, triangle",
    "point",
    "occluded",
]


@pytest.mark.parametrize("rays", ["a.rays", "a.csv"])
@pytest.mark.parametrize("hits", ["a.hits", "hits.csv"])
def test_the_round_trip_takes_two_commands(
    traced: Traced, rays: str, hits: str, tmp_path: Path
) -> None:
    shutil.copy(traced.folder / hits, tmp_path)
    case = verify(traced, tmp_path / hits, rays=rays)
    assert case["verdict"] == "ok"
    assert case["rays"] == case["agree"] == 60 * 50
    assert case["hits"] == np.count_nonzero(traced.primitive != NONE) > 500


def test_rays_as_csv_are_exact_for_readers_of_double(traced: Traced) -> None:
    table = np.loadtxt(traced.folder / "a.csv", delimiter=",", skiprows=1)
    assert np.array_equal(table, traced.rays.astype("f8"))


def clear_hit(traced: Traced) -> int:
    """Returns a ray whose neighbors in the picture all hit the same triangle."""
    picture = traced.primitive.reshape(50, 60)
    for y in range(1, 49):
        for x in range(1, 59):
            if picture[y, x] != NONE and np.all(
                picture[y - 1 : y + 2, x - 1 : x + 2] == picture[y, x]
            ):
                return y * 60 + x
    raise AssertionError("no triangle is large enough")


@pytest.mark.parametrize("ending", [".hits", ".csv"])
@pytest.mark.parametrize("form", FORMS)
def test_planted_faults_are_found_in_every_form(
    traced: Traced, form: str, ending: str, tmp_path: Path
) -> None:
    at = clear_hit(traced)
    file = tmp_path / f"mine{ending}"
    write_hits(file, columns_of(form, traced, traced.t, traced.primitive))
    assert verify(traced, file)["verdict"] == "ok"

    largest = np.abs(traced.points()[traced.primitive != NONE]).max()
    tolerance = 16 * 2**-24 * (largest + np.linalg.norm(traced.rays[at, :3]))
    faults: dict[str, tuple[NDArray, NDArray]] = {}
    if form != "occluded":
        moved = traced.t.copy()
        moved[at] += 10 * tolerance / np.linalg.norm(traced.rays[at, 4:7])
        faults["moved"] = (moved, traced.primitive)
    if "," in form:
        exchanged = traced.primitive.copy()
        exchanged[at] = (exchanged[at] + 7) % 64
        faults["exchanged"] = (traced.t, exchanged)
    lost_t, lost_ids = traced.t.copy(), traced.primitive.copy()
    lost_t[at], lost_ids[at] = np.inf, NONE
    faults["left out"] = (lost_t, lost_ids)
    for fault, (t, ids) in faults.items():
        write_hits(file, columns_of(form, traced, t, ids))
        case = verify(traced, file)
        assert case["structure_error"] == 1, fault
        assert case["verdict"] == "mismatch", fault
        example = case["examples"][0]
        assert example["index"] == at
        place = f"mine.csv:{at + 2}" if ending == ".csv" else "mine.hits: byte "
        assert place in example["place"]
        assert example["oracle"]["primitive"] == traced.primitive[at]


def test_a_picture_marks_where_hits_are_wrong(traced: Traced, tmp_path: Path) -> None:
    at = clear_hit(traced)
    t = traced.t.copy()
    t[at] *= 0.9
    write_hits(tmp_path / "mine.hits", {"t": t, "primitive": traced.primitive})
    case = verify(
        traced, tmp_path / "mine.hits", "--pictures", tmp_path / "p", "--resolution", "60x50"
    )
    (picture,) = (tmp_path / "p").iterdir()
    assert case["picture"] == str(picture)
    pixels = np.asarray(Image.open(picture).convert("RGB")).astype(int)
    red, green, blue = pixels[:50, -60 - (pixels.shape[1] - 60) // 2 :][:, :60].transpose(2, 0, 1)
    marked = np.argwhere((red > 180) & (green < 130) & (blue < 60))
    assert len(marked) >= 9
    assert np.abs(marked.mean(axis=0) - [at // 60, at % 60]).max() < 1.5


def test_right_hits_leave_no_picture(traced: Traced, tmp_path: Path) -> None:
    shutil.copy(traced.folder / "a.hits", tmp_path)
    assert "picture" not in verify(traced, tmp_path / "a.hits", "--pictures", tmp_path / "p")
    assert list((tmp_path / "p").iterdir()) == []


def test_any_hits_answer_rays_of_any_kind(tmp_path: Path) -> None:
    chosen = ("--rays", "shadow", "--resolution", "40x30")
    output_of("rays", "teapot:n=2", *chosen, "-o", tmp_path / "s.rays")
    for hits in ("s.hits", "s.csv"):
        rays = ("--rays", tmp_path / "s.rays")
        output_of("hits", "teapot:n=2", *rays, "-o", tmp_path / hits)
        done = beambench("verify", "teapot:n=2", *rays, "--hits", tmp_path / hits)
        assert done.returncode == 0, done.stdout + done.stderr
        assert "  any  " in done.stdout


# Refusals


def write_spoiled(traced: Traced, path: Path, fault: str) -> None:
    t, ids = traced.t.copy(), traced.primitive.copy()
    columns = {"t": t, "primitive": ids}
    if fault == "nan":
        t[17] = np.nan
    elif fault == "id":
        ids[17] = 64
    elif fault == "too few":
        columns = {"t": t[:-1], "primitive": ids[:-1]}
    elif fault == "too many":
        columns = {"t": np.append(t, np.float32(1)), "primitive": np.append(ids, np.uint32(1))}
    write_hits(path, columns)


@pytest.mark.parametrize("ending", [".hits", ".csv"])
@pytest.mark.parametrize("rays", ["a.rays", "a.csv"])
@pytest.mark.parametrize(
    ("fault", "words"),
    [
        ("nan", ["hit 17: t is not a number"]),
        ("id", ["hit 17: there is no primitive 64", "0 to 63"]),
        ("too few", ["2999 hits for the 3000 rays"]),
        ("too many", ["for the 3000 rays"]),
    ],
)
def test_what_no_hit_can_be_is_refused_with_its_place(
    traced: Traced, ending: str, rays: str, fault: str, words: list[str], tmp_path: Path
) -> None:
    file = tmp_path / f"mine{ending}"
    write_spoiled(traced, file, fault)
    done = beambench("verify", SCENE, "--rays", traced.folder / rays, "--hits", file)
    assert done.returncode == 2
    message = done.stderr.splitlines()[-1]
    for word in words:
        assert word in message
    assert str(file) in message
    if fault in ("nan", "id"):
        assert (":19: " if ending == ".csv" else ": byte ") in message


def test_other_files_are_refused_with_one_sentence(traced: Traced, tmp_path: Path) -> None:
    rays = traced.folder / "a.rays"
    (tmp_path / "words.csv").write_text("t,primitive\n1,2\nmaybe,3\n")
    (tmp_path / "cut.hits").write_bytes((traced.folder / "a.hits").read_bytes()[:-3])
    (tmp_path / "damaged.rays").write_bytes(rays.read_bytes()[:-1] + b"\x01")
    (tmp_path / "nan.csv").write_text("ox,oy,oz,dx,dy,dz\n0,0,0,0,0,1\n0,0,nan,0,0,1\n")
    hits = traced.folder / "a.hits"
    for scene, rays_file, hits_file, words in [
        (SCENE, rays, tmp_path / "words.csv", ["words.csv:3", "column 't'", "'maybe'"]),
        (SCENE, rays, tmp_path / "cut.hits", ["cut.hits", "bytes of hits"]),
        (SCENE, rays, tmp_path / "none.hits", ["none.hits", "No such file"]),
        (SCENE, rays, rays, ["this is not a hit file"]),
        (SCENE, hits, hits, ["'beambench rays"]),
        ("tetra:n=2", rays, hits, ["made for a scene with hash"]),
        (SCENE, tmp_path / "nan.csv", hits, ["nan.csv:3"]),
    ]:
        done = beambench("verify", scene, "--rays", rays_file, "--hits", hits_file)
        refused(done, words)
    # Damage to a file is found at its end, after the progress line has begun.
    done = beambench("verify", SCENE, "--rays", tmp_path / "damaged.rays", "--hits", hits)
    assert done.returncode == 2
    assert "hash differs" in done.stderr.splitlines()[-1]
    assert done.stdout == ""


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--hits", "a.hits"], ["name one scene"]),
        ([SCENE, "balls", "--rays", "a.rays", "--hits", "a.hits"], ["name one scene"]),
        ([SCENE, "--hits", "a.hits"], ["'primary'", "beambench rays tetra:n=3 -o FILE.rays"]),
        ([SCENE, "--rays", "a.rays", "--hits", "a.hits", "--accel", "samet"], ["--accel"]),
        ([SCENE, "--rays", "a.rays", "--command", "true"], ["no {hits}"]),
        ([SCENE, "--kit", "kit"], ["leave out SCENE and --hits"]),
        (["--kit", "no-kit"], ["no-kit/kit.json", "does not contain a kit", "selftest --export"]),
    ],
)
def test_requests_that_do_not_go_together_are_refused(
    arguments: list[str], words: list[str], traced: Traced
) -> None:
    refused(beambench("verify", *arguments, cwd=traced.folder), words)


# OBJ


def test_obj_files_have_the_triangles_that_hits_name(tmp_path: Path) -> None:
    output_of("export", "gears:n=2", "-o", tmp_path / "gears.obj")
    lines = (tmp_path / "gears.obj").read_text().splitlines()
    vertices = np.array([line.split()[1:] for line in lines if line[0] == "v"], "f4")
    faces = np.array([line.split()[1:] for line in lines if line[0] == "f"], int) - 1
    assert {line[0] for line in lines} == {"v", "f"}
    as_double = np.array([line.split()[1:] for line in lines if line[0] == "v"], "f8")
    assert np.array_equal(as_double, vertices), "exact for readers of double"
    assert faces.min() == 0
    assert faces.max() < len(vertices)
    facts = json.loads(output_of("scene", "gears:n=2", "--json"))
    assert len(faces) > facts["primitives"], (
        "polygons with four or more corners are several triangles"
    )
    refused(beambench("export", "balls:n=1", "-o", tmp_path / "b.obj"), ["spheres", ".nff"])
    refused(beambench("export", "tetra:n=1", "-o", tmp_path / "b.stl"), [".nff or .obj"])


# Commands and kits

TRACER = (Path(__file__).parent / "own_tracer.py").read_text()


@pytest.fixture(scope="module")
def kit(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("kit")
    (folder / "tracer.py").write_text(TRACER)
    text = output_of("selftest", "--export", folder / "kit", "--scenes", "7")
    assert "47 scenes of polygons" in text
    return folder


def tracer(kit: Path, fault: str) -> str:
    return f"{sys.executable} {kit / 'tracer.py'} {{obj}} {{rays}} {{hits}} {fault}"


def test_a_kit_holds_each_scene_as_files(kit: Path) -> None:
    index = json.loads((kit / "kit/kit.json").read_text())
    assert len(index["cases"]) == 47
    for case in index["cases"]:
        folder = kit / "kit" / case["folder"]
        names = {path.name for path in folder.iterdir()}
        assert {"scene.nff", "scene.obj", "closest.rays", "any.rays", "rays.csv"} <= names
        closest = read_binary(folder / "closest.rays", "<f4")
        assert len(closest) % 8 == 0
        assert np.array_equal(closest, read_binary(folder / "any.rays", "<f4"))
        assert len((folder / "rays.csv").read_text().splitlines()) == 1 + len(closest) // 8
        faces = [line for line in (folder / "scene.obj").read_text().splitlines() if line[0] == "f"]
        assert len(faces) == case["triangles"] > 0
        assert case["family"]
        assert "hit or miss" in case["tolerance"] or "any of the" in case["tolerance"]
        whole = np.isinf(closest[7::8]) & (closest[3::8] == 0)
        assert whole.all() if case["family"] != "t interval" else not whole.any()
    families = {case["family"] for case in index["cases"]}
    assert {"t interval", "rays in planes", "edges and vertices", "closed mesh"} <= families
    assert {"huge scale", "tiny scale", "odd directions", "origins on surfaces"} <= families
    assert {"needles", "duplicates", "thousands in a plane"} <= families
    assert "beambench verify --kit" in (kit / "kit/README.md").read_text()
    refused(beambench("selftest", "--export", kit / "kit"), ["is not empty"])


def test_a_kit_of_other_primitives_has_them(tmp_path: Path) -> None:
    output_of(
        "selftest", "--export", tmp_path / "kit", "--scenes", "2", "--primitives", "spheres,cones"
    )
    index = json.loads((tmp_path / "kit/kit.json").read_text())
    assert all(case["polygons"] == 0 for case in index["cases"])
    assert sum(case["spheres"] for case in index["cases"]) > 0
    done = beambench("verify", "--kit", tmp_path / "kit", "--accel", "samet")
    assert done.returncode == 0, done.stdout + done.stderr
    refused(
        beambench("selftest", "--export", tmp_path / "b", "--primitives", "cubes"),
        ["'cubes'", "spheres, cones, polygons"],
    )


def test_a_program_is_run_over_a_kit_and_its_fault_reduced(kit: Path, tmp_path: Path) -> None:
    small = shutil.copytree(kit / "kit", tmp_path / "kit")
    index = json.loads((small / "kit.json").read_text())
    index["cases"] = [case for case in index["cases"] if case["triangles"] < 20]
    (small / "kit.json").write_text(json.dumps(index))
    done = beambench("verify", "--kit", small, "--command", tracer(kit, "none"))
    assert done.returncode == 0, done.stdout + done.stderr
    count = 2 * len(index["cases"])
    assert count >= 12
    assert f"{count} of {count} cases right" in done.stdout

    failures = tmp_path / "failures"
    command = tracer(kit, "epsilon")
    done = beambench(
        *("verify", "--kit", small, "--command", command, "--minimize", failures),
        *("--json", tmp_path / "v.json"),
    )
    assert done.returncode == 1
    assert "tiny-scale" in done.stdout
    assert "a hit was lost" in done.stdout
    assert "reduced to 1 primitive and 1 ray" in done.stdout
    for line in re.findall(r"^replay: (.*ray.rays.*)$", done.stdout, re.MULTILINE):
        assert shell(line, tmp_path).returncode == 1, line
    wrong = [
        case
        for case in json.loads((tmp_path / "v.json").read_text())["cases"]
        if not case["passed"]
    ]
    folders = sorted(failures.iterdir())
    assert len(folders) == len(wrong) > 0
    for folder in folders:
        case = json.loads((folder / "case.json").read_text())
        assert case["repeated"]
        assert len(case["primitives"]) == case["rays"] == 1
        assert (folder / "scene.obj").read_text().count("f ") == 1
    for folder in folders[:3]:
        # The case itself is wrong, but a correct program passes.
        files = ("verify", folder / "scene.nff", "--rays", folder / "ray.rays")
        assert beambench(*files, "--command", command).returncode == 1
        assert beambench(*files, "--command", tracer(kit, "none")).returncode == 0


HITS_COMMAND = f"{BINARY} hits {{nff}} --rays {{rays}} --accel sah-bvh -o {{hits}}"


def family_rows(text: str) -> list[tuple[str, str]]:
    """Returns the family with the query, and the verdict of each row of the last table."""
    lines = text[text.rindex("family  ") :].splitlines()[2:]
    cells = [re.split(r"  +", line) for line in lines[: lines.index("")]]
    return [(f"{row[0]}, {row[1]}", row[-1].strip()) for row in cells]


def test_a_program_may_decline_a_query_by_exit_code_77(kit: Path) -> None:
    """Half of the cases are unsupported; the supported cases decide the verdict."""
    command = "head -2 {rays} | grep -aq '\"any\"' && exit 77; " + HITS_COMMAND
    done = beambench("verify", "--kit", kit / "kit", "--command", command)
    assert done.returncode == 0, done.stdout + done.stderr
    rows = family_rows(done.stdout)
    assert {verdict for name, verdict in rows if name.endswith(", any")} == {"unsupported"}
    assert {verdict for name, verdict in rows if name.endswith(", closest")} == {"ok"}
    assert "47 of 47 cases right, 47 unsupported" in done.stdout


def test_a_program_that_declines_everything_verifies_nothing(kit: Path) -> None:
    done = beambench("verify", "--kit", kit / "kit", "--command", "exit 77 {hits}")
    assert done.returncode == 2
    assert "nothing was verified: the command declines" in done.stderr


def test_a_program_that_fails_in_some_cases_is_run_over_the_others(kit: Path) -> None:
    command = "test $(grep -c '^p 4' {nff}) -gt 4000 && exit 3; " + HITS_COMMAND
    done = beambench("verify", "--kit", kit / "kit", "--command", command)
    assert done.returncode == 1, done.stdout + done.stderr
    rows = family_rows(done.stdout)
    assert ("thousands in a plane, closest", "error") in rows
    assert ("closed mesh, closest", "ok") in rows
    verdicts = [verdict for _, verdict in rows]
    assert verdicts == sorted(verdicts, key=lambda verdict: verdict == "error")
    assert "ended with exit code 3" in done.stdout


def test_a_closed_mesh_must_not_leak(kit: Path, tmp_path: Path) -> None:
    """A miss at an edge is a graze elsewhere, and not an error."""
    small = shutil.copytree(kit / "kit", tmp_path / "kit")
    index = json.loads((small / "kit.json").read_text())
    index["cases"] = [
        case for case in index["cases"] if case["family"] in ("closed mesh", "origins on surfaces")
    ]
    (small / "kit.json").write_text(json.dumps(index))
    command = tracer(kit, "leak")
    done = beambench("verify", "--kit", small, "--command", command, "--json", tmp_path / "v",
                     "--minimize", tmp_path / "failures")  # fmt: skip
    assert done.returncode == 1
    cases = json.loads((tmp_path / "v").read_text())["cases"]
    for case in cases:
        assert case["structure_error"] == 0
        assert case["passed"] == (case["family"] == "origins on surfaces")
        assert (case["leaks"] > 0) == (case["family"] == "closed mesh")
        assert case["leaks"] <= case["graze"]
    (closest, _) = [case for case in cases if case["leaks"] > 0]
    assert closest["examples"][0]["class"] == "leak"
    assert ": leak, it left a closed surface" in done.stdout
    assert f"mismatch, {closest['leaks']} leaks\n" in done.stderr
    row = next(line for line in done.stdout.splitlines() if line.startswith("closed mesh"))
    assert re.split(" {2,}", row)[6:9] == ["0", "0", str(closest["leaks"])], "graze, wrong, leaks"

    # Over the few remaining triangles, the faulty tracer still leaks, and a correct one does not.
    for folder in sorted((tmp_path / "failures").iterdir()):
        reduced = json.loads((folder / "case.json").read_text())
        assert 2 <= len(reduced["primitives"]) <= 8
        assert reduced["wrong"]["class"] == "leak"
        files = ("verify", folder / "scene.nff", "--rays", folder / "ray.rays")
        assert beambench(*files, "--command", command).returncode == 1
        assert beambench(*files, "--accel", "exhaustive").returncode == 0


def test_each_failing_case_is_printed_with_the_command_that_replays_it(
    kit: Path, tmp_path: Path
) -> None:
    small = shutil.copytree(kit / "kit", tmp_path / "my kit")
    index = json.loads((small / "kit.json").read_text())
    index["cases"] = [case for case in index["cases"] if case["triangles"] < 20][:4]
    (small / "kit.json").write_text(json.dumps(index))
    command = tracer(kit, "none") + "; head -c 90 {hits} > {hits}.cut; mv {hits}.cut {hits}"
    done = beambench("verify", "--kit", small, "--command", command)
    assert done.returncode == 1, done.stderr
    replays = re.findall(r"^replay: (.*)$", done.stdout, re.MULTILINE)
    assert len(replays) == 2 * len(index["cases"])
    for line in replays[:2]:
        again = shell(line, tmp_path)
        assert again.returncode == 2, again.stdout
        assert "bytes of hits" in again.stderr
    counts = re.findall(r"^\[(\d+)/(\d+)\]", done.stderr, re.MULTILINE)
    assert all(int(one) <= int(of) for one, of in counts), counts


@pytest.mark.parametrize("fault", ["exit 3", "false", "kill -SEGV $$"])
def test_a_command_that_always_fails_fails_in_each_case(
    kit: Path, tmp_path: Path, fault: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    command = f"test -s {{obj}} && sh -c '{fault}'; exit $?; {{hits}}"
    done = beambench("verify", "--kit", kit / "kit", "--command", command)
    assert done.returncode == 1, done.stderr
    assert "0 of 94 cases right" in done.stdout
    assert {verdict for _, verdict in family_rows(done.stdout)} == {"error"}
    (run,) = re.findall(r"^the command test -s (\S+/scene.obj) && .* its files are kept",
                        done.stdout, re.MULTILINE)  # fmt: skip
    assert Path(run).exists()
    how = {"exit 3": "exit code 3", "false": "exit code 1"}.get(fault, "crashed (SIGSEGV")
    assert how in done.stdout


def test_reduced_cases_do_not_exceed_the_number_of_cells(traced: Traced, tmp_path: Path) -> None:
    at = clear_hit(traced)
    t = traced.t.copy()
    t[at] *= 0.9
    write_hits(tmp_path / "mine.hits", {"t": t, "primitive": traced.primitive})
    command = f"cp {tmp_path / 'mine.hits'} {{hits}}"
    done = beambench("verify", SCENE, "--rays", traced.folder / "a.rays", "--command", command,
                     "--minimize", tmp_path / "m", "--verbose")  # fmt: skip
    assert done.returncode == 1, done.stderr
    counts = re.findall(r"^\[(\d+)/(\d+)\]", done.stderr, re.MULTILINE)
    assert counts
    assert all(int(one) <= int(of) for one, of in counts), counts


def test_spheres_are_unsupported_where_a_command_takes_obj(tmp_path: Path) -> None:
    output_of("selftest", "--export", tmp_path / "kit", "--scenes", "2", "--primitives", "all")
    done = beambench("verify", "--kit", tmp_path / "kit", "--json", tmp_path / "v",
                     "--command", "exit 3; {obj} {hits}")  # fmt: skip
    assert done.returncode == 1
    index = json.loads((tmp_path / "kit/kit.json").read_text())["cases"]
    found = json.loads((tmp_path / "v").read_text())["cases"]
    for case, verified in zip(np.repeat(index, 2), found, strict=True):
        polygons_alone = case["spheres"] == case["cones"] == 0
        assert verified["verdict"] == ("error" if polygons_alone else "unsupported")


def test_hits_that_lie_in_a_kit_are_verified(kit: Path, tmp_path: Path) -> None:
    copy = tmp_path / "kit"
    shutil.copytree(kit / "kit", copy)
    refused(beambench("verify", "--kit", copy), ["there are no hits beside the rays"])
    for case in json.loads((copy / "kit.json").read_text())["cases"]:
        folder = copy / case["folder"]
        for query, hits in (("closest", "closest.hits"), ("any", "any-hits.csv")):
            chosen = ("--rays", folder / f"{query}.rays", "--accel", "exhaustive")
            output_of("hits", folder / "scene.nff", *chosen, "-o", folder / hits)
    done = beambench("verify", "--kit", copy)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "94 of 94 cases right" in done.stdout


def test_a_fault_of_files_is_reduced_to_what_the_answers_name(
    traced: Traced, tmp_path: Path
) -> None:
    at = clear_hit(traced)
    ids = traced.primitive.copy()
    ids[at] = (ids[at] + 7) % 64
    write_hits(tmp_path / "mine.hits", {"t": traced.t, "primitive": ids})
    case = verify(traced, tmp_path / "mine.hits", "--minimize", tmp_path / "m")
    assert "reduced to 2 primitives and 1 ray" in case["minimal"]
    (folder,) = (tmp_path / "m").iterdir()
    written = json.loads((folder / "case.json").read_text())
    assert not written["repeated"]
    assert written["primitives"] == sorted({int(ids[at]), int(traced.primitive[at])})
    assert read_binary(folder / "ray.rays", "<f4").tolist() == traced.rays[at].tolist()


def test_many_hits_are_verified_in_little_memory(tmp_path: Path) -> None:
    """Files of 80 MB need no more memory than a few blocks."""
    count = 2_000_000
    output_of("rays", SCENE, "--resolution", "1x1", "-o", tmp_path / "one.rays")
    (ray,) = read_binary(tmp_path / "one.rays", "<f4").reshape(-1, 8)
    header = {"rays": count, "query": "closest"}
    with (tmp_path / "many.rays").open("wb") as file:
        file.write(b"beambench-rays 1\n" + json.dumps(header).encode() + b"\n")
        file.write(ray.tobytes() * count)
    output_of("hits", SCENE, "--rays", tmp_path / "one.rays", "-o", tmp_path / "one.hits")
    hit = read_binary(tmp_path / "one.hits", "u1").tobytes()
    assert len(hit) == struct.calcsize("<fI")
    header = {"hits": count, "columns": ["t", "primitive"]}
    with (tmp_path / "many.hits").open("wb") as file:
        file.write(b"beambench-hits 1\n" + json.dumps(header).encode() + b"\n" + hit * count)

    def peak(rays: str, hits: str) -> int:
        """Returns the peak memory in kilobytes."""
        measured = (
            "import resource, subprocess, sys;"
            "done = subprocess.run(sys.argv[1:], capture_output=True);"
            "print(done.returncode, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)"
        )
        files = ("--rays", tmp_path / rays, "--hits", tmp_path / hits)
        done = subprocess.run(
            [sys.executable, "-c", measured, BINARY, "verify", SCENE, *files],
            capture_output=True,
            text=True,
            check=True,
        )
        code, kilobytes = map(int, done.stdout.split())
        assert code == 0, done.stderr
        return kilobytes

    assert peak("many.rays", "many.hits") < peak("one.rays", "one.hits") + 60_000
