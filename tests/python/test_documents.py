"""Help, completion, manual page, READMEs: their statements are true and complete."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from program import BINARY, beambench, output_of, shell

REPOSITORY = Path(__file__).resolve().parents[2]


def commands() -> list[str]:
    """Returns the subcommands listed by --help."""
    listed = output_of("--help").split("Subcommands:")[1].split("Examples:")[0]
    return re.findall(r"^  (\w+) ", listed, re.MULTILINE)


def options(command: str) -> list[str]:
    """Returns the options listed by a command's --help."""
    listed = output_of(command, "--help").split("Examples:")[0]
    return re.findall(r"^  (?:-\w,)?(--?[\w-]+)", listed, re.MULTILINE)


def examples(*command: str) -> list[str]:
    """Returns the example lines of a --help."""
    text = output_of(*command, "--help")
    assert "Examples:" in text
    return re.findall(r"^  (beambench .*)$", text.split("Examples:")[1], re.MULTILINE)


COMMANDS = commands()


def test_help_names_every_command_that_others_rely_on() -> None:
    wanted = {"list", "scene", "export", "render", "trace", "stats", "verify", "run"}
    assert wanted <= set(COMMANDS)


# The examples of these commands measure, draw large pictures or verify whole images, and take up to
# half a minute.
SLOW = {"time", "render", "report", "sampling", "verify", "census", "fingerprint"}


@pytest.mark.parametrize(
    "command",
    [
        pytest.param(command, marks=[pytest.mark.full] if command in SLOW else [])
        for command in ("", *COMMANDS)
    ],
)
def test_examples_work_when_they_are_pasted(tmp_path: Path, command: str) -> None:
    (tmp_path / "harness").symlink_to(REPOSITORY / "harness")
    lines = examples(*command.split())
    assert any(f"beambench {command}" in line for line in lines)
    for line in lines:
        done = shell(line, tmp_path)
        assert done.returncode == 0, f"{line}\n{done.stderr}"


# Completion


@pytest.fixture(scope="module")
def bash_words() -> str:
    return output_of("completion", "bash")


