"""Command lines as users type them: output, written files, refusals."""

from __future__ import annotations

import array
import json
import os
import re
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from beambench_report.base.records import read_run
from program import BINARY, beambench, output_of, refused, shell

VIEW = "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0.1\nresolution 8 8\n"
STRUCTURES = [
    "exhaustive",
    "samet",
    "samet-net",
    "glassner",
    "gargantini",
    "voxel-grid",
    "hierarchical-grid",
    "goldsmith-salmon",
    "sah-bvh",
    "kd-tree",
    "beam",
    "grid-beam",
    "tile-beam",
    "ray-classification",
    "z-buffer",
    "polygon-beam",
    "embree",
    "null",
]


def count_colors(picture: Image.Image) -> int:
    return len(picture.getcolors(picture.width * picture.height) or [])


# Lists and help


def test_list_names_structures_scenes_and_rays_with_their_parameters() -> None:
    text = output_of("list")
    for word in [
        *STRUCTURES,
        "max_level=",
        "mode=",
        "balls",
        "escena1",
        "tetra",
        "primary",
    ]:
        assert word in text
    assert max(map(len, text.splitlines())) <= 100


def test_list_as_json_says_all_of_each_parameter() -> None:
    everything = json.loads(output_of("list", "--json"))
    structures = {structure["name"]: structure for structure in everything["structures"]}
    assert set(STRUCTURES) <= set(structures)
    assert structures["samet"]["conformance"] == "bit-exact"
    assert structures["embree"]["conformance"] == "tolerance"
    assert structures["null"]["conformance"] == "baseline"
    level = next(p for p in structures["samet"]["parameters"] if p["name"] == "max_level")
    assert level["type"] == "integer or auto"
    assert level["minimum"] <= int(level["default"]) <= level["maximum"]
    assert level["description"]
    mode = next(p for p in structures["embree"]["parameters"] if p["name"] == "mode")
    assert mode["type"] == "choice"
    assert mode["default"] in mode["choices"]
    assert {"balls", "bumpy", "escena1", "escena2", "stetra", "tetra"} <= {
        scene["name"] for scene in everything["scenes"]
    }
    assert [kind["name"] for kind in everything["rays"]] == [
        "primary",
        "shadow",
        "area",
        "reflection",
        "mirror",
        "diffuse",
        "ao",
        "path",
        "random",
        "whitted",
    ]


@pytest.mark.parametrize(
    ("name", "words", "others"),
    [
        ("samet", ["max_level=", "neighbor_steps", "[bit-exact, no SIMD]"], ["sah-bvh", "balls"]),
        ("samet:max_level=4", ["max_level="], ["sah-bvh"]),
        ("balls", ["n=4", "balls:parameter"], ["samet", "tetra"]),
        ("diffuse", ["seed=", "--rays"], ["shadow rays", "samet"]),
        ("ao", ["samples=16", "distance=0.1", "diagonals"], ["bounces", "samet"]),
        ("path", ["bounces=4", "seed="], ["samples", "samet"]),
        ("area", ["samples=16", "size=0.05", "diagonals"], ["bounces", "samet"]),
    ],
)
def test_list_prints_one_alone(name: str, words: list[str], others: list[str]) -> None:
    text = output_of("list", name)
    assert all(word in text for word in words), text
    assert not any(word in text for word in others), text


def test_list_prints_several_in_the_order_given() -> None:
    text = output_of("list", "tetra", "null")
    assert text.index("tetra") < text.index("null")


def test_list_explains_what_is_counted() -> None:
    text = output_of("list", "--counters")
    for name in ["traversal_steps", "confirmed_tests", "beams_made", "neighbor_steps"]:
        assert re.search(rf"^ +{name}\n +\w", text, re.MULTILINE), name
    counted = json.loads(output_of("stats", "tetra:n=2", "--accel", "all", "--json"))
    names = {name for structure in counted["structures"] for name in structure["per_ray"]}
    assert [name for name in sorted(names) if f" {name}\n" not in text] == []
    assert max(map(len, text.splitlines())) <= 100


@pytest.mark.parametrize("arguments", [["help"], ["help", "render"], ["help", "list"]])
def test_help_as_a_command_is_help(arguments: list[str]) -> None:
    assert output_of(*arguments) == output_of(*arguments[1:], "--help")


@pytest.mark.parametrize(
    "command",
    ["scene", "export", "render", "rays", "stats", "trace", "verify", "census", "mirrors"],
)
def test_help_says_what_a_scene_may_be(command: str) -> None:
    text = " ".join(output_of(command, "--help").split())
    assert "Catalogue name, mesh:NAME, or path of an NFF or mesh file" in text


@pytest.mark.parametrize(
    "command", ["list", "scene", "export", "render", "rays", "stats", "verify", "run"]
)
def test_help_of_each_command_has_examples(command: str) -> None:
    text = output_of(command, "--help")
    assert "Examples:" in text
    assert f"beambench {command}" in text


def test_version() -> None:
    assert re.fullmatch(r"beambench \d+\.\d+\.\d+\n", output_of("--version"))


# Scenes


def test_scene_counts_what_the_generator_made() -> None:
    scene = json.loads(output_of("scene", "tetra:n=3", "--json"))
    assert scene["name"] == "tetra:n=3"
    assert scene["primitives"] == scene["polygons"] == scene["triangles"] == 4**3
    assert scene["spheres"] == scene["cones"] == 0
    assert re.fullmatch("[0-9a-f]{16}", scene["hash"])
    assert all(
        low < high
        for low, high in zip(scene["bounds"]["lower"], scene["bounds"]["upper"], strict=True)
    )
    text = output_of("scene", "tetra:n=3")
    assert scene["hash"] in text
    assert "64 polygons" in text


def test_scene_reads_a_file_with_all_kinds(tmp_path: Path) -> None:
    file = tmp_path / "mixed.nff"
    file.write_text(
        VIEW
        + "l 1 2 3\nf 1 0 0 1 0 0 0 0\ns 0 0 0 1\nc\n0 0 0 1\n0 0 1 0.5\n"
        + "p 3\n0 0 0\n1 0 0\n0 1 0\n"
    )
    scene = json.loads(output_of("scene", file, "--json"))
    assert (scene["spheres"], scene["cones"], scene["polygons"]) == (1, 1, 1)
    assert scene["cameras"][0]["width"] == 8
    assert scene["lights"][0]["position"] == [1, 2, 3]


def test_equal_scenes_have_equal_hashes_and_a_seed_changes_them() -> None:
    def hash_of(scene: str) -> str:
        return json.loads(output_of("scene", scene, "--json"))["hash"]

    assert hash_of("escena1") == hash_of("escena1:seed=1999")
    assert hash_of("escena1") != hash_of("escena1:seed=7")


def facts_of(scene: str | Path) -> dict:
    """Returns the facts of `scene --json`, except the scene's name and the sharing of vertices."""
    facts = json.loads(output_of("scene", scene, "--json"))
    del facts["name"], facts["vertices"]
    return facts


@pytest.mark.parametrize("scene", ["escena1", "escena2", "tetra:n=3", "bumpy:triangles=768"])
def test_an_exported_scene_is_the_same(tmp_path: Path, scene: str) -> None:
    file = tmp_path / "scene.nff"
    done = beambench("export", scene, "-o", file)
    assert done.returncode == 0, done.stderr
    assert done.stdout == ""
    assert re.search(r"scene\.nff: \S+, \d+ primitives", done.stderr)
    assert facts_of(file) == facts_of(scene)
    again = tmp_path / "again.nff"
    output_of("export", file, "--strict", "-o", again)
    assert again.read_text().splitlines()[1:] == file.read_text().splitlines()[1:]
    assert set(tmp_path.iterdir()) == {file, again}


def test_an_export_keeps_cameras_surfaces_and_the_words_of_the_thesis(
    tmp_path: Path,
) -> None:
    file = tmp_path / "mixed.nff"
    file.write_text(
        VIEW
        + "#beambench name from the front\n#beambench aspect 1.5\n"
        + "l 1 2 3 20 0 .5\ntexredmarble\ns 0 0 0 -1\nsurfglass 1 0 0\nc 0 0 0 -1 0 0 1 0\n"
        + "f 1 0 0 .5 .5 100000\npp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 .6 .8\n"
    )
    copy = tmp_path / "copy.nff"
    output_of("export", file, "-o", copy)
    assert facts_of(copy) == facts_of(file)
    assert facts_of(copy)["finishes"] == ["texredmarble", "surfglass"]
    assert facts_of(copy)["cameras"][0]["name"] == "from the front"
    text = output_of("scene", copy)
    assert "texredmarble, surfglass" in text


