"""Converts users' arguments to arrays for the compiled part, or reports the problem."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beambench._beambench import InputError

LARGEST_ID = 0xFFFFFFFF


def whole_number(name: str, given: object) -> int:
    """Returns a whole number; raises TypeError for anything else."""
    if isinstance(given, bool) or not isinstance(given, int | np.integer):
        raise TypeError(f"{name} is {given!r}; expected a whole number")
    return int(given)


def text(name: str, given: object) -> str:
    """Returns a Unicode string; raises TypeError for other types, InputError for surrogates."""
    if not isinstance(given, str):
        raise TypeError(f"{name} is {given!r}; expected a string")
    try:
        given.encode()
    except UnicodeEncodeError:
        raise InputError(f"{name} is {given!a}; expected a string that UTF-8 can encode") from None
    return given


def encoded(name: str, given: str | bytes | os.PathLike[Any]) -> bytes:
    """Returns the bytes of a name or a path, UTF-8 or not; raises TypeError for anything else."""
    try:
        return os.fsencode(given)
    except UnicodeEncodeError:
        raise InputError(f"{name} is {given!a}; expected characters valid in a path") from None
    except TypeError:
        raise TypeError(f"{name} is {given!r}; expected a string or a path") from None


def _shape_text(shape: tuple[int | str, ...]) -> str:
    """Returns a string such as `(N, 3)` or `(N,)`."""
    return f"({', '.join(map(str, shape))}{',' if len(shape) == 1 else ''})"


def _as_array(name: str, given: ArrayLike, kinds: str, expected: str) -> NDArray[Any]:
    """Returns an array of any shape, after checking that the kind of its dtype is in `kinds`."""
    try:
        array = np.asarray(given)
    except ValueError as error:  # rows of several lengths
        raise InputError(f"{name} is not an array: {error}") from None
    if array.size == 0 and not isinstance(given, np.ndarray):
        array = array.astype(np.int64 if "i" in kinds else np.float64)  # an empty list has no type
    if array.dtype.kind not in kinds:
        raise TypeError(f"{name} has dtype {array.dtype}; expected {expected}")
    return array


def _require_shape(name: str, array: NDArray[Any], shape: tuple[int | str, ...]) -> None:
    """Raises InputError unless `array` has the shape; a string in `shape` stands for any number."""
    fits = array.ndim == len(shape) and all(
        isinstance(wanted, str) or wanted == found
        for wanted, found in zip(shape, array.shape, strict=True)
    )
    if not fits:
        raise InputError(
            f"{name} has shape {_shape_text(array.shape)}; expected {_shape_text(shape)}"
        )


def reals(
    name: str,
    given: ArrayLike,
    shape: tuple[int | str, ...],
    dtype: type[np.float32] | type[np.float64],
) -> NDArray[Any]:
    """Returns real numbers of a shape in one block of memory; copies them only if necessary."""
    array = _as_array(name, given, "fiu", f"real numbers ({np.dtype(dtype)})")
    _require_shape(name, array, shape)
    with np.errstate(over="ignore"):  # numbers too large for float32 become infinite
        return np.require(array, dtype=dtype, requirements=["C", "A"])


def ids(name: str, given: ArrayLike, shape: tuple[int | str, ...]) -> NDArray[np.uint32]:
    """Returns indices as uint32; -1 in a signed type stands for NO_PRIMITIVE."""
    array = _as_array(name, given, "iu", "integers (uint32)")
    _require_shape(name, array, shape)
    if array.dtype == np.uint32:
        return np.require(array, requirements=["C", "A"])
    wrong = (array > LARGEST_ID) if array.dtype.itemsize > 4 else np.zeros(array.shape, bool)
    if array.dtype.kind == "i":
        wrong |= array < -1
    if wrong.any():
        place = tuple(int(i) for i in np.argwhere(wrong)[0])
        raise InputError(
            f"{name}[{', '.join(map(str, place))}] is {array[place]}; expected an index "
            "of at least 0, or -1 for a miss"
        )
    return np.ascontiguousarray(array.astype(np.uint32))


def flags(name: str, given: ArrayLike, shape: tuple[int | str, ...]) -> NDArray[np.uint8]:
    """Returns booleans, or 1 and 0, as uint8."""
    array = _as_array(name, given, "biu", "bool, or integers 0 and 1")
    _require_shape(name, array, shape)
    if array.dtype.kind == "b":
        return np.require(array, requirements=["C", "A"]).view(np.uint8)
    wrong = (array != 0) & (array != 1)
    if wrong.any():
        first = int(np.argmax(wrong))
        raise InputError(f"{name}[{first}] is {array[first]}; expected 0 or 1")
    return np.require(array, dtype=np.uint8, requirements=["C", "A"])


def rays_in_place(given: ArrayLike) -> NDArray[np.float32]:
    """Returns rays; copies them unless they are float32 in one block of memory."""
    return reals("rays", given, ("N", 8), np.float32)


def require_coordinates(name: str, points: NDArray[np.float64]) -> None:
    """Raises InputError for the first row with an invalid coordinate."""
    wrong = ~(np.abs(points) <= 1e9).all(axis=-1)
    if wrong.any():
        first = int(np.argmax(wrong))
        numbers = ", ".join(f"{x:g}" for x in np.atleast_1d(points[first]))
        raise InputError(f"{name}[{first}] is ({numbers}); expected numbers from -1e9 to 1e9")
