"""Churning of gears that dip into an oil bath, by Changenet and Velex or by ISO/TR 14179-2.

Changenet and Velex know oil, sump volume and regime of one gear; losses of the gears of a sump are added.
ISO/TR 14179-2 (Mauz) gives the torque of a dipped stage from immersion, width, speed and housing; the viscosity does
not enter, so it stands for oil at working temperature. On gears of 100 mm it gives several times the others:
`churning_comparison` shows both.

Left out, as no formula was found: side walls near the gear (they lower the loss; radial walls matter less: Changenet
and Velex 2008), the sense of rotation of a pair (oil drawn into the mesh swells and raises the loss), air in the oil
(raises it: Leprince et al. 2011), oil trapped in the mesh (`mesh_loss.squeeze_loss` takes it as an input).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, NamedTuple

from dynamics.losses.immersion import OilBath, RunningGear, immersion, level_warnings, wetted_area
from dynamics.losses.loss import Loss, LossError
from dynamics.losses.windage import disc_coefficient
from dynamics.standards import iso_tr_14179_2_2001 as tr14179

# Coefficient of the churning torque of one gear after Changenet and Velex, from tests on single gears in a bath.
#
#     T = rho omega^2 R^3 S_m C_m / 2 ,   R pitch radius, S_m wetted surface (`immersion.wetted_area`)
#
# C_m is a product of powers of h/D, V_0/D^3, b/D, Froude and Reynolds number. The form of 2007 tells the regimes apart
# by Re_c = omega R b/nu, that of 2011 by a centrifugal acceleration and by Re_c. All digits are from memory, no public
# copy of them was found. One check speaks for those of 2011: the formulas meet in pairs, 1.366 to 0.239 and 20.797 to
# 3.644, both at a Reynolds number of 4000 within 1 %.

GRAVITY = 9.81
SLOW, FAST = 750.0, 1250.0
"""Centrifugal accelerations [m/s2] between which the 2011 laws are joined."""
VISCOUS_LIMIT = 4000.0
"""Re_c above which viscosity drops out of the 2011 laws."""
LOW_RE, HIGH_RE = 6000.0, 9000.0
"""Re_c between which the 2007 laws are joined."""


class BathNumbers(NamedTuple):
    """Dimensionless numbers of a dipped gear, lengths at its pitch circle."""

    depth: float
    """h/D"""
    oil: float
    """V_0/D^3"""
    width: float
    """b/D"""
    froude: float
    """omega^2 R/g"""
    reynolds: float
    """omega R b/nu, the number that separates the regimes"""
    acceleration: float
    """gamma = omega^2 (b R m)^(1/3) [m/s2]"""


def bath_numbers(running: RunningGear, bath: OilBath) -> BathNumbers:
    """Dimensionless numbers of a gear in a bath; the depth is that of the pitch circle."""
    gear, speed = running.gear, abs(running.speed)
    diameter = 2.0 * gear.pitch_radius
    size: float = (gear.face_width * gear.pitch_radius * gear.normal_module) ** (1.0 / 3.0)
    return BathNumbers(
        depth=immersion(gear, bath, gear.pitch_radius).depth / diameter,
        oil=bath.volume / diameter**3,
        width=gear.face_width / diameter,
        froude=speed**2 * gear.pitch_radius / GRAVITY,
        reynolds=speed * gear.pitch_radius * gear.face_width / bath.kinematic_viscosity,
        acceleration=speed**2 * size,
    )


def coefficient_2007(numbers: BathNumbers) -> float:
    """C_m of Changenet and Velex, J. Mech. Des. 129 (2007) 128 [-], from memory.

    Re_c <= 6000: 1.366 (h/D)^0.45 (V_0/D^3)^0.1 Fr^-0.6 Re^-0.21, Re = omega R^2/nu
    Re_c >= 9000: 3.644 (h/D)^0.1 (V_0/D^3)^-0.35 Fr^-0.88 (b/D)^0.85; straight in Re_c between
    """
    share = _between(numbers.reynolds, LOW_RE, HIGH_RE)
    slow: float = 1.366 * _slow_shape(numbers) * numbers.reynolds**-0.21
    return (1.0 - share) * slow + share * 3.644 * _fast_shape(numbers)


def coefficient_2011(numbers: BathNumbers) -> float:
    """C_m of Changenet, Leprince, Ville and Velex, J. Mech. Des. 133 (2011) 121009 [-], from memory.

    gamma <= 750 m/s2: 1.366 (h/D)^0.45 (V_0/D^3)^0.1 Fr^-0.6 Re_c^-0.21 (b/R)^0.21, without Re_c: 0.239
    gamma >= 1250 m/s2: 20.797 (h/D)^0.1 (V_0/D^3)^-0.35 Fr^-0.88 Re_c^-0.21 (b/D)^0.85, without Re_c: 3.644

    Straight in gamma between. Viscosity acts below Re_c = 4000, where both forms of a line meet: the constants 0.239
    and 3.644 are 1.366 and 20.797 times 4000^-0.21.
    """
    share = _between(numbers.acceleration, SLOW, FAST)
    viscous: float = min(numbers.reynolds, VISCOUS_LIMIT) ** -0.21
    slow, fast = 1.366 * _slow_shape(numbers), 20.797 * _fast_shape(numbers)
    return viscous * ((1.0 - share) * slow + share * fast)


def _slow_shape(numbers: BathNumbers) -> float:
    """(h/D)^0.45 (V_0/D^3)^0.1 Fr^-0.6 (b/R)^0.21; the last turns Re_c^-0.21 into Re^-0.21."""
    shape: float = (
        numbers.depth**0.45 * numbers.oil**0.1 * numbers.froude**-0.6 * (2.0 * numbers.width) ** 0.21
    )
    return shape


def _fast_shape(numbers: BathNumbers) -> float:
    shape: float = numbers.depth**0.1 * numbers.oil**-0.35 * numbers.froude**-0.88 * numbers.width**0.85
    return shape


def _between(value: float, low: float, high: float) -> float:
    return min(1.0, max(0.0, (value - low) / (high - low)))


ChurningLaw = Literal["changenet_2011", "changenet_2007", "iso_tr_14179_2"]
LAWS: tuple[ChurningLaw, ...] = ("changenet_2011", "changenet_2007", "iso_tr_14179_2")
"""In the order of preference where validity does not decide: the first knows oil, volume and regime."""

TESTED = {
    "pitch diameter": (0.09, 0.16, "m"),
    "face width": (0.014, 0.04, "m"),
    "normal module": (0.0015, 0.006, "m"),
    "immersion / diameter": (0.03, 0.5, ""),
}
"""Gears behind the laws of Changenet and Velex (size of their test gears; limits from memory, rounded outwards)."""
ISO_RANGE = {
    "circumferential speed": (1.0, 60.0, "m/s"),
    "face width": (0.01, 0.06, "m"),
    "immersion / tip radius": (0.05, 1.05, ""),
}
"""Where the ISO formula counts as interpolation (limits assumed; the cube of the width rules above 60 mm)."""


def churning_loss(running: RunningGear, bath: OilBath, law: ChurningLaw = "changenet_2011") -> Loss:
    """Churning of one gear alone in a bath [W].

    By ISO/TR 14179-2 the point of contact lies at the height of the axis (level neighbour) and the neighbour is dry;
    for a pair of dipped gears use `stage_churning`. Zero without speed or immersion.

    Raises LossError for a level at or above the top of the shaft, an unknown law, or the ISO law with a bath without
    hydraulic length.
    """
    _known(law)
    if law == "iso_tr_14179_2":
        h = 1e3 * immersion(running.gear, bath).depth
        stage = tr14179.DippedStage(
            h, 0.0, 1e3 * running.gear.tip_radius, 1e3 * _length(bath), 1e3 * running.gear.face_width
        )
        return _iso_loss(running, bath, stage, 1.0)
    numbers = bath_numbers(running, bath)
    wet = wetted_area(running.gear, bath)
    power = coefficient = 0.0
    if running.speed != 0.0 and wet > 0.0:
        coefficient = _COEFFICIENTS[law](numbers)
        radius, omega = running.gear.pitch_radius, abs(running.speed)
        power = 0.5 * bath.density * omega**3 * radius**3 * wet * coefficient
    return Loss(
        place=running.place,
        kind="churning",
        power=power,
        details={
            "coefficient": coefficient,
            "wetted_area": wet,
            "immersion_ratio": numbers.depth,
            "froude_number": numbers.froude,
            "reynolds_number": numbers.reynolds,
            "centrifugal_acceleration": numbers.acceleration,
            "side_friction": side_friction(running, bath),
            "extrapolation": _extrapolation(_tested_values(running, numbers), TESTED),
            "law": law,
            "source": _SOURCES[law],
        },
        warnings=level_warnings(running.place, running.gear, bath)
        + _outside(f"{running.place}: churning (Changenet)", _tested_values(running, numbers), TESTED),
    )


def side_friction(running: RunningGear, bath: OilBath) -> float:
    """Skin friction of the immersed part of both faces alone [W], an estimate from below for any law.

    Free disc in oil (`windage.disc_coefficient`) to the root radius times the immersed share of its area.
    """
    radius, omega = running.gear.root_radius, abs(running.speed)
    share = immersion(running.gear, bath, radius).side_area / (2.0 * math.pi * radius**2)
    coefficient = disc_coefficient(omega * radius**2 / bath.kinematic_viscosity)
    return 0.5 * share * coefficient * bath.density * omega**3 * radius**5


def stage_churning(
    stage: tuple[RunningGear, RunningGear], bath: OilBath, law: ChurningLaw = "changenet_2011"
) -> tuple[Loss, Loss]:
    """Churning of both gears of a stage in one sump [W].

    By Changenet and Velex the sum of single gears. By ISO/TR 14179-2 the torque of the stage times the speed of the
    gear that dips deeper, divided in proportion to the immersions (no part of the document).

    Raises LossError as `churning_loss`.
    """
    _known(law)
    if law != "iso_tr_14179_2":
        return churning_loss(stage[0], bath, law), churning_loss(stage[1], bath, law)
    depths = [immersion(running.gear, bath).depth for running in stage]
    deeper = stage[depths.index(max(depths))]
    share_1 = depths[0] / sum(depths) if sum(depths) > 0.0 else 0.5
    tr_stage = tr14179.DippedStage(
        h_e1=1e3 * depths[0],
        h_e2=1e3 * depths[1],
        h_C=1e3 * (_contact_height(stage) - deeper.gear.lowest_point),
        l_h=1e3 * _length(bath),
        b=1e3 * min(running.gear.face_width for running in stage),
    )
    whole = _iso_loss(deeper, bath, tr_stage, 1.0).power
    first, second = (
        _iso_loss(running, bath, tr_stage, share, whole)
        for running, share in zip(stage, (share_1, 1.0 - share_1), strict=True)
    )
    return first, second


_COEFFICIENTS: dict[ChurningLaw, Callable[[BathNumbers], float]] = {
    "changenet_2007": coefficient_2007,
    "changenet_2011": coefficient_2011,
}
_SOURCES: dict[ChurningLaw, str] = {
    "changenet_2007": "Changenet and Velex, ASME J. Mech. Des. 129 (2007) 128",
    "changenet_2011": "Changenet, Leprince, Ville and Velex, ASME J. Mech. Des. 133 (2011) 121009",
    "iso_tr_14179_2": "ISO/TR 14179-2:2001, hydraulic torque of a dipped stage (Mauz 1987)",
}


def _iso_loss(
    running: RunningGear, bath: OilBath, stage: tr14179.DippedStage, share: float, whole: float | None = None
) -> Loss:
    """Share of the loss of a stage; ``whole`` is T_H omega of this gear unless given [W]."""
    v_t = running.circumferential_speed
    torque = tr14179.T_H(stage, v_t)
    power = torque * abs(running.speed) if whole is None else whole
    return Loss(
        place=running.place,
        kind="churning",
        power=share * power,
        details={
            "stage_torque": torque,
            "splash_factor": tr14179.C_Sp(stage),
            "share_of_stage": share,
            "hydraulic_length": 1e-3 * stage.l_h,
            "circumferential_speed": v_t,
            "extrapolation": _extrapolation(_iso_values(running, bath), ISO_RANGE),
            "law": "iso_tr_14179_2",
            "source": _SOURCES["iso_tr_14179_2"],
        },
        warnings=level_warnings(running.place, running.gear, bath)
        + _outside(f"{running.place}: churning (ISO)", _iso_values(running, bath), ISO_RANGE),
    )


def _known(law: str) -> None:
    if law not in LAWS:
        raise LossError(f"churning law = {law!r}: unknown; give one of {', '.join(LAWS)}")


def _length(bath: OilBath) -> float:
    if bath.hydraulic_length is None:
        raise LossError(
            "oil bath: the hydraulic length is missing: ISO/TR 14179-2 needs 4 x inner plan area / perimeter of the "
            'chamber; give it or take law = "changenet_2011"'
        )
    return bath.hydraulic_length


def _contact_height(stage: tuple[RunningGear, RunningGear]) -> float:
    """Height of the pitch point [m]."""
    first, second = (running.gear for running in stage)
    share = first.pitch_radius / (first.pitch_radius + second.pitch_radius)
    return first.axis_height + share * (second.axis_height - first.axis_height)


def _tested_values(running: RunningGear, numbers: BathNumbers) -> dict[str, float]:
    """Numbers of a dipped gear by the keys of `TESTED`; none if it is dry."""
    if numbers.depth == 0.0:
        return {}
    gear = running.gear
    values = (2.0 * gear.pitch_radius, gear.face_width, gear.normal_module, numbers.depth)
    return dict(zip(TESTED, values, strict=True))


def _iso_values(running: RunningGear, bath: OilBath) -> dict[str, float]:
    gear = running.gear
    depth = immersion(gear, bath).depth
    if depth == 0.0 or running.speed == 0.0:
        return {}
    values = (running.circumferential_speed, gear.face_width, depth / gear.tip_radius)
    return dict(zip(ISO_RANGE, values, strict=True))


_ROUNDING = 1.0 + 1e-9


def _outside(
    head: str, values: dict[str, float], limits: dict[str, tuple[float, float, str]]
) -> tuple[str, ...]:
    warnings = []
    for name, value in values.items():
        low, high, unit = limits[name]
        tail = f" {unit}" if unit else ""
        if not low / _ROUNDING <= value <= high * _ROUNDING:
            warnings.append(
                f"{head}: {name} = {value:.3g}{tail}: outside {low:g} to {high:g}{tail} of this law; "
                "compare the laws or give the measured loss"
            )
    return tuple(warnings)


def _extrapolation(values: dict[str, float], limits: dict[str, tuple[float, float, str]]) -> float:
    """Largest factor by which a number leaves its range, 1 inside [-]."""
    return max(
        (max(1.0, limits[name][0] / value, value / limits[name][1]) for name, value in values.items()),
        default=1.0,
    )


# Churning of a dipped stage by all laws: the range they span and the one to use.

EXTRAPOLATION = 1.5
"""Factor by which a number may leave the range of a law before another law is recommended (a choice, no source)."""


@dataclass(frozen=True, kw_only=True)
class ChurningComparison:
    """One stage by all laws that its data allow.

    losses : both gears by law; recommended : the first of `LAWS` that is extrapolated by no more than `EXTRAPOLATION`,
    else the least extrapolated; reason : one sentence with the factors. The laws can differ by more than
    five on small gears.
    """

    losses: dict[ChurningLaw, tuple[Loss, Loss]]
    recommended: ChurningLaw
    reason: str

    @property
    def powers(self) -> dict[ChurningLaw, float]:
        """Sum of both gears by law [W]."""
        return {law: first.power + second.power for law, (first, second) in self.losses.items()}


def compare_churning(stage: tuple[RunningGear, RunningGear], bath: OilBath) -> ChurningComparison:
    """All laws on one stage and the one to use; ISO/TR 14179-2 is left out where the hydraulic length is missing.

    Raises LossError for a level at or above the top of a shaft.
    """
    laws = [law for law in LAWS if law != "iso_tr_14179_2" or bath.hydraulic_length is not None]
    losses = {law: stage_churning(stage, bath, law) for law in laws}
    factors = {
        law: max(float(loss.details["extrapolation"]) for loss in pair) for law, pair in losses.items()
    }
    near = [law for law in laws if factors[law] <= EXTRAPOLATION]
    best = near[0] if near else min(laws, key=lambda law: factors[law])
    factors_text = ", ".join(f"{law} {factor:.3g}" for law, factor in factors.items())
    reason = (
        f"{best}: first law extrapolated by no more than {EXTRAPOLATION:g} ({factors_text})"
        if near
        else f"{best}: least extrapolated of all ({factors_text}); measure the no-load torque"
    )
    return ChurningComparison(losses=losses, recommended=best, reason=reason)
