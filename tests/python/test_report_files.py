"""The report writers' handling of links, pipes and folders."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from beambench_report.base.files import write_text


def test_a_file_is_replaced_whole(tmp_path: Path) -> None:
    file = tmp_path / "a.txt"
    assert write_text(file, "old") == file
    assert write_text(file, "new") == file
    assert file.read_text() == "new"
    assert list(tmp_path.iterdir()) == [file]


def test_a_link_stays_and_what_it_leads_to_is_replaced(tmp_path: Path) -> None:
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    link = tmp_path / "a.txt"
    link.symlink_to("elsewhere/b.txt")
    for text in ("new", "newer"):  # first the link is dangling
        assert write_text(link, text) == link
        assert link.is_symlink()
        assert (folder / "b.txt").read_text() == text
    assert list(folder.iterdir()) == [folder / "b.txt"]


def test_a_named_pipe_is_written_into(tmp_path: Path) -> None:
    pipe = tmp_path / "a.txt"
    os.mkfifo(pipe)
    read: list[str] = []
    reader = threading.Thread(target=lambda: read.append(pipe.read_text()), daemon=True)
    reader.start()
    write_text(pipe, "text")
    reader.join(timeout=5)
    assert read == ["text"]
    assert stat.S_ISFIFO(pipe.stat().st_mode)


def test_a_folder_is_not_replaced(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="directory"):
        write_text(tmp_path, "text")
    assert list(tmp_path.iterdir()) == []


def test_progress_that_cannot_be_written_ends_nothing() -> None:
    code = "from beambench_report.base.files import say; say('a'); say('b'); print('done')"
    with Path("/dev/full").open("w") as full:
        ended = subprocess.run(
            [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=full, check=False
        )
    assert (ended.returncode, ended.stdout) == (0, b"done\n")
