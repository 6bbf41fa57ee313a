"""The one place that says what happens to a number that is none: the run fails, and names where it stood.

NaN passes every comparison in silence and the maximum of a list may skip it, so that a verdict built on one is
worthless. Values of checks, the state of the coupling loop after every iteration and every record of a result are
held against this; the command ends with the exit status of an iteration without a solution.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from math import isfinite
from typing import Any

import numpy as np

from rigdesign.base.errors import NonFiniteResultError


def finite(path: str, value: float) -> float:
    """``value``, if it is a number.

    Raises
    ------
    NonFiniteResultError
        NaN or infinite; names ``path``.
    """
    if isfinite(value):
        return value
    raise _error(path, value)


def require_finite(record: Any, path: str = "") -> None:
    """Check every number of a record: dataclasses, mappings, sequences and arrays, however deep.

    Raises
    ------
    NonFiniteResultError
        The first number that is NaN or infinite; names its path, that of the record in front.
    """
    for place, value in _not_finite(record, path):
        raise _error(place, value)


def _error(path: str, value: complex) -> NonFiniteResultError:
    return NonFiniteResultError(
        f"{path} = {value}: results hold finite numbers only; a quantity that does not exist is None. An input at the "
        "edge of its range may cause it: move it inwards; report the case as a defect if it does not"
    )


def _not_finite(value: Any, path: str) -> Iterator[tuple[str, complex]]:
    """Path and value of every number that is NaN or infinite."""
    if isinstance(value, float | complex | np.inexact):
        if not np.isfinite(value):
            yield path, value.item() if isinstance(value, np.inexact) else value
    elif isinstance(value, np.ndarray):
        if value.dtype.kind in "fc" and not np.isfinite(value).all():
            place = np.argwhere(~np.isfinite(value))[0]
            yield f"{path}[{', '.join(map(str, place))}]", value[tuple(place)].item()
    elif is_dataclass(value) and not isinstance(value, type):
        for item in fields(value):
            yield from _not_finite(getattr(value, item.name), _joined(path, item.name))
    elif isinstance(value, Mapping):
        for key, item in value.items():
            yield from _not_finite(item, _joined(path, str(key)))
    elif isinstance(value, Sequence) and not isinstance(value, str | bytes):
        for index, item in enumerate(value):
            yield from _not_finite(item, f"{path}[{index}]")


def _joined(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key
