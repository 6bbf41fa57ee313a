"""Arrays that REXS stores as base64 of little-endian numbers (``code`` int32, float32, float64)."""

import binascii
import struct
from base64 import b64decode

_FORMATS = {"int32": ("i", 4), "float32": ("f", 4), "float64": ("d", 8)}


class CodedNumbersError(ValueError):
    """Text that is no base64 of numbers of this code."""


def coded_array(code: str, text: str) -> tuple[float, ...]:
    """Numbers of a coded array.

    Parameters
    ----------
    code : int32, float32 or float64
    text : base64; blanks and line ends are skipped

    Raises
    ------
    CodedNumbersError
        Another code, text that is no base64, or bytes that do not divide into numbers.
    """
    if code not in _FORMATS:
        raise CodedNumbersError(f"code {code[:20]!r} is none of {', '.join(_FORMATS)}")
    letter, size = _FORMATS[code]
    try:
        content = b64decode("".join(text.split()), validate=True)
    except (binascii.Error, ValueError):
        raise CodedNumbersError("no base64 text") from None
    if len(content) % size:
        raise CodedNumbersError(f"{len(content)} bytes do not divide into numbers of {size}")
    return struct.unpack(f"<{len(content) // size}{letter}", content)


def coded_matrix(code: str, text: str, rows: int, columns: int) -> tuple[tuple[float, ...], ...]:
    """Numbers of a coded matrix, shape (rows, columns).

    Raises
    ------
    CodedNumbersError
        As ``coded_array``, or a shape that does not fit the numbers.
    """
    numbers = coded_array(code, text)
    if rows < 0 or columns < 0 or rows * columns != len(numbers):
        raise CodedNumbersError(f"{rows} rows of {columns} do not hold {len(numbers)} numbers")
    return tuple(numbers[row * columns : (row + 1) * columns] for row in range(rows))
