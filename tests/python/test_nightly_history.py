"""The history of nights: written atomically, rebuilt from CSVs, locked during a run."""

from __future__ import annotations

import multiprocessing
import os
import shutil
import sqlite3
from pathlib import Path

import numpy as np
import pytest

from beambench_operations.history.night import night_of
from beambench_operations.history.nights import read_nights
from beambench_operations.history.store import SCHEMA_VERSION, History
from beambench_operations.nightly.home import Home, abandon, only_one, prune
from beambench_operations.nightly.run import catch_up, rebuild_history
from beambench_report.base.analysis import read_analysis
from beambench_report.base.files import Problem
from beambench_report.base.records import read_run
from beambench_report.base.run_log import has_log
from synthetic_nights import BLOCKS, add_all, counting, write_nights, wrong
from synthetic_run import synthetic_rows, without_times, write_cell, write_run


@pytest.fixture
def home(tmp_path: Path) -> Home:
    return Home(tmp_path / "nightly")


def everything(history: Path) -> list[str]:
    with sqlite3.connect(history) as base:
        return list(base.iterdump())


def test_it_can_be_rebuilt_from_the_csvs_alarms_and_all(home: Home) -> None:
    folders = write_nights(home, 3, counting("samet", "escena1", [1.0, 1.0, 1.2]))
    assert [len(alarms) > 0 for alarms in add_all(home, folders)] == [False, False, True]
    before = everything(home.history)
    home.history.unlink()
    assert rebuild_history(home) == 3
    assert everything(home.history) == before


def test_a_run_is_added_once(home: Home) -> None:
    [folder] = write_nights(home, 1)
    night = night_of(read_run(folder))
    with History(home.history) as history:
        assert history.add(night, folder) == 1
        assert history.add(night, folder) is None
        assert history.read("SELECT count(*) FROM nights") == [(1,)]


def killed_while_adding(history_path: Path, folder: Path) -> None:
    History(history_path).add(night_of(read_run(folder)), folder, lambda *_: os._exit(9))


def test_a_killed_process_leaves_the_history_as_it_was(home: Home) -> None:
    first, second = write_nights(home, 2)
    add_all(home, [first])
    before = everything(home.history)
    child = multiprocessing.get_context("spawn").Process(
        target=killed_while_adding, args=(home.history, second)
    )
    child.start()
    child.join()
    assert child.exitcode == 9
    assert everything(home.history) == before
    catch_up(home)
    with History(home.history) as history:
        assert history.read("SELECT count(*) FROM nights") == [(2,)]


def test_a_file_that_is_no_history_is_refused_with_the_remedy(home: Home) -> None:
    home.folder.mkdir()
    home.history.write_bytes(b"this is no database, " * 100)
    with pytest.raises(Problem, match=r"history\.sqlite.*not a database.*nightly rebuild"):
        History(home.history)
    home.history.unlink()
    with sqlite3.connect(home.history) as base:
        base.execute("CREATE TABLE others (id)")
    with pytest.raises(Problem, match="not a history of nightly runs"):
        History(home.history)


def test_another_version_is_refused_until_it_is_rebuilt(home: Home) -> None:
    add_all(home, write_nights(home, 2))
    with sqlite3.connect(home.history) as base:
        base.execute(f"PRAGMA user_version = {SCHEMA_VERSION + 1}")
    base.close()
    with pytest.raises(Problem, match=f"schema version {SCHEMA_VERSION + 1}"):
        History(home.history)
    assert rebuild_history(home) == 2
    History(home.history).read("SELECT 1")


def test_a_history_from_before_blocks_is_read_on(home: Home) -> None:
    *known, new = write_nights(home, 3, old=2)
    add_all(home, known)
    with sqlite3.connect(home.history) as base:
        base.execute("ALTER TABLE nights DROP COLUMN in_blocks")
        base.execute("ALTER TABLE figures DROP COLUMN error")
        base.execute("PRAGMA user_version = 1")
    base.close()
    add_all(home, [new])
    with History(home.history) as history:
        assert list(read_nights(history).nights["in_blocks"]) == [0, 0, 1]
        assert history.read(
            "SELECT count(ratio) > 0, count(error) FROM figures WHERE night = 2"
        ) == [(1, 0)]
    before = [line for line in everything(home.history) if line.startswith("INSERT")]
    assert rebuild_history(home) == 3
    assert [line for line in everything(home.history) if line.startswith("INSERT")] == before


