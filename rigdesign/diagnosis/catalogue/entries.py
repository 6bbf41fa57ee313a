"""What entries of the catalogue share: parameters of the usual kinds, and the usual changes of a case."""

from dataclasses import dataclass

from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue.effects import Changes, Effect, Parameter
from rigdesign.diagnosis.catalogue.families import Family

PRACTICE = "rig practice: catalogue of the workflow, section 4"
"""Source of bounds that no standard gives."""


def factor(name: str, low: float, high: float) -> Parameter:
    """A factor on what the case says."""
    return Parameter(name=name, unit="", low=low, high=high, source=PRACTICE, factor=True)


def share(name: str, most: float) -> Parameter:
    """A share, zero without the effect."""
    return Parameter(name=name, unit="", low=0.0, high=most, source=PRACTICE)


class Scaled:
    """Sets paths to their value of the case times the factor, at most ``most``."""

    def __init__(self, places: tuple[tuple[str, float], ...], most: float = float("inf")) -> None:
        self._places, self._most = places, most

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        """The change at the value of the factor."""
        return {path: min(value * values[0], self._most) for path, value in self._places}


@dataclass(frozen=True, kw_only=True)
class UncertainValue:
    """A value of the case that is known up to a factor.

    path : in the case; now : its value there
    bounds : of the factor; healthy : standard deviation of its logarithm in a healthy rig
    """

    path: str
    now: float
    bounds: tuple[float, float]
    healthy: float

    def effect(self, name: str, title: str, family: Family, signature: str) -> Effect:
        """The entry that multiplies it."""
        return Effect(
            name=name,
            title=title,
            family=family,
            signature=signature,
            parameters=(factor("factor", *self.bounds),),
            change=Scaled(((self.path, self.now),)),
            healthy=self.healthy,
        )


class Added:
    """Adds to the value at a path."""

    def __init__(self, path: str, now: float) -> None:
        self._path, self._now = path, now

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        """The change at the value that is added."""
        return {self._path: self._now + values[0]}
