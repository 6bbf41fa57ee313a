"""Results kept in memory for the next call with the same arguments, bounded by the bytes that all of them hold.

A count of entries says nothing of memory: a mesh may have two megabytes or two hundred. What was used last stays, what
has been left alone longest goes; a result that is larger than the limit by itself stays until the next one is kept.
"""

import gc
import sys
from collections import OrderedDict
from collections.abc import Callable, Hashable
from functools import wraps
from types import BuiltinFunctionType, FunctionType, ModuleType
from typing import Any, ParamSpec, TypeVar, cast

import numpy as np

P = ParamSpec("P")
T = TypeVar("T")

LIMIT = 150_000_000
"""Of all results together [bytes]: those of a large rig at standard, of some dozens of small ones."""
_SHARED = (type, ModuleType, FunctionType, BuiltinFunctionType)
"""What belongs to the program and not to a result."""

LEFT = 0.8
"""Share of the limit that is left when it is exceeded: what two results share is counted over all of them then only."""

_results: OrderedDict[Hashable, Any] = OrderedDict()
"""By function and arguments, what was used last at the end."""
_bytes_kept = 0
"""Bytes of all results, those that two share counted for each that came since the last count over all."""


def kept(function: Callable[P, T]) -> Callable[P, T]:
    """Keep the results of a function of hashable arguments, which nobody changes afterwards."""

    @wraps(function)
    def call(*arguments: P.args, **keywords: P.kwargs) -> T:
        key = (function, arguments, tuple(keywords.items()))
        return kept_as(key, lambda: function(*arguments, **keywords))

    return call


def kept_as(key: Hashable, make: Callable[[], T]) -> T:
    """The result kept under a key, which must name its maker, or the one ``make`` gives, kept."""
    if key in _results:
        _results.move_to_end(key)
        return cast(T, _results[key])
    made = make()
    _results[key] = made
    global _bytes_kept
    _bytes_kept += _bytes([key, made], set())
    if _bytes_kept > LIMIT:
        _bytes_kept = _forget_oldest()
    return made


def _forget_oldest() -> int:
    """Drop what lies beyond the share that is left, counted from the result that was used last; bytes of the others."""
    seen: set[int] = set()
    total = 0
    for number, (key, result) in enumerate(reversed(list(_results.items()))):
        size = _bytes([key, result], seen)
        if total + size > LEFT * LIMIT and number > 0:
            _results.pop(key, None)
        else:
            total += size
    return total


def _bytes(values: list[Any], seen: set[int]) -> int:
    """Bytes of all that can be reached from some values and was not seen before."""
    total = 0
    while values:
        value = values.pop()
        if id(value) in seen or isinstance(value, _SHARED):
            continue
        seen.add(id(value))
        if isinstance(value, np.ndarray) and value.base is not None:
            if isinstance(value.base, np.ndarray):
                values.append(value.base)
            else:  # of a compiled function, which owns the memory
                total += value.nbytes
            continue
        total += sys.getsizeof(value, 0)
        values += gc.get_referents(value)
    return total
