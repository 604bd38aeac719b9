"""Mutates Quake 3 maps and converts them: only Problem may be raised.

usage: .venv/bin/python -m beambench_operations.campaign.quake3_maps FILE
       .venv/bin/python -m beambench_operations.campaign.quake3_maps SECONDS SEED FAULTS FOLDER...

Converts one file; or, for some time, mutated files from the folders. Then it writes each file that
fails in a new way to the folder FAULTS, and prints the number of converted files.
"""

import hashlib
import signal
import struct
import sys
import time
import traceback
from pathlib import Path
from random import Random
from types import FrameType

from beambench_meshes.problem import Problem
from beambench_meshes.quake3_bsp import convert

_LARGEST = 8192  # bytes of an input
_SECONDS_FOR_ONE = 20
_LIMITS = (-(2**31), -1, 0, 1, 2, 3, 0x7FFFFFFF, 0x10000)
_WORDS = (b"inf", b"nan", b"-1", b"1e400", b'"origin"', b'"model" "*9"', b"{", b"}", b"\0")


def read(data: bytes) -> None:
    """Converts a map as scripts/meshes does. Ignores Problem and passes on other exceptions."""
    signal.alarm(_SECONDS_FOR_ONE)
    try:
        level = convert(data, 2)
        level.starts()
        level.report()
    except Problem:
        pass
    finally:
        signal.alarm(0)


def mutated(data: bytes, others: list[bytes], random: Random) -> bytes:
    """Returns the data with some bytes changed, removed, repeated, or taken from another input."""
    result = bytearray(data)
    for _ in range(random.choice((1, 1, 2, 4, 8))):
        place = random.randrange(len(result) + 1)
        size = random.choice((1, 4, 16, 72, 104))
        match random.randrange(6):
            case 0:
                result[place : place + 1] = bytes([random.randrange(256)])
            case 1:
                place -= place % 4
                result[place : place + 4] = struct.pack("<i", random.choice(_LIMITS))
            case 2:
                del result[place : place + size]
            case 3:
                result[place:place] = result[place : place + size]
            case 4:
                word = random.choice(_WORDS)
                result[place : place + len(word)] = word
            case 5:
                other = random.choice(others)
                start = random.randrange(len(other) + 1)
                result[place : place + size] = other[start : start + size]
    return bytes(result[:_LARGEST])


def fault(data: bytes) -> str:
    """Returns the exception that an input causes, with its place; empty if there is none."""
    try:
        read(data)
    except Exception as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        return f"{type(error).__name__}: {error} ({Path(place.filename).name}:{place.lineno})"
    return ""


def search(seconds: float, seed: int, faults: Path, inputs: list[bytes]) -> int:
    """Mutates and converts inputs for some time; returns the number of conversions."""
    random = Random(seed)
    end = time.monotonic() + seconds
    places = set()
    executions = 0
    while time.monotonic() < end:
        data = mutated(random.choice(inputs), inputs, random)
        executions += 1
        message = fault(data)
        place = message[message.rfind("(") :]
        if message and place not in places:
            places.add(place)
            (faults / f"crash-{hashlib.sha1(data).hexdigest()}").write_bytes(data)
    return executions


def _too_slow(_number: int, _frame: FrameType | None) -> None:
    raise TimeoutError(f"no answer within {_SECONDS_FOR_ONE} s")


def main(arguments: list[str]) -> int:
    """Returns the exit code: 1 if the file fails."""
    signal.signal(signal.SIGALRM, _too_slow)
    if len(arguments) == 1:
        message = fault(Path(arguments[0]).read_bytes())
        print(message or "no fault")
        return 1 if message else 0
    if len(arguments) < 4:
        print(__doc__, file=sys.stderr)
        return 2
    files = [path for folder in arguments[3:] for path in sorted(Path(folder).iterdir())]
    inputs = [path.read_bytes() for path in files]
    print(search(float(arguments[0]), int(arguments[1]), Path(arguments[2]), inputs))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
