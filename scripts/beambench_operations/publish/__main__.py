"""The command line of scripts/publish."""

import signal
import sys
from dataclasses import replace
from pathlib import Path

from beambench_operations.publish.documents import PUBLISHED, differences, write_documents
from beambench_operations.publish.make import Place, make_folder
from beambench_operations.publish.needs import Debian13, missing, plugins_for
from beambench_operations.publish.plan import Folder, Plan, as_table, read_plan
from beambench_operations.publish.plots import write_plots
from beambench_operations.publish.progress import Progress, extent_of, is_published, progress_of
from beambench_operations.publish.provenance import Provenance, git, preflight, require_clean
from beambench_operations.publish.small import size
from beambench_operations.publish.verified_again import verify_again, write_summary
from beambench_operations.site.write import write_site
from beambench_report.base.command_line import BEAMBENCH, Options, ScriptParser
from beambench_report.base.files import ROOT, Problem, load_json, say
from beambench_report.base.quantities import size_in_words

_ASIDE = ROOT / "results/runs/publish"


def main(arguments: list[str]) -> int:
    """Runs the command line; returns the exit code."""
    parser = ScriptParser("publish")
    parser.add_argument("--only", nargs="+", default=[], metavar="FOLDER")
    parser.add_argument("--plan", "--dry-run", action="store_true")
    parser.add_argument("--texts", action="store_true")
    parser.add_argument("--plots", action="store_true")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--verify-again", action="store_true")
    parser.add_argument("--commit", action="store_true")
    parser.add_argument("--tinybvh", type=Path, metavar="DIR")
    parser.add_argument("--madmann91-bvh", type=Path, metavar="DIR")
    parser.add_argument("--debian-13", type=Path, metavar="DIR")
    parser.add_argument("--aside", type=Path, default=_ASIDE, metavar="DIR")
    parser.add_argument("--published", type=Path, default=PUBLISHED, metavar="DIR")
    parser.add_argument("--beambench", type=Path, default=BEAMBENCH, metavar="PROGRAM")
    interrupted = "interrupted; on this machine, the same command continues from here"
    return parser.run(_run, arguments, interrupted)


def _run(options: Options) -> int:
    for name in ("aside", "published", "beambench"):
        setattr(options, name, getattr(options, name).absolute())
    plan = read_plan().only(options.only)
    if options.check:
        found = differences(options.published)
        print(*found, sep="\n", end="\n" if found else "")
        return 1 if found else 0
    if options.texts or options.plots:
        write = write_documents if options.texts else write_plots
        for path in write(options.published):
            print(path)
        return 0
    if options.verify_again:
        return _verify_again(options)
    if options.plan:
        provenance = preflight(options.beambench) if options.beambench.is_file() else None
        extents = {one.name: extent_of(options.published / one.name) for one in plan.folders}
        states = {
            one.name: _state(one, options, provenance) or _begun(one, options, provenance)
            for one in plan.folders
            if provenance
        }
        print(as_table(plan, states, extents))
        return 0
    return _make(plan, options, preflight(options.beambench))


def _verify_again(options: Options) -> int:
    """Verifies all committed cells; writes the differences to results/published."""
    commit = preflight(options.beambench).commit
    record = options.aside.parent / f"verified-again-{commit[:12]}.jsonl"
    lines = verify_again(options.published, options.beambench, record)
    path = write_summary(options.published / "verified-again.json", lines, commit)
    found = load_json(path)
    for name in ("hashes_changed", "verdicts_changed", "classes_changed"):
        say(f"{name.replace('_', ' ')}: {len(found[name])}")
    say(f"{found['cells']} cells of {found['views']} views; the list is {path}")
    wrong = [one for one in found["verdicts_changed"] if one["now"]["verdict"] != "ok"]
    return 1 if wrong else 0


def _state(folder: Folder, options: Options, provenance: Provenance) -> str:
    """Returns why a folder is skipped: it is complete, or left as it is; empty if it is made."""
    if is_published(options.published / folder.name, provenance):
        return "complete"
    lack = missing(folder, options, provenance)
    return f"left as it is: {lack}" if lack else ""


def _begun(folder: Folder, options: Options, provenance: Provenance) -> str:
    begun = progress_of(options.aside / folder.name_aside, provenance)
    return f"{len(begun.seconds)} of {len(folder.steps)} steps are done" if begun else ""


def _make(plan: Plan, options: Options, provenance: Provenance) -> int:
    require_clean(provenance)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    say(f"Commit {provenance.commit[:7]} on {provenance.cpu}, {provenance.cores} cores")
    for warning in provenance.warnings:
        say(f"warning: {warning}")
    wrong = False
    for folder in plan.folders:
        if state := _state(folder, options, provenance):
            say(f"== {folder.name} is {state}")
        else:
            progress = _made(folder, options)
            has_texts = _write_texts(options.published)
            wrong = wrong or bool(progress.wrong) or not has_texts
            _commit(folder, provenance, options)
    site = write_site([options.published], options.aside / "site", beambench=options.beambench)
    say(f"{size_in_words(size(options.published))} are published; look at {site}")
    return 1 if wrong else 0


def _write_texts(published: Path) -> bool:
    """Writes the texts; returns whether their sentences hold for the new rows."""
    try:
        write_documents(published)
    except Problem as problem:
        say(f"the texts were not written: {problem}; edit it, then: scripts/publish --texts")
        return False
    return True


def _made(folder: Folder, options: Options) -> Progress:
    provenance = preflight(options.beambench)
    for warning in provenance.warnings:
        say(f"warning before {folder.name}: {warning}")
    place = Place(options.aside, options.published, options.beambench)
    if folder.needs == "libraries":
        place = replace(place, plugins=plugins_for(options))
    if folder.needs == "debian-13" and options.debian_13:
        system = Debian13(options.debian_13, provenance.commit)
        place = replace(place, run=lambda command, _: system.run(command, options.aside))
    return make_folder(folder, place, provenance)


def _commit(folder: Folder, provenance: Provenance, options: Options) -> None:
    relative = options.published.relative_to(ROOT)
    words = f"Published: {folder.name} ({provenance.commit[:7]})"
    if options.commit:
        git("add", "--all", "--", str(relative))
        git("commit", "--quiet", "-m", words)
        say(f"committed: {words}")
    else:
        say(f'to commit: git add --all {relative} && git commit -m "{words}"')


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
