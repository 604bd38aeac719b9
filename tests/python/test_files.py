"""Files that cannot be read completely, and output to links, pipes and devices."""

from __future__ import annotations

import json
import os
import resource
import shutil
import stat
import subprocess
import threading
from pathlib import Path

import pytest

from program import BINARY, beambench, refused

SPHERES = 3000
VERIFY = ["verify", "balls:n=1", "--accel", "samet", "--resolution", "8x8", "--json"]
RENDER = ["render", "balls:n=1", "--accel", "samet", "--resolution", "8x8", "-o"]
EXPORT = ["export", "balls:n=1", "-o"]
RAYS = ["rays", "balls:n=1", "--resolution", "8x8", "-o"]

# A failing disk: read() of the file FAULTY fails with EIO after 20 kB.
FAULTY_READ = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

ssize_t read(int file, void* buffer, size_t size) {
  static ssize_t (*real)(int, void*, size_t);
  static size_t given;
  char link[64];
  char name[4096];
  if (!real) real = dlsym(RTLD_NEXT, "read");
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = readlink(link, name, sizeof name - 1);
  if (length < 0) return real(file, buffer, size);
  name[length] = '\0';
  if (strcmp(name, getenv("FAULTY")) != 0) return real(file, buffer, size);
  if (given >= 20000) {
    errno = EIO;
    return -1;
  }
  const ssize_t count = real(file, buffer, size < 20000 - given ? size : 20000 - given);
  if (count > 0) given += (size_t)count;
  return count;
}
"""


@pytest.fixture(scope="module")
def faulty_disk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A library to be loaded before the program's own libraries."""
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler")
    folder = tmp_path_factory.mktemp("faulty")
    (folder / "read.c").write_text(FAULTY_READ)
    library = folder / "read.so"
    subprocess.run(
        [compiler, "-shared", "-fPIC", "-o", library, folder / "read.c", "-ldl"], check=True
    )
    return library


