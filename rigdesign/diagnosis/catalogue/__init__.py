"""Effects that the model can express: each changes the case and is simulated by it, never by a formula here.

The modules imported here register their effects, in this order.
"""

from collections.abc import Iterable

from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue import circuit, gauges, heat, lateral, local_heat  # noqa: F401 - register effects
from rigdesign.diagnosis.catalogue.effects import Effect, registered_effects
from rigdesign.prediction.model import LATERAL_QUANTITIES, Channel


def effects_of(case: Case, *, channels: Iterable[Channel] | None = ()) -> tuple[Effect, ...]:
    """Entries for this case, in a fixed order; names are unique.

    Each has a healthy spread or a smallest size that matters.

    channels : of the measurement; effects of shafts that bend are there where one of them shows such (`lateral`), and
        for None, which stands for any
    """
    bending = channels is None or any(channel.quantity in LATERAL_QUANTITIES for channel in channels)
    effects = tuple(registered_effects(case, lateral=bending))
    names = [effect.name for effect in effects]
    assert len(set(names)) == len(names)
    assert all(effect.healthy > 0.0 or effect.matters > 0.0 for effect in effects)
    return effects
