"""Places of a housing whose temperatures are kept over time."""

from rigdesign.coupling.housing_context import BEARING_FILM, BEARING_OIL, GEAR_OIL
from rigdesign.rig.model import Rig
from rigdesign.transient.bearing_nodes import seated_bearings
from thermal.transient.probes import Probe


def probes_of(rig: Rig, name: str) -> list[Probe]:
    """Every body by its mean, the hottest place of the housing, oil outlets, bearing films, and those of the case."""
    box = rig.case.gearboxes[name]
    fed = box.fed_bearings is not None
    films = list(box.bearings) if fed else seated_bearings(rig, name)
    own = [
        *(Probe(name=body, place=body) for body in rig.models[name].mesh.bodies),
        Probe(name="housing_max", place="housing", quantity="max"),
        Probe(name="gear_oil_outlet", place=GEAR_OIL),
        Probe(name="bearing_oil_outlet", place=BEARING_OIL if fed else GEAR_OIL),
        *(Probe(name=f"film_outlet_{part}", place=f"{BEARING_FILM}:{part}") for part in films),
    ]
    taken = {probe.name for probe in own}
    return own + [
        Probe(name=f"probe_{key}" if key in taken else key, place=entry.place, quantity=entry.quantity)
        for key, entry in rig.case.transient.probes.items()
        if entry.gearbox == name
    ]
