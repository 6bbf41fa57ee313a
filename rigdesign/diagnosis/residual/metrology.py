"""What an inspection of gears and axes, or a contact pattern, says of an effect before any sensor is read.

The measured value stands in the case. What the inspection leaves open is the spread of the effect: it takes the place
of the healthy spread and the bounds of the catalogue where it is narrower.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from rigdesign.base.errors import Fault, MeasurementError
from rigdesign.case.faults import unknown
from rigdesign.diagnosis.catalogue.effects import Effect

LENGTH = "m"
"""Unit of the parameter of effects that an inspection measures."""
REACH = 3.0
"""Standard deviations of an inspection up to which an effect is believed."""


def inspected(effects: Iterable[Effect], spreads: Mapping[str, float], source: str) -> tuple[Effect, ...]:
    """Effects with the spreads that inspections leave.

    Parameters
    ----------
    spreads : effect -> standard deviation of what was measured of it [m]
    source : of the set, for faults

    Raises
    ------
    MeasurementError
        A name that is no effect of the case with a length as its one parameter.
    """
    effects = tuple(effects)
    faults = list(_faults(effects, spreads))
    if faults:
        raise MeasurementError(faults, source)
    return tuple(
        _narrowed(effect, spreads[effect.name]) if effect.name in spreads else effect for effect in effects
    )


def _faults(effects: tuple[Effect, ...], spreads: Mapping[str, float]) -> Iterator[Fault]:
    known = tuple(effect.name for effect in effects if _measured(effect))
    for name in spreads:
        if name not in known:
            yield unknown(f"inspections.{name}", name, known, "effect that an inspection measures")


def _measured(effect: Effect) -> bool:
    return len(effect.parameters) == 1 and effect.parameters[0].unit == LENGTH and not effect.any_tooth


def _narrowed(effect: Effect, deviation: float) -> Effect:
    (parameter,) = effect.parameters
    reach = REACH * deviation
    narrow = replace(
        parameter, low=max(parameter.low, -reach), high=min(parameter.high, reach), source="inspection"
    )
    healthy = min(effect.healthy, deviation) if effect.healthy else 0.0
    return replace(effect, parameters=(narrow,), healthy=healthy)
