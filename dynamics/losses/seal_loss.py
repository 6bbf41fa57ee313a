"""Losses of shaft seals: rubbing lips and contactless gaps."""

import math
from dataclasses import dataclass

from dynamics.losses.loss import Loss, LossError
from dynamics.standards import iso_tr_14179_2_2001 as tr14179

TAYLOR_LIMIT = 41.3
"""Re sqrt(gap / R) above which vortices fill the gap (G. I. Taylor 1923)."""


def lip_seal_loss(place: str, shaft_diameter: float, omega: float) -> Loss:
    """Radial lip seal P = 7.69e-6 d^2 n (ISO/TR 14179-2; W, mm, 1/min); diameter [m], omega [rad/s].

    Independent of oil and temperature; for rubber lips up to about 30 m/s. Confidence high for the constant.
    """
    if not shaft_diameter > 0.0:
        raise LossError(f"{place}: seal diameter = {shaft_diameter} m: must be above 0; correct it")
    speed = 0.5 * abs(omega) * shaft_diameter
    warnings: tuple[str, ...] = ()
    if speed > 30.0:
        warnings = (
            f"{place}: lip speed = {speed:.1f} m/s: above 30 m/s, rubbing lips burn; use a contactless seal",
        )
    return Loss(
        place=place,
        kind="seal",
        power=tr14179.P_VD(shaft_diameter * 1e3, abs(omega) * 30.0 / math.pi),
        details={"lip_speed": speed, "source": "ISO/TR 14179-2:2001"},
        warnings=warnings,
    )


@dataclass(frozen=True, kw_only=True)
class SealGap:
    """Concentric cylindrical gap round a shaft: shaft radius, radial gap and length [m]."""

    radius: float
    gap: float
    length: float


def gap_seal_loss(place: str, seal: SealGap, omega: float, density: float, viscosity: float) -> Loss:
    """Power lost to the fluid in a concentric cylindrical gap [W], air or oil.

    Laminar (Couette): P = 2 pi eta omega^2 R^3 L / s. With Taylor vortices P = pi C rho omega^3 R^4 L / 2,
    C = 2 (s/R)^0.3 Re^-0.6 to Re 500, 1.03 (s/R)^0.3 Re^-0.5 to 1e4, 0.065 (s/R)^0.3 Re^-0.2 beyond, with
    Re = rho omega R s / eta, never less than laminar.

    omega [rad/s], density [kg/m3], dynamic viscosity [Pa s]. Raises LossError for what is not above 0.

    Source: Couette 1890; E. Bilgen, R. Boulos, ASME J. Fluids Eng. 95 (1973). Confidence medium to high.
    """
    radius, gap, length = seal.radius, seal.gap, seal.length
    for name, value in (("radius", radius), ("gap", gap), ("density", density), ("viscosity", viscosity)):
        if not value > 0.0:
            raise LossError(
                f"{place}: {name} = {value:.6g}: must be above 0; the seal touches or is not defined"
            )
    speed = abs(omega)
    reynolds = density * speed * radius * gap / viscosity
    power = 2.0 * math.pi * viscosity * speed**2 * radius**3 * length / gap
    vortices = reynolds * math.sqrt(gap / radius) > TAYLOR_LIMIT
    if vortices:
        coefficient = _vortex_coefficient(reynolds, gap / radius)
        power = max(power, 0.5 * math.pi * coefficient * density * speed**3 * radius**4 * length)
    return Loss(
        place=place,
        kind="seal",
        power=power,
        details={
            "reynolds_number": reynolds,
            "regime": "vortices" if vortices else "laminar",
            "source": "Couette; Bilgen and Boulos 1973",
        },
    )


def _vortex_coefficient(reynolds: float, gap_ratio: float) -> float:
    factor, exponent = (
        (2.0, -0.6) if reynolds <= 500.0 else (1.03, -0.5) if reynolds <= 1e4 else (0.065, -0.2)
    )
    coefficient: float = factor * gap_ratio**0.3 * reynolds**exponent
    return coefficient
