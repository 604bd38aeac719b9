"""The one definition rule: no two types of the program share a name.

Two different definitions of a type in one program are undefined behavior that no compiler reports:
the linker keeps one of the two sets of inline functions. Types in anonymous namespaces belong only
to their file.
"""

from __future__ import annotations

import re
from collections import defaultdict
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
FOLDERS = ("accel", "harness", "scenes", "tests")
# Alternative definitions, of which the preprocessor selects one.
ALTERNATIVES = {
    "beambench::accel::embree::Context": {"accel/embree_api/api3.hpp", "accel/embree_api/api4.hpp"}
}

NOT_CODE = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"'
    r"|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'|^[ \t]*\#(?:\\\n|[^\n])*",
    re.DOTALL | re.MULTILINE,
)
NAMESPACE = re.compile(r"\bnamespace\b(?:\s*\[\[.*?\]\])?\s*(?P<name>[\w:]*)\s*$")
TYPE = re.compile(
    r"\b(?:struct|class|union|enum(?:\s+(?:struct|class))?)\b"
    r"(?:\s*(?:\[\[.*?\]\]|alignas\s*\([^)]*\)))*\s+(?P<name>\w+)(?:\s+final)?(?:\s*:[^:].*)?\s*$",
    re.DOTALL,
)
TEMPLATE = re.compile(r"\btemplate\s*<(?:[^<>]|<[^<>]*>)*>")


def defined_types(source: str) -> set[str]:
    """Returns the types that a C++ source defines in named namespaces, with their scopes."""
    found: set[str] = set()
    scopes: list[str | None] = []  # names of namespaces; None for everything else, including
    # anonymous ones
    head = ""
    for piece in re.split(r"([{};])", NOT_CODE.sub(" ", source)):
        if piece == "{":
            namespace = NAMESPACE.search(head)
            made = TYPE.search(TEMPLATE.sub(" ", head))
            if made and None not in scopes:
                found.add("::".join([*(scope for scope in scopes if scope), made["name"]]))
            if namespace:
                scopes.append(namespace["name"] or None)
            else:
                scopes.append(None if head.split()[:1] != ["extern"] else "")
        elif piece == "}":
            assert scopes, "a brace is closed that was not opened"
            scopes.pop()
        head = piece if piece not in ("{", "}", ";") else ""
    assert not scopes, "a brace is not closed"
    return found


def clashes(sources: dict[str, str]) -> dict[str, set[str]]:
    """Returns the types defined in several of the sources (by path)."""
    files: dict[str, set[str]] = defaultdict(set)
    for path, source in sources.items():
        for name in defined_types(source):
            files[name].add(path)
    return {name: where for name, where in files.items() if len(where) > 1}


def sources_of_the_program() -> dict[str, str]:
    return {
        path.relative_to(REPOSITORY).as_posix(): path.read_text(encoding="utf-8")
        for folder in FOLDERS
        for path in sorted((REPOSITORY / folder).rglob("*"))
        if path.suffix in (".hpp", ".cpp")
    }


def test_every_type_has_a_name_of_its_own() -> None:
    assert clashes(sources_of_the_program()) == ALTERNATIVES


def test_the_scan_finds_the_types_of_the_program() -> None:
    sources = sources_of_the_program()
    assert "beambench::scenes::Scene" in defined_types(sources["scenes/scene.hpp"])
    assert "beambench::accel::Accelerator" in defined_types(sources["accel/core/accelerator.hpp"])
    assert len({name for source in sources.values() for name in defined_types(source)}) > 300


def test_two_definitions_of_one_name_are_found() -> None:
    line = "namespace a { struct Line final : Base<int> { int x; }; }"
    template = "namespace a { template <class T, std::size_t n = 2> class Line { T x; }; }"
    enum = "namespace a::b { } namespace a { enum class Line : std::uint8_t { kOne }; }"
    assert clashes({"1": line, "2": template}) == {"a::Line": {"1", "2"}}
    assert clashes({"1": line, "2": enum}) == {"a::Line": {"1", "2"}}


def test_types_of_other_scopes_do_not_clash() -> None:
    line = "namespace a { struct Line { int x; }; }"
    others = [
        "namespace a { namespace { struct Line { int x; }; } }",
        "namespace b { struct Line { int x; }; }",
        "namespace a { class Outer { struct Line { int x; }; }; }",
        "namespace a { inline int f() { struct Line { int x; }; return 1'000; } }",
        "namespace a { struct Line; void f(struct Line line); }  // struct Line {",
        'namespace a { const char* text = R"(struct Line {)"; }',
    ]
    for other in others:
        assert clashes({"1": line, "2": other}) == {}, other
