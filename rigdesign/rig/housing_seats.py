"""Housings condensed to their bearing seats, for rigs whose shafts bend in them."""

from collections.abc import Callable, Mapping

import numpy as np

from dynamics.rotor.rotor_model import HousingSupport
from rigdesign.base.errors import CaseError, Fault
from rigdesign.case.gearbox import Gearbox
from rigdesign.properties.materials import Material
from rigdesign.rig.shaft_axes import ShaftAxis
from thermal.expansion.elastic import condense_seats
from thermal.housing.stations import GearboxModel

DAMPING_TIME = 1.6e-6
"""Damping over stiffness of a housing [s]: loss factor 0.01, that of a bolted steel housing, at 1 kHz."""


def housing_supports(
    boxes: Mapping[str, Gearbox],
    axes: Mapping[str, ShaftAxis],
    meshed: Callable[[], Mapping[str, GearboxModel]],
    materials: Callable[[str, GearboxModel], Mapping[str, Material]],
) -> tuple[HousingSupport, ...]:
    """Housings whose case says that their seats yield with them.

    meshed : makes the models, asked only then; materials : of every body of a model of a gearbox

    Raises CaseError for a model without bearing stations.
    """
    names = [name for name, box in boxes.items() if box.housing and box.housing.bearing_seats == "elastic"]
    if not names:
        return ()
    models = meshed()
    return tuple(
        _support(
            name, boxes[name], models[name], materials(name, models[name]), _direction(boxes[name], axes)
        )
        for name in names
    )


def _direction(box: Gearbox, axes: Mapping[str, ShaftAxis]) -> float:
    """1 where the gearbox stands front ahead in the rig, -1 the other way round."""
    return axes[next(iter(box.bearings.values())).shaft].direction


def _support(
    name: str, box: Gearbox, model: GearboxModel, materials: Mapping[str, Material], direction: float
) -> HousingSupport:
    """The housing of a gearbox as support of all its bearings, in the frame of the rig."""
    if not model.bearings:
        raise CaseError([Fault(
            f"gearboxes.{name}.housing.bearing_seats", "elastic",
            f"no bearing bore to condense to: {model.no_expansion}",
            "write rigid and state support_stiffness at the bearings",
        )])  # fmt: skip
    seats = condense_seats(
        model,
        {
            body: (one.elastic_modulus, one.poisson_ratio, one.expansion_coefficient)
            for body, one in materials.items()
        },
        {body: one.density for body, one in materials.items()},
    )
    bearings = {f"bearing_bore_{entry.shaft}_{entry.side}": part for part, entry in box.bearings.items()}
    surfaces = {station.name: station.bore_surface for station in model.bearings}
    turned = np.tile(
        [direction, 1.0, direction], len(seats.names)
    )  # turned about z: y and x change their sign
    stiffness = seats.stiffness * np.outer(turned, turned)
    return HousingSupport(
        name=f"{name} housing",
        bearings=tuple(f"{name}.{bearings[surfaces[seat]]}" for seat in seats.names),
        stiffness=stiffness,
        mass=seats.mass * np.outer(turned, turned),
        damping=DAMPING_TIME * stiffness,
    )
