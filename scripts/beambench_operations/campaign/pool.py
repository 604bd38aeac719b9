"""Runs pieces, several at once, until the time is up."""

import time
from collections.abc import Callable, Collection
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait

from beambench_operations.campaign.piece import Piece, Task
from beambench_operations.campaign.programs import Programs
from beambench_operations.campaign.record import Record
from beambench_report.base.files import say

_SILENCE = 30.0  # longest time in seconds without a message

Choose = Callable[[Collection[str]], Task]
"""A function that returns the next task, given the subjects in progress."""


def do_pieces(
    choose: Choose, record: Record, programs: Programs, seconds: float, jobs: int
) -> list[Piece]:
    """Records each piece when it is done and returns all of them; starts at least one.

    Pieces in progress when the time is up are finished. If an exception such as a keyboard
    interrupt ends the call, the pieces in progress are stopped and not counted.
    """
    end = time.monotonic() + seconds
    said = time.monotonic()
    pieces: list[Piece] = []
    running: dict[Future[Piece], str] = {}
    with ThreadPoolExecutor(jobs) as pool:
        try:
            while True:
                while len(running) < jobs and (time.monotonic() < end or not (running or pieces)):
                    task = choose(list(running.values()))
                    running[pool.submit(task.run)] = task.subject
                if not running:
                    return pieces
                done, _ = wait(running, timeout=1, return_when=FIRST_COMPLETED)
                for future in done:
                    running.pop(future)
                    piece = future.result()
                    record.add(piece)
                    pieces.append(piece)
                    left = max(end - time.monotonic(), 0) / 60
                    say(f"{piece}; {left:.1f} min left")
                    for finding in piece.findings:
                        say(f"   {finding.message}\n   repeat it: {finding.command}")
                if done or time.monotonic() > said + _SILENCE:
                    said = time.monotonic()
                    if running:
                        say(f"   under way: {', '.join(running.values())}")
        finally:
            programs.stop()
