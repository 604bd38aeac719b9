"""Reading results.csv: accepted input, and the messages for refused input."""

from __future__ import annotations

from pathlib import Path

import pytest

from beambench_report.base.columns import RENAMED_COLUMNS
from beambench_report.base.files import Problem
from beambench_report.base.records import read_run
from synthetic_run import synthetic_rows, without_times, write_run


def test_the_structure_null_is_a_name_and_not_a_missing_value(run_folder: Path) -> None:
    assert set(read_run(run_folder).rows["structure"]) == {"exhaustive", "samet", "embree", "null"}


def test_rows_judged_ok_or_baseline_are_timed(run_folder: Path) -> None:
    assert read_run(run_folder).rows["timed"].all()


@pytest.mark.parametrize("verdict", ["mismatch", "grazes", "error", "no_rays", ""])
def test_any_other_verdict_takes_a_row_out_of_the_times(tmp_path: Path, verdict: str) -> None:
    rows = synthetic_rows()
    rows[4] = {**rows[4], "verdict": verdict}  # times left in: the verdict alone must decide
    timed = read_run(write_run(tmp_path, rows)).rows["timed"]
    assert not timed[4]
    assert timed.drop(index=4).all()


def test_empty_fields_are_not_measured(tmp_path: Path) -> None:
    rows = synthetic_rows()
    rows[4] = without_times(rows[4], "mismatch")
    run = read_run(write_run(tmp_path, rows))
    assert run.rows["total_ms_median"].isna().sum() == 1
    assert run.rows["leaves_per_ray"].isna().all()
    assert run.counters == ["traversal_steps_per_ray", "primitive_tests_per_ray"]


def test_a_column_of_the_family_s_own_is_a_counter(tmp_path: Path) -> None:
    rows = [{**row, "neighbour_climbs_per_ray": 3.5} for row in synthetic_rows()]
    assert "neighbour_climbs_per_ray" in read_run(write_run(tmp_path, rows)).counters


@pytest.mark.parametrize(("then", "now"), RENAMED_COLUMNS.items())
def test_columns_of_older_records_are_read_under_their_new_names(
    tmp_path: Path, then: str, now: str
) -> None:
    rows = [{**row, then: 3.5} for row in synthetic_rows()]
    run = read_run(write_run(tmp_path, rows, without=(now,)))
    assert run.rows[now].eq(3.5).all()
    assert then not in run.rows


def test_counters_of_a_kind_of_rays_are_told_apart(tmp_path: Path) -> None:
    rows = [{**row, "shadow_rays": 9, "shadow_box_tests_per_ray": 3.5} for row in synthetic_rows()]
    run = read_run(write_run(tmp_path, rows))
    assert run.counters_by_kind == ["shadow_box_tests_per_ray"]
    assert "shadow_box_tests_per_ray" not in run.counters
    assert run.rows["shadow_rays"].eq(9).all()


def test_finest_gives_the_highest_number_of_rays(run_folder: Path) -> None:
    rows = read_run(run_folder).finest("escena1")
    assert set(rows["rays"]) == {1280 * 1024}
    assert len(rows) == 5


def test_columns_of_a_newer_beambench_are_kept_as_they_are(tmp_path: Path) -> None:
    rows = [{**row, "new_figure": 3, "new_word": "x"} for row in synthetic_rows()]
    run = read_run(write_run(tmp_path, rows))
    assert set(run.rows["new_figure"]) == {3}
    assert set(run.rows["new_word"]) == {"x"}


def test_missing_columns_are_named(tmp_path: Path) -> None:
    folder = write_run(tmp_path, synthetic_rows(), without=("verdict", "memory_bytes"))
    with pytest.raises(Problem, match=r"results\.csv: the columns memory_bytes, verdict are miss"):
        read_run(folder)


def test_a_field_that_is_no_number_is_named_with_its_row(tmp_path: Path) -> None:
    rows = synthetic_rows()
    rows[2] = {**rows[2], "build_ms_median": "fast"}
    with pytest.raises(Problem, match="row 4: build_ms_median is 'fast', not a number"):
        read_run(write_run(tmp_path, rows))


@pytest.mark.parametrize("column", ["scene", "structure", "rays"])
def test_a_row_without_identity_is_refused(tmp_path: Path, column: str) -> None:
    rows = synthetic_rows()
    rows[0] = {**rows[0], column: ""}
    with pytest.raises(Problem, match=f"row 2: {column} is empty"):
        read_run(write_run(tmp_path, rows))


@pytest.mark.parametrize("version", [0, 3, "", "one"])
def test_another_version_of_the_schema_is_refused(tmp_path: Path, version: object) -> None:
    rows = synthetic_rows()
    rows[3] = {**rows[3], "schema_version": version}
    with pytest.raises(
        Problem, match=r"row 5: schema_version is '.*', but only versions 1 to 2 can be read"
    ):
        read_run(write_run(tmp_path, rows))


def test_a_table_without_a_version_is_refused(tmp_path: Path) -> None:
    with pytest.raises(Problem, match="there is no column schema_version"):
        read_run(write_run(tmp_path, synthetic_rows(), without=("schema_version",)))


@pytest.mark.parametrize("text", ["true", "1e", "0x10"])
def test_what_a_reader_could_take_for_a_number_is_refused(tmp_path: Path, text: str) -> None:
    rows = [{**row, "memory_bytes": text} for row in synthetic_rows()]
    with pytest.raises(Problem, match=f"(?i)row 2: memory_bytes is '{text}', not a number"):
        read_run(write_run(tmp_path, rows))


def test_hashes_of_digits_alone_stay_texts(tmp_path: Path) -> None:
    rows = [{**row, "scene_hash": "0000000000000012"} for row in synthetic_rows()]
    run = read_run(write_run(tmp_path, rows))
    assert set(run.rows["scene_hash"]) == {"0000000000000012"}


def test_a_run_without_rows_is_refused(tmp_path: Path) -> None:
    with pytest.raises(Problem, match="has no rows"):
        read_run(write_run(tmp_path, []))


def test_a_folder_without_results_is_refused(tmp_path: Path) -> None:
    with pytest.raises(Problem, match="there is no such file"):
        read_run(tmp_path)


@pytest.mark.parametrize("content", [b"", b"\xff\xfe\x00", b'a,b\n"1,2\n3,4,5,6\n'])
def test_what_is_no_csv_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "results.csv").write_bytes(content)
    with pytest.raises(Problem, match=r"results\.csv: cannot be read as CSV"):
        read_run(tmp_path)
