"""What an effect is: parameters with bounds, the change it makes to the case, its signature in words."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from math import exp, log

from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue.families import EXCITATION, Family


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """One number of an effect.

    The coordinate of a parameter is zero without the effect: the logarithm of a factor, the value of the rest.
    """

    name: str
    unit: str
    """As the case file writes it; empty for a factor or share."""
    low: float
    high: float
    """Bounds of the value, in the unit."""
    source: str
    """Of the bounds."""
    factor: bool = False
    """A factor: neutral at one, its coordinate is the logarithm. Else neutral at zero."""

    @property
    def bounds(self) -> tuple[float, float]:
        """Of the coordinate."""
        return (log(self.low), log(self.high)) if self.factor else (self.low, self.high)

    def value(self, coordinate: float) -> float:
        """Value at a coordinate."""
        return exp(coordinate) if self.factor else coordinate


Changes = Mapping[str, object]
"""Path of the case -> what the file would hold there."""


@dataclass(frozen=True, kw_only=True)
class Effect:
    """One entry of the catalogue."""

    name: str
    """``kind:place``."""
    title: str
    family: Family
    signature: str
    """How it shows, in words."""
    parameters: tuple[Parameter, ...]
    """One, or amplitude along cosine and sine of an excitation with free phase."""
    change: Callable[[Case, tuple[float, ...]], Changes] = field(repr=False)
    """Change of the case at the values of the parameters."""
    healthy: float = 0.0
    """Standard deviation of the coordinate in a healthy rig; zero for what a healthy rig does not have."""
    matters: float = 0.0
    """Smallest coordinate that is named, of a harmonic its amplitude; for what a healthy rig does not have, of which no
    spread says what is too little to count."""
    any_tooth: int = 0
    """Teeth of the gear of which any one may be meant; the change is made for tooth 0 unless one more value, the
    number of the tooth, says otherwise."""
    linear: bool = False
    """The numbers answer in proportion: one small step is enough."""
    links: tuple[str, ...] = ()
    """Local conductances that its first parameter, a factor, scales all at once (``film:gearbox.surface``); ``*``
    stands for any run of characters."""

    exponents: tuple[str, ...] = ()
    """Settings over which the exponent of its law is uncertain: ``speed``, ``torque``."""
    doubled: str = ""
    """Name of twice its amplitude, where drawings give that."""
    bends: bool = False
    """It shows only where shafts bend: a library with it is made with the shafts of the case."""
    heats: str = ""
    """Oil stream that takes most of a loss, ``test.gear_oil``."""
    stands_for: str = ""
    """What else leaves its trace and is in no catalogue: it is suspected at most, never named."""
    likeness_of_place: bool = False
    """Entries of other gearboxes are alike only where they are of the same place in it."""

    def scales(self, link: str) -> bool:
        """Whether a local conductance is one of those it scales."""
        return any(fnmatchcase(link, pattern) for pattern in self.links)

    def changes(self, case: Case, coordinates: tuple[float, ...]) -> Changes:
        """Change of the case at coordinates."""
        values = tuple(p.value(u) for p, u in zip(self.parameters, coordinates, strict=True))
        return self.change(case, values)

    @property
    def reach(self) -> float:
        """Largest coordinate within its bounds."""
        return max(abs(bound) for parameter in self.parameters for bound in parameter.bounds)

    @property
    def claim(self) -> str:
        """What is named: the entry without its order, ``cumulative_pitch:test.pinion`` of ``.../2``."""
        return self.name.split("/")[0]

    @property
    def kind(self) -> str:
        """The part of the name before its place."""
        return self.claim.split(":")[0]

    @property
    def place(self) -> str:
        """The part of the name after its kind; empty for the rig as a whole."""
        return self.claim.partition(":")[2]

    @property
    def likeness(self) -> str:
        """What it shares with entries of other gearboxes and rigs: its kind, of a film also the entry."""
        return f"{self.kind}.{self.place.partition('.')[2]}" if self.likeness_of_place else self.kind

    @property
    def oscillates(self) -> bool:
        """It only oscillates, with no mean over a turn: waves over the teeth, harmonic torques."""
        return self.family == EXCITATION and self.linear and not self.any_tooth