def test_a_ratio_is_the_mean_over_the_blocks_with_its_error(home: Home) -> None:
    [folder] = write_nights(home, 1)
    totals = read_analysis(folder).block_totals
    for one in night_of(read_run(folder)).figures:
        own, base = (
            np.log(list(totals["/".join(map(str, name))].values()))
            for name in (_name(one.key), _name(one.reference))
        )
        logs = own - base
        assert len(logs) == BLOCKS
        assert one.ratio == pytest.approx(np.exp(logs.mean()))
        assert one.error == pytest.approx(logs.std(ddof=1) / np.sqrt(BLOCKS), abs=1e-12)


def _name(key: tuple) -> tuple:
    scene, camera, structure, parameters, width, height, samples, rays = key
    accel = f"{structure}:{parameters}".rstrip(":")
    return scene, camera, f"{width}x{height}", samples, rays, accel


def test_a_torn_file_is_refused(home: Home) -> None:
    add_all(home, write_nights(home, 2))
    data = home.history.read_bytes()
    home.history.write_bytes(data[: len(data) // 2] + b"\xff" * (len(data) // 2))
    with pytest.raises(Problem, match="cannot be used as a history"):
        read_all(home.history)


def read_all(history_path: Path) -> None:
    with History(history_path) as history:
        for table in ("nights", "cells", "inputs", "work", "figures", "alarms"):
            history.read(f"SELECT * FROM {table}")


def test_a_csv_that_cannot_be_read_is_named_and_the_old_history_stays(home: Home) -> None:
    folders = write_nights(home, 2)
    add_all(home, folders)
    before = everything(home.history)
    (folders[0] / "results.csv").write_bytes(b"\xff\xfe\x00broken")
    with pytest.raises(Problem, match=r"20260101T030000Z/results\.csv"):
        rebuild_history(home)
    assert everything(home.history) == before
    assert [path.name for path in home.folder.glob(".pending*")] == []


def test_rows_of_two_runs_are_no_night(home: Home, tmp_path: Path) -> None:
    rows = synthetic_rows()
    rows[-1]["run_id"] = "another"
    with pytest.raises(Problem, match="a night is one run"):
        night_of(read_run(write_run(tmp_path, rows)))
    with pytest.raises(Problem, match="row 3: repeats an earlier cell"):
        night_of(read_run(write_run(tmp_path, [synthetic_rows()[0]] * 2)))


def test_two_runs_at_once_are_kept_apart(home: Home) -> None:
    other = only_one(home.lock)
    with only_one(home.lock), pytest.raises(Problem, match=rf"process {os.getpid()} since 2"):
        other.__enter__()
    with only_one(home.lock):
        pass


def hold_and_die(lock: Path) -> None:
    holder = only_one(lock)
    holder.__enter__()
    os._exit(9)


def test_a_lock_dies_with_its_holder(home: Home) -> None:
    child = multiprocessing.get_context("spawn").Process(target=hold_and_die, args=(home.lock,))
    child.start()
    child.join()
    with only_one(home.lock):
        pass


def test_old_raw_samples_are_pruned_but_not_what_was_wrong(home: Home) -> None:
    folders = write_nights(home, 4, old=4)
    right, bad = synthetic_rows()[0], without_times(synthetic_rows()[1], "mismatch")
    for number, folder in enumerate(folders):
        write_cell(folder, right)
        if number == 1:
            write_cell(folder, bad)
        (folder / "google-benchmark.json").write_text("{}")
    (home.folder / "abandoned-20250101T000000Z").mkdir()
    prune(home, keep=2)
    assert [has_log(folder) for folder in folders] == [False, True, True, True]
    for folder in folders[:2]:
        assert not (folder / "google-benchmark.json").exists()
        assert (folder / "results.csv").exists()
    assert list(home.folder.glob("abandoned-*")) == []


def test_a_run_that_was_cut_off_stays_out(home: Home) -> None:
    first, second = write_nights(home, 2)
    (second / "manifest.json").write_text('{"finished_utc": null}')
    assert home.finished() == [first]
    assert home.unfinished() == [second]
    abandon(second)
    assert home.unfinished() == []
    assert rebuild_history(home) == 1


def test_runs_without_a_reference_have_no_ratios(home: Home) -> None:
    [folder] = write_nights(home, 1, wrong("embree", "escena1", 0))
    figures = night_of(read_run(folder)).figures
    assert {one.ratio is None for one in figures if one.key[0] == "escena1"} == {True}
    assert {one.ratio is None for one in figures if one.key[0] != "escena1"} == {False}


def test_a_history_moves_with_its_folder(home: Home, tmp_path: Path) -> None:
    add_all(home, write_nights(home, 1))
    moved = Home(tmp_path / "elsewhere")
    shutil.move(home.folder, moved.folder)
    with History(moved.history) as history:
        [(folder,)] = history.read("SELECT folder FROM nights")
    assert (moved.folder / folder / "results.csv").exists()
