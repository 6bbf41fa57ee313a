"""What an effect is: parameters with bounds, the change it makes to the case, its signature in words."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from itertools import groupby
from math import exp, log

from rigdesign.case.gearbox import Gearbox
from rigdesign.case.housing import Housing
from rigdesign.case.model import Case

# Families of effects: what is off, and what follows from that for its healthy spread, its traces and its runs.


@dataclass(frozen=True, kw_only=True)
class Family:
    """Kind of thing that is off; it names the amplitude of what cannot be distinguished from it.

    amplitude : of `rigdesign.diagnosis.statistics.amplitudes.Amplitudes`, on the healthy spread of its effects
    dynamic : leaves temperatures and losses nearly as they are, shows in orders and natural frequencies
    circuit : changes how the power circuit passes on what the teeth excite
    heat : a constant that moves the heat
    strain : shows at strain gauges in tooth roots alone, but for traces in mesh orders
    sizes : shares of the bounds at which a nonlinear effect is run
    one_sided_sizes : the same of an effect whose size has one sign
    tooth_contact : every run solves the contact of the teeth anew
    run_rank : place in the order in which runs are started, longest first
    """

    name: str
    amplitude: str
    dynamic: bool = False
    circuit: bool = False
    heat: bool = False
    strain: bool = False
    sizes: tuple[float, ...] = (-1.0, -0.4, -0.12, 0.12, 0.4, 1.0)
    one_sided_sizes: tuple[float, ...] = (-1.0, -0.4, -0.12, 0.12, 0.4, 1.0)
    tooth_contact: bool = False
    run_rank: int = 7


FEWER_SIZES = (-1.0, -0.3, 0.3, 1.0)
"""Of the flanks of a gear, whose runs take longest, and of inertias, which move little."""

YIELDING_SIZES = (0.12, 0.4, 0.7, 1.0)
"""Of a tooth that yields: the model may refuse the largest sizes."""

EXCITATION = Family(name="excitation", amplitude="tooth", dynamic=True, run_rank=4)
TOOTH = Family(
    name="tooth", amplitude="tooth", dynamic=True, sizes=FEWER_SIZES, one_sided_sizes=YIELDING_SIZES,
    tooth_contact=True, run_rank=0,
)  # fmt: skip
STIFFNESS = Family(name="stiffness", amplitude="constant_loop", dynamic=True, circuit=True, run_rank=1)
BEARING = replace(STIFFNESS, name="bearing", sizes=FEWER_SIZES)
"""Bearings and their supports, of which there are many."""
INERTIA = Family(
    name="inertia", amplitude="constant_loop", dynamic=True, circuit=True, sizes=FEWER_SIZES,
    one_sided_sizes=YIELDING_SIZES, run_rank=2,
)  # fmt: skip
DAMPING = Family(name="damping", amplitude="constant_loop", dynamic=True, circuit=True, run_rank=3)
LOSS = Family(name="loss", amplitude="constant_loss", heat=True)
SPLIT = Family(name="split", amplitude="constant_film", heat=True)
FILM = Family(name="film", amplitude="constant_film", heat=True)
CONTACT = Family(name="contact", amplitude="constant_film", heat=True)
FLOW = Family(name="flow", amplitude="constant_oil", heat=True)
OIL = Family(name="oil", amplitude="constant_oil", heat=True, run_rank=6)
ONE_FEED = replace(FLOW, name="one feed", one_sided_sizes=(0.4, 1.0))
"""Oil of one bearing: two runs, as there are many of them."""
ONE_JOINT = replace(CONTACT, name="one joint", one_sided_sizes=(0.12, 1.0))
"""Joint of one shell, the same."""
FACE = Family(name="face", amplitude="sensor", strain=True, sizes=FEWER_SIZES, tooth_contact=True, run_rank=0)
"""Load over the face and profile; spreads as tolerances and inspection give them."""
GAUGE_PLACE = Family(name="gauge place", amplitude="sensor", strain=True)
CHAIN = Family(name="measuring chain", amplitude="sensor", strain=True, one_sided_sizes=(0.12, 0.4, 1.0))
STATE = Family(name="state", amplitude="constant_loop", run_rank=5)


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


# What entries of the catalogue share: parameters of the usual kinds, and the usual changes of a case.

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

    def __init__(self, path: str, stated: float) -> None:
        self._path, self._stated = path, stated

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        """The change at the value that is added."""
        return {self._path: self._stated + values[0]}


# Register of the catalogue: an effect says what it needs of a case, nothing else lists it.


@dataclass(frozen=True, kw_only=True)
class GearboxPart:
    """One gearbox of a case, as the effects of its parts see it."""

    case: Case
    name: str
    box: Gearbox

    @property
    def path(self) -> str:
        """Of the gearbox in the case file."""
        return f"gearboxes.{self.name}"

    @property
    def housing(self) -> Housing:
        """For effects that are registered with ``housing``."""
        return self.case.housings[self.name]


OfRig = Callable[[Case], Iterator[Effect]]
OfGearbox = Callable[[GearboxPart], Iterator[Effect]]


@dataclass(frozen=True, kw_only=True)
class _Entry:
    of_rig: OfRig | None = None
    of_gearbox: OfGearbox | None = None
    drivetrain: bool = False
    housing: bool = False
    lateral: bool = False

    def of_case(self, case: Case) -> Iterator[Effect]:
        if self.of_rig is not None and (case.drivetrain is not None or not self.drivetrain):
            yield from self.of_rig(case)

    def of_part(self, part: GearboxPart) -> Iterator[Effect]:
        lacks_drivetrain = self.drivetrain and part.case.drivetrain is None
        lacks_housing = self.housing and part.box.housing is None
        if self.of_gearbox is not None and not lacks_drivetrain and not lacks_housing:
            yield from self.of_gearbox(part)


_ENTRIES: list[_Entry] = []


def of_rig(*, drivetrain: bool = False, lateral: bool = False) -> Callable[[OfRig], OfRig]:
    """Register effects of the rig as a whole; ``drivetrain``: they need one; ``lateral``: and shafts that bend."""

    def register(make: OfRig) -> OfRig:
        _ENTRIES.append(_Entry(of_rig=make, drivetrain=drivetrain or lateral, lateral=lateral))
        return make

    return register


def of_gearbox(
    *, drivetrain: bool = False, housing: bool = False, lateral: bool = False
) -> Callable[[OfGearbox], OfGearbox]:
    """Register effects of every gearbox; ``drivetrain``, ``housing``: they need one;
    ``lateral``: they need a drivetrain whose shafts bend."""

    def register(make: OfGearbox) -> OfGearbox:
        _ENTRIES.append(
            _Entry(
                of_gearbox=make,
                drivetrain=drivetrain or lateral,
                housing=housing,
                lateral=lateral,
            )
        )
        return make

    return register


def registered_effects(case: Case, *, lateral: bool) -> Iterator[Effect]:
    """Effects of a case as registered, those of one gearbox together; ``lateral``: with those of shafts that bend."""
    bends = case.power_circuit.shaft_model == "elastic"
    wanted = [entry for entry in _ENTRIES if (lateral and bends) or not entry.lateral]
    for by_gearbox, group in groupby(wanted, lambda entry: entry.of_gearbox is not None):
        entries = list(group)
        if not by_gearbox:
            for entry in entries:
                yield from entry.of_case(case)
            continue
        for name, box in case.gearboxes.items():
            part = GearboxPart(case=case, name=name, box=box)
            for entry in entries:
                yield from entry.of_part(part)
