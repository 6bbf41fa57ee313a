"""Films of rotating shafts, discs and narrow gaps in air. Speeds in rad/s, fixed when the law is made.

The Jungnickel/Grossmann laws (P2 Ref. 18) carry constants for air near room temperature, do not depend on the
temperatures they are given and warn at others; the rest take air at the film temperature. At rest the
rotating films vanish: use a free-convection law there.

The laws with a Reynolds number also serve in a mist of oil drops: ``density`` [kg/m3] replaces that of dry air in
it, as the windage laws take it. Drops that are brought to the speed of the wall are brought to its temperature too
(Reynolds analogy); conductivity and heat capacity stay those of air, which leaves out what the drops store. No
measurement of such films is known: the density is an estimate with a wide range.
"""

import math
from collections.abc import Callable
from dataclasses import replace

from thermal.films.air import Air, air
from thermal.films.inputs import not_negative, outside, positive
from thermal.films.law import Correlation, FilmCoefficient, FilmLaw
from thermal.films.still import GRAVITY

JUNGNICKEL = "Jungnickel/Grossmann 2010 (P2 Ref. 18)"
_STANDSTILL = "use a free-convection law for slow or standing shafts"

_FAST = "compare with another law for rotating bodies"
ROOM = (283.15, 333.15)
"""Film temperatures [K] for which the fixed constants of Jungnickel/Grossmann are taken to hold (limits assumed)."""


def rotating_cylinder_jungnickel(speed: float, diameter: float) -> FilmLaw:
    """Smooth cylinder turning in still air: 3.75 w^0.7 r^0.4 (Jungnickel/Grossmann).

    speed : w [rad/s]
    diameter : [m]
    """
    radius = positive("cylinder diameter", diameter, "m") / 2.0
    value = 3.75 * not_negative("speed", speed, "rad/s") ** 0.7 * radius**0.4
    return _fixed(value, "rotating_cylinder_jungnickel", {"speed": speed, "radius": radius})


def rotating_disc_jungnickel(speed: float, radius: float) -> FilmLaw:
    """Disc (or cone) turning in still air: 2.73 w^0.8 r^0.6 (Jungnickel/Grossmann).

    speed : w [rad/s]
    radius : outer radius [m]
    """
    positive("disc radius", radius, "m")
    value = 2.73 * not_negative("speed", speed, "rad/s") ** 0.8 * radius**0.6
    return _fixed(value, "rotating_disc_jungnickel", {"speed": speed, "radius": radius})


def narrow_gap_jungnickel(speed: float, radius: float, gap: float) -> FilmLaw:
    """Air in a narrow gap round a turning shaft, surface to surface: 0.765 (w r)^0.666 / s^0.333.

    speed : w [rad/s]
    radius : of the shaft [m]
    gap : s, radial [m]

    Source: Jungnickel/Grossmann. Below the onset of vortices conduction k/s is the lower bound; the law does
    not know it, `narrow_gap_taylor` does.
    """
    positive("shaft radius", radius, "m")
    positive("gap", gap, "m")
    value = 0.765 * (not_negative("speed", speed, "rad/s") * radius) ** 0.666 / gap**0.333
    return _fixed(value, "narrow_gap_jungnickel", {"speed": speed, "radius": radius, "gap": gap})


def rotating_cylinder_becker(speed: float, diameter: float, density: float | None = None) -> FilmLaw:
    """Cylinder turning in still air: Nu_D = 0.133 Re^(2/3) Pr^(1/3), Re = w D^2/(2 nu) (Becker 1963).

    speed : w [rad/s]
    diameter : D [m]. Range 800 < Re < 4e5.
    density : of a mist [kg/m3]; that of air when left out
    """
    return _cylinder(
        speed, diameter,
        Correlation("rotating_cylinder_becker", (800.0, 4e5), "Becker, Int. J. Heat Mass Transfer 6 (1963) 1053"),
        lambda reynolds, _, gas: 0.133 * reynolds ** (2.0 / 3.0) * gas.prandtl ** (1.0 / 3.0),
        density,
    )  # fmt: skip


