"""The commands of the packages of scripts/."""

from __future__ import annotations

import pytest

from beambench_report.__main__ import main


@pytest.mark.parametrize(
    ("former", "present"),
    [
        ("beat", "beambench_report embree-comparison"),
        ("ledger", "beambench_thesis claims"),
        ("levels", "beambench_thesis levels"),
        ("benchmarks --format google-benchmark", "beambench_operations benchmarks"),
    ],
)
def test_a_former_command_works_with_a_warning(
    former: str, present: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*former.split(), "/nowhere"]) == 2
    warning, error = capsys.readouterr().err.splitlines()
    assert warning == f"warning: the command '{former.split()[0]}' is now: python -m {present}"
    assert error.startswith("error: /nowhere")
