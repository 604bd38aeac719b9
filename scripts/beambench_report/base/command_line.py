"""The commands of beambench_report, beambench_thesis and beambench_operations."""

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import NoReturn

from beambench_report.base.files import ROOT, Problem, say

PROGRAMS = ROOT / "build/release/bin"
BEAMBENCH = PROGRAMS / "beambench"

Options = argparse.Namespace
Result = int | str | list[Path]
"""The result of a command: its exit code, a text to print, or the files that it wrote."""
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
    """Runs the command in `arguments` (default: the arguments of the process).

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


class ScriptParser(argparse.ArgumentParser):
    """An argument parser for a program in scripts/ that prints its own --help."""

    def __init__(self, name: str) -> None:
        """Creates a parser without arguments."""
        super().__init__(f"scripts/{name}", add_help=False, allow_abbrev=False)

    def error(self, message: str) -> NoReturn:
        """Raises Problem with the message."""
        raise Problem(message)

    def run(self, work: Callable[[Options], int], arguments: list[str], interrupted: str) -> int:
        """Runs `work`; returns its exit code, 2 for invalid input, or 130 after Ctrl-C.

        After Ctrl-C it prints the sentence `interrupted`.
        """
        try:
            return work(self.parse_args(arguments))
        except Problem as problem:
            say(f"error: {problem} (see {self.prog} --help)")
            return 2
        except KeyboardInterrupt:
            say(interrupted)
            return 130
