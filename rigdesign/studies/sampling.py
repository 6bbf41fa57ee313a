"""Points spread over a unit cube: Latin hypercube, Sobol sequence, and the design of Sobol indices."""

import re
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from rigdesign.base.errors import UsageError, shortened
from rigdesign.studies.grid import MAX_POINTS

Array = NDArray[np.float64]
SAMPLE = re.compile(r"\s*(lhs|sobol)\s*:\s*(\d{1,9})\s*")
EXAMPLE = "write --sample lhs:200 or --sample sobol:256"


@dataclass(frozen=True)
class Sample:
    """What ``--sample`` asks for: a kind of design and its number of points."""

    kind: Literal["lhs", "sobol"]
    size: int


def parse_sample(text: str) -> Sample:
    """Read ``lhs:N`` or ``sobol:N``.

    Raises
    ------
    UsageError
        Another text, fewer than 2 points, too many, or a number for Sobol that is no power of two.
    """
    found = SAMPLE.fullmatch(text)
    if found is None:
        raise UsageError(f"--sample {shortened(text)}: no such design; {EXAMPLE}")
    size = int(found[2])
    if not 2 <= size <= MAX_POINTS:
        raise UsageError(f"--sample {text}: {size} points, 2 to {MAX_POINTS} are possible; {EXAMPLE}")
    if found[1] == "lhs":
        return Sample("lhs", size)
    if size & (size - 1):
        below = 1 << (size.bit_length() - 1)
        raise UsageError(
            f"--sample {text}: a Sobol sequence is even only with a power of two; write sobol:{below} or "
            f"sobol:{2 * below}"
        )
    return Sample("sobol", size)


def unit_points(sample: Sample, inputs: int, seed: int) -> Array:
    """Points of a design in [0, 1), (size, inputs); the same for the same seed.

    Latin hypercube: McKay, Beckman, Conover, Technometrics 21 (1979); Sobol: scrambled (Owen).
    """
    rng = np.random.default_rng(seed)
    if sample.kind == "lhs":
        return np.asarray(qmc.LatinHypercube(inputs, rng=rng).random(sample.size))
    return np.asarray(qmc.Sobol(inputs, rng=rng).random(sample.size))


def saltelli_points(size: int, inputs: int, seed: int) -> Array:
    """The design of first-order and total indices, (size * (inputs + 2), inputs).

    Two independent samples A and B, then for every input A with that input from B, as in Saltelli et al., Computer
    Physics Communications 181 (2010) 259, table 2.
    """
    both = np.asarray(qmc.Sobol(2 * inputs, rng=np.random.default_rng(seed)).random(size))
    first, second = both[:, :inputs], both[:, inputs:]
    mixed = []
    for number in range(inputs):
        page = first.copy()
        page[:, number] = second[:, number]
        mixed.append(page)
    return np.concatenate([first, second, *mixed])
