"""Register of the catalogue: an effect says what it needs of a case, nothing else lists it."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import groupby

from rigdesign.case.gearbox import Gearbox
from rigdesign.case.housing import Housing
from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue.effects import Effect


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
        assert self.box.housing is not None
        return self.box.housing


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
    bends = case.drivetrain is not None and case.drivetrain.shaft_model == "elastic"
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
