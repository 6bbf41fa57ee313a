"""Rolling bearing in steady state: friction, temperature, life, stiffness.

Heat balance of one node, the rolling elements with their lubricant:

    P(T) + heat from bodies = rho c Q (T - T_in) + G_s (T - T_s) + G_h (T - T_h)

oil well mixed in the bearing, shaft and housing seats joined by the conductances G_s and G_h; the friction P depends
on T by the viscosity. With grease the oil flow is 0 and the seats take all of it.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

from scipy.optimize import brentq

from dynamics.rotor.bearing import (
    BearingError,
    BearingNotConvergedError,
    BearingOperation,
    HeatStar,
)
from dynamics.rotor.rolling_friction import (
    LAWS,
    LUBRICATIONS,
    OIL_KINDS,
    FrictionConditions,
    FrictionLaw,
    FrictionTorque,
    Lubrication,
    OilKind,
)
from dynamics.rotor.rolling_kinds import CatalogueBearing
from dynamics.rotor.rolling_row import COMMON_GROOVE, BallGroove, RowOfElements, contact_law
from dynamics.rotor.rolling_state import LifeConditions, RollingState, limit_warnings, rating_life
from dynamics.rotor.rolling_stiffness import bearing_stiffness
from dynamics.standards import iso281_2007

# Heat paths of a rolling bearing from its oil and rolling elements to shaft and housing.
#
# One node (rolling elements with their lubricant) is joined to each seat by three resistances in series: the raceway
# film, the ring and the joint of the fit. Ring conduction is that of a cylinder; the two film coefficients are
# assumptions for want of a formula that holds for all kinds and are to be replaced where the bearing was measured.

RACEWAY_FILM = 1000.0
"""Rolling contacts and carried oil between rolling elements and raceway [W/(m2 K)], on the raceway area; assumed,
300 to 3000."""
SEAT_JOINT = 5000.0
"""Joint of ring and seat [W/(m2 K)]: ground steel, interference fit; assumed, 2000 (loose) to 20000."""
RING_CONDUCTIVITY = 46.0
"""Rolling bearing steel, hardened [W/(m K)]."""


@dataclass(frozen=True, kw_only=True)
class HeatPath:
    """Series of resistances from the rolling elements to one seat [K/W]."""

    film: float
    ring: float
    joint: float

    @property
    def conductance(self) -> float:
        """[W/K]."""
        return 1.0 / (self.film + self.ring + self.joint)

    @property
    def ring_share(self) -> float:
        """Share of the temperature difference between bearing and seat down to the middle of the ring [-]."""
        return (self.film + 0.5 * self.ring) / (self.film + self.ring + self.joint)


@dataclass(frozen=True, kw_only=True)
class SeatConductances:
    """Conductances between the bearing and its seats, measured or from a finer model; they replace the default ones.

    shaft, housing : [W/K], not negative

    Raises BearingError for a negative one.
    """

    shaft: float
    housing: float

    def __post_init__(self) -> None:
        for name in ("shaft", "housing"):
            value = getattr(self, name)
            if not (value >= 0.0 and math.isfinite(value)):
                raise BearingError(
                    f"seat conductance: {name} = {value:.6g} W/K: must be finite and not negative; 0 keeps the heat in"
                )


def shaft_path(bearing: CatalogueBearing) -> HeatPath:
    """Inner raceway, inner ring and its seat."""
    return _path(bearing.elements.inner_raceway, bearing.bore, bearing.width)


def housing_path(bearing: CatalogueBearing) -> HeatPath:
    """Outer raceway, outer ring and its seat."""
    return _path(bearing.elements.outer_raceway, bearing.outside_diameter, bearing.width)


def _path(raceway: float, seat: float, width: float) -> HeatPath:
    return HeatPath(
        film=1.0 / (RACEWAY_FILM * math.pi * raceway * width),
        ring=abs(math.log(raceway / seat)) / (2.0 * math.pi * RING_CONDUCTIVITY * width),
        joint=1.0 / (SEAT_JOINT * math.pi * seat * width),
    )


MAXIMUM_RISE = 400.0
"""Temperature above that without friction at which the balance is given up [K]."""
MAXIMUM_DROP = 60.0
"""Temperature below that without friction at which the balance is given up [K]."""
OIL_CONDUCTIVITY = 0.13
"""Of the oil in the equivalent gap of `RollingState.mean_inverse_gap` [W/(m K)]."""


@dataclass(frozen=True, kw_only=True)
class RollingBearing:
    """Rolling bearing with its friction law, lubrication and clearance as it runs.

    data : catalogue numbers
    law : friction law, ``skf`` or ``iso_tr_14179_2``
    lubrication : how the oil comes; the oil of a ``grease`` is its base oil
    oil_level : of an oil bath above the lowest point of the outer raceway [m]; None is the centre of the lowest
        rolling element
    oil_kind : sliding friction of the SKF model in full film
    clearance : radial internal clearance as it runs [m], negative is preload; see
        `dynamics.rotor.rolling_clearance`. It decides the stiffness only
    contamination : factor e_C of ISO 281, 0 to 1, or the name of a level of its table 13
    reliability : of the rating life, 0.90 to 0.99
    seal_torque : of the bearing's own contact seals [N m]
    seats : conductances to shaft and housing in place of the default ones
    groove : conformities of a ball bearing

    Raises BearingError naming key, value and remedy.
    """

    data: CatalogueBearing
    law: FrictionLaw = "skf"
    lubrication: Lubrication = "oil_bath"
    oil_level: float | None = None
    oil_kind: OilKind = "mineral"
    clearance: float = 0.0
    contamination: float | str = "normal cleanliness"
    reliability: float = 0.90
    seal_torque: float = 0.0
    seats: SeatConductances | None = None
    groove: BallGroove = COMMON_GROOVE

    def __post_init__(self) -> None:
        for name, options in (("law", LAWS), ("lubrication", LUBRICATIONS), ("oil_kind", OIL_KINDS)):
            value = getattr(self, name)
            if value not in options:
                raise BearingError(
                    f"rolling bearing: {name} = {value!r}: must be one of {', '.join(options)}"
                )
        if self.law not in self.data.rules.friction_sources:
            raise self.data.wrong(
                "law", repr(self.law),
                f"has no coefficients for its kind; take {' or '.join(self.data.rules.friction_sources)}",
            )  # fmt: skip
        if not (self.seal_torque >= 0.0 and math.isfinite(self.seal_torque)):
            raise BearingError(
                f"rolling bearing: seal_torque = {self.seal_torque:.6g} N m: must be finite and not negative"
            )
        if self.oil_level is not None and not 0.0 <= self.oil_level <= self.data.outside_diameter:
            raise BearingError(
                f"rolling bearing: oil_level = {self.oil_level:.6g} m: must lie within 0 to the outside diameter "
                f"{self.data.outside_diameter:.6g} m, above the lowest point of the outer raceway"
            )
        if not isinstance(self.contamination, str) and not 0.0 <= self.contamination <= 1.0:
            raise BearingError(
                f"rolling bearing: contamination = {self.contamination:.6g}: must lie within 0 to 1 (factor e_C of "
                "ISO 281); 1 is clean"
            )
        iso281_2007.a_1(self.reliability)
        if (
            not 0.5
            < min(self.groove.inner, self.groove.outer)
            <= max(self.groove.inner, self.groove.outer)
            < 1.0
        ):
            raise BearingError(
                f"rolling bearing: groove = {self.groove.inner:.4g}, {self.groove.outer:.4g}: groove radius over ball "
                "diameter must lie within 0.5 to 1"
            )

    def operating_state(self, operation: BearingOperation) -> "RollingState":
        """Solve friction and heat balance together; life, safety and stiffness at the temperature found.

        Raises
        ------
        BearingError : axial load on a bearing that carries none, or nothing that carries the heat
        BearingNotConvergedError : the temperature would leave that without friction by more than 400 K
        """
        self.data.check_axial(operation.axial_load)
        paths = self._paths(operation)
        carried = paths.total
        if carried == 0.0:
            raise BearingError(
                f"rolling bearing {self.data.designation}: oil flow = 0 m3/s, shaft and housing without temperature or "
                "conductance: nothing carries the friction heat; feed oil"
            )

        def excess(temperature: float) -> float:
            given = operation.friction_heat
            own = (
                self._friction(operation, temperature).total * abs(operation.speed)
                if given is None
                else given
            )
            return own + operation.heat_from_bodies - carried * (temperature - paths.without_friction)

        temperature = _balance(excess, paths.without_friction)
        return _state(self, operation, paths, temperature)

    @cached_property
    def row(self) -> RowOfElements:
        """Rolling elements with contact law and clearance as the stiffness reads them."""
        elements = self.data.elements
        return RowOfElements(
            elements=elements, law=contact_law(elements, self.groove), clearance=self.clearance
        )

    @cached_property
    def bath_level(self) -> float:
        """Oil level above the lowest point of the outer raceway [m]."""
        return 0.5 * self.data.elements.diameter if self.oil_level is None else self.oil_level

    @cached_property
    def contamination_factor(self) -> float:
        """e_C [-]."""
        if isinstance(self.contamination, str):
            return iso281_2007.e_C(self.contamination, self.data.elements.pitch_diameter * 1e3)
        return self.contamination

    def _friction(self, operation: BearingOperation, temperature: float) -> FrictionTorque:
        open_bearing = self.data.rules.friction(
            self.law,
            self.data,
            FrictionConditions(
                radial=operation.load,
                axial=operation.axial_load,
                speed=abs(operation.speed),
                viscosity=operation.oil.viscosity(temperature) / operation.oil.density,
                lubrication=self.lubrication,
                oil_level=self.bath_level,
                oil_kind=self.oil_kind,
            ),
        )
        sealed = FrictionTorque(
            rolling=open_bearing.rolling,
            sliding=open_bearing.sliding,
            seals=self.seal_torque,
            drag=open_bearing.drag,
        )
        return sealed.scaled(operation.friction_factor)

    def _paths(self, operation: BearingOperation) -> "_HeatPaths":
        shaft, housing = shaft_path(self.data), housing_path(self.data)
        to_shaft = shaft.conductance if self.seats is None else self.seats.shaft
        to_housing = housing.conductance if self.seats is None else self.seats.housing
        return _HeatPaths(
            shaft_ring=shaft,
            housing_ring=housing,
            shaft=0.0 if operation.shaft_temperature is None else to_shaft,
            housing=0.0 if operation.housing_temperature is None else to_housing,
            capacity_rate=operation.oil.density * operation.oil.heat_capacity * operation.oil.flow,
            operation=operation,
        )


@dataclass(frozen=True)
class _HeatPaths:
    shaft_ring: HeatPath
    housing_ring: HeatPath
    shaft: float
    housing: float
    capacity_rate: float
    operation: BearingOperation

    @property
    def shaft_temperature(self) -> float:
        given = self.operation.shaft_temperature
        return self.operation.oil.inlet_temperature if given is None else given

    @property
    def housing_temperature(self) -> float:
        given = self.operation.housing_temperature
        return self.operation.oil.inlet_temperature if given is None else given

    @property
    def total(self) -> float:
        """Sum of what oil and seats carry [W/K]."""
        return self.capacity_rate + self.shaft + self.housing

    @property
    def without_friction(self) -> float:
        """Mean of oil inlet and seats, weighed by what they carry [K]."""
        return (
            self.capacity_rate * self.operation.oil.inlet_temperature
            + self.shaft * self.shaft_temperature
            + self.housing * self.housing_temperature
        ) / self.total


def _balance(excess: Callable[[float], float], start: float) -> float:
    """Temperature at which the heat is carried away [K]."""
    at_start = excess(start)
    if at_start == 0.0:
        return start
    limit = MAXIMUM_RISE if at_start > 0.0 else -MAXIMUM_DROP
    step = math.copysign(10.0, limit)
    while excess(start + step) * at_start > 0.0:
        if step == limit:
            raise BearingNotConvergedError(
                f"rolling bearing: temperature leaves the {start:.0f} K without friction by more than {limit:+.0f} K; "
                "feed more oil, cool the housing or correct the heat from the bodies"
            )
        step = math.copysign(min(2.0 * abs(step), abs(limit)), limit)
    low, high = sorted((start, start + step))
    root: float = brentq(excess, low, high, xtol=1e-9, rtol=1e-13)
    return root


def _state(
    bearing: RollingBearing, operation: BearingOperation, paths: _HeatPaths, temperature: float
) -> RollingState:
    data, oil, omega = bearing.data, operation.oil, abs(operation.speed)
    friction = bearing._friction(operation, temperature)
    to_shaft = paths.shaft * (temperature - paths.shaft_temperature)
    to_housing = paths.housing * (temperature - paths.housing_temperature)
    viscosity = oil.viscosity(temperature)
    life = rating_life(
        data,
        LifeConditions(
            radial=operation.load,
            axial=operation.axial_load,
            speed=omega,
            viscosity=viscosity / oil.density,
            contamination=bearing.contamination_factor,
            reliability=bearing.reliability,
        ),
    )
    carried_axially = 0.0 if data.elements.straight else operation.axial_load
    stiffness = bearing_stiffness(bearing.row, operation.load, carried_axially)
    state = RollingState(
        load=operation.load,
        axial_load=operation.axial_load,
        omega=omega,
        drag_torque=friction.total,
        friction=friction,
        power=friction.total * omega,
        torsional_damping=friction.total / omega if omega > 0.0 else 0.0,
        film_temperature=temperature,
        outlet_temperature=temperature,
        viscosity=viscosity,
        flow=oil.flow,
        cooling_flow=oil.flow,
        capacity_rate=paths.capacity_rate,
        mean_inverse_gap=paths.shaft_ring.conductance / (OIL_CONDUCTIVITY * math.pi * data.bore * data.width),
        heat_from_bodies=operation.heat_from_bodies - to_shaft - to_housing,
        shaft_conductance=paths.shaft,
        housing_conductance=paths.housing,
        star=HeatStar(
            shaft=paths.shaft,
            housing=paths.housing,
            oil=paths.capacity_rate,
            oil_temperature=oil.inlet_temperature,
            heat=paths.total * (temperature - paths.without_friction),
        ),
        heat_to_shaft=to_shaft,
        heat_to_housing=to_housing,
        inner_ring_temperature=_ring(temperature, paths.shaft_temperature, paths.shaft_ring, paths.shaft),
        outer_ring_temperature=_ring(
            temperature, paths.housing_temperature, paths.housing_ring, paths.housing
        ),
        specific_load=None,
        minimum_film=None,
        transition_speed=None,
        life=life,
        load_utilisation=life.equivalent_load / data.dynamic_rating,
        speed_utilisation=omega / data.limiting_speed,
        reference_speed_utilisation=omega / data.reference_speed,
        minimum_load=data.rules.minimum_load(data, omega, viscosity / oil.density),
        stiffness=stiffness,
        row=bearing.row,
        source=data.rules.friction_sources[bearing.law],
        warnings=(),
    )
    bath = bearing.lubrication == "oil_bath"
    warnings = tuple(limit_warnings(state, data, drag_in_bath=bath and bearing.law == "skf"))
    if bath and bearing.law == "iso_tr_14179_2" and bearing.bath_level > data.elements.diameter:
        warnings += (_level_not_counted(bearing.bath_level, 0.5 * data.elements.diameter),)
    return replace(state, warnings=warnings)


def _level_not_counted(level: float, tabled: float) -> str:
    return (
        f"oil level = {level * 1e3:.1f} mm: ISO/TR 14179-2 has f_0 for a bath up to the middle of the lowest rolling "
        f'element, {tabled * 1e3:.1f} mm, what stands higher is not counted; take friction_law = "skf"'
    )


def _ring(bearing: float, seat: float, path: HeatPath, conductance: float) -> float:
    """Temperature of the middle of a ring [K]; that of the bearing where no heat flows through it."""
    return bearing - path.ring_share * (bearing - seat) if conductance > 0.0 else bearing
