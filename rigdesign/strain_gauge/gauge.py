"""A foil strain gauge: its grid, its gauge factor, and what it reads without being strained."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.errors import Fault, MeasurementError
from rigdesign.base.units import ZERO_CELSIUS, refuse, require_above, require_at_least

Array = NDArray[np.float64]


REFERENCE_TEMPERATURE = 20.0 + ZERO_CELSIUS
"""Temperature at which data sheets give gauge factor and resistance [K]."""
CALIBRATION_POISSON_RATIO = 0.285
"""Of the beam on which makers find the gauge factor (Micro-Measurements TN-509)."""


@dataclass(frozen=True, kw_only=True)
class ThermalOutput:
    """Apparent strain of an unloaded gauge over its temperature, as the data sheet of its package has it.

    Parameters
    ----------
    coefficients : (m,) a_i in a_0 + a_1 t + a_2 t^2 + ..., strain [m/m] over t in degC
    gauge_factor : at which the polynomial is stated (Micro-Measurements: 2.0); None: that of the gauge
    expansion_mismatch : expansion coefficient of the part less that the gauge is matched to [1/K]
    """

    coefficients: tuple[float, ...]
    gauge_factor: float | None = None
    expansion_mismatch: float = 0.0

    def __post_init__(self) -> None:
        if not self.coefficients or not np.all(np.isfinite(self.coefficients)):
            refuse(
                "thermal_output.coefficients", str(self.coefficients), "must be numbers, one at least",
                "write those of the package, in strain: 1 um/m is 1e-6",
            )  # fmt: skip
        if self.gauge_factor is not None:
            require_above(
                "thermal_output.gauge_factor", self.gauge_factor, "", "write that of the data sheet"
            )

    def strain(self, temperature: float | Array, gauge_factor: float) -> Array:
        """Apparent strain [-] at ``temperature`` [K] of a gauge with ``gauge_factor``."""
        celsius = np.asarray(temperature, dtype=float) - ZERO_CELSIUS
        scale = 1.0 if self.gauge_factor is None else self.gauge_factor / gauge_factor
        stated = np.polynomial.polynomial.polyval(celsius, np.array(self.coefficients, dtype=float))
        mismatch = self.expansion_mismatch * (np.asarray(temperature, dtype=float) - REFERENCE_TEMPERATURE)
        return np.asarray(scale * stated + mismatch)


@dataclass(frozen=True, kw_only=True)
class StrainGauge:
    """Foil strain gauge.

    Parameters
    ----------
    gauge_factor : k, relative change of resistance over strain along the grid [-]
    resistance : [ohm]
    grid_length, grid_width : of the grid, along and across its wires [m]
    transverse_sensitivity : K_t, sensitivity across over along the grid [-]
    gauge_factor_slope : relative change of k over temperature [1/K]
    thermal_output : None: not corrected

    Raises
    ------
    CaseError
        k, resistance or grid not above zero; a transverse sensitivity beyond +-0.2.
    """

    gauge_factor: float = 2.0
    resistance: float = 120.0
    grid_length: float
    grid_width: float
    transverse_sensitivity: float = 0.0
    gauge_factor_slope: float = 0.0
    thermal_output: ThermalOutput | None = None

    def __post_init__(self) -> None:
        sheet = "write that of its data sheet"
        require_above("gauge_factor", self.gauge_factor, "", f"{sheet}, 2.0 to 2.2 for constantan")
        require_above("resistance", self.resistance, "ohm", f"{sheet}, 120 or 350 ohm as a rule")
        require_above("grid_length", self.grid_length, "m", sheet)
        require_above("grid_width", self.grid_width, "m", sheet)
        if not abs(self.transverse_sensitivity) <= 0.2:
            refuse(
                "transverse_sensitivity", f"{self.transverse_sensitivity:.6g}", "must lie within -0.2 to 0.2",
                f"{sheet} as a share: 0.2 % is 0.002",
            )  # fmt: skip

    def factor_at(self, temperature: float | Array | None) -> float | Array:
        """Gauge factor at ``temperature`` [K]; None: that of the data sheet."""
        if temperature is None:
            return self.gauge_factor
        excess = np.asarray(temperature, dtype=float) - REFERENCE_TEMPERATURE
        return np.asarray(self.gauge_factor * (1.0 + self.gauge_factor_slope * excess))

    def thermal_strain(self, temperature: float | Array | None) -> float | Array:
        """Apparent strain [-] at ``temperature`` [K]; zero where either is not known."""
        if temperature is None or self.thermal_output is None:
            return 0.0
        return self.thermal_output.strain(temperature, self.gauge_factor)

    def indicated(self, transverse_ratio: float, misalignment: float = 0.0) -> float:
        """Strain a gauge indicates by its gauge factor over the strain in the direction it is meant to measure.

        eps_ind = (eps_along + K_t eps_across) / (1 - nu_0 K_t), with both strains turned by the misalignment as
        Mohr's circle has it, shear being zero in the direction that is meant.

        Parameters
        ----------
        transverse_ratio : strain across over strain along the direction that is meant [-]
        misalignment : angle between the grid and that direction [rad]

        Source: Micro-Measurements TN-509 (transverse sensitivity) and TN-511 (misalignment), from memory.
        """
        along = np.cos(misalignment) ** 2 + transverse_ratio * np.sin(misalignment) ** 2
        across = np.sin(misalignment) ** 2 + transverse_ratio * np.cos(misalignment) ** 2
        sensitivity = self.transverse_sensitivity
        return float((along + sensitivity * across) / (1.0 - CALIBRATION_POISSON_RATIO * sensitivity))


# The Wheatstone bridge of a strain gauge: voltage over supply as a function of strain, and back.
#
#     u = U_B / U_E = (R1 R3 - R2 R4) / ((R1 + R2)(R3 + R4)),  R_i = R (1 + k eps_i)
#
# Every resistance is linear in the strain, so that u(eps) is a quotient of quadratics and its inverse the root of
# a quadratic: both are exact, nonlinearity and leads included. Linearised, u = B k eps / 4 with the bridge factor
# B = eps_1 - eps_2 + eps_3 - eps_4 over eps.
# Source: K. Hoffmann, An Introduction to Measurements using Strain Gages (HBM 1989), ch. 3; the converted forms of the
# types are those of Keysight's and NI's strain equations.

BridgeKind = Literal["quarter", "half_passive", "half", "full"]
ARMS: Mapping[BridgeKind, tuple[float, ...]] = {
    "quarter": (1.0,), "half_passive": (1.0,), "half": (1.0, -1.0), "full": (1.0, -1.0, 1.0, -1.0),
}  # fmt: skip
"""Strain of each active arm over that of the gauge where nothing else is stated: a bent bar."""
WIRES: Mapping[BridgeKind, tuple[int, ...]] = {
    "quarter": (3, 2), "half_passive": (3, 5), "half": (3, 5), "full": (4, 6),
}  # fmt: skip
"""Wires a bridge can have, the usual number first; 5 and 6 sense the supply at the bridge."""
LARGEST_MISMATCH = 0.02
"""Relative difference between completion resistor and gauge: 5 mV/V before any strain, beyond what strain amplifiers
balance; another nominal resistance is meant."""
LARGEST_LEAD = 0.5
"""Lead resistance over that of the gauge from which the circuit measures its leads."""
LARGEST_STRAIN = 0.05
"""Strain [-] at which foil gauges tear (elongation of constantan grids, data sheets)."""


class _Arm(NamedTuple):
    """Resistance base + slope * strain [ohm]."""

    base: float | Array
    slope: float | Array


class _Quadratic(NamedTuple):
    """constant + linear x + square x^2."""

    constant: float | Array
    linear: float | Array
    square: float | Array

    def at(self, x: float | Array) -> float | Array:
        return self.constant + x * (self.linear + x * self.square)


@dataclass(frozen=True, kw_only=True)
class Bridge:
    """Bridge circuit of one measuring point.

    Parameters
    ----------
    kind : quarter: one gauge, completed in the amplifier; half_passive: one gauge with a passive resistor beside it,
        as in P1 (the half bridge is led through the slip ring in three lines and completed in the logger);
        half: two gauges; full: four
    supply_voltage : U_E at the amplifier [V]
    arms : strain of each active arm over that of the gauge, e.g. (1, -nu) for a transverse second gauge;
        None: those of ``ARMS``
    completion_resistance : of the passive resistor [ohm]; None: that of the gauge
    wires : as in ``WIRES``; None: the usual number
    lead_resistance : of one wire with its slip-ring contact [ohm]

    Raises
    ------
    CaseError
        A kind, number of wires or of active arms that does not exist, arms that cancel, a supply not above zero,
        a completion resistor that does not match the gauge or has no place, leads of no sensible resistance.
    """

    kind: BridgeKind
    gauge: StrainGauge
    supply_voltage: float
    arms: tuple[float, ...] | None = None
    completion_resistance: float | None = None
    wires: int | None = None
    lead_resistance: float = 0.0

    def __post_init__(self) -> None:
        if self.kind not in ARMS:
            refuse("kind", str(self.kind), "no such bridge", f"write one of {', '.join(ARMS)}")
        require_above("supply_voltage", self.supply_voltage, "V", "write the voltage that feeds the bridge")
        self._check_arms()
        if self.wires is not None and self.wires not in WIRES[self.kind]:
            accepted = " or ".join(str(count) for count in sorted(WIRES[self.kind]))
            refuse(
                "wires",
                str(self.wires),
                f"a {self.kind} bridge has {accepted}",
                "count those to the amplifier",
            )
        require_at_least("lead_resistance", self.lead_resistance, "ohm", "write that of one wire")
        if self.lead_resistance > LARGEST_LEAD * self.gauge.resistance:
            refuse(
                "lead_resistance", f"{self.lead_resistance:.6g} ohm",
                f"must be at most {LARGEST_LEAD:.0%} of the {self.gauge.resistance:.6g} ohm of the gauge",
                "write that of one wire; look at plugs and slip ring",
            )  # fmt: skip
        self._check_completion()

    def _check_arms(self) -> None:
        active, most = self.active_arms, len(ARMS[self.kind])
        if len(active) != most:
            more = "more" if len(active) > most else "fewer"
            refuse(
                "arms", f"{len(active)} active arms", f"{more} than the {most} of a {self.kind} bridge",
                "correct the arms or the kind of the bridge",
            )  # fmt: skip
        if not (all(np.isfinite(active)) and all(abs(arm) <= 1.0 for arm in active)):
            refuse(
                "arms", str(active), "must lie within -1 to 1",
                "write the strain of each arm over that of the gauge with the largest",
            )  # fmt: skip
        if abs(self.bridge_factor) < 1e-9:
            refuse(
                "arms", str(active), "the arms cancel, bridge factor 0", "turn the sign of neighbouring arms"
            )

    def _check_completion(self) -> None:
        if self.completion_resistance is None:
            return
        key, given = "completion_resistance", f"{self.completion_resistance:.6g} ohm"
        if self.kind in ("half", "full"):
            refuse(
                key, given, f"a {self.kind} bridge has none", "remove it or correct the kind of the bridge"
            )
        require_above(key, self.completion_resistance, "ohm", "write that of the passive resistor")
        if abs(self.completion_resistance / self.gauge.resistance - 1.0) > LARGEST_MISMATCH:
            refuse(
                key, given,
                f"must match the {self.gauge.resistance:.6g} ohm of the gauge within {LARGEST_MISMATCH:.0%}",
                "use a resistor of the gauge's nominal resistance",
            )  # fmt: skip

    @property
    def active_arms(self) -> tuple[float, ...]:
        """Strain of each active arm over that of the gauge."""
        return ARMS[self.kind] if self.arms is None else self.arms

    @property
    def lines(self) -> int:
        """Wires to the amplifier, each a channel of the slip ring: 3, and 15 for the five gauges of P1."""
        return WIRES[self.kind][0] if self.wires is None else self.wires

    @property
    def bridge_factor(self) -> float:
        """B in u = B k eps / 4."""
        return sum(arm * sign for arm, sign in zip(self.active_arms, (1.0, -1.0, 1.0, -1.0)))

    @property
    def sensitivity(self) -> float:
        """du/d(strain) at zero strain and reference temperature, leads and completion included [V/V]."""
        numerator, denominator = self._quotient(None)
        top, bottom = numerator.constant, denominator.constant
        return float((numerator.linear * bottom - top * denominator.linear) / bottom**2)

    def ratio(self, strain: float | Array, temperature: float | Array | None = None) -> Array:
        """U_B / U_E [V/V] at the indicated strain [-], not balanced.

        Parameters
        ----------
        strain : (n,) of the gauge, as its gauge factor indicates it
        temperature : (n,) or one of all gauges [K]; None: at the reference temperature, without thermal output
        """
        numerator, denominator = self._quotient(temperature)
        x = np.asarray(strain, dtype=float)
        return np.asarray(numerator.at(x) / denominator.at(x))

    def strain(self, ratio: float | Array, temperature: float | Array | None = None) -> Array:
        """Indicated strain [-] of a ratio [V/V] as `ratio` gives it; the exact inverse. NaN stays NaN.

        Raises
        ------
        MeasurementError
            A ratio that no strain within +-5 % gives.
        """
        u = np.asarray(ratio, dtype=float)
        top, bottom = self._quotient(temperature)
        constant, linear, square = (np.asarray(n - u * d) for n, d in zip(top, bottom))
        with np.errstate(invalid="ignore", divide="ignore"):
            root = np.sqrt(linear**2 - 4.0 * square * constant)
            strain = np.asarray(-2.0 * constant / (linear + np.sign(linear) * root))
        beyond = np.isfinite(u) & ~(np.abs(strain) <= LARGEST_STRAIN)
        if beyond.any():
            worst = float(np.abs(u[beyond]).max())
            raise MeasurementError([Fault(
                "voltage_ratio", f"{1e3 * worst:.6g} mV/V",
                f"{np.count_nonzero(beyond)} samples beyond a strain of {LARGEST_STRAIN:.0%}",
                "look at the unit of the channel, the supply voltage, the zero and the gauge's wires",
            )])  # fmt: skip
        return strain

    def nonlinearity(self, strain: float) -> float:
        """Relative deviation of the balanced output from the tangent at zero; -k eps / 2 for a quarter bridge [-]."""
        output = float(self.ratio(strain) - self.ratio(0.0))
        return output / (self.sensitivity * strain) - 1.0 if strain else 0.0

    def _quotient(self, temperature: float | Array | None) -> tuple[_Quadratic, _Quadratic]:
        """Numerator and denominator of u over the strain."""
        first, second, third, fourth = self._resistances(temperature)
        left = _Arm(first.base + second.base, first.slope + second.slope)
        right = _Arm(third.base + fourth.base, third.slope + fourth.slope)
        plus, minus = _product(first, third), _product(second, fourth)
        numerator = _Quadratic(*(a - b for a, b in zip(plus, minus)))
        # the supply of four wires drops over two leads in series with both halves of the bridge in parallel
        lost = 2.0 * self.lead_resistance if self.lines == 4 else 0.0
        both = _product(left, right)
        denominator = _Quadratic(
            both.constant + lost * (left.base + right.base),
            both.linear + lost * (left.slope + right.slope),
            both.square,
        )
        return numerator, denominator

    def _resistances(self, temperature: float | Array | None) -> tuple[_Arm, _Arm, _Arm, _Arm]:
        factor, apparent = self.gauge.factor_at(temperature), self.gauge.thermal_strain(temperature)
        nominal = self.gauge.resistance
        # wires 3: one lead in each of the first two arms; 2: both in the arm of the gauge
        leads, neighbour = {2: (2.0, 0.0), 3: (1.0, 1.0)}.get(self.lines, (0.0, 0.0))
        active = [
            _Arm(nominal * (1.0 + factor * apparent), nominal * factor * arm) for arm in self.active_arms
        ]
        if len(active) == 1:
            active.append(_Arm(self.completion_resistance or nominal, 0.0))
        first, second = active[:2]
        first = _Arm(first.base + leads * self.lead_resistance, first.slope)
        second = _Arm(second.base + neighbour * self.lead_resistance, second.slope)
        third, fourth = active[2:] or (_Arm(nominal, 0.0), _Arm(nominal, 0.0))
        return first, second, third, fourth


def _product(first: _Arm, second: _Arm) -> _Quadratic:
    return _Quadratic(
        first.base * second.base,
        first.base * second.slope + first.slope * second.base,
        first.slope * second.slope,
    )
