"""Changes of the program between two runs, from git, if this is a repository."""

import re
import subprocess
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

from beambench_report.base.files import ROOT

_HASH = re.compile(r"[0-9a-f]{7,40}")
# https://[user[:password]@]host/path.git, ssh://[user@]host/path.git or [user@]host:path.git
_ADDRESS = re.compile(
    r"(?:https://|ssh://)?(?:[^@/]+@)?(?P<host>[\w.-]+)(?::\d+/|[:/])(?P<path>[\w./~-]+?)(?:\.git)?/?"
)
_MOST = 20


def web_address(origin: str) -> str:
    """Returns the address of a repository on GitHub or GitLab, without credentials; or empty."""
    found = _ADDRESS.fullmatch(origin.strip())
    if not found or not {"github", "gitlab"} & set(found["host"].split(".")):
        return ""
    return f"https://{found['host']}/{found['path'].strip('/')}"


@dataclass(frozen=True)
class Change:
    """The change from one commit to another."""

    subjects: tuple[str, ...]
    """The subjects of at most twenty commits between them, the newest first."""
    url: str
    """The web page that shows the difference; may be empty."""
    command: str
    """The command that shows it in a clone."""


@dataclass(frozen=True)
class Repository:
    """A clone; commits that it lacks have no subject."""

    folder: Path = ROOT

    @cached_property
    def url(self) -> str:
        """The web address of its origin; empty if there is none."""
        return web_address(self._git("remote", "get-url", "origin"))

    def commit_url(self, commit: str) -> str:
        """Returns the address of the page of a commit."""
        return f"{self._pages}/commit/{commit}" if self.url and _HASH.fullmatch(commit) else ""

    def subject(self, commit: str) -> str:
        """Returns the first line of a commit's message."""
        return self._git("log", "-1", "--format=%s", commit, "--") if self._known(commit) else ""

    def change(self, before: str, after: str) -> Change | None:
        """Returns the change between two commits; None if they are equal or one is not a hash."""
        if before == after or not _HASH.fullmatch(before) or not _HASH.fullmatch(after):
            return None
        log = ""
        if self._known(before) and self._known(after):
            log = self._git("log", f"-{_MOST}", "--format=%h %s", f"{before}..{after}", "--")
        url = f"{self._pages}/compare/{before}...{after}" if self.url else ""
        command = f"git log -p {before[:12]}..{after[:12]}"
        return Change(tuple(log.splitlines()), url, command)

    @property
    def _pages(self) -> str:
        return f"{self.url}/-" if "gitlab" in self.url else self.url

    def _known(self, commit: str) -> bool:
        return bool(_HASH.fullmatch(commit)) and self._git("cat-file", "-t", commit) == "commit"

    def _git(self, *arguments: str) -> str:
        return _output_of("git", "-C", str(self.folder), *arguments)


@cache  # many runs have the same commit
def _output_of(*command: str) -> str:
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError:
        return ""
    return done.stdout.strip() if done.returncode == 0 else ""
