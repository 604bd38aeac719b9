"""The alarms of a night: planted regressions trigger them, and nothing else does."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from beambench_operations.history.alarms import doubt, find_alarms, sentence
from beambench_operations.history.steps import Rule, find_steps
from beambench_operations.history.store import Alarm, History
from beambench_operations.nightly.calibration import (
    Effort,
    Noise,
    calibrate,
    count_alarms,
    noise_of_samples,
    share_interval,
    synthetic_nights,
)
from beambench_operations.nightly.home import Home
from beambench_report.base.files import Problem
from synthetic_nights import (
    NOISE,
    Row,
    add_all,
    counting,
    nothing,
    slower,
    write_night,
    write_nights,
    wrong,
)
from synthetic_run import without_times

NIGHTS = 30


@pytest.fixture
def home(tmp_path: Path) -> Home:
    return Home(tmp_path / "nightly")


def flat(told: list[list[Alarm]]) -> list[Alarm]:
    return [alarm for night in told for alarm in night]


def test_pure_noise_passes(home: Home) -> None:
    assert flat(add_all(home, write_nights(home, NIGHTS, nothing))) == []


def test_a_structure_slower_by_5_percent_in_one_scene_is_found_and_named_once(home: Home) -> None:
    plant = slower("exhaustive", "tetra:n=5", 1.05, 16)
    told = add_all(home, write_nights(home, NIGHTS, plant))
    [alarm] = flat(told)
    assert alarm.kind == "time"
    assert alarm.details["title"] == "exhaustive in tetra:n=5"
    assert alarm.details["low"] < 0.05 < alarm.details["high"]
    assert "20260114T030000Z" <= alarm.details["since_run"] <= "20260119T030000Z"
    assert alarm.details["last_good_commit"] < "0000010def5678"  # that of the first slow night
    assert alarm.details["since_commit"] >= "0000010def5678"
    assert alarm.night <= 29, "as soon as some twelve nights were slower"
    assert "exhaustive in tetra:n=5: +" in sentence(alarm)


def test_nights_from_before_blocks_are_compared_with_none(home: Home) -> None:
    slow, more = slower("exhaustive", "tetra:n=5", 1.5, 13), counting("samet", "escena1", [1] * 13)

    def plant(night: int, row: Row) -> Row:
        return slow(night, row) if night >= 13 else more(night, row | {"build_ms_median": 9.0})

    assert flat(add_all(home, write_nights(home, NIGHTS, plant, old=13))) == []


def test_nights_in_blocks_are_compared_after_those_from_before(home: Home) -> None:
    plant = slower("exhaustive", "tetra:n=5", 1.05, 16)
    folders = write_nights(home, NIGHTS + 4, lambda night, row: plant(night - 4, row), old=4)
    [alarm] = flat(add_all(home, folders))
    assert alarm.details["title"] == "exhaustive in tetra:n=5"
    assert alarm.details["nights_before"] <= 17, "none of the four is among them"


def test_a_night_before_blocks_has_no_alarm_but_of_wrong_hits(home: Home) -> None:
    more = counting("samet", "escena1", [1, 1.5, 1.5])
    bad = wrong("exhaustive", "tetra:n=5", 1)
    folders = write_nights(home, 3, lambda night, row: bad(night, more(night, row)), old=3)
    told = add_all(home, folders)
    assert [{alarm.kind for alarm in night} for night in told] == [set(), {"verdict"}, {"verdict"}]


def test_a_structure_that_got_faster_is_no_regression(home: Home) -> None:
    plant = slower("exhaustive", "tetra:n=5", 0.9, 16)
    assert flat(add_all(home, write_nights(home, NIGHTS, plant))) == []


def test_a_kind_of_rays_that_a_scene_has_none_of_raises_no_alarm(home: Home) -> None:
    def without_rays(_: int, row: Row) -> Row:
        return without_times(row, "no_rays") if row["scene"] == "tetra:n=5" else row

    assert flat(add_all(home, write_nights(home, 3, without_rays))) == []


def test_a_wrong_hit_is_found_and_named(home: Home) -> None:
    told = add_all(home, write_nights(home, 2, wrong("samet", "tetra:n=5", 1)))
    assert told[0] == []
    assert {alarm.kind for alarm in told[1]} == {"verdict"}
    assert len(told[1]) == 6
    sentences = [sentence(alarm) for alarm in told[1]]
    assert "samet max_level=6 in tetra:n=5 at 320x200: wrong hits (mismatch)" in sentences


@pytest.mark.parametrize(
    ("factors", "alarms"),
    [
        ([1, 1.02], [0, 6]),
        ([1, 1.0005], [0, 0]),
        ([1, 0.9], [0, 0]),
        ([1, 1.02, 1.02], [0, 6, 0]),  # reported once
        ([1, 1.02, 1.05], [0, 6, 6]),
        ([1, 1.0007, 1.0014], [0, 0, 6]),  # small steps add up
        ([1, 0.9, 1], [0, 0, 6]),  # an improvement must not be lost again
    ],
)
def test_more_work_is_found(home: Home, factors: list[float], alarms: list[int]) -> None:
    plant = counting("samet", "escena1", factors)
    told = add_all(home, write_nights(home, len(factors), plant))
    assert [len(night) for night in told] == alarms
    for alarm in flat(told):
        assert alarm.kind == "counter"
        assert alarm.series.startswith("samet max_level=")
        assert "escena1" in alarm.series
        assert alarm.details["counter"] == "traversal steps"


def test_another_scene_under_the_same_name_is_not_compared(home: Home) -> None:
    def plant(night: int, row: dict) -> dict:
        return row if night == 0 else {**row, "scene_hash": "9", "traversal_steps_per_ray": 99}

    assert flat(add_all(home, write_nights(home, 2, plant))) == []


def test_nights_of_another_machine_are_another_history(home: Home) -> None:
    def plant(night: int, row: dict) -> dict:
        return row if night == 0 else {**row, "machine_id": "b", "traversal_steps_per_ray": 99}

    assert flat(add_all(home, write_nights(home, 2, plant))) == []


def test_nights_of_another_processor_under_the_same_id_are_another_history(home: Home) -> None:
    def plant(night: int, row: dict) -> dict:
        return row if night == 0 else {**row, "traversal_steps_per_ray": 99}

    folders = write_nights(home, 2, plant)
    for folder, name in zip(folders, ("Xeon", "EPYC"), strict=True):
        manifest = json.loads((folder / "manifest.json").read_text())
        (folder / "manifest.json").write_text(json.dumps(manifest | {"machine": {"cpu": name}}))
    assert flat(add_all(home, folders)) == []


def noise(nights: int = 200, scenes: int = 3, size: float = 0.01) -> Noise:
    random = np.random.default_rng(3)
    return Noise(tuple(random.normal(0, size, (nights, 7)) for _ in range(scenes)), nights)


def test_a_hundred_nights_of_noise_over_all_series_raise_at_most_one_alarm() -> None:
    values = synthetic_nights(noise(), 100, np.random.default_rng(5))
    assert values.shape == (100, 105)
    assert len(count_alarms(values, Rule())) <= 1


def test_calibration_finds_what_is_large_and_counts_what_is_false() -> None:
    progress: list[str] = []
    effort = Effort(precision=0.001, trials=36)
    told = calibrate(noise(), 40, (0.001, 0.05), effort, report=progress.append)
    assert told.alarms == 0
    # None in 40 nights means at most 3.69 with 97.5% confidence (Poisson).
    assert (told.alarms_low, told.alarms_high) == pytest.approx((0, 3.689), abs=1e-3)
    assert [(one.found, one.trials) for one in told.power] == [(0.0, 36), (1.0, 36)]
    assert told.power[0].low == 0.0
    assert told.power[1].low == pytest.approx(36 / (36 + 1.959964**2))  # Wilson's, for all of n
    assert told.smallest_found == 0.05
    assert "100.0% of 36 trials (95% confidence interval 90.4% to 100.0%)" in told.summary()
    assert "0.0% to 9.6%)." in str(told.power[0])
    file = json.loads(told.as_json(), parse_constant=pytest.fail)  # NaN is not JSON
    assert [one["nights_until"] for one in file["power"]] == [None, told.power[1].nights_until]
    assert file["power"][1]["low"] == told.power[1].low


def test_trials_end_when_the_powers_are_known_well_enough() -> None:
    told = calibrate(noise(), 24, (0.0005, 0.08), Effort(precision=0.1, trials=500))
    # At shares of 0 and 1 Wilson's interval is 0.2 wide after 16 trials.
    assert {one.trials for one in told.power} == {16}
    assert all(one.high - one.low <= 0.2 for one in told.power)


def test_trials_end_when_the_time_is_up() -> None:
    told = calibrate(noise(), 24, (0.02,), Effort(precision=0.001, trials=10**6, seconds=0.5))
    assert 1 <= told.power[0].trials < 10**4


def test_a_larger_slow_down_is_never_found_less_often() -> None:
    """Every size is planted into the same noise: with few separate trials, chance would decide."""
    told = calibrate(noise(), 24, (0.01, 0.02, 0.03), Effort(precision=0.01, trials=10))
    found = [one.found for one in told.power]
    assert found == sorted(found)
    assert found[0] < found[-1]


@pytest.mark.parametrize(
    ("found", "trials", "low", "high"),
    # Newcombe, "Two-sided confidence intervals for the single proportion" (1998), table I
    [
        (81, 263, 0.2553, 0.3662),
        (15, 148, 0.0624, 0.1605),
        (0, 20, 0, 0.1611),
        (1, 29, 0.0061, 0.1718),
    ],
)
def test_the_interval_of_a_share_is_the_tabulated_one(
    found: int, trials: int, low: float, high: float
) -> None:
    assert share_interval(found, trials) == pytest.approx((low, high), abs=5e-5)


def test_nights_that_are_missing_are_no_reason_to_raise_or_to_fall_silent() -> None:
    random = np.random.default_rng(11)
    values = random.normal(0, 0.01, (50, 20))
    values[random.random(values.shape) < 0.1] = np.nan
    assert find_steps(values) == []
    values[30:, 4] += 0.06
    [step] = find_steps(values)
    assert step.series == 4
    assert 29 <= step.change <= 32


def test_an_earlier_gain_does_not_hide_a_later_loss() -> None:
    random = np.random.default_rng(12)
    values = random.normal(0, 0.01, (60, 5))
    values[20:, 2] -= 0.10
    values[42:, 2] += 0.05
    assert [step.series for step in find_steps(values)] == [2]


def test_noise_can_be_drawn_from_the_blocks_of_a_run(home: Home) -> None:
    random = np.random.default_rng(13)
    many, few = (
        write_night(home, place, random, nothing, blocks=count)
        for place, count in ((0, 40), (1, 4))
    )
    drawn = noise_of_samples([many, few])
    assert [scene.shape for scene in drawn.scenes] == [(200, 3)] * 2
    # Both times of a ratio vary; a night has eight blocks, and a scene three resolutions.
    expected = NOISE * np.sqrt(2 / 8 / 3)
    assert drawn.standard_deviation == pytest.approx(expected, rel=0.3)
    assert drawn.within == pytest.approx(expected, rel=0.3)
    with pytest.raises(Problem, match="8 blocks"):
        noise_of_samples([few])


def test_a_night_that_is_judged_again_raises_the_same(home: Home) -> None:
    folders = write_nights(home, NIGHTS, slower("exhaustive", "tetra:n=5", 1.08, 16))
    told = add_all(home, folders)
    [number] = [place for place, night in enumerate(told, 1) if night]
    with History(home.history) as history:
        assert find_alarms(history, number) == told[number - 1]


def test_a_faster_reference_is_doubted() -> None:
    alarms = [Alarm(1, "time", str(series), {}) for series in range(80)]
    assert doubt(alarms, 105).startswith("80 of 105 series got slower at once")
    assert doubt(alarms[:20], 105) == ""
    assert doubt(alarms[:4], 6) == ""
