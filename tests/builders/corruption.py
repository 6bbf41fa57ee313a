"""Damaged files, the same ones at every run: bits flipped, bytes replaced, ends cut off."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Damage:
    """One damaged content; ``what`` says how it came about."""

    what: str
    content: bytes

    @property
    def cut(self) -> bool:
        """Whether the end is missing."""
        return self.what.startswith("cut")


def damages(content: bytes, count: int, seed: int, head: int | None = None) -> Iterator[Damage]:
    """``count`` different damages of a content, in turn a flipped bit, a replaced byte, a cut end.

    head : only of so many bytes at the beginning
    """
    rng = np.random.default_rng(seed)
    seen = {content}
    while len(seen) <= count:
        place = int(rng.integers(len(content[:head])))
        kind = (len(seen) - 1) % 3
        changed = bytearray(content)
        if kind == 0:
            bit = int(rng.integers(8))
            changed[place] ^= 1 << bit
            what = f"bit {bit} of byte {place} flipped"
        elif kind == 1:
            changed[place] = int(rng.integers(256))
            what = f"byte {place} replaced"
        else:
            del changed[place:]
            what = f"cut to {place} bytes"
        if bytes(changed) not in seen:
            seen.add(bytes(changed))
            yield Damage(what, bytes(changed))