def read_from_faulty_disk(
    library: Path, file: Path, *arguments: str
) -> subprocess.CompletedProcess[str]:
    """Runs the program while reading the file fails halfway."""
    return subprocess.run(
        [BINARY, *arguments],
        env={**os.environ, "LD_PRELOAD": str(library), "FAULTY": str(file)},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


# Reading


def test_a_scene_cut_by_an_input_error_is_refused(faulty_disk: Path, tmp_path: Path) -> None:
    file = tmp_path / "many.nff"
    file.write_text("".join(f"s {i} 0 0 0.25       \n" for i in range(SPHERES)))
    done = read_from_faulty_disk(faulty_disk, file, "scene", str(file))
    refused(done, [str(file), "Input/output error"])


@pytest.mark.parametrize(
    ("name", "text", "arguments"),
    [
        ("sweep.json", '{"name": "x"}' + " " * 40000, ["run", "FILE", "-o", "OUT"]),
        ("many.ply", "ply\nformat ascii 1.0\n" + "comment x\n" * 4000, ["scene", "FILE"]),
        (
            "some.rays",
            'beambench-rays 1\n{"query": "any", "rays": 1000}\n' + "\0" * 32000,
            ["stats", "balls:n=1", "--accel", "samet", "--rays", "FILE"],
        ),
    ],
    ids=lambda value: value if isinstance(value, str) and "." in value[:12] else "",
)
def test_other_input_cut_by_an_input_error_is_refused(
    faulty_disk: Path, tmp_path: Path, name: str, text: str, arguments: list[str]
) -> None:
    file = tmp_path / name
    file.write_text(text)
    places = {"FILE": str(file), "OUT": str(tmp_path / "out")}
    done = read_from_faulty_disk(
        faulty_disk, file, *(places.get(argument, argument) for argument in arguments)
    )
    refused(done, [str(file), "Input/output error"])


def test_a_scene_that_does_not_fit_into_the_memory_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "large.nff"
    with file.open("wb") as large:  # spaces between the spheres, most of them in a hole of the file
        large.write(b"s 0 0 0 1\n")
        large.seek(3 << 30)
        large.write(b"\ns 3 0 0 1\n")

    def limit_memory() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))

    done = subprocess.run(
        [BINARY, "scene", file],
        preexec_fn=limit_memory,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    refused(done, [str(file), "out of memory"])


def test_a_scene_can_come_through_a_pipe() -> None:
    done = subprocess.run(
        [BINARY, "scene", "/dev/stdin", "--json"],
        input="s 0 0 0 1\ns 3 0 0 1\n",
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["spheres"] == 2


# Writing

WRITERS = [
    pytest.param(VERIFY, "a.json", id="verify"),
    pytest.param(RENDER, "a.png", id="render"),
    pytest.param(RENDER, "a.exr", id="render-exr"),
    pytest.param(EXPORT, "a.nff", id="export"),
    pytest.param(RAYS, "a.rays", id="rays"),
]


@pytest.mark.parametrize(("command", "name"), WRITERS)
def test_output_to_a_link_replaces_what_it_points_at(
    tmp_path: Path, command: list[str], name: str
) -> None:
    target = tmp_path / "elsewhere" / "target"
    target.parent.mkdir()
    target.write_text("old")
    link = tmp_path / name
    link.symlink_to("elsewhere/target")
    done = beambench(*command, link)
    assert done.returncode == 0, done.stderr
    assert link.is_symlink()
    assert target.stat().st_size > 3
    assert sorted(tmp_path.iterdir()) == sorted([link, target.parent])
    assert list(target.parent.iterdir()) == [target], "nothing is left behind"


def test_output_to_a_dangling_link_makes_what_it_points_at(tmp_path: Path) -> None:
    link = tmp_path / "a.json"
    link.symlink_to("b.json")
    (tmp_path / "b.json").symlink_to("c.json")
    assert beambench(*VERIFY, link).returncode == 0
    assert link.is_symlink()
    assert (tmp_path / "b.json").is_symlink()
    assert json.loads((tmp_path / "c.json").read_text())["passed"]


def test_links_that_lead_nowhere_are_refused(tmp_path: Path) -> None:
    (tmp_path / "round.json").symlink_to("round.json")
    refused(beambench(*VERIFY, tmp_path / "round.json"), ["round.json", "symbolic links"])
    (tmp_path / "lost.json").symlink_to("no/such/folder.json")
    refused(beambench(*VERIFY, tmp_path / "lost.json"), ["lost.json", "does not exist"])
    (tmp_path / "folder.json").symlink_to(".")
    refused(beambench(*VERIFY, tmp_path / "folder.json"), ["folder.json", "folder"])


@pytest.mark.parametrize(("command", "name"), WRITERS)
def test_output_to_a_named_pipe_reaches_its_reader(
    tmp_path: Path, command: list[str], name: str
) -> None:
    pipe = tmp_path / name
    os.mkfifo(pipe)
    read: list[bytes] = []
    reader = threading.Thread(target=lambda: read.append(pipe.read_bytes()), daemon=True)
    reader.start()
    done = beambench(*command, pipe)
    assert done.returncode == 0, done.stderr
    reader.join(timeout=5)
    assert read, "nothing came through the pipe"
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    plain = tmp_path / "plain" / name
    plain.parent.mkdir()
    assert beambench(*command, plain).returncode == 0
    if name not in ("a.exr", "a.json"):  # these contain a time
        assert read == [plain.read_bytes()]
    else:
        assert len(read[0]) > 100


def device_node(path: Path, minor: int) -> Path:
    """Creates a memory device in the test's folder: a bug would replace the system's own."""
    try:
        os.mknod(path, 0o666 | stat.S_IFCHR, os.makedev(1, minor))
        path.open("w").close()
    except PermissionError:
        pytest.skip("only root may make device nodes, and may not everywhere")
    return path


def test_output_to_a_device_leaves_the_device(tmp_path: Path) -> None:
    device = device_node(tmp_path / "null.json", 3)
    done = beambench(*VERIFY, device)
    assert done.returncode == 0, done.stderr
    assert stat.S_ISCHR(device.stat().st_mode)
    assert list(tmp_path.iterdir()) == [device]


def test_output_to_a_full_device_is_reported(tmp_path: Path) -> None:
    device = device_node(tmp_path / "full.json", 7)
    done = beambench(*VERIFY, device)
    assert done.returncode == 2, done.stderr
    assert f"cannot write '{device}': No space left on device" in done.stderr
    assert stat.S_ISCHR(device.stat().st_mode)


def test_output_to_the_standard_output_comes_behind_what_is_printed(tmp_path: Path) -> None:
    link = tmp_path / "stdout.json"  # like /dev/stdout
    link.symlink_to("/proc/self/fd/1")
    done = beambench(*VERIFY, link)
    assert done.returncode == 0, done.stderr
    assert '"passed": true' in done.stdout
    file = tmp_path / "out.txt"
    with file.open("w") as out:
        print("before", file=out, flush=True)
        subprocess.run([BINARY, *VERIFY, link], stdout=out, check=True, timeout=120)
    assert file.read_text() == "before\n" + done.stdout
    assert link.is_symlink()