def completed(script: str, *words: str) -> list[str]:
    """Returns bash's completions of the last of the words."""
    line = (
        f'{script}\nCOMP_LINE="$*"; COMP_POINT=${{#COMP_LINE}}; COMP_WORDBREAKS=" :="; _beambench; '
        'printf "%s\\n" '
    )
    done = subprocess.run(
        ["bash", "-c", line + '"${COMPREPLY[@]}"', "bash", "beambench", *words],
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.split()


def test_bash_completes_every_command(bash_words: str) -> None:
    offered = completed(bash_words, "")
    assert set(COMMANDS) <= set(offered)
    assert completed(bash_words, "rend") == ["render"]


@pytest.mark.parametrize("command", COMMANDS)
def test_bash_completes_every_option(bash_words: str, command: str) -> None:
    wanted = options(command)
    assert "--help" in wanted
    assert set(wanted) <= set(completed(bash_words, command, "-"))


def test_bash_completes_names_and_leaves_files_to_the_shell(bash_words: str) -> None:
    assert "samet" in completed(bash_words, "render", "balls", "--accel", "")
    assert completed(bash_words, "render", "balls", "--accel", "sam")[0].startswith("samet")
    assert completed(bash_words, "scene", "tet") == ["tetera", "tetra"]
    assert completed(bash_words, "render", "balls", "--shade", "norm") == ["normals"]
    assert completed(bash_words, "render", "balls", "--overlay", "") == [
        "beams",
        "cells",
        "pencils",
    ]
    assert completed(bash_words, "render", "balls", "-o", "") == []
    assert completed(bash_words, "run", "") == []
    assert "complete -o default" in bash_words


def test_bash_completes_lists_and_parameters(bash_words: str) -> None:
    assert completed(bash_words, "verify", "--accel", "samet,sah") == ["samet,sah-bvh"]
    assert completed(bash_words, "time", "tetra", "--rays", "primary,sha") == ["primary,shadow"]
    # The shell itself keeps what comes before a colon.
    assert completed(bash_words, "render", "balls", "--accel", "samet:max_l") == ["max_level="]
    assert completed(bash_words, "verify", "--accel", "embree,samet:max_l") == ["max_level="]
    assert "samet:max_level=5,max_objects=".split(":")[1] in completed(
        bash_words, "verify", "--accel", "samet:max_level=5,max_o"
    )
    assert completed(bash_words, "scene", "tetra:") == ["n="]


def test_bash_completes_commands_after_a_plugin_and_leaves_its_file_to_the_shell(
    bash_words: str,
) -> None:
    assert completed(bash_words, "--plugin", "") == []
    assert completed(bash_words, "--plugin", "mine.so", "rend") == ["render"]
    assert completed(bash_words, "--plugin", "mine.so", "scene", "tetr") == ["tetra"]


@pytest.mark.skipif(shutil.which("fish") is None, reason="fish is not installed")
def test_fish_completes(tmp_path: Path) -> None:
    (tmp_path / "beambench.fish").write_text(output_of("completion", "fish"))

    def offered(line: str) -> list[str]:
        script = f"source beambench.fish; complete -C {line!r}"
        lines = shell(f'fish --no-config -c "{script}"', tmp_path).stdout.splitlines()
        return [line.split("\t")[0] for line in lines]

    assert set(COMMANDS) <= set(offered("beambench "))
    assert {"--pixel", "--json"} <= set(offered("beambench trace --"))
    assert "normals" in offered("beambench render --shade ")
    assert offered("beambench verify --accel samet,sah-b") == ["samet,sah-bvh"]
    assert offered("beambench time tetra --rays primary,sha") == ["primary,shadow"]
    for typed in ("samet:max_l", "embree,samet:max_l"):
        whole = typed.replace("max_l", "max_level=")
        assert offered(f"beambench verify --accel {typed}") == [whole]
    more = "samet:max_level=5,max_o"
    assert f"{more}bjects=" in offered(f"beambench verify --accel {more}")
    assert "tetra:n=" in offered("beambench scene tetra:")


@pytest.mark.skipif(shutil.which("zsh") is None, reason="zsh is not installed")
def test_zsh_reads_its_script(tmp_path: Path) -> None:
    (tmp_path / "_beambench").write_text(output_of("completion", "zsh"))
    line = "autoload -U compinit; compinit -u -D; source ./_beambench; print $_comps[beambench]"
    done = shell(f"zsh -f -c '{line}'", tmp_path)
    assert done.stderr == ""
    assert "_beambench" in done.stdout


# The manual page


def test_the_manual_names_every_command_and_option() -> None:
    page = output_of("man").replace("\\-", "-")
    for command in COMMANDS:
        section = page.split(f".SS beambench {command}\n")[1].split(".SS ")[0]
        for option in options(command):
            assert f"\\fB{option}\\fR" in section, (command, option)
        assert "Examples:" in section
    assert "\\fIVALUE\\fR" not in page
    assert "\\fIX,Y,Z\\fR" in page
    environment = page.split(".SH ENVIRONMENT\n")[1].split(".SH ")[0]
    assert "BEAMBENCH_MEMORY" in environment
    assert "BEAMBENCH_CACHE" in environment


@pytest.mark.skipif(
    shutil.which("groff") is None or shutil.which("col") is None,
    reason="groff or col is not installed",
)
def test_the_manual_is_right_roff(tmp_path: Path) -> None:
    (tmp_path / "beambench.1").write_text(output_of("man"))
    done = shell("groff -man -ww -Tascii -P-c -rLL=100n beambench.1 | col -b", tmp_path)
    assert done.stderr == ""
    assert "BEAMBENCH(1)" in done.stdout
    for line in examples("trace"):
        assert line in done.stdout


def test_install_brings_the_manual_and_the_completions(tmp_path: Path) -> None:
    build = BINARY.resolve().parents[1]
    if shutil.which("cmake") is None or not (build / "harness/written/beambench.1").exists():
        pytest.skip("not a build folder in which everything was built")
    done = shell(f"cmake --install {build} --prefix {tmp_path}", tmp_path)
    assert done.returncode == 0, done.stderr
    picture = ["render", "tetra:n=1", "--resolution", "8x8", "-o", tmp_path / "a.png"]
    subprocess.run([tmp_path / "bin/beambench", *picture], check=True, timeout=60)
    assert (tmp_path / "a.png").exists(), "the image encoder is installed beside the program"
    share = tmp_path / "share"
    assert (share / "man/man1/beambench.1").read_text() == output_of("man")
    scripts = {
        "bash": share / "bash-completion/completions/beambench",
        "zsh": share / "zsh/site-functions/_beambench",
        "fish": share / "fish/vendor_completions.d/beambench.fish",
    }
    for name, file in scripts.items():
        assert file.read_text() == output_of("completion", name)


def test_version_of_the_manual_is_that_of_the_program() -> None:
    version = beambench("--version").stdout.strip()
    assert version in output_of("man")


# READMEs


def anchors(text: str) -> set[str]:
    """Returns the headings of a text, as GitHub turns them into anchors."""
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_links_lead_somewhere() -> None:
    listed = shell("git ls-files --cached --others --exclude-standard '*.md'", REPOSITORY)
    texts = [REPOSITORY / name for name in listed.stdout.split() if (REPOSITORY / name).is_file()]
    if not texts:
        pytest.skip("this is not a repository")
    broken = []
    for text in texts:
        for link in re.findall(r"\]\(([^)\s]+)\)", text.read_text("utf-8")):
            path, _, anchor = link.partition("#")
            target = (text.parent / path).resolve() if path else text
            if link.startswith(("http://", "https://")):
                continue
            if not target.exists() or (anchor and anchor not in anchors(target.read_text("utf-8"))):
                broken.append(f"{text.relative_to(REPOSITORY)}: {link}")
        for file in re.findall(r"`([\w./-]+/[\w-]+\.(?:cpp|hpp|py))`", text.read_text("utf-8")):
            if not any((folder / file).exists() for folder in (REPOSITORY, text.parent)):
                broken.append(f"{text.relative_to(REPOSITORY)}: {file}")
    assert broken == []


def test_the_root_readme_is_an_entrance() -> None:
    text = (REPOSITORY / "README.md").read_text("utf-8")
    assert len(text.splitlines()) <= 150
    for structure in json.loads(output_of("list", "--json"))["structures"]:
        assert f"| `{structure['name']}` |" in text
