"""What goes round the coupling loop, and what one iteration of it returns. SI units throughout.

Parts are named by gearbox and own name: gear ``test.pinion``, mesh ``test.main``, bearing
``test.pinion_front``; the two oil streams of a gearbox are ``test.gear_oil`` and ``test.bearing_oil``.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace

Values = Mapping[str, float]

LEAST_TORQUE = 1.0
"""Torque of a mesh [N m] below which its stiffness and friction are taken at this torque."""


@dataclass(frozen=True, kw_only=True)
class OperatingPoint:
    """A steady point: speed [rad/s] and torque [N m] at the gear where the case counts them."""

    stage: str
    speed: float
    torque: float


@dataclass(frozen=True, kw_only=True)
class CouplingState:
    """What an iteration takes from the one before: the arrows of the loop, one field each."""

    gear_temperature: Values
    """Bulk temperature of each gear [K]: its expansion enters backlash and mesh."""
    centre_distance: Values
    """Hot centre distance of each mesh under load [m]: of the housing, and of the shafts in their bearings."""
    bearing_clearance: Values
    """Hot diametral clearance of each bearing, centrifugal expansion included [m]."""
    bearing_heat: Values
    """Heat that shaft and shell give to the film of each bearing [W]."""
    wall_heat: Values
    """Heat that walls, shafts and gears give to each oil stream [W]."""
    oil_outlet: Values
    """Temperature with which each oil stream leaves its chamber [K]: it wets the walls and thins the tooth film."""
    oil_supply: Values
    """Supply temperature of each oil stream that an oil circuit feeds [K]; the others have that of the case."""
    mesh_torque: Values
    """Mean torque of each mesh at its pinion [N m], positive where the pinion drives: it loads the bearings."""
    axial_expansion: Values
    """Axial expansion that shifts a helical gear against its partner, by mesh [m]: it changes the bracing."""
    seat_temperature: Values = field(default_factory=dict)
    """Mean temperature of every seat that takes heat of a rolling bearing, ``gearbox.bearing.shaft`` and
    ``gearbox.bearing.housing`` [K]: it warms the bearing."""

    flank_approach: Values = field(default_factory=dict)
    """How far the journals bring the flanks of each mesh together beyond bending and the springs of the bearings [m]:
    it changes the bracing. Empty for shafts that only twist."""
    axis_tilt: Values = field(default_factory=dict)
    """Angles of the wheel axis against that of the pinion that bending shafts and journals add, ``mesh.inclination``
    and ``mesh.skew`` [rad] over x: they open the flanks over the face. Empty for shafts that only twist."""
    coupling_offset: Values = field(default_factory=dict)
    """How far warm housings set the axis of the first shaft of a coupling off that of the second, ``coupling.lateral``
    and ``coupling.vertical`` [m], beyond the cold set-up: it loads their bearings. Of couplings that resist it."""
    coupling_angle: Values = field(default_factory=dict)
    """The same of its slope over x [rad]."""

    def with_torque_share(self, share: float) -> "CouplingState":
        """This coupling state with a share of its mesh torques."""
        return replace(self, mesh_torque={name: share * torque for name, torque in self.mesh_torque.items()})

    def freeze(self, arrows: frozenset[str], initial: "CouplingState") -> "CouplingState":
        """This coupling state with the named arrows cut: those fields stay as in ``initial``.

        Raises KeyError for a name that is no field.
        """
        unknown = arrows - {entry.name for entry in fields(self)}
        if unknown:
            raise KeyError(f"no such arrow: {', '.join(sorted(unknown))}")
        return CouplingState(
            **{
                entry.name: getattr(initial if entry.name in arrows else self, entry.name)
                for entry in fields(self)
            }
        )


TEMPERATURES = ("gear_temperature", "oil_outlet", "seat_temperature", "oil_supply")
LENGTHS = ("centre_distance", "bearing_clearance", "axial_expansion", "flank_approach", "coupling_offset")
TILT_ARM = 0.05
"""Half of a wide face [m], at whose end a tilt of the axes counts as a length."""


def temperature_change(old: CouplingState, new: CouplingState) -> float:
    """Largest change of a temperature between two iterations [K]."""
    return _largest_change(old, new, TEMPERATURES)


def length_change(old: CouplingState, new: CouplingState) -> float:
    """Largest change of a length between two iterations [m], tilts of the axes included."""
    tilt = TILT_ARM * _largest_change(old, new, ("axis_tilt", "coupling_angle"))
    return max(_largest_change(old, new, LENGTHS), tilt)


def torque_change(old: CouplingState, new: CouplingState) -> float:
    """Largest relative change of a mean mesh torque between two iterations [-]."""
    changes = (
        abs(new.mesh_torque[name] - value) / max(abs(value), 1e-9) for name, value in old.mesh_torque.items()
    )
    return max(changes, default=0.0)


def _largest_change(old: CouplingState, new: CouplingState, names: tuple[str, ...]) -> float:
    changes = (
        abs(getattr(new, name)[part] - value) for name in names for part, value in getattr(old, name).items()
    )
    return max(changes, default=0.0)
