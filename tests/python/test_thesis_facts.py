"""The report's facts other than the sweeps, from commands of a stand-in."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from PIL import Image

from beambench_report.base.published import primitives_by_scene
from beambench_thesis.chapter5.facts import TURN, facts, gather_facts, turn_camera
from beambench_thesis.claims.register import SWEPT_CLAIMS, judge_claims
from beambench_thesis.claims.verdict import Verdict
from beambench_thesis.paper.cells import Cells
from beambench_thesis.paper.measured import is_census_folder
from beambench_thesis.paper.section import section_as_markdown
from beambench_thesis.report.command import _QUICK
from beambench_thesis.report.pictures import octree_figures
from beambench_thesis.report.plan import make_plan
from beambench_thesis.report.report import gather, sections_of
from beambench_thesis.report.write import write_report
from program import BINARY
from synthetic_thesis import Row, pages_of, texts_of, write_runs

# Replaces the program: records its arguments and prints the output of that command.
STAND_IN = """#!/usr/bin/env python3
import json, pathlib, sys
arguments = sys.argv[1:]
with (pathlib.Path(__file__).parent / "calls").open("a") as calls:
    calls.write(" ".join(arguments) + "\\n")
command, first = arguments[:2]
def option(name):
    return arguments[arguments.index(name) + 1]
if command == "export":
    lines = ["v", "from 0 -2 0", "at 0 0 0", "up 0 0 1", "angle 19", "hither 0"]
    pathlib.Path(option("-o")).write_text("\\n".join(lines) + "\\n")
elif command == "scene":
    polygons = {"escena1": 0, "escena2": 1}.get(first, 1692)
    camera = {"from": [0, -2, 0], "at": [0, 0, 0]}
    counts = {"polygons": polygons, "spheres": 430 if first == "escena1" else 0, "cones": 0}
    print(json.dumps(counts | {"cameras": [camera]}))
elif command == "census":
    counts = {"eye_rays": 900, "reflected_rays": 7, "refracted_rays": 0, "shadow_hidden": 40}
    cached = {"scan": 10, "beams": 30}[option("--order")]
    scenes = [{"scene": name, "shadow_cached": cached} | counts for name in arguments[1:16]]
    print(json.dumps({"shadows": "cache", "order": option("--order"), "scenes": scenes}))
elif "--levels" in arguments:
    names = ("nodes", "leaves", "occupied_leaves", "node_visits", "leaf_visits", "beams")
    visits = {5: 8000, 6: 3200, 7: 800}
    levels = [{"level": n, **dict.fromkeys(names, 8), "node_visits": v} for n, v in visits.items()]
    print(json.dumps({"rays": 64000, "structures": [{"levels": levels}]}))
else:
    turned = pathlib.Path(first).exists()
    camera = [line for line in open(first) if line.startswith("from")] if turned else []
    assert not turned or camera != ["from 0 -2 0\\n"]
    leaving = {"per_ray": {"samples_leaving": 0.01 if turned else 0.25}}
    print(json.dumps({"rays": 1000000, "structures": [leaving]}))
