"""Churning of gears that dip into an oil bath, by Changenet and Velex or by ISO/TR 14179-2.

Changenet and Velex (`changenet`) know oil, sump volume and regime of one gear; losses of the gears of a sump are added.
ISO/TR 14179-2 (Mauz) gives the torque of a dipped stage from immersion, width, speed and housing; the viscosity does
not enter, so it stands for oil at working temperature. On gears of 100 mm it gives several times the others:
`churning_comparison` shows both.

Left out, as no formula was found: side walls near the gear (they lower the loss; radial walls matter less: Changenet
and Velex 2008), the sense of rotation of a pair (oil drawn into the mesh swells and raises the loss), air in the oil
(raises it: Leprince et al. 2011), oil trapped in the mesh (`mesh_loss.squeeze_loss` takes it as an input).
"""

import math
from collections.abc import Callable
from typing import Literal

from dynamics.losses.changenet import BathNumbers, bath_numbers, coefficient_2007, coefficient_2011
from dynamics.losses.immersion import OilBath, RunningGear, immersion, level_warnings, wetted_area
from dynamics.losses.mesh_loss import Loss, LossError
from dynamics.losses.windage import disc_coefficient
from dynamics.standards import iso_tr_14179_2_2001 as tr14179

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
    found = []
    for name, value in values.items():
        low, high, unit = limits[name]
        tail = f" {unit}" if unit else ""
        if not low / _ROUNDING <= value <= high * _ROUNDING:
            found.append(
                f"{head}: {name} = {value:.3g}{tail}: outside {low:g} to {high:g}{tail} of this law; "
                "compare the laws or give the measured loss"
            )
    return tuple(found)


def _extrapolation(values: dict[str, float], limits: dict[str, tuple[float, float, str]]) -> float:
    """Largest factor by which a number leaves its range, 1 inside [-]."""
    return max(
        (max(1.0, limits[name][0] / value, value / limits[name][1]) for name, value in values.items()),
        default=1.0,
    )