def rotating_cylinder_kays_bjorklund(speed: float, diameter: float, density: float | None = None) -> FilmLaw:
    """Horizontal cylinder turning in still air, buoyancy included: Nu_D = 0.11 ((0.5 Re^2 + Gr) Pr)^0.35.

    speed : w [rad/s]
    diameter : D [m]. The only rotating law here that holds down to zero speed; upper limit assumed.
    density : of a mist [kg/m3]; that of air when left out
    """
    return _cylinder(
        speed, diameter,
        Correlation("rotating_cylinder_kays_bjorklund", (0.0, 1e5), "Kays and Bjorklund, Trans. ASME 80 (1958) 70"),
        lambda reynolds, grashof, gas: 0.11 * ((0.5 * reynolds**2 + grashof) * gas.prandtl) ** 0.35,
        density,
    )  # fmt: skip


def rotating_cylinder_etemad(speed: float, diameter: float, density: float | None = None) -> FilmLaw:
    """Cylinder turning in still air: Nu_D = 0.076 Re^0.7 (Etemad 1955).

    speed : w [rad/s]
    diameter : D [m]. Range 8000 < Re < 6.5e4; further up it stays close to the others (12,000 rpm, 80 mm: 4 %).
    density : of a mist [kg/m3]; that of air when left out
    """
    return _cylinder(
        speed, diameter,
        Correlation("rotating_cylinder_etemad", (8000.0, 6.5e4), "Etemad, Trans. ASME 77 (1955) 1283"),
        lambda reynolds, _grashof, _gas: 0.076 * reynolds**0.7,
        density,
    )  # fmt: skip


def rotating_cylinder_dropkin_carmi(speed: float, diameter: float, density: float | None = None) -> FilmLaw:
    """Cylinder turning in still air, rotation alone: Nu_D = 0.073 Re^0.7 (Dropkin and Carmi 1957).

    speed : w [rad/s]
    diameter : D [m]. Range 1.5e4 < Re < 4.3e5, the widest of the measured ones; coefficient and range as later
        papers quote them.
    density : of a mist [kg/m3]; that of air when left out
    """
    return _cylinder(
        speed, diameter,
        Correlation("rotating_cylinder_dropkin_carmi", (1.5e4, 4.3e5), "Dropkin and Carmi, Trans. ASME 79 (1957) 741"),
        lambda reynolds, _grashof, _gas: 0.073 * reynolds**0.7,
        density,
    )  # fmt: skip


def rotating_disc(speed: float, radius: float, density: float | None = None) -> FilmLaw:
    """Mean over one side of a disc turning in still air, laminar inside and turbulent outside.

    Laminar Nu_r = 0.36 Re_r^(1/2), so that h is the same at every radius; turbulent mean over a whole disc
    0.015 Re_r^0.8, so that the local h grows with r^0.6. With the change at Re_r = w r^2/nu = 2.5e5, at the
    share x = r_c/R of the radius, the mean is

        Nu = 0.36 Re^(1/2) x^2 + 0.015 Re^0.8 (1 - x^2.6)

    speed : w [rad/s]
    radius : R [m]
    density : of a mist [kg/m3]; that of air when left out
    """
    positive("disc radius", radius, "m")
    not_negative("speed", speed, "rad/s")
    _check_density(density)

    def law(wall: float, fluid: float) -> FilmCoefficient:
        gas = _medium(0.5 * (wall + fluid), density)
        reynolds = speed * radius**2 / gas.kinematic_viscosity
        share = min(1.0, math.sqrt(2.5e5 / reynolds)) if reynolds > 0.0 else 1.0
        nusselt = 0.36 * math.sqrt(reynolds) * share**2 + 0.015 * reynolds**0.8 * (1.0 - share**2.6)
        return FilmCoefficient(
            value=nusselt * gas.conductivity / radius,
            formula="rotating_disc",
            inputs={
                "speed": speed, "radius": radius, "reynolds": reynolds, "laminar_share_of_radius": share,
                "film_temperature": gas.temperature, "density": gas.density,
            },
            valid_range="still air, 1e3 < Re_r < 1e7 (limits assumed)",
            source="Kreith, Adv. Heat Transfer 5 (1968) 129: laminar 0.36 Re^0.5, turbulent 0.015 Re^0.8",
            warnings=outside(
                "Reynolds number w r^2/nu", reynolds, 1e3, 1e7, _STANDSTILL if reynolds < 1e3 else _FAST
            ),
        )  # fmt: skip

    return law