"""


@pytest.fixture
def stand_in(tmp_path: Path) -> Path:
    """A program that has no scenes."""
    path = tmp_path / "program" / "beambench"
    path.parent.mkdir()
    path.write_text(STAND_IN)
    path.chmod(0o755)
    return path


def sections(directory: Path) -> dict[str, str]:
    """Returns the sections of the report that need no cells, by their anchors."""
    found, unread = sections_of(directory, Cells(directory, (), ()))
    assert not unread
    return {section.anchor: section_as_markdown(section) for section in found}


def test_every_fact_is_made_once(stand_in: Path, tmp_path: Path) -> None:
    run = tmp_path / "run"
    run.mkdir()
    assert gather_facts(run, stand_in) == []
    assert all(fact.path.exists() for fact in facts(run))
    assert is_census_folder(run / "census")
    calls = stand_in.with_name("calls").read_text().splitlines()
    assert len(calls) == 15 + 2 + 2 + 2 + 4  # scenes, censuses, visits, own camera, turned camera
    assert gather_facts(run, stand_in) == []
    assert len(stand_in.with_name("calls").read_text().splitlines()) == len(calls)


def test_what_cannot_be_made_is_said_and_left_out(tmp_path: Path) -> None:
    broken = tmp_path / "beambench"
    broken.write_text("#!/bin/sh\necho 'beambench: no such scene' >&2\nexit 2\n")
    broken.chmod(0o755)
    run = tmp_path / "run"
    run.mkdir()
    failed = gather_facts(run, broken)
    assert "visits/maceta.json was not made: beambench: no such scene" in failed
    assert failed[-1].startswith("delfines from another camera: ")
    assert sections(run) == {}


def test_the_sections_state_what_the_files_have(stand_in: Path, tmp_path: Path) -> None:
    gather_facts(tmp_path, stand_in)
    texts = sections(tmp_path)
    assert list(texts) == ["scenes", "visits", "camera"]
    assert "| Escena 1 | 0 | 0 | 430 | 430 | 0 |" in texts["scenes"]
    assert "| Maceta | 1,284 | 1,692 | 0 | 0 | 0 |" in texts["scenes"]
    assert "2 of 15 scenes have the thesis's numbers; others: Escena 2, " in texts["scenes"]
    assert (
        "a node of level 6 is visited by 400 of 64,000 rays on average (0.62%), one of level 5 by "
        "2.50 times as many, one of level 7 by 4.00 times fewer." in texts["visits"]
    )
    assert "| 6 | 8 | 400 | 0.625% | 8 | 8 | 8 | 8 |" in texts["visits"]
    assert "250,000 from the scene's own camera and 10,000 from the turned" in texts["camera"]
    assert "| thesis | 612,706 | 3,031 |" in texts["camera"]


def test_a_camera_is_turned_around_the_point_it_looks_at() -> None:
    scene = "v\nfrom 1 -3 0\nat 1 -1 0\nup 0 0 1\nangle 19\n"
    lines = turn_camera(scene, {"from": [1, -3, 0], "at": [1, -1, 0]}, TURN).splitlines()
    away = [float(a) - b for a, b in zip(lines[1].split()[1:], (1, -1, 0), strict=True)]
    assert math.hypot(*away) == pytest.approx(2 * 1.34, abs=1e-5)
    assert math.degrees(math.atan2(away[1], away[0])) == pytest.approx(-90 + 29.6, abs=1e-3)
    assert math.degrees(math.asin(away[2] / math.hypot(*away))) == pytest.approx(4, abs=1e-3)
    assert lines[2:] == ["at 1 -1 0", "up 0 0 1", "angle 9.74"]
    with pytest.raises(ValueError, match="no line 'from'"):
        turn_camera("v\n", {"from": [1, -3, 0], "at": [1, -1, 0]}, TURN)


def with_times_of_tasks(row: Row) -> Row:
    """Adds times of tasks, as in a real row of the beams."""
    names = ("beams_nonterminal_ns", "beams_occupied_ns", "beams_leaving_ns", "beam_clips")
    names = (*names, "neighbor_searches", "samples_in_leaves", "rays_after_leaf")
    return row | {f"{name}_per_ray": 50 if row["structure"] == "beam" else "" for name in names}


@pytest.mark.full
def test_a_quick_run_says_which_claims_it_can_decide(stand_in: Path, tmp_path: Path) -> None:
    plan = make_plan([], [], True)
    run = write_runs(tmp_path / "run", plan, with_times_of_tasks)
    gather_facts(run, stand_in)
    found = judge_claims(
        [*(run / sweep.name for sweep in plan.sweeps), run / "census"], SWEPT_CLAIMS
    )
    decided = [e.claim.name for e in found if e.ours.verdict is not Verdict.NOT_TESTED]
    assert f"the claims {', '.join(decided[:-1])} and {decided[-1]} alone" in _QUICK
    notice = write_report(run, plan).notice
    assert f"Its cells are enough for {len(decided)} of {len(found)} claims: " in notice
    assert ", ".join(decided) in notice
    assert notice in texts_of(run)


def test_the_script_s_help_says_so_too(repository: Path) -> None:
    text = " ".join((repository / "scripts/thesis").read_text().split())
    (words,) = [part for part in _QUICK.split("; ") if part.startswith("enough")]
    assert words.removeprefix("enough for the claims ").split(" alone")[0] in text
    assert "--levels also measure how well max_level=auto chooses the level" in text


@pytest.mark.full
def test_octrees_are_drawn_with_their_level_stated(tmp_path: Path) -> None:
    if not BINARY.exists():
        pytest.skip("beambench is not built; run scripts/setup")
    (figure,) = octree_figures(("5.9", "5.12"), tmp_path, BINARY)
    assert figure.number == "5.9"
    assert figure.path == tmp_path / "figures/figure-5.9.png"
    assert Image.open(figure.path).width > 1000
    changed = figure.path.stat().st_mtime_ns
    assert octree_figures(("5.9",), tmp_path, Path("/no/such/program")) == [figure]
    assert figure.path.stat().st_mtime_ns == changed


def test_octrees_that_cannot_be_drawn_are_named(tmp_path: Path) -> None:
    (figure,) = octree_figures(("5.5",), tmp_path, Path("/no/such/program"))
    assert figure.path is None
    assert figure.caption.startswith("Delfines, level 4, 0 objects: /no/such/program cannot be run")


def test_the_report_shows_facts_and_figures_of_pictures(stand_in: Path, tmp_path: Path) -> None:
    plan = make_plan(["5.2"], [], False)
    assert "5.4" in plan.figures
    run = write_runs(tmp_path / "run", plan)
    gather_facts(run, stand_in)
    report = gather(run, plan, Path("/no/such/program"))
    assert [picture.number for picture in report.pictures] == ["5.4", "5.5"]
    (cache,) = (entry for entry in report.claims if entry.claim.name == "C31")
    assert cache.ours.verdict is Verdict.SUPPORTED
    assert len(cache.ours.checks) == len(primitives_by_scene())
    write_report(run, plan, Path("/no/such/program"))
    page, text = pages_of(run), texts_of(run)
    assert "## Figure 5.4: Maceta by different criteria of division" in text
    assert 'id="figure-5.5"' in page
    assert '<section id="visits">' in page
    assert "## Table 5.1: the scenes" in text
