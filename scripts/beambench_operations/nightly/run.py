"""Runs one night: measures, records, tests for regressions, and reports."""

from datetime import UTC, datetime, timedelta
from pathlib import Path

from beambench_operations.history.alarms import doubt, find_alarms, sentence
from beambench_operations.history.night import night_of
from beambench_operations.history.nights import read_nights
from beambench_operations.history.store import History, rebuild
from beambench_operations.nightly.exports import write_exports
from beambench_operations.nightly.home import Home, abandon, is_finished, prune
from beambench_operations.nightly.mismatches import picture_mismatches
from beambench_operations.site.write import write_site
from beambench_report.base.command_line import Options
from beambench_report.base.files import INTERRUPTED, Problem, load_json, run_in_foreground, say
from beambench_report.base.records import read_run
from beambench_report.base.run_log import has_log


def run_night(options: Options, lock: int) -> int:
    """Measures and reports a night; returns 1 if anything regressed or was wrong.

    `lock` is the descriptor of the lock that keeps other runs away.
    """
    catch_up(options.home)
    folder = _folder_for(options)
    resumed = options.resume and has_log(folder)
    arguments = ["--resume", folder] if resumed else [options.sweep, "-o", folder]
    command = [str(part) for part in (options.beambench, "run", *arguments)]
    code = run_in_foreground(command, pass_fds=(lock,))
    if code in INTERRUPTED:
        say("interrupted; resume with: scripts/nightly --resume (or the next run abandons it)")
        return 130
    if code not in (0, 1) or not is_finished(folder):
        raise Problem(f"{folder}: the sweep could not be run (see above); nothing was recorded")
    return record(options, folder)


def record(options: Options, folder: Path) -> int:
    """Adds a finished run to the history, writes the site, prints alarms; returns the exit code.

    The options are `home`, `beambench`, `published` and `keep`.
    """
    home = options.home
    run = read_run(folder)
    night = night_of(run)
    picture_mismatches(run, options.beambench)
    write_exports(run)
    with History(home.history) as history:
        history.add(night, folder, find_alarms)
        number = history.number_of(night.run_id)
        alarms = [alarm for alarm in history.alarms() if alarm.night == number]
        series = len(read_nights(history, number).pools)
    prune(home, options.keep)
    write_site([home.folder], home.site, options.published)
    if doubtful := doubt(alarms, series):
        say(doubtful)
    for alarm in alarms:
        say(f"REGRESSION {sentence(alarm)}" if alarm.kind != "verdict" else sentence(alarm))
    print(home.page)
    return 1 if alarms else 0


def catch_up(home: Home) -> None:
    """Adds finished runs whose process was killed before they entered the history."""
    with History(home.history) as history:
        known = {folder for (folder,) in history.read("SELECT folder FROM nights")}
        for folder in home.finished():
            if folder.name in known:
                continue
            try:
                night = night_of(read_run(folder))
            except Problem as problem:
                say(f"left out of the history: {problem}")
                continue
            history.add(night, folder, find_alarms)


def rebuild_history(home: Home) -> int:
    """Rebuilds the history from the CSVs; returns its number of nights."""
    return rebuild(home.history, home.finished(), find_alarms)


def describe(options: Options) -> str:
    """Describes what a night would do."""
    sweep = load_json(options.sweep)
    runs = options.home.finished()
    lines = [
        f"sweep      {options.sweep} ({sweep.get('budget_seconds', 0) / 60:.0f} min)",
        f"           {sweep.get('description', '')}",
        f"history    {options.home.history} ({len(runs)} nights)",
        f"page       {options.home.page}",
    ]
    for run in options.home.unfinished():
        what = "would be resumed" if options.resume else "would be abandoned"
        lines.append(f"cut off    {run} ({what})")
    return "\n".join(lines) + "\n"


def _folder_for(options: Options) -> Path:
    """Returns the run to resume, or a new one after renaming interrupted runs."""
    unfinished = options.home.unfinished()
    if options.resume:
        if not unfinished:
            raise Problem(f"{options.home.folder}: no run was cut off; leave out --resume")
        return unfinished[-1]
    for run in unfinished:
        say(f"== {run.name} was cut off: abandoned")
        abandon(run)
    return _free_folder(options.home.folder, datetime.now(UTC))


def _free_folder(home: Path, time: datetime) -> Path:
    """Returns a folder named after this time, or after the first later second that is free."""
    folder = home / time.strftime("%Y%m%dT%H%M%SZ")
    return _free_folder(home, time + timedelta(seconds=1)) if folder.exists() else folder
