"""What these sensors and points can see and tell apart, before any name is looked for."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from rigdesign.diagnosis.columns import Array
from rigdesign.diagnosis.covariance import Whitened
from rigdesign.diagnosis.evidence import Hypothesis, release_of

SEEN = 3.3
"""Standard deviations at which a size is told from nothing with 5 % error on both sides (1.645 + 1.645)."""

TOLD = 4.3
"""Standard deviations at which it is told from its nearest rival as well."""

ALIAS = 0.95
"""Correlation above which two effects look alike to these sensors."""

Verdict = Literal["testable", "visible only", "not testable here"]


@dataclass(frozen=True, kw_only=True)
class Detectability:
    """One effect in the eyes of these sensors; sizes in the coordinate of its parameter.

    detectable : smallest size that is seen; isolable : smallest that can be named; rival : nearest explanation
    """

    effect: str
    detectable: float
    isolable: float
    bound: float
    rival: str
    correlation: float

    @property
    def verdict(self) -> Verdict:
        """Against the physical bound."""
        if self.isolable <= self.bound:
            return "testable"
        return "visible only" if self.detectable <= self.bound else "not testable here"


def slope_of(hypothesis: Hypothesis) -> Array:
    """(n, k) whitened columns of a hypothesis at its smallest size."""
    if hypothesis.curve is not None:
        return hypothesis.curve.slope(0.0)[:, None]
    assert hypothesis.columns is not None
    return hypothesis.columns


def detectabilities(
    space: Whitened, effects: Sequence[Hypothesis], rivals: Sequence[Hypothesis]
) -> tuple[Detectability, ...]:
    """The table of all effects against all rivals, anonymous ones included.

    Nonlinear effects are judged by their slope at the detectable size, found by one repetition.
    """
    everything = _Bases((*effects, *rivals))
    rows = []
    for effect in effects:
        release = release_of(space, effect.own)
        column = slope_of(effect)
        size = _detectable(release.product(column, column))
        if effect.curve is not None and np.isfinite(size):
            at = float(np.clip(size, *effect.curve.bounds))
            if at > 0.0:
                answer = effect.curve.at(np.array([at]))[0][:, None] / at
                size = _detectable(release.product(answer, answer))
                column = answer
        rival, correlation = everything.nearest(effect.parts, column)
        half = effect.half if effect.curve is None else effect.curve.half
        told = TOLD / SEEN * size / max(np.sqrt(max(1.0 - correlation**2, 0.0)), 1e-9)
        rows.append(
            Detectability(
                effect=effect.name,
                detectable=size,
                isolable=float(told),
                bound=half,
                rival=rival,
                correlation=correlation,
            )
        )
    return tuple(rows)


def _detectable(gram: Array) -> float:
    """Size seen in its least visible phase."""
    least = float(np.linalg.eigvalsh(np.atleast_2d(gram))[0])
    return SEEN / least**0.5 if least > 0.0 else float("inf")


class _Bases:
    """Orthonormal bases of what many explanations span, two columns at most each."""

    def __init__(self, explanations: Sequence[Hypothesis]) -> None:
        self.names = [one.name for one in explanations]
        self._parts = [one.parts for one in explanations]
        self._bases = np.stack([_two_columns(slope_of(one)) for one in explanations])

    def alike(self, basis: Array) -> Array:
        """(m,) largest cosine between a basis (n, k) and each explanation."""
        overlap = np.einsum("nk,mnj->mkj", basis, self._bases)
        squares = np.linalg.eigvalsh(overlap @ overlap.transpose(0, 2, 1))[:, -1]
        return np.asarray(np.sqrt(np.clip(squares, 0.0, 1.0)))

    def nearest(self, parts: tuple[str, ...], column: Array) -> tuple[str, float]:
        """The explanation most like these columns that claims something else."""
        alike = self.alike(np.linalg.qr(column)[0])
        alike[[i for i, other in enumerate(self._parts) if other == parts]] = -1.0
        best = int(np.argmax(alike))
        return self.names[best], max(float(alike[best]), 0.0)


def _two_columns(columns: Array) -> Array:
    basis, _ = np.linalg.qr(columns)
    return np.pad(basis, ((0, 0), (0, 2 - basis.shape[1])))


def aliases(space: Whitened, effects: Sequence[Hypothesis]) -> list[tuple[str, str, float]]:
    """Pairs of effects these sensors cannot tell apart, with their correlation."""
    everything = _Bases(effects)
    pairs = []
    for number, effect in enumerate(effects):
        alike = everything.alike(np.linalg.qr(slope_of(effect))[0])
        pairs += [
            (effect.name, everything.names[other], float(alike[other]))
            for other in range(number + 1, len(effects))
            if alike[other] > ALIAS
        ]
    return sorted(pairs, key=lambda pair: -pair[2])
