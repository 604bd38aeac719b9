"""Renders the parts of the cluster's page from templates."""

import re
from pathlib import Path

from beambench_thesis.paper.markdown import markdown_environment

_ENVIRONMENT = markdown_environment(Path(__file__).with_name("templates"))


def rendered(name: str, **values: object) -> str:
    """Returns the Markdown of templates/NAME.md.j2; each paragraph becomes one line."""
    text = _ENVIRONMENT.get_template(f"{name}.md.j2").render(values)
    joined = re.sub(r"^(?![|#!])(.+)\n(?=[^|#!\n])", r"\1 ", text, flags=re.MULTILINE)
    return re.sub(r"\n{3,}", "\n\n", joined)
