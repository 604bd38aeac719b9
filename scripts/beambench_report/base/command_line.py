"""The commands of beambench_report, beambench_thesis and beambench_operations."""

import argparse
from collections.abc import Callable
from pathlib import Path

from beambench_report.base.files import ROOT, Problem, say

PROGRAMS = ROOT / "build/release/bin"
BEAMBENCH = PROGRAMS / "beambench"

Options = argparse.Namespace
Result = int | str | list[Path]
"""What a command returns: its exit code, a text to be printed, or the files that it wrote."""
Commands = argparse._SubParsersAction
AddArgument = Callable[..., argparse.Action]


def add_command(
    commands: Commands, name: str, handler: Callable[[Options], Result], **words: str
) -> AddArgument:
    """Adds a command; returns the function that adds its arguments."""
    command = commands.add_parser(name, **words)
    command.set_defaults(handler=handler)
    return command.add_argument


def run_command(parser: argparse.ArgumentParser, arguments: list[str] | None) -> int:
    """Runs the command in `arguments`, those of the process if None.

    Returns the exit code: 2 for invalid arguments or input.
    """
    options = parser.parse_args(arguments)
    try:
        result: Result = options.handler(options)
    except Problem as problem:
        say(f"error: {problem}")
        return 2
    except OSError as error:
        say(f"error: {error.filename}: {error.strerror}")
        return 2
    if isinstance(result, int):
        return result
    print(result if isinstance(result, str) else "".join(f"{path}\n" for path in result), end="")
    return 0
