"""What every kind of bearing answers: its steady state at a load, a speed, an oil supply and the heat of its bodies;
and its state, what stiffness and damping a rotor finds there.

A kind of bearing is a module of its own behind `Bearing`. What a kind adds to the common `BearingState` stays between
its module and its tests; whoever reads a state reads the common fields and need not know the kind.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError, DynamicsNotConverged

# Stiffness and damping of a bearing across its axis, as a rotor on it feels them.
#
# Axes of the rig: x along the shaft, (y, z) across it, turns about x, y, z right-handed. Force on the journal about its
# static position = -stiffness u - damping u', u = (u_y, u_z).

Array = NDArray[np.float64]

Regime = Literal["hydrodynamic", "mixed", "standstill", "elastic", "constant"]


@dataclass(frozen=True, kw_only=True, eq=False)
class LateralCoefficients:
    """Linear coefficients of one bearing at its static position.

    stiffness : (2, 2) [N/m]; that of a film is not symmetric
    damping : (2, 2) [N s/m], symmetric
    position : (2,) static displacement of the journal against the bearing [m]
    regime : what carries the journal
    eccentricity : static, over the radial clearance [-]; None for a kind without a film
    all_stiffness, all_damping : (5, 5) in the order u_x, u_y, u_z, theta_y, theta_z, of kinds that hold more than the
        two lateral directions; None for others. [N/m, N/rad = N m/m, N m/rad] and the same times s
    """

    stiffness: Array
    damping: Array
    position: Array
    regime: Regime
    eccentricity: float | None = None
    all_stiffness: Array | None = None
    all_damping: Array | None = None

    @property
    def node_stiffness(self) -> Array:
        """(5, 5) in the order u_x, u_y, u_z, theta_y, theta_z; 0 where the bearing holds nothing."""
        return _at_node(self.stiffness) if self.all_stiffness is None else self.all_stiffness

    @property
    def node_damping(self) -> Array:
        """(5, 5) as `node_stiffness`."""
        return _at_node(self.damping) if self.all_damping is None else self.all_damping

    @property
    def axial_stiffness(self) -> float:
        """Along x [N/m]; 0 for a plain bearing or rollers without contact angle."""
        return float(self.node_stiffness[0, 0])

    @property
    def tilting_stiffness(self) -> Array:
        """(2, 2) moments about y and z over tilts about them [N m/rad]."""
        return self.node_stiffness[3:, 3:]


def constant_coefficients(
    stiffness: float, damping: float, force: tuple[float, float] = (0.0, 0.0)
) -> LateralCoefficients:
    """Coefficients that a case states, equal in all directions (P2, Table 1: 1e8 N/m and 4e4 N s/m).

    stiffness, damping : radial [N/m], [N s/m]
    force : static load on the journal in y and z [N]

    Raises DynamicsInputError for a stiffness not above 0 or a negative damping.
    """
    if not (stiffness > 0.0 and math.isfinite(stiffness)):
        raise DynamicsInputError(
            f"bearing: stiffness = {stiffness:.6g} N/m: must be finite and above 0; correct the radial stiffness"
        )
    if not (damping >= 0.0 and math.isfinite(damping)):
        raise DynamicsInputError(
            f"bearing: damping = {damping:.6g} N s/m: must be finite and not negative; correct the radial damping"
        )
    return LateralCoefficients(
        stiffness=stiffness * np.eye(2),
        damping=damping * np.eye(2),
        position=np.array(force) / stiffness,
        regime="constant",
    )


def load_axes(force: tuple[float, float], sense: int) -> Array:
    """(2, 2) unit vectors in (y, z) as columns: along the load, and across it where the running journal is carried to.

    The second is the first turned a right angle in the direction of rotation. y without a load.

    sense : +1 for a shaft that turns about +x, from y to z; -1 the other way
    """
    magnitude = math.hypot(*force)
    along = np.array(force) / magnitude if magnitude > 0.0 else np.array([1.0, 0.0])
    return np.column_stack([along, sense * np.array([-along[1], along[0]])])


def _at_node(lateral: Array) -> Array:
    whole = np.zeros((5, 5))
    whole[1:3, 1:3] = lateral
    return whole


class BearingError(DynamicsInputError):
    """An impossible bearing or operation of one; the message names value, limit and remedy."""


class BearingNotConvergedError(DynamicsNotConverged):
    """No oil temperature balances friction and oil flow."""


@dataclass(frozen=True, kw_only=True)
class OilSupply:
    """Oil as it is fed to one bearing.

    inlet_temperature : [K]
    flow : not negative [m3/s]; 0 is grease, only for a kind that gives its heat to its seats as well
    viscosity : dynamic viscosity [Pa s] of a temperature [K], falling with it
    density, heat_capacity : at the inlet [kg/m3], [J/(kg K)]

    Raises BearingError for a flow that is negative or another number that is not above 0.
    """

    inlet_temperature: float
    flow: float
    viscosity: Callable[[float], float]
    density: float
    heat_capacity: float

    def __post_init__(self) -> None:
        if not self.flow >= 0.0:
            raise BearingError(
                f"bearing: oil flow = {self.flow} m3/s: must not be negative; correct the oil supply"
            )
        for name, value, unit in (
            ("oil density", self.density, "kg/m3"),
            ("oil heat capacity", self.heat_capacity, "J/(kg K)"),
            ("oil inlet temperature", self.inlet_temperature, "K"),
        ):
            if not value > 0.0:
                raise BearingError(
                    f"bearing: {name} = {value} {unit}: must be above 0; correct the oil supply"
                )

    def temperature_rise(self, heat: float, flow: float) -> float:
        """Rise of ``flow`` [m3/s] of this oil that takes up ``heat`` [W], with properties at the inlet [K]."""
        return heat / (self.density * self.heat_capacity * flow)


@dataclass(frozen=True, kw_only=True)
class BearingOperation:
    """Operating condition of one bearing.

    load : radial force, not negative [N]
    axial_load : axial force inside the bearing, not negative [N]; for kinds that carry one
    speed : of the shaft; its sign does not matter [rad/s]
    oil : as it is fed
    heat_from_bodies : heat that shaft and shell give to the oil in the bearing; negative if they cool it [W]
    friction_heat : measured or assumed friction heat, not negative [W]; it takes the place of the computed friction in
        the heat balance, the drag torque is the computed one all the same
    friction_factor : multiplies the friction, and with it its heat; not negative [-]
    shaft_temperature, housing_temperature : of the seats [K], for kinds that conduct heat into them; None where a seat
        takes none

    Raises BearingError for a load, friction heat or factor that is negative or not finite, or a seat temperature that
    is not above 0.
    """

    load: float
    speed: float
    oil: OilSupply
    heat_from_bodies: float = 0.0
    friction_heat: float | None = None
    friction_factor: float = 1.0
    axial_load: float = 0.0
    shaft_temperature: float | None = None
    housing_temperature: float | None = None

    def __post_init__(self) -> None:
        for name, value, unit, remedy in (
            ("load", self.load, " N", "give its magnitude"),
            ("axial_load", self.axial_load, " N", "give its magnitude"),
            (
                "friction_heat", self.friction_heat, " W",
                "give the measured loss, or none to let the bearing make its own",
            ),
            ("friction_factor", self.friction_factor, "", "give 1 for the friction of the bearing itself"),
        ):  # fmt: skip
            if value is not None and not (value >= 0.0 and math.isfinite(value)):
                raise BearingError(
                    f"bearing: {name} = {value}{unit}: must be finite and not negative; {remedy}"
                )
        for name, temperature in (
            ("shaft_temperature", self.shaft_temperature),
            ("housing_temperature", self.housing_temperature),
        ):
            if temperature is not None and not (temperature > 0.0 and math.isfinite(temperature)):
                raise BearingError(
                    f"bearing: {name} = {temperature} K: must be finite and above 0; give an absolute temperature"
                )


@dataclass(frozen=True, kw_only=True)
class LateralOperation:
    """Load under which a bearing in its steady state is asked for stiffness and damping.

    force : on the journal in y and z, weight included [N]; it decides the static position and may differ from the load
        at which temperature and viscosity of the state were found
    axial_force : on the shaft along x inside the bearing [N]; its sign says which way an angular contact presses
    sense : +1 for a shaft that turns about +x, from y to z; -1 the other way
    structural_damping : of contacts of metal, c = structural_damping times k, not negative [s]; rolling bearings have
        0.25e-5 to 2.5e-5 s (E. Kraemer, Dynamics of Rotors and Foundations, 1993)

    Raises BearingError for a force that is not finite, another sense or a negative damping.
    """

    force: tuple[float, float]
    axial_force: float = 0.0
    sense: Literal[1, -1] = 1
    structural_damping: float = 0.0

    def __post_init__(self) -> None:
        for name, value in (("force", math.hypot(*self.force)), ("axial_force", self.axial_force)):
            if not math.isfinite(value):
                raise BearingError(f"bearing: {name} = {value} N: must be finite; correct the loads")
        if self.sense not in (1, -1):
            raise BearingError(
                f"bearing: sense = {self.sense}: must be 1 (turns about +x) or -1; state one of them"
            )
        if not (self.structural_damping >= 0.0 and math.isfinite(self.structural_damping)):
            raise BearingError(
                f"bearing: structural_damping = {self.structural_damping} s: must be finite and not negative; 1e-5 s "
                "is usual"
            )


@dataclass(frozen=True, kw_only=True)
class HeatStar:
    """A bearing as one node between shaft seat, housing seat and oil.

    heat + oil (T_oil - T) + shaft (T_shaft - T) + housing (T_housing - T) = 0

    shaft, housing : conductances to the seats [W/K]; 0 to one that takes no heat
    oil : rho c Q of the oil that passes [W/K]
    oil_temperature : with which it comes [K]
    heat : friction heat in the balance [W]
    """

    shaft: float
    housing: float
    oil: float
    oil_temperature: float
    heat: float

    @property
    def total(self) -> float:
        """Sum of the three [W/K]."""
        return self.shaft + self.housing + self.oil

    def node(self, shaft: float, housing: float) -> float:
        """Temperature of the node between seats of these temperatures [K]."""
        carried = self.shaft * shaft + self.housing * housing + self.oil * self.oil_temperature
        return (self.heat + carried) / self.total


@dataclass(frozen=True, kw_only=True)
class BearingState:
    """Steady state of one bearing of any kind; SI units."""

    load: float
    """Radial [N]."""
    omega: float
    """Magnitude of the shaft speed [rad/s]."""
    drag_torque: float
    """[N m]"""
    power: float
    """Friction heat [W]."""
    torsional_damping: float
    """drag_torque / omega [N m s/rad]."""
    film_temperature: float
    """Of the oil that separates shaft and bearing [K]."""
    outlet_temperature: float
    """All oil fed, mixed behind the bearing [K]."""
    flow: float
    """Oil fed [m3/s]."""
    cooling_flow: float
    """Part of it that takes up the friction heat; the rest leaves past it [m3/s]."""
    mean_inverse_gap: float
    """Mean of 1/h of the oil between shaft and shell [1/m]; times the oil conductivity a heat transfer coefficient.
    A kind without one gap gives that of the gap which conducts as much."""
    heat_from_bodies: float
    """Heat conducted into the oil from shaft and shell [W]."""
    specific_load: float | None
    """F / (B D) [Pa]; None for a kind that is not rated by it."""
    minimum_film: float | None
    """Smallest film [m]; None for a kind that is not rated by it."""
    transition_speed: float | None
    """Fluid friction above this speed at this load and viscosity [rad/s]; None for a kind without mixed friction."""
    source: str
    """Document behind the friction."""
    warnings: tuple[str, ...]
    """What lies outside the theory: name, value, limit, remedy."""
    star: HeatStar | None = None
    """Of a kind that conducts its heat to its seats; None for a film that takes up the heat of its walls."""

    def lateral_coefficients(self, operation: LateralOperation) -> LateralCoefficients:
        """Stiffness, damping and static position at this speed and temperature under a load vector.

        Raises BearingError where nothing holds the journal, or for a kind that states no stiffness.
        """
        raise BearingError(
            f"bearing: stiffness = none: {type(self).__name__} states none; use constant coefficients for a load of "
            f"{math.hypot(*operation.force):.6g} N"
        )


class Bearing(Protocol):
    """A bearing with its clearance as it runs: thermal and centrifugal expansion taken off by whoever makes it."""

    def operating_state(self, operation: BearingOperation) -> BearingState:
        """Solve friction and heat balance together.

        Raises
        ------
        BearingError : an operation that the kind cannot have
        BearingNotConvergedError : no oil temperature balances friction and oil flow
        """
        ...