def narrow_gap_taylor(speed: float, radius: float, gap: float, density: float | None = None) -> FilmLaw:
    """Air in the gap between a turning shaft and a bore, surface to surface, with onset of Taylor vortices.

    With Ta^2 = w^2 r_m s^3/nu^2 and Nu = 2 h s/k: Nu = 2 (conduction) up to Ta = 41, then
    0.128 Ta^0.734 up to Ta^2 = 1e4 and 0.409 Ta^0.482 above (Becker and Kaye 1962), never below 2.

    speed : w [rad/s]
    radius : of the shaft [m]
    gap : s, radial [m]
    density : of a mist [kg/m3]; that of air when left out
    """
    positive("shaft radius", radius, "m")
    positive("gap", gap, "m")
    not_negative("speed", speed, "rad/s")
    _check_density(density)

    def law(wall: float, fluid: float) -> FilmCoefficient:
        gas = _medium(0.5 * (wall + fluid), density)
        taylor = speed**2 * (radius + gap / 2.0) * gap**3 / gas.kinematic_viscosity**2
        if taylor < 41.0**2:
            nusselt = 2.0
        else:
            nusselt = max(2.0, 0.128 * taylor**0.367 if taylor < 1e4 else 0.409 * taylor**0.241)
        warnings = outside("Taylor number squared", taylor, 0.0, 1e7, "use a measured coefficient")
        warnings += outside(
            "gap / radius", gap / radius, 0.0, 0.1, "the gap is not narrow; use a wider-gap law"
        )
        return FilmCoefficient(
            value=nusselt * gas.conductivity / (2.0 * gap),
            formula="narrow_gap_taylor",
            inputs={
                "speed": speed, "radius": radius, "gap": gap, "taylor_squared": taylor,
                "film_temperature": gas.temperature, "density": gas.density,
            },
            valid_range="Ta^2 < 1e7, s/r < 0.1, no axial flow",
            source="Becker and Kaye, J. Heat Transfer 84 (1962) 97",
            warnings=warnings,
        )  # fmt: skip

    return law


def _cylinder(
    speed: float,
    diameter: float,
    correlation: Correlation,
    nusselt: Callable[[float, float, Air], float],
    density: float | None = None,
) -> FilmLaw:
    """A law Nu(Re, Gr, air) on the diameter, Re = w D^2/(2 nu)."""
    positive("cylinder diameter", diameter, "m")
    not_negative("speed", speed, "rad/s")
    _check_density(density)
    low, high = correlation.limits

    def law(wall: float, fluid: float) -> FilmCoefficient:
        gas = _medium(0.5 * (wall + fluid), density)
        nu = gas.kinematic_viscosity
        reynolds = speed * diameter**2 / (2.0 * nu)
        slow = reynolds < low
        grashof = GRAVITY * gas.expansion * abs(wall - fluid) * diameter**3 / nu**2
        return FilmCoefficient(
            value=nusselt(reynolds, grashof, gas) * gas.conductivity / diameter,
            formula=correlation.formula,
            inputs={
                "speed": speed, "diameter": diameter, "reynolds": reynolds, "grashof": grashof,
                "film_temperature": gas.temperature, "density": gas.density,
            },
            valid_range=f"{low:g} < Re < {high:g}",
            source=correlation.source,
            warnings=outside("Reynolds number", reynolds, low, high, _STANDSTILL if slow else _FAST),
        )  # fmt: skip

    return law


def _check_density(density: float | None) -> None:
    if density is not None:
        positive("density of the mist", density, "kg/m3")


def _medium(temperature: float, density: float | None) -> Air:
    """Air at the film temperature [K], with the density of the mist if there is one."""
    gas = air(temperature)
    return gas if density is None else replace(gas, density=density)


def _fixed(value: float, formula: str, inputs: dict[str, float]) -> FilmLaw:
    """A Jungnickel law: one number at any temperature, with a warning away from room temperature."""
    slow = () if inputs["speed"] > 0.0 else (f"speed = 0 rad/s gives no film; {_STANDSTILL}",)

    def law(wall: float, fluid: float) -> FilmCoefficient:
        film = 0.5 * (wall + fluid)
        other = "its constants are those of air near room temperature: use a law that takes air at the film temperature"
        return FilmCoefficient(
            value=value,
            formula=formula,
            inputs=inputs | {"film_temperature": film},
            valid_range=f"air near room temperature, film at {ROOM[0]:g} to {ROOM[1]:g} K (limits assumed)",
            source=JUNGNICKEL,
            warnings=slow + outside("film temperature", film, *ROOM, other, "K"),
        )

    return law
