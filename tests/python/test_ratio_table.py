"""The table of every contender of a run relative to one of them."""

from pathlib import Path

import pytest

from beambench_report.__main__ import main
from synthetic_run import synthetic_rows, write_run


def a_run(folder: Path) -> Path:
    """Returns a run: two scenes, Embree, and samet at two levels, one of them wrong in a scene."""
    example = synthetic_rows()[0]
    times = {
        ("one", "embree", "mode=single"): 2.0,
        ("one", "samet", "max_level=5"): 4.0,
        ("one", "samet", "max_level=6"): 3.0,
        ("two", "embree", "mode=single"): 1.0,
        ("two", "samet", "max_level=5"): 2.0,
        ("two", "samet", "max_level=6"): None,
    }
    rows = [
        example
        | {"scene": scene, "structure": structure, "parameters": parameters}
        | {"verdict": "ok" if time else "mismatch", "structure_error": 0 if time else 3}
        | {"trace_net_ms_median": time, "build_ms_median": 7.0}
        for (scene, structure, parameters), time in times.items()
    ]
    write_run(folder, rows)
    return folder


def printed(run: Path, to: str, capsys: pytest.CaptureFixture[str]) -> str:
    assert main(["ratios", str(run), "--to", to]) == 0
    return capsys.readouterr().out


def test_ratios_are_to_a_contender(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = printed(a_run(tmp_path), "embree", capsys)
    assert "| build, ms; primary | `one` | `two` | all scenes |" in text
    assert "| `embree` | 7.00; 1.00 | 7.00; 1.00 | 1.000 |" in text
    assert "| `samet max_level=5` | 7.00; 2.00 | 7.00; 2.00 | 2.000 |" in text
    assert "| `samet max_level=6` | 7.00; 1.50 | -; wrong | - |" in text
    assert "5 of 6 cells have correct hits." in text
    assert "- `samet max_level=6` over `two`, primary: mismatch, 3 of " in text


def test_a_structure_stands_for_its_fastest_in_each_view(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = printed(a_run(tmp_path), "samet", capsys)
    assert "| `embree` | 7.00; 0.67 | 7.00; 0.50 | 0.577 |" in text
    assert "| `samet max_level=5` | 7.00; 1.33 | 7.00; 1.00 | 1.155 |" in text


def test_it_is_written_to_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run = a_run(tmp_path)
    text = printed(run, "samet", capsys)
    assert main(["ratios", str(run), "--to", "samet", "-o", str(tmp_path / "ratios.md")]) == 0
    assert (tmp_path / "ratios.md").read_text() == text


def test_an_unknown_base_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["ratios", str(a_run(tmp_path)), "--to", "smaet"]) == 2
    assert "no contender or structure 'smaet' has correct hits; there are: embree" in (
        capsys.readouterr().err
    )
