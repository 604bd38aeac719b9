"""Renders Markdown from templates."""

from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from beambench_report.base.quantities import number


def markdown_environment(folder: Path) -> Environment:
    """Returns the environment of the Markdown templates in a folder; nothing is escaped."""
    made = Environment(
        loader=FileSystemLoader(folder),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    made.filters |= {"number": number, "table": "\n".join}
    return made