def test_what_a_reader_skips_is_said_and_strictly_refused(tmp_path: Path) -> None:
    file = tmp_path / "dialect.nff"
    file.write_text(VIEW + "g 1\ns 0 0 0 1\ng 2\ns 1 0 0 1\nf 1 1 1 1 0 0 0 1 7\n")
    done = beambench("scene", file)
    assert done.returncode == 0
    assert done.stderr.splitlines() == [
        f"beambench: {file}:8: unknown word 'g', skipped up to line 9 (and 1 more)",
        f"beambench: {file}:12: the ninth field of a surface, ENFF's ambient factor, is ignored",
    ]
    refused(beambench("scene", file, "--strict"), [":8", "'g'", "--strict"])
    refused(beambench("export", file, "--strict", "-o", tmp_path / "a.nff"), [":8", "'g'"])
    assert set(tmp_path.iterdir()) == {file}


def test_a_sweep_s_lines_leave_out_what_is_at_its_default(tmp_path: Path) -> None:
    (tmp_path / "sweep.json").write_text(
        '{"name": "s", "scenes": ["tetra:n=1", "escena1"], "budget_seconds": 1,'
        ' "structures": ["samet:max_level=3", "sah-bvh"], "resolutions": ["8x8"],'
        ' "repetitions": {"minimum": 1, "maximum": 1}}'
    )
    done = beambench("run", "sweep.json", "-o", "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    lines = [line for line in done.stderr.splitlines() if "Mrays/s" in line]
    assert len(lines) == 4
    assert any("tetra:n=1/default/8x8/1/primary/samet:max_level=3: " in line for line in lines)
    assert any("escena1/default/8x8/1/primary/sah-bvh: " in line for line in lines)
    # A disturbed repetition is repeated.
    assert all(re.search(r"ok after \d repetitions? in 1 block \(", line) for line in lines), lines
    assert not any(word in line for line in lines for word in ("spheres=", "max_leaf="))
    assert "4 cells, all verified" in done.stderr


def test_the_plan_of_a_sweep_as_json(tmp_path: Path) -> None:
    (tmp_path / "sweep.json").write_text(
        '{"name": "s", "scenes": ["tetra:n=1"], "structures": ["samet:max_level=3", "sah-bvh"],'
        ' "resolutions": ["8x8", "16x8"], "budget_seconds": 1}'
    )
    names = beambench("run", "sweep.json", "--dry-run", cwd=tmp_path).stdout.splitlines()
    plan = json.loads(beambench("run", "sweep.json", "--dry-run", "--json", cwd=tmp_path).stdout)
    assert [cell["name"] for cell in plan["cells"]] == names
    first = plan["cells"][0]
    assert first.pop("parameters").startswith("max_level=3,")
    assert first == {
        "name": names[0],
        "scene": "tetra:n=1",
        "primitives": 4,
        "camera": "default",
        "width": 8,
        "height": 8,
        "samples": 1,
        "rays": "primary",
        "structure": "samet",
        "threads": 1,
    }


def test_a_renamed_option_works_with_a_warning() -> None:
    census = ["census", "tetra:n=1", "--resolution", "8x8"]
    done = beambench(*census, "--least-weight", "0.1")
    assert done.returncode == 0
    assert "beambench: --least-weight is now called --min-weight\n" in done.stderr
    assert "--least-weight" not in beambench(*census, "--min-weight=0.1").stderr


def test_the_hint_to_resume_can_be_pasted(tmp_path: Path) -> None:
    """Runs beambench as a user did: by its path, from another folder, without it on the PATH."""
    sweep = {
        "name": "s",
        "scenes": ["tetra:n=4"],
        "structures": ["samet", "exhaustive"],
        "resolutions": ["64x64"],
        "repetitions": {"minimum": 100000, "maximum": 100000},
        "precision": 0,
        "budget_seconds": 1000,
    }
    (tmp_path / "a sweep.json").write_text(json.dumps(sweep))
    (tmp_path / "bin dir").mkdir()
    (tmp_path / "bin dir/beambench").symlink_to(BINARY.resolve())
    run = subprocess.Popen(
        ["bin dir/beambench", "run", "a sweep.json", "-o", "my run"],
        cwd=tmp_path,
        stderr=subprocess.PIPE,
        text=True,
    )
    for _ in range(300):
        if (tmp_path / "my run/run.jsonl").exists():
            break
        time.sleep(0.1)
    time.sleep(0.5)
    run.send_signal(signal.SIGINT)
    _, messages = run.communicate(timeout=60)
    assert run.returncode == 130
    hint = messages.splitlines()[-1].split("resume with: ")[1]
    assert hint == "'bin dir/beambench' run --resume 'my run'"
    dry = subprocess.run(
        ["bash", "-c", f"{hint} --dry-run"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        env={"PATH": "/usr/bin:/bin"},
        timeout=60,
        check=False,
    )
    assert dry.returncode == 0, dry.stderr
    assert len(dry.stdout.splitlines()) == 2


def test_a_sweep_hands_on_what_a_reader_skipped(tmp_path: Path) -> None:
    (tmp_path / "dialect.nff").write_text(VIEW + "g 1\ns 0 0 0 1\n")
    (tmp_path / "sweep.json").write_text(
        '{"name": "s", "scenes": ["./dialect.nff"], "structures": ["exhaustive"],'
        ' "resolutions": ["8x8"], "precision": 0.1, "budget_seconds": 1,'
        ' "repetitions": {"minimum": 1, "maximum": 1}}'
    )
    done = beambench("run", "sweep.json", "-o", "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "dialect.nff:8: unknown word 'g'" in done.stderr


# Pictures


def test_render_writes_a_png_of_the_wanted_size(tmp_path: Path) -> None:
    file = tmp_path / "balls.png"
    done = beambench("render", "balls:n=1", "--accel", "samet", "-o", file, "--resolution", "60x40")
    assert done.returncode == 0, done.stderr
    assert "100.0% of the rays hit" in done.stderr
    with Image.open(file) as picture:
        assert picture.size == (60, 40)
        assert picture.mode == "RGB"
        assert count_colors(picture) > 50
    assert list(tmp_path.iterdir()) == [file]


def test_a_plain_picture_needs_no_structure(tmp_path: Path) -> None:
    size = ("--resolution", "60x40")
    done = beambench("render", "tetra:n=2", "-o", tmp_path / "a.png", *size)
    assert done.returncode == 0, done.stderr
    assert "by sah-bvh" in done.stderr
    output_of("render", "tetra:n=2", "--accel", "exhaustive", "-o", tmp_path / "b.png", *size)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_a_view_of_the_users_own(tmp_path: Path) -> None:
    scene = tmp_path / "ball.nff"
    scene.write_text(VIEW + "s 0 0 0 1\n")

    def share(*view: str) -> float:
        stats = ("stats", scene, "--accel", "sah-bvh", "--resolution", "64x64", "--json")
        return json.loads(output_of(*stats, *view))["structures"][0]["hit_share"]

    own = share()
    assert share("--from", "0,0,5", "--at", "0,0,0", "--up", "0,1,0", "--angle", "45") == own
    assert share("--from", "5,0,0") == pytest.approx(own, abs=0.01), "a ball from its side"
    assert share("--from", "-5,0,0", "--up", "0,0,-1.5") == pytest.approx(own, abs=0.01)
    assert share("--angle", "20") > 2 * own
    assert share("--from", "0,0,20") < own / 4
    assert share("--at", "0,0,9") == 0, "it looks away"

    pictures = []
    for view in ([], ["--from=0,0,5"], ["--from", "1,2,5"]):
        file = tmp_path / f"{len(pictures)}.png"
        output_of("render", scene, "-o", file, "--resolution", "32x32", *view)
        pictures.append(file.read_bytes())
    assert pictures[0] == pictures[1] != pictures[2]


def test_a_ray_of_the_users_own_view_is_traced() -> None:
    view = ("--from", "0,0.5,4", "--at", "0,0,0", "--up", "0,1,0", "--angle", "30")
    trace = ("trace", "balls:n=1", "--accel", "sah-bvh", "--pixel", "16,16")
    text = output_of(*trace, "--resolution", "32x32", *view)
    assert "agree" in text


def test_the_camera_says_the_size_where_nobody_else_does(tmp_path: Path) -> None:
    scene = tmp_path / "ball.nff"
    scene.write_text(VIEW + "s 0 0 0 1\n")
    output_of("render", scene, "--accel", "exhaustive", "-o", tmp_path / "a.png")
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.size == (8, 8)


# Every wall of this room is a mirror, so the light is reflected between walls to the maximum depth.
def test_a_whole_picture_by_beams_is_that_of_single_rays(tmp_path: Path) -> None:
    render = ("render", "closed-room", "--shade", "whitted", "--resolution", "160x120")
    pictures = {}
    for structure in ("beam", "samet"):
        picture = tmp_path / f"{structure}.exr"  # all bits of the light
        output_of(*render, "--accel", structure, "-o", picture)
        pictures[structure] = picture.read_bytes()
    assert pictures["beam"] == pictures["samet"]


@pytest.mark.parametrize("shading", ["preview", "normals", "id", "depth", "whitted"])
def test_every_structure_draws_the_same_picture(tmp_path: Path, shading: str) -> None:
    pictures = []
    for structure in ["exhaustive", "samet"]:
        file = tmp_path / f"{structure}.png"
        output_of(
            *("render", "tetra:n=3", "--accel", structure, "-o", file),
            *("--resolution", "64x64", "--shade", shading),
        )
        pictures.append(file.read_bytes())
    assert pictures[0] == pictures[1]


def test_a_heat_map_of_exhaustive_is_even_and_has_a_legend(tmp_path: Path) -> None:
    file = tmp_path / "work.png"
    output_of(
        *("render", "tetra:n=2", "--accel", "exhaustive", "-o", file),
        *("--resolution", "400x30", "--heatmap", "primitive_tests"),
    )
    with Image.open(file) as picture:
        width, height = picture.size
        assert width == 400
        assert height > 30
        assert count_colors(picture.crop((0, 0, 400, 30))) == 1
        assert count_colors(picture.crop((0, 30, 400, height))) > 50


@pytest.mark.parametrize(
    ("accel", "overlay", "names"),
    [
        ("beam:max_level=4", "beams", ["occupied", "non-terminal", "leaving"]),
        ("beam:max_level=4", "cells", ["occupied cells"]),
        ("tile-beam", "beams", ["tiles", "rays in blocks"]),
        ("tile-beam", "pencils", ["parts", "rays in blocks, side [+-][xyz]"]),
        ("tile-beam", "pencils:light=1", ["parts"]),
    ],
)
@pytest.mark.parametrize("shading", ["preview", "depth"])
def test_an_overlay_has_lines_in_colour_and_a_legend(
    tmp_path: Path, accel: str, overlay: str, names: list[str], shading: str
) -> None:
    done = beambench(
        *("render", "tetra:n=2", "--accel", accel, "--overlay", overlay),
        *("--shade", shading, "-o", "over.png", "--resolution", "300x240"),
        cwd=tmp_path,
    )
    assert done.returncode == 0, done.stderr
    assert all(re.search(rf"; {name}: [1-9]", done.stderr) for name in names), done.stderr
    with Image.open(tmp_path / "over.png") as picture:
        assert picture.width == 300
        assert picture.height > 240
        colors = picture.crop((0, 0, 300, 240)).getcolors(300 * 240)
        legend = picture.crop((0, 240, 300, picture.height)).getcolors(300 * 240)
    assert any(red > blue + 100 for _, (red, _, blue) in colors)
    assert (240, 228, 66) in {color for _, color in legend}


def test_the_overlay_of_a_pencil_has_the_shadow_rays_of_one_light(tmp_path: Path) -> None:
    saved = output_of("rays", "teapot:n=4", "--rays", "shadow", "--json", "--resolution", "96x80")
    rays = json.loads(saved)["rays"]
    found = 0
    for light in [1, 2]:
        done = beambench(
            *("render", "teapot:n=4", "--accel", "tile-beam", "-o", "over.png"),
            *("--overlay", f"pencils:light={light}", "--resolution", "96x80"),
            cwd=tmp_path,
        )
        assert done.returncode == 0, done.stderr
        entries = re.findall(r"; ([^;:]+): (\d+)", done.stderr)
        assert entries[0][0] == "parts"
        found += sum(int(count) for _, count in entries[1:])
    assert found == rays


def test_an_overlay_as_exr_has_no_legend(tmp_path: Path) -> None:
    file = tmp_path / "cells.exr"
    output_of(
        *("render", "tetra:n=2", "--accel", "samet", "--overlay", "cells", "-o", file),
        *("--resolution", "16x16"),
    )
    assert b"\0Z\0" in file.read_bytes()[:2000]


def test_a_view_past_the_scene_has_no_beams_and_is_no_mistake(tmp_path: Path) -> None:
    scene = tmp_path / "past.nff"
    scene.write_text(VIEW + "s 0 0 900 1\n")
    done = beambench(
        *("render", scene, "--accel", "beam", "--overlay", "beams", "-o", "past.png"), cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    assert "; leaving: 0" in done.stderr


def test_render_writes_an_exr(tmp_path: Path) -> None:
    file = tmp_path / "hits.exr"
    output_of("render", "tetra:n=2", "--accel", "embree", "-o", file, "--resolution", "16x16")
    header = file.read_bytes()[:2000]
    assert header.startswith(b"\x76\x2f\x31\x01")
    for channel in [b"\0R\0", b"\0G\0", b"\0Z\0", b"\0id\0"]:
        assert channel in header


# Statistics


def test_stats_compare_structures() -> None:
    arguments = ("stats", "tetra:n=3", "--accel", "all", "--resolution", "32x32")
    text = output_of(*arguments)
    for word in [*STRUCTURES, "memory", "references", "primitive_tests per ray"]:
        assert word in text

    found = json.loads(output_of(*arguments, "--json"))
    assert found["rays"] == 32 * 32
    by_name = {structure["structure"]: structure for structure in found["structures"]}
    assert by_name["exhaustive"]["per_ray"]["primitive_tests"] == 4**3
    assert by_name["samet"]["per_ray"]["primitive_tests"] < 4**3
    assert by_name["samet"]["hits"] == by_name["exhaustive"]["hits"] > 0
    assert by_name["null"]["hits"] == 0
    assert by_name["samet"]["leaves"] > by_name["samet"]["empty_leaves"]


def test_stats_choose_a_level_for_the_rays() -> None:
    def depth(resolution: str) -> int:
        text = output_of(
            *("stats", "delfines", "--accel", "samet:max_level=auto", "--json"),
            *("--resolution", resolution),
        )
        return int(json.loads(text)["structures"][0]["depth"])

    assert depth("16x12") < depth("640x480")


def test_sampling_compares_methods(tmp_path: Path) -> None:
    picture = tmp_path / "samples.png"
    arguments = ("sampling", "delfines", "--resolution", "64x48", "--repetitions", "1")
    text = output_of(*arguments, "--picture", picture)
    for word in ["uniform", "object-space", "image-space", "rays per pixel", "error"]:
        assert word in text
    assert count_colors(Image.open(picture)) > 2

    results = json.loads(output_of(*arguments, "--json"))["results"]
    uniform = {row["setting"]: row for row in results if row["method"] == "uniform"}
    assert uniform["25"]["error"] < uniform["1"]["error"]
    assert uniform["25"]["rays_per_pixel"] == pytest.approx(
        25 * uniform["1"]["rays_per_pixel"], rel=0.05
    )


def test_a_census_counts_rays_by_kind(tmp_path: Path) -> None:
    arguments = ("census", "balls:n=1", "--resolution", "48x48", "--shadows", "cache")
    done = beambench(*arguments, "--pictures", tmp_path / "all" / "of" / "them")
    assert done.returncode == 0, done.stderr
    assert f"1 picture in the folder '{tmp_path}/all/of/them'" in done.stderr
    text = done.stdout
    for word in ["eye rays", "reflected", "refracted", "shadow", "cached", "balls:n=1"]:
        assert word in text
    assert count_colors(Image.open(tmp_path / "all" / "of" / "them" / "balls-n-1.png")) > 50

    (cached,) = json.loads(output_of(*arguments, "--json"))["scenes"]
    assert cached["eye_rays"] == 48 * 48
    assert cached["reflected_rays"] > 0
    assert cached["refracted_rays"] == 0
    assert 0 < cached["shadow_cached"] <= cached["shadow_hidden"] < cached["shadow_rays"]
    (shallow,) = json.loads(output_of(*arguments, "--json", "--depth", "1"))["scenes"]
    assert shallow["reflected_rays"] == 0
    assert shallow["shadow_rays"] < cached["shadow_rays"]


def test_a_census_counts_the_work_of_the_structure() -> None:
    arguments = ("census", "balls:n=1", "--resolution", "48x48", "--accel", "samet", "--count")
    assert re.search(r"balls:n=1 +traversal_steps +\d+ +[0-9.]+\n", output_of(*arguments))
    (one,) = json.loads(output_of(*arguments, "--json", "--threads", "1"))["scenes"]
    (two,) = json.loads(output_of(*arguments, "--json", "--threads", "2"))["scenes"]
    assert one["work"] == two["work"]
    assert one["work"]["rays"] == one["eye_rays"] + one["reflected_rays"] + one["shadow_rays"]
    assert one["work"]["rays_that_hit"] > one["eye_hits"]
    assert one["work"]["traversal_steps"] > one["work"]["leaves"] > one["eye_hits"]
    (glass,) = json.loads(output_of(*("census", "mount:n=2"), *arguments[2:], "--json"))["scenes"]
    of_paths = glass["eye_rays"] + glass["reflected_rays"] + glass["refracted_rays"]
    assert glass["shadow_queries"] > glass["shadow_rays"], "uncounted ones behind glass"
    assert glass["work"]["rays"] == of_paths + glass["shadow_rays"]
    assert one["size"]["nodes"] > one["size"]["leaves"] > one["size"]["empty_leaves"] > 0


def test_a_census_by_beams_asks_the_shadow_cache_in_another_order() -> None:
    arguments = ("census", "maceta", "--accel", "beam", "--resolution", "80x64", "--json")
    scan, beams = (
        json.loads(output_of(*arguments, "--shadows", "cache", "--order", order))
        for order in ("scan", "beams")
    )
    assert (scan["order"], beams["order"]) == ("scan", "beams")
    (scan,), (beams,) = scan["scenes"], beams["scenes"]
    same = ("eye_rays", "reflected_rays", "shadow_rays", "shadow_hidden")
    assert [scan[name] for name in same] == [beams[name] for name in same]
    assert scan["shadow_cached"] != beams["shadow_cached"]
    for wrong in (("--accel", "samet"), ("--rules", "spd", "--accel", "beam")):
        done = beambench("census", "tetra:n=1", "--order", "beams", *wrong)
        assert done.returncode == 2
        assert "--order" in done.stderr


def test_a_census_tells_what_faint_rays_save_and_cost() -> None:
    def scene(*options: str) -> dict:
        arguments = ("census", "mount:n=3", "--resolution", "64x64", "--json", *options)
        (result,) = json.loads(output_of(*arguments))["scenes"]
        return result

    def rays(result: dict) -> int:
        return sum(result[f"{k}_rays"] for k in ("eye", "reflected", "refracted", "shadow"))

    whole = scene()
    assert "error" not in whole
    little, much = scene("--min-weight", "0.01"), scene("--min-weight", "0.1")
    for result in (little, much):
        assert result["full_rays"] == rays(whole)
        assert result["too_faint"] > 0
    assert rays(much) < rays(little) < rays(whole)
    assert 0 < little["error"] < much["error"] < 20
    # No ray is below this share, so nothing is left out.
    assert scene("--min-weight", "1e-9")["error"] == 0
    text = output_of("census", "mount:n=3", "--resolution", "64x64", "--min-weight", "0.01")
    for word in ["too faint", "of the rays", "error"]:
        assert word in text


def test_whole_pictures_do_not_depend_on_the_threads(tmp_path: Path) -> None:
    arguments = ("census", "finishes", "mount:n=3", "--resolution", "80x60", "--samples", "4")

    def counts(threads: int) -> list[dict]:
        drawn = ("--threads", str(threads), "--pictures", tmp_path / str(threads), "--json")
        scenes = json.loads(output_of(*arguments, *drawn))["scenes"]
        return [{k: v for k, v in scene.items() if not k.endswith("_ms")} for scene in scenes]

    one = counts(1)
    for threads in (2, 3, 7):
        assert counts(threads) == one
        for name in ("finishes.png", "mount-n-3.png"):
            drawn = (tmp_path / str(threads) / name).read_bytes()
            assert drawn == (tmp_path / "1" / name).read_bytes()


def test_mirrors_are_shown_by_beams_and_by_rays() -> None:
    arguments = ("mirrors", "teapot:n=2", "--resolution", "64x64", "--repetitions", "1")
    text = output_of(*arguments)
    assert "1 planar mirror," in text
    assert "rays/beams" in text
    (board,) = json.loads(output_of(*arguments, "--json"))["seen"]
    assert 0 < board["hits"] < board["samples"] < 64 * 64
    assert board["different"] == 0
    assert json.loads(output_of("mirrors", "tetra:n=1", "--json"))["seen"] == []


def test_planar_glass_is_shown_by_beams_and_by_rays() -> None:
    arguments = ("mirrors", "aquarium:detail=1", "--resolution", "96x72", "--repetitions", "1")
    assert "6 planes of glass" in output_of(*arguments)
    seen = json.loads(output_of(*arguments, "--json"))
    assert seen["planar_glass"] == 6
    (front,) = seen["seen_through"]
    assert front["different"] == 0
    assert 0 < front["samples"] == sum(each["samples"] for each in front["by_angle"])
    steep = [each for each in front["by_angle"] if each["degrees_below"] <= 30]
    assert sum(each["alone"] for each in steep) <= 0.2 * sum(each["samples"] for each in steep)


def test_the_rules_of_spd_fix_the_rays() -> None:
    (tetra,) = json.loads(output_of("census", "tetra:n=2", "--rules", "spd", "--json"))["scenes"]
    assert tetra["eye_rays"] == 513 * 513
    assert "published" not in tetra, "Haines published the counts of tetra:n=6"


def test_the_census_of_spd_is_printed_beside_what_haines_published() -> None:
    text = output_of("census", "tetra", "shells:n=2", "--rules", "spd")
    assert re.search(r"tetra:n=6 +eye_hits +\d+ +49788 +[+-]0\.\d\d%\n", text), text
    assert re.search(r"tetra:n=6 +shadow +\d+ +46112 +[+-]0\.\d\d%\n", text), text
    assert "explained" not in text
    (tetra,) = json.loads(output_of("census", "tetra", "--rules", "spd", "--json"))["scenes"]
    hits = tetra["published"]["eye_hits"]
    assert (hits["here"], hits["published"]) == (tetra["eye_hits"], 49788)
    assert hits["difference_percent"] == pytest.approx(100 * (tetra["eye_hits"] / 49788 - 1))
    assert "Haines published" not in output_of("census", "tetra", "--resolution", "16x16")


def test_a_census_says_why_it_is_far_from_what_haines_published() -> None:
    text = output_of("census", "mount", "--rules", "spd", "--depth", "2")
    assert re.search(r"mount:n=6 +reflected +\d+ +354769 +-\d+\.\d\d% +by --depth 2\n", text), text
    by_rays = [line for line in text.splitlines() if " eye_hits " in line]
    assert "--depth" not in by_rays[0], "they do not depend on it"
    faint = output_of("census", "mount", "--rules", "spd", "--min-weight", "0.2")
    assert re.search(r"reflected .* by --min-weight 0.2\n", faint), faint
    wrong = output_of("census", "tetra", "--rules", "spd", "--accel", "null")
    assert re.search(r"eye_hits +0 +49788 +-100\.00% +unexplained\n", wrong), wrong


def test_stats_tell_parameters_apart() -> None:
    text = output_of(
        *(
            "stats",
            "tetra:n=3",
            "--accel",
            "samet:max_level=3,samet:max_level=4,root=box",
        ),
        *("--resolution", "8x8"),
    )
    assert "samet:max_level=3" in text
    assert "samet:max_level=4,root=box" in text


def test_a_structure_over_its_cap_names_the_parameter() -> None:
    done = beambench("stats", "tetra:n=4", "--accel", "samet:max_references=1")
    refused(done, ["max_references"])


def test_a_structure_over_its_cap_does_not_hide_the_others() -> None:
    done = beambench("stats", "tetra:n=4", "--accel", "samet:max_references=1,embree")
    assert done.returncode == 2
    assert "max_references" in done.stderr
    assert "embree" in done.stdout


# Verdicts


def test_verify_judges_every_structure(tmp_path: Path) -> None:
    file = tmp_path / "verdicts.json"
    done = beambench(
        *("verify", "escena1:spheres=40", "tetra:n=2", "balls:n=1"),
        *("--accel", "all", "--resolution", "40x30", "--json", file),
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert len(re.findall(r"\[\d+/\d+\] ", done.stderr)) == 3 * len(STRUCTURES)

    verdicts = json.loads(file.read_text())
    assert verdicts["passed"] is True
    assert len(verdicts["cells"]) == 3 * len(STRUCTURES)
    unsupported = [cell for cell in verdicts["cells"] if cell["verdict"] == "unsupported"]
    assert [cell["structure"] for cell in unsupported] == 2 * ["polygon-beam"], "over spheres"
    for cell in verdicts["cells"]:
        if cell in unsupported:
            continue
        assert cell["rays"] == 40 * 30
        if cell["structure"] == "null":
            assert cell["verdict"] == "baseline"
            continue
        assert cell["verdict"] == "ok"
        assert cell["structure_error"] == 0
        assert cell["agree"] + cell["tie"] + cell["graze"] + cell["embree_error"] == cell["rays"]
        if cell["structure"] == "samet":
            assert cell["bits"] == {"compared_with": "exhaustive", "different": 0}


def test_verify_goes_on_past_a_structure_that_cannot_be_built(tmp_path: Path) -> None:
    file = tmp_path / "verdicts.json"
    done = beambench(
        *("verify", "tetra:n=4", "--accel", "samet:max_references=1,samet"),
        *("--resolution", "16x16", "--json", file),
    )
    assert done.returncode == 1
    verdicts = json.loads(file.read_text())
    assert verdicts["passed"] is False
    assert [cell["verdict"] for cell in verdicts["cells"]] == ["error", "ok"]
    assert "max_references" in verdicts["cells"][0]["message"]
    assert "max_references" in done.stdout


def write_dark_sphere(folder: Path) -> Path:
    """Writes a scene without lights, and therefore without shadow rays."""
    file = folder / "dark.nff"
    file.write_text(
        "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0\nresolution 8 8\ns 0 0 0 1\n"
    )
    return file


def test_verify_states_which_kinds_have_no_rays_and_judges_the_others(tmp_path: Path) -> None:
    scene = write_dark_sphere(tmp_path)
    file = tmp_path / "verdicts.json"
    done = beambench(
        *("verify", scene, "--accel", "exhaustive,samet", "--rays", "primary,shadow,random"),
        *("--resolution", "16x16", "--json", file),
    )
    assert done.returncode == 0, done.stderr
    verdicts = json.loads(file.read_text())
    assert verdicts["passed"] is True
    found = [(cell["ray_kind"], cell["structure"], cell["verdict"]) for cell in verdicts["cells"]]
    assert found == [
        (kind, structure, "no_rays" if kind == "shadow" else "ok")
        for kind in ("primary", "shadow", "random")
        for structure in ("exhaustive", "samet")
    ]
    assert "has no lights" in verdicts["cells"][2]["message"]
    assert "rays" not in verdicts["cells"][2]
    assert done.stdout.count("no_rays") == 2
    assert done.stdout.count("has no lights") == 1  # the same for both structures


def test_verify_fails_where_no_kind_has_rays(tmp_path: Path) -> None:
    file = tmp_path / "verdicts.json"
    done = beambench(
        *("verify", write_dark_sphere(tmp_path), "--accel", "samet", "--rays", "shadow"),
        *("--resolution", "16x16", "--json", file),
    )
    assert done.returncode == 2
    assert "nothing was verified" in done.stderr
    assert "'shadow'" in done.stderr
    assert json.loads(file.read_text())["passed"] is False


def test_run_keeps_rows_of_kinds_without_rays(tmp_path: Path) -> None:
    scene = write_dark_sphere(tmp_path)
    sweep = tmp_path / "dark.json"

    def run(rays: list[str], folder: str) -> subprocess.CompletedProcess[str]:
        settings = {
            "name": "dark",
            "scenes": [str(scene)],
            "structures": ["exhaustive", "samet"],
            "resolutions": ["16x16"],
            "rays": rays,
            "budget_seconds": 1,
            "warm_up_seconds": 0,
        }
        sweep.write_text(json.dumps(settings))
        return beambench("run", sweep, "-o", tmp_path / folder)

    done = run(["primary", "shadow"], "some")
    assert done.returncode == 0, done.stderr
    assert "2 of 4 cells have no rays" in done.stderr
    rows = read_run(tmp_path / "some").rows
    assert list(rows[rows["ray_kind"] == "shadow"]["verdict"]) == ["no_rays", "no_rays"]
    assert list(rows["timed"]) == list(rows["ray_kind"] == "primary")

    assert run(["shadow"], "none").returncode == 2
    assert set(read_run(tmp_path / "none").rows["verdict"]) == {"no_rays"}


def test_rays_are_saved_and_asked_again(tmp_path: Path) -> None:
    file = tmp_path / "some.rays"
    rays = ("rays", "escena1:spheres=40", "--rays", "shadow", "--resolution", "40x30", "--json")
    made = json.loads(output_of(*rays, "-o", file))
    assert made["ray_kind"] == "shadow"
    assert made["query"] == "any"
    assert 0.01 < made["occluded_share"] < 0.99
    assert -1.0 <= made["coherence"] <= 1.0
    with file.open("rb") as lines:
        assert lines.readline() == b"beambench-rays 1\n"
        header = json.loads(lines.readline())
        floats = array.array("f", lines.read())
    assert header["hash"] == made["hash"]
    assert len(floats) == 8 * made["rays"] == 8 * header["rays"]
    assert all(0.999 < t_max < 1.0 for t_max in floats[7::8])  # the light is at t = 1

    read = json.loads(output_of("rays", "escena1:spheres=40", "--rays", file, "--json"))
    assert {**read, "ray_kind": "", "resolution": ""} == {**made, "ray_kind": "", "resolution": ""}
    stats = ("stats", "escena1:spheres=40", "--accel", "samet", "--resolution", "40x30", "--json")
    by_kind = json.loads(output_of(*stats, "--rays", "shadow"))
    by_file = json.loads(output_of(*stats, "--rays", file))
    assert by_kind["structures"][0]["per_ray"] == by_file["structures"][0]["per_ray"]
    verdict = beambench("verify", "escena1:spheres=40", "--accel", "samet,embree", "--rays", file)
    assert verdict.returncode == 0, verdict.stderr
    refused(beambench("rays", "tetra:n=1", "--rays", file), ["some.rays", "hash", "tetra:n=1"])


def test_mirror_rays_are_of_planar_mirrors_and_keep_their_pencils(tmp_path: Path) -> None:
    file = tmp_path / "mirror.rays"
    rays = ("rays", "teapot:n=2", "--resolution", "40x30", "--json")
    made = json.loads(output_of(*rays, "--rays", "mirror", "-o", file))
    assert 0 < made["rays"] < json.loads(output_of(*rays, "--rays", "reflection"))["rays"]
    with file.open("rb") as lines:
        lines.readline()
        (pencil,) = json.loads(lines.readline())["pencils"]
    assert (pencil["first"], pencil["count"], pencil["toward"]) == (0, made["rays"], False)
    for given in ("mirror", file):
        verify = ("verify", "teapot:n=2", "--accel", "all", "--resolution", "40x30")
        verdict = beambench(*verify, "--rays", given)
        assert verdict.returncode == 0, verdict.stdout + verdict.stderr
    refused(
        beambench("rays", "balls:n=1", "--rays", "mirror"),
        ["balls:n=1", "no planar mirrors", "specular", "reflection"],
    )


def test_verify_judges_every_kind_of_rays(tmp_path: Path) -> None:
    file = tmp_path / "v.json"
    done = beambench(
        *("verify", "escena1:spheres=40", "--accel", "exhaustive,samet,embree:mode=packet8"),
        *("--rays", "primary,shadow,reflection,diffuse:seed=5,ao:samples=2,path,random"),
        *("--resolution", "40x30", "--json", file),
    )
    assert done.returncode == 0, done.stdout + done.stderr
    cells = json.loads(file.read_text())["cells"]
    assert len(cells) == 7 * 3
    assert {cell["ray_kind"] for cell in cells} == {
        "primary", "shadow", "reflection", "diffuse:seed=5", "ao:samples=2", "path", "random",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ("ao:samples=0", ["samples", "1", "1024"]),
        ("ao:samples=1025", ["samples", "1", "1024"]),
        ("ao:distance=0", ["distance", "1e-06"]),
        ("ao:distance=-2", ["distance", "1e-06"]),
        ("path:bounces=0", ["bounces", "1", "64"]),
    ],
)
def test_ray_kinds_refuse_what_their_parameters_cannot_be(kind: str, words: list[str]) -> None:
    refused(beambench("verify", "balls:n=1", "--accel", "sah-bvh", "--rays", kind), words)


def test_verify_judges_every_ray_of_whole_pictures(tmp_path: Path) -> None:
    file = tmp_path / "v.json"
    done = beambench(
        *("verify", "finishes", "--accel", "exhaustive,sah-bvh,beam,embree:mode=single,null"),
        *("--rays", "whitted:depth=4,shadows=cache,primary", "--resolution", "48x30"),
        *("--json", file),
    )
    assert done.returncode == 0, done.stdout + done.stderr
    cells = json.loads(file.read_text())["cells"]
    whole = {cell["structure"]: cell for cell in cells if cell["ray_kind"] != "primary"}
    assert {cell["ray_kind"] for cell in whole.values()} == {"whitted:depth=4,shadows=cache"}
    assert whole["beam"]["rays"] == whole["exhaustive"]["rays"] > 3 * 48 * 30
    assert whole["beam"]["bits"] == {"compared_with": "exhaustive", "different": 0}
    assert whole["null"]["verdict"] == "baseline"


def test_a_build_that_memory_does_not_hold_is_refused_before_it_begins(tmp_path: Path) -> None:
    stats = "beambench stats mount:n=9 --resolution 8x8 --accel"
    refused(
        shell(f"BEAMBENCH_MEMORY=100M {stats} sah-bvh", tmp_path),
        ["'sah-bvh'", "524292 primitives", "GiB of memory", "available", "BEAMBENCH_MEMORY"],
    )
    refused(
        shell(f"BEAMBENCH_MEMORY=lots {stats} samet", tmp_path),
        ["BEAMBENCH_MEMORY", "'lots'", "12G"],
    )
    assert shell(f"BEAMBENCH_MEMORY=2G {stats} sah-bvh", tmp_path).returncode == 0


def test_verify_goes_on_after_a_build_that_memory_does_not_hold(tmp_path: Path) -> None:
    verify = (
        "beambench verify mount:n=9 --resolution 8x8 --json v.json --accel samet,embree,sah-bvh"
    )
    done = shell(f"BEAMBENCH_MEMORY=160M {verify}", tmp_path)
    assert done.returncode == 1, done.stderr
    cells = json.loads((tmp_path / "v.json").read_text())["cells"]
    verdicts = {cell["structure"]: cell["verdict"] for cell in cells}
    assert verdicts["samet"] == "ok"
    assert verdicts["sah-bvh"] == "error"


def test_verify_leaves_exhaustive_out_of_all_over_many_primitives() -> None:
    done = beambench("verify", "bumpy:triangles=21168", "--resolution", "8x8")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "exhaustive is left out" in done.stderr
    assert "exhaustive" not in done.stdout
    assert "samet" in done.stdout


# Refusals


WRONG_FILES = {
    "cut.nff": (VIEW + "s 0 0", [":8", "ends", "sphere"]),
    "cut_polygon.nff": (VIEW + "p 4\n0 0 0\n1 0 0\n", [":8", "polygon", "cut off"]),
    "nan.nff": (VIEW + "s 0 nan 0 1\n", [":8", "nan", "sphere"]),
    "infinite.nff": (VIEW + "s 0 inf 0 1\n", [":8", "inf"]),
    "overflow.nff": (VIEW + "s 0 1e999 0 1\n", [":8", "1e999"]),
    "too_far.nff": (VIEW + "s 0 2e9 0 1\n", [":8", "1e9"]),
    "flat_ball.nff": (VIEW + "s 0 0 0 0\n", [":8", "radius"]),
    "two_corners.nff": (VIEW + "p 2\n0 0 0\n1 1 1\n", [":8", "polygon", "3"]),
    "no_corners.nff": (VIEW + "p 0\n", [":8", "polygon"]),
    "fewer_than_none.nff": (VIEW + "p -3\n", [":8", "polygon"]),
    "billion.nff": (VIEW + "p 1000000000\n0 0 0\n", [":8", "1000000000"]),
    "trillion.nff": (VIEW + "p 1000000000000000\n0 0 0\n", [":8", "vertices"]),
    "no_area.nff": (VIEW + "p 3\n0 0 0\n1 1 1\n2 2 2\n", [":8", "polygon", "area"]),
    "no_cone.nff": (VIEW + "c\n0 0 0 0\n0 0 1 0\n", [":8", "cone"]),
    "short_cone.nff": (VIEW + "c\n0 0 0 1\n0 0 0 1\n", [":8", "cone"]),
    "wrong_view.nff": (
        VIEW.replace("angle 45", "angle 200") + "s 0 0 0 1\n",
        ["angle"],
    ),
    "word.nff": (VIEW + "s 0 zero 0 1\n", [":8", "zero"]),
}


@pytest.mark.parametrize("name", WRONG_FILES)
def test_a_malformed_file_is_refused_with_its_line(tmp_path: Path, name: str) -> None:
    text, words = WRONG_FILES[name]
    (tmp_path / name).write_text(text)
    refused(beambench("scene", tmp_path / name), [name, *words])


def test_bytes_of_any_kind_do_not_crash(tmp_path: Path) -> None:
    file = tmp_path / "bytes.nff"
    file.write_bytes(bytes(range(256)) * 40)
    done = beambench("scene", file)
    assert done.returncode in (0, 2)
    assert "terminate called" not in done.stderr


STATS = ("stats", "tetra:n=1", "--accel")
RENDER = ("render", "tetra:n=1", "--accel")

WRONG_REQUESTS = [
    # commands and options
    ([], ["list", "render", "--help"]),
    (["rendr"], ["rendr", "render"]),
    (["render"], ["SCENE", "render --help"]),
    (["render", "balls:n=1"], ["-o"]),
    (["render", "balls:n=1", "-o", "a.png", "--heatmap", "leaves"], ["--heatmap", "--accel"]),
    (["render", "balls:n=1", "-o", "a.png", "--overlay", "beams"], ["--overlay", "--accel"]),
    (["render", "balls:n=1", "-o", "a.png", "--size", "9x9"], ["did you mean '--resolution'"]),
    (["stats", "balls:n=1", "--accel", "samet", "--size=9x9"], ["did you mean '--resolution'"]),
    (["benchmark"], ["benchmark", "did you mean 'run'"]),
    (["help", "rendr"], ["rendr", "render"]),
    (["list", "smet"], ["smet", "did you mean 'samet'"]),
    (["list", "samet", "--json"], ["--json"]),
    (
        [*RENDER, "embree", "-o", "a.png", "--overlay", "beams"],
        ["embree", "beams", "beam, tile-beam"],
    ),
    ([*RENDER, "embree", "-o", "a.png", "--overlay", "cells"], ["cells", "samet", "voxel-grid"]),
    ([*RENDER, "beam", "-o", "a.png", "--overlay", "rays"], ["rays", "beams, cells, pencils"]),
    (
        [*RENDER, "beam", "-o", "a.png", "--overlay", "pencils"],
        ["beam has no pencils", "tile-beam"],
    ),
    ([*RENDER, "tile-beam", "-o", "a.png", "--overlay", "cells"], ["tile-beam", "cells", "samet"]),
    (
        [*RENDER, "tile-beam", "-o", "a.png", "--overlay", "pencils:light=99"],
        ["tetra", "no light 99", "light is 1 ..."],
    ),
    ([*RENDER, "tile-beam", "-o", "a.png", "--overlay", "pencils:lamp=1"], ["lamp", "light"]),
    (
        [*RENDER, "beam", "-o", "a.png", "--overlay", "beams", "--heatmap", "leaves"],
        ["--heatmap", "--overlay"],
    ),
    (
        [*RENDER, "beam", "-o", "a.png", "--overlay", "beams", "--difference", "oracle"],
        ["--difference", "--overlay"],
    ),
    (["list", "--colour"], ["--colour", "list --help"]),
    (["verify", "--resolution"], ["--resolution"]),
    # scenes
    (["scene", "missing.nff"], ["missing.nff", "cannot be read"]),
    (["scene", "no/such/place.nff"], ["no/such/place.nff"]),
    (["scene", "."], ["."]),
    (["scene", "./"], ["./", "folder"]),
    (["scene", "teapott"], ["teapott", "balls", "tetra"]),
    (["scene", "balls:n=1000000000"], ["balls", "n", "1000000000", "8"]),
    (["scene", "balls:n=99999999999999999999"], ["balls", "n"]),
    (["scene", "balls:n=-1"], ["balls", "n", "-1"]),
    (["scene", "balls:n=nan"], ["nan"]),
    (["scene", "balls:n=2.5"], ["2.5"]),
    (["scene", "balls:levels=2"], ["levels", "n"]),
    (["scene", "balls:n"], ["balls:n"]),
    (["scene", "balls:n="], ["n="]),
    (["scene", "balls:n=1,n=2"], ["twice"]),
    (["scene", ""], ["name"]),
    (["scene", "sphereflake"], ["did you mean 'balls'"]),
    (["scene", "helix"], ["helix", "--plugin FILE"]),
    # structures
    ([*STATS, "smet"], ["smet", "did you mean 'samet'"]),
    ([*STATS, "bvh"], ["did you mean 'sah-bvh'"]),
    ([*STATS, "octree"], ["did you mean 'samet'"]),
    ([*STATS, "mine"], ["unknown structure 'mine'; expected one of", "--plugin FILE"]),
    ([*STATS, "samet:level=6"], ["level", "did you mean 'max_level'"]),
    ([*STATS, "samet:max_level=99"], ["max_level", "99"]),
    ([*STATS, "samet:max_level=nan"], ["max_level", "nan"]),
    ([*STATS, "samet:depth=5"], ["depth", "max_level"]),
    ([*STATS, "embree:mode=packet5"], ["mode", "packet5", "packet4"]),
    ([*STATS, "null:x=1"], ["null", "x"]),
    ([*STATS, ""], ["name"]),
    ([*STATS, "samet,"], ["samet,", "comma"]),
    ([*RENDER, "all", "-o", "a.png"], ["all", "one"]),
    # rays and cameras
    *(
        ([*STATS, "null", "--resolution", text], [f"'{text}'", "640x480"])
        for text in [
            "640x",
            "x480",
            "0x0",
            "-1x5",
            "99999x99999",
            "1e3x1",
            "nanxnan",
            "640*480",
        ]
    ),
    ([*STATS, "null", "--rays", "shadowy"], ["shadowy", "primary"]),
    ([*STATS, "null", "--rays", "diffuse:sed=1"], ["sed", "seed"]),
    ([*STATS, "null", "--rays", "no.rays"], ["no.rays"]),
    (["rays", "tetra:n=1", "-o", "rays.txt"], ["rays.txt", ".rays"]),
    (["rays", "tetra:n=1", "-o", "missing/a.rays"], ["missing"]),
    (["trace", "tetra:n=1", "--accel", "null"], ["--pixel"]),
    (["trace", "tetra:n=1", "--accel", "null", "--pixel", "1,1", "--ray", "2"], ["--ray"]),
    (["trace", "tetra:n=1", "--accel", "null", "--rays", "random"], ["--ray", "262143"]),
    (
        ["trace", "tetra:n=1", "--accel", "null", "--rays", "random", "--pixel", "1,1"],
        ["--ray N", "--pixel"],
    ),
    ([*STATS, "null", "--camera", "side"], ["side", "default"]),
    ([*STATS, "null", "--from", "1,2"], ["--from", "'1,2'", "X,Y,Z", "1,2.5,-3"]),
    ([*STATS, "null", "--at", "1,2,3,4"], ["--at", "'1,2,3,4'"]),
    ([*STATS, "null", "--at", "1,2,nan"], ["--at", "nan"]),
    ([*STATS, "null", "--from", "1e30,2,3"], ["--from", "1e30", "1e+09"]),
    ([*STATS, "null", "--from", "1,2,3", "--at", "1,2,3"], ["--from", "--at", "same point"]),
    ([*STATS, "null", "--from", "0,0,5", "--at", "0,0,0", "--up", "0,0,1"], ["--up", "parallel"]),
    ([*STATS, "null", "--up", "0,0,0"], ["--up"]),
    *(
        ([*STATS, "null", "--angle", angle], ["--angle", "180"])
        for angle in ("0", "180", "-5", "nan")
    ),
    ([*RENDER, "null", "-o", "a.png", "--samples", "3"], ["3 samples"]),
    ([*RENDER, "null", "-o", "a.png", "--samples", "many"], ["many"]),
    (
        [
            *RENDER,
            "null",
            "-o",
            "a.png",
            "--samples",
            "64",
            "--resolution",
            "16384x16384",
        ],
        ["resolution", "samples"],
    ),
    *(
        (["trace", "tetra:n=1", "--accel", "null", "--resolution", "8x8", "--pixel", *rest], words)
        for rest, words in [
            (["8,0"], ["8,0", "0 to 7"]),
            (["0,-1"], ["0,-1", "8x8"]),
            (["5"], ["'5'", "10,20"]),
            (["1,2,3"], ["1,2,3"]),
            (["1,2", "--sample", "1"], ["sample 1", "0 to 0"]),
            (["1,2", "--samples", "2"], ["2 samples"]),
            (["1,2", "--camera", "side"], ["side", "default"]),
        ]
    ),
    (["trace", "tetra:n=1", "--accel", "all", "--pixel", "1,1"], ["all", "one"]),
    (["trace", "tetra:n=1", "--accel", "null"], ["--pixel"]),
    (["verify", "tetra:n=1", "--camera", "side"], ["side", "default"]),
    (["verify", "tetra:n=1", "--samples", "3"], ["3 samples"]),
    (["completion", "tcsh"], ["tcsh", "bash"]),
    (["sampling", "tetra:n=1", "--accel", "samet"], ["samet", "--accel beam"]),
    (["mirrors", "tetra:n=1", "--accel", "samet"], ["samet", "--accel beam"]),
    (["census", "tetra:n=1", "--rules", "haines"], ["haines", "spd", "image"]),
    (["census", "tetra:n=1", "--rules", "spd", "--resolution", "9x9"], ["513x513"]),
    (["census", "tetra:n=1", "--shadows", "volumes"], ["volumes", "light-buffer"]),
    (["census", "tetra:n=1", "--depth", "0"], ["--depth"]),
    (["stats", "tetra:n=1", "--accel", "samet", "--rays", "whitted"], ["list", "verify"]),
    (["verify", "tetra:n=1", "--rays", "whitted:depth=0"], ["depth", "1 to 64"]),
    (["verify", "tetra:n=1", "--rays", "whitted:batch=63"], ["batch", "64 to 524288"]),
    (["census", "tetra:n=1", "--pictures", "/dev/null/here"], ["/dev/null/here", "--pictures"]),
    (["sampling", "tetra:n=1", "--resolution", "9000x9000"], ["9000x9000"]),
    (["sampling", "tetra:n=1", "--repetitions", "0"], ["--repetitions"]),
    (["stats", "tetra:n=1", "--accel", "samet:max_level=deep"], ["deep", "auto", "1 to 16"]),
    # files to write
    ([*RENDER, "null", "-o", "a.png", "--difference", "smet"], ["smet", "samet"]),
    ([*RENDER, "null", "-o", "a.png", "--difference", "all"], ["--difference", "one"]),
    (
        [*RENDER, "null", "-o", "a.png", "--difference", "oracle", "--heatmap", "leaves"],
        ["exclude"],
    ),
    (["verify", "tetra:n=1", "--pictures", "cut.json"], ["cut.json", "--pictures"]),
    ([*RENDER, "null", "-o", "a.jpg"], ["a.jpg", ".png", ".exr"]),
    ([*RENDER, "null", "-o", "picture"], ["picture", ".png"]),
    ([*RENDER, "null", "-o", "missing/a.png"], ["missing", "create"]),
    ([*RENDER, "null", "-o", "/proc/a.png"], ["/proc/a.png"]),
    ([*RENDER, "null", "-o", "a.png", "--shade", "whited"], ["whited", "preview"]),
    (
        [*RENDER, "null", "-o", "a.png", "--heatmap", "steps"],
        ["steps", "traversal_steps"],
    ),
    (["verify", "tetra:n=1", "--json", "missing/v.json"], ["missing"]),
    (["verify", "tetra:n=1", "nowhere"], ["nowhere"]),
    (["export", "tetra:n=1"], ["-o", "export --help"]),
    (["export", "tetra:n=1", "-o", "a.stl"], ["a.stl", ".nff"]),
    (["export", "tetra:n=1", "-o", "missing/a.nff"], ["missing", "create"]),
    (["export", "tetra:n=1", "-o", "/dev/full/a.nff"], ["/dev/full"]),
    (["export", "tetraa", "-o", "a.nff"], ["tetraa", "tetra"]),
    # configurations
    (["run", "missing.json"], ["missing.json"]),
    (["run", "cut.json"], ["cut.json"]),
    (["run", "list.json"], ["list.json"]),
    (["run", "comma.json"], ["comma.json:3:1", "there is a comma before this '}'", "remove"]),
    (["run", "commas.json"], ["commas.json:1:22", "there is a comma before this ']'"]),
    (["run", "unknown.json", "-o", "out"], ["smet"]),
]


@pytest.mark.parametrize(
    ("arguments", "words"),
    WRONG_REQUESTS,
    ids=lambda value: " ".join(value) or "nothing",
)
def test_a_wrong_request_is_refused_in_one_sentence(
    tmp_path: Path, arguments: list[str], words: list[str]
) -> None:
    (tmp_path / "cut.json").write_text('{"name": "cut", "scenes": [')
    (tmp_path / "list.json").write_text("[1, 2, 3]")
    (tmp_path / "comma.json").write_text('{\n"name": "comma",\n}\n')
    (tmp_path / "commas.json").write_text('{"scenes": ["tetra", ]}')
    (tmp_path / "unknown.json").write_text(
        '{"name": "unknown", "scenes": ["tetra:n=1"], "structures": ["smet"],'
        ' "resolutions": ["8x8"], "budget_seconds": 1}'
    )
    before = set(tmp_path.iterdir())
    refused(beambench(*arguments, cwd=tmp_path), words)
    assert set(tmp_path.iterdir()) == before, "a refused request leaves nothing behind"


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_without_write_permission_is_refused(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    refused(beambench(*RENDER, "null", "-o", tmp_path / "a.png"), ["not writable"])


def test_a_full_disk_is_reported() -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [BINARY, "list"],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.returncode == 2
    assert "cannot write" in done.stderr


def test_trace_with_beams_prints_those_of_the_sample() -> None:
    command = ["trace", "delfines", "--accel", "beam:max_level=5", "--pixel", "44,30"]
    command += ["--resolution", "64x64"]
    way = json.loads(beambench(*command, "--json").stdout)
    kinds = [beam["kind"] for beam in way["beams"]]
    assert kinds == ["non-terminal"] * (len(kinds) - 1) + ["occupied"]
    assert way["beams"][-1]["index"] == way["steps"][0]["index"]
    assert all(beam["samples"] >= 1 and len(beam["outline"]) >= 3 for beam in way["beams"])
    assert any(beam["cuts"] for beam in way["beams"])
    text = beambench(*command).stdout
    assert f"The sample's beams, {len(kinds)} leaves; outlines in pixels:" in text
    assert "terminal: its samples become rays" in text
    alone = json.loads(beambench(*command, "--json", "--alone").stdout)
    assert "beams" not in alone
    assert alone["hit"] == way["hit"]


# Files of other programs


CORNELL = """b 0 0 0
v
from 275 275 -800
at 275 275 0
up 0 1 0
angle 40
hither 0.1
resolution 48 48
la 200 550 200  150 0 0  0 0 150  1 1 1
f 0.7 0.7 0.7 1 0 0 0 1
p 4 550 0 0   0 0 0   0 0 550   550 0 550
p 4 550 550 0   550 550 550   0 550 550   0 550 0
p 4 550 0 550   0 0 550   0 550 550   550 550 550
"""


def test_a_cornell_box_is_not_black(tmp_path: Path) -> None:
    """The only light is a rectangle in the ceiling, written as `la` in a dialect of NFF."""
    file = tmp_path / "cornell.nff"
    file.write_text(CORNELL)
    picture = tmp_path / "cornell.png"
    done = beambench("render", file, "--accel", "samet", "--shade", "whitted", "-o", picture)
    assert done.returncode == 0, done.stderr
    assert f"{file}:9: an area light is read as a point light" in done.stderr
    with Image.open(picture) as image:
        floor = image.convert("L").getpixel((24, 44))
        assert floor > 150
        assert count_colors(image) > 50


def test_a_picture_that_is_too_bright_names_the_exposure_that_it_needs(tmp_path: Path) -> None:
    file = tmp_path / "shells.nff"
    file.write_text(VIEW + "l 0 0 5 20 20 20\nfp 1 0.5 0.5 .9 0 64 0 1\ns 0 0 0 1.5\n")
    picture = tmp_path / "shells.png"
    render = ["render", file, "--accel", "samet", "--shade", "whitted", "--resolution", "64x64"]
    done = beambench(*render, "-o", picture)
    assert done.returncode == 0, done.stderr
    found = re.search(r"(\d+)% of the pixels are brighter .*'(--exposure) (-[\d.]+)'", done.stderr)
    assert found
    assert int(found[1]) > 20
    done = beambench(*render, "-o", picture, found[2], found[3])
    assert done.returncode == 0, done.stderr
    assert "brighter" not in done.stderr
    with Image.open(picture) as image:
        red, green, _ = image.convert("RGB").getpixel((32, 32))
        assert red > green + 40, "the surface's own colour is seen"


@pytest.mark.parametrize("scene", ["gears", "habitacion", "rings"])
@pytest.mark.parametrize("shading", ["whitted", "preview"])
def test_automatic_exposure_clips_one_percent_at_most(
    tmp_path: Path, scene: str, shading: str
) -> None:
    picture = tmp_path / "picture.png"
    options = ["--shade", shading, "--resolution", "96x96", "--exposure", "auto"]
    for threads in ("1", "3"):
        done = beambench("render", scene, "-o", picture, *options, "--threads", threads)
        assert done.returncode == 0, done.stderr
        assert re.search(r"; exposure [+-]\d\.\d, white \d\.\d\d", done.stderr)
        (tmp_path / threads).write_bytes(picture.read_bytes())
    assert (tmp_path / "1").read_bytes() == (tmp_path / "3").read_bytes()
    with Image.open(picture) as image:
        brightest = np.asarray(image.convert("RGB")).max(axis=2)
    assert (brightest == 255).mean() <= 0.01
    assert np.percentile(brightest, 98) > 240, "what was bright stays bright"


def test_no_exposure_is_that_of_zero_stops(tmp_path: Path) -> None:
    pictures = [tmp_path / "default.png", tmp_path / "zero.png"]
    for picture, options in zip(pictures, ([], ["--exposure", "+0"]), strict=True):
        done = beambench("render", "gears:n=1", "-o", picture, "--resolution", "64x64", *options)
        assert done.returncode == 0, done.stderr
    assert pictures[0].read_bytes() == pictures[1].read_bytes()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--exposure", "bright"], ["--exposure 'bright'", "'auto'", "stops from -32 to 32"]),
        (["--exposure", "33"], ["--exposure '33'", "from -32 to 32"]),
        (["--exposure", "nan"], ["--exposure 'nan'"]),
        (["--exposure", "1x"], ["--exposure '1x'"]),
        (["--exposure", ""], ["--exposure ''"]),
        (["--exposure", "1", "--shade", "id"], ["--exposure", "--shade whitted"]),
        (["--exposure", "auto", "--shade", "normals"], ["--exposure", "--shade preview"]),
        (["--exposure", "auto", "--accel", "samet", "--heatmap", "leaves"], ["--exposure"]),
        (["--exposure", "1", "--accel", "samet", "--difference", "oracle"], ["--exposure"]),
        (["--exposure", "auto", "-o", "picture.exr"], ["--exposure auto", ".exr"]),
    ],
)
def test_a_wrong_exposure_is_refused(tmp_path: Path, options: list[str], words: list[str]) -> None:
    output = [] if "-o" in options else ["-o", tmp_path / "picture.png"]
    refused(beambench("render", "tetra:n=1", *output, *options), words)
    assert not list(tmp_path.iterdir())


def test_a_file_with_degenerate_primitives_is_read_without_them(tmp_path: Path) -> None:
    file = tmp_path / "found.nff"
    file.write_text("s 0 0 0 1\np 3\n0 0 0\n1 1 1\n2 2 2\ns 1 1 1 0\n")
    done = beambench("scene", file, "--json")
    assert done.returncode == 0
    assert json.loads(done.stdout)["primitives"] == 1
    assert f"{file}:2: a degenerate primitive is skipped: polygon (primitive 1)" in done.stderr
    assert "(and 1 more)" in done.stderr
    again = tmp_path / "clean.nff"
    for command in (["scene", file], ["export", file, "-o", again]):
        refused(beambench(*command, "--strict"), ["found.nff:2", "polygon (primitive 1)"])
    output_of("export", file, "-o", again)
    output_of("scene", again, "--strict")
