"""Power to bring injected oil to the speed of the gear that carries it: momentum, not a correlation.

Two sources pay: the shaft gives rho Q v (v - v_jet cos(angle)), the pump rho Q v_jet^2 / 2. What they give together
is lost at the impact and against the walls, rho Q |v - v_jet|^2 / 2 + rho Q v^2 / 2, and so never negative; a jet
that is faster than the pitch line hands a part of the pump's power to the shaft.
"""

import math
from dataclasses import dataclass

from dynamics.losses.loss import Loss, LossError

JET_ANGLES = {"into_mesh": 0.0, "radial": 0.5 * math.pi, "out_of_mesh": math.pi}
"""Angle between jet and surface speed [rad] by the side of the mesh the nozzle points at."""


@dataclass(frozen=True, kw_only=True)
class OilJet:
    """Oil injected at a gear or mesh.

    flow : oil on this gear or mesh [m3/s]
    density : of the oil [kg/m3]
    speed : of the jet [m/s]
    angle : between jet and surface velocity [rad]; 0 with the motion into the mesh, pi/2 radial
        or dripping, pi against the motion into the mesh exit
    carried_share : share of the oil that reaches the surface speed, 0 to 1 [-]; some programs take 0
        behind the mesh. A marked assumption where it is not 1
    """

    flow: float
    density: float
    speed: float = 0.0
    angle: float = 0.5 * math.pi
    carried_share: float = 1.0

    @property
    def power(self) -> float:
        """Kinetic energy of the jet, rho Q v_jet^2 / 2 [W]: given by the pump, found again as heat of the oil.

        Source: energy theorem; the pressure before the nozzle is rho v_jet^2 / 2, its losses not counted.
        """
        return 0.5 * self.density * self.flow * self.speed**2


def oil_acceleration(place: str, jet: OilJet, surface_speed: float) -> Loss:
    """Power that a gear spends on the oil it throws off, P = rho Q v (v - v_jet cos(angle)) [W].

    Parameters
    ----------
    place : name in the rig
    jet : oil on this gear or mesh
    surface_speed : pitch line speed v [m/s]

    Negative if a jet faster than the pitch line pushes the gear: the pump pays, and `OilJet.power` is its part
    of the heat. Together with it all ends in oil and walls.

    Raises LossError for a negative flow, density or jet speed or a share outside 0 to 1.

    Source: momentum theorem; the same form as the impulse loss of Ariura et al. 1973. Check: 5 l/min at
    62 m/s take about 270 W.
    """
    for name, value in (("oil flow", jet.flow), ("oil density", jet.density), ("jet speed", jet.speed)):
        if not value >= 0.0:
            raise LossError(f"{place}: {name} = {value}: must not be negative; give its magnitude")
    if not 0.0 <= jet.carried_share <= 1.0:
        raise LossError(
            f"{place}: carried share = {jet.carried_share}: must lie within 0 to 1; it is a share"
        )
    speed = abs(surface_speed)
    gain = speed - jet.speed * math.cos(jet.angle)
    return Loss(
        place=place,
        kind="oil_acceleration",
        power=jet.carried_share * jet.density * jet.flow * speed * gain,
        details={
            "flow": jet.flow,
            "surface_speed": speed,
            "jet_speed": jet.speed,
            "jet_angle": jet.angle,
            "carried_share": jet.carried_share,
            "source": "momentum of the injected oil",
        },
    )
