"""Windage of a shaft coupling in the air of its guard: two free faces and a smooth cylinder.

    P = rho omega^3 R^5 C_disc / 2  +  pi C_cylinder rho omega^3 R^4 L

Source: free disc (Schlichting, Boundary-Layer Theory) and rotating cylinder (Theodorsen and Regier, NACA Report 793),
both of `dynamics.losses.windage`. Bolt heads and a tight guard are not in it: take a rig's measured torque where they
count.
"""

from dataclasses import dataclass, field

from dynamics.losses.windage import Mist, disc_coefficient, shaft_windage
from rigdesign.base.number_faults import require_above, require_at_least
from rigdesign.rig_heat.component import ComponentHeat, HeatSplit
from thermal.films.air import air


@dataclass(frozen=True, kw_only=True)
class CouplingRotor:
    """Coupling as the air sees it.

    radius : of its rim [m]; length : of its rim [m]
    hub_radius : inside of which its faces are covered by the shafts [m]
    """

    name: str
    radius: float
    length: float
    hub_radius: float = 0.0
    split: HeatSplit = field(default_factory=HeatSplit)

    def __post_init__(self) -> None:
        require_above(f"{self.name}.length", self.length, "m", "give the length of the rim")
        require_at_least(f"{self.name}.hub_radius", self.hub_radius, "m", "give 0 for whole faces")
        require_above(
            f"{self.name}.radius", self.radius, "m", "the rim is outside of the hub", limit=self.hub_radius
        )


def coupling_windage(rotor: CouplingRotor, speed: float, air_temperature: float) -> ComponentHeat:
    """Heat of a coupling [W] at a speed [rad/s] in air of a temperature [K] at one atmosphere.

    The faces are those of a disc less what the shafts cover, each with the coefficient of its own radius.
    """
    gas = air(air_temperature)
    mist = Mist(density=gas.density, viscosity=gas.viscosity)
    rim = shaft_windage(rotor.name, rotor.radius, rotor.length, speed, mist)
    faces = _faces(rotor.radius, speed, mist) - _faces(rotor.hub_radius, speed, mist)
    return ComponentHeat(
        name=rotor.name,
        power=rim.power + faces,
        split=rotor.split,
        source="free disc (Schlichting) and rotating cylinder (NACA Report 793)",
        warnings=rim.warnings,
    )


def _faces(radius: float, speed: float, mist: Mist) -> float:
    """Friction of both faces of a disc [W]."""
    return 0.5 * mist.density * abs(speed) ** 3 * radius**5 * disc_coefficient(mist.reynolds(speed, radius))
