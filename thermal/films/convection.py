"""Film laws for `thermal.conditions.boundary`: everything a surface of a gearbox may be cooled or heated by.

A law is called with the area-mean wall temperature and the fluid temperature [K] (for an exchange: the means
of the two surfaces) and returns a coefficient with its formula, inputs, range, source and warnings.
The laws that are a number or a sum of others stand first; then moving air, shafts and discs, ribs. Still air:
`thermal.films.still`.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from thermal.films.law import (
    Correlation,
    FilmCoefficient,
    FilmError,
    FilmLaw,
    not_negative,
    outside,
    positive,
)
from thermal.films.still import (
    GRAVITY,
    Air,
    air,
    horizontal_cylinder_churchill_chu,
    horizontal_plate_mcadams,
    horizontal_plate_rohsenow,
    horizontal_plate_vdi,
    iso_tr_14179_2_free,
    niemann_winter,
    recknagel_plate,
    vertical_plate_churchill,
)

__all__ = [
    "FilmError",
    "bearing_film",
    "constant",
    "forced_air_plate",
    "formula_4",
    "horizontal_cylinder_churchill_chu",
    "horizontal_plate_mcadams",
    "horizontal_plate_rohsenow",
    "horizontal_plate_vdi",
    "iso_tr_14179_2_free",
    "narrow_gap_jungnickel",
    "narrow_gap_taylor",
    "niemann_winter",
    "oil_wetted",
    "recknagel_plate",
    "ribbed",
    "rotating_cylinder_becker",
    "rotating_cylinder_dropkin_carmi",
    "rotating_cylinder_etemad",
    "rotating_cylinder_jungnickel",
    "rotating_cylinder_kays_bjorklund",
    "rotating_disc",
    "rotating_disc_jungnickel",
    "scaled",
    "series",
    "vertical_plate_churchill",
]


OIL_RANGE = (100.0, 600.0)
"""Usual films of oil-wetted walls [W/(m2 K)] (limits assumed)."""


def constant(
    value: float,
    source: str,
    formula: str = "constant",
    usual: tuple[float, float] | None = None,
    *,
    radiation_included: bool = False,
) -> FilmLaw:
    """A given coefficient [W/(m2 K)], measured or published, with its source.

    formula : how the source got it
    usual : range of such films; a value outside warns
    radiation_included : the coefficient was read from a law for convection and radiation together
    """
    not_negative("film coefficient", value, "W/(m2 K)")
    if not source.strip():
        raise FilmError("source of a constant film coefficient is empty; say where the number comes from")
    return _always(
        FilmCoefficient(
            value=value,
            formula=formula,
            inputs={"value": value},
            valid_range="as given" if usual is None else f"as given; usually {usual[0]:g} to {usual[1]:g}",
            source=source,
            warnings=() if usual is None else outside("film", value, *usual, "check the unit", "W/(m2 K)"),
            radiation_included=radiation_included,
        )
    )


def oil_wetted(value: float = 300.0) -> FilmLaw:
    """Wall wetted by gear oil: a constant, 300 W/(m2 K) by default (P2 Figure 11, after Niemann/Winter)."""
    positive("film coefficient of the oil", value, "W/(m2 K)")
    return _always(
        FilmCoefficient(
            value=value,
            formula="oil_wetted",
            inputs={"value": value},
            valid_range="splash- or jet-wetted walls of a gear chamber; 100 to 600 W/(m2 K) (limits assumed)",
            source="P2 Figure 11, after Niemann/Winter",
            warnings=outside("oil film", value, *OIL_RANGE, "check the unit", "W/(m2 K)"),
        )
    )


def scaled(law: FilmLaw, factor: float) -> FilmLaw:
    """``law`` times a factor [-], which stands for its scatter; the product of all factors is among its inputs."""
    positive("film factor", factor, "")
    if factor == 1.0:
        return law

    def multiplied(wall: float, fluid: float) -> FilmCoefficient:
        film = law(wall, fluid)
        whole = factor * film.inputs.get("film_factor", 1.0)
        return replace(film, value=factor * film.value, inputs=film.inputs | {"film_factor": whole})

    return multiplied


def series(first: FilmLaw, second: FilmLaw) -> FilmLaw:
    """Two films one behind the other: 1/a = 1/a_1 + 1/a_2 (P2 Formula 3), both at the same two temperatures.

    Inputs and warnings of both parts are kept; the result is zero if one of them is.
    """

    def law(wall: float, fluid: float) -> FilmCoefficient:
        film_a, film_b = first(wall, fluid), second(wall, fluid)
        total = film_a.value + film_b.value
        inputs = {f"first.{name}": number for name, number in film_a.inputs.items()}
        inputs |= {f"second.{name}": number for name, number in film_b.inputs.items()}
        return FilmCoefficient(
            value=film_a.value * film_b.value / total if total > 0.0 else 0.0,
            formula=f"series({film_a.formula}, {film_b.formula})",
            inputs=inputs | {"first": film_a.value, "second": film_b.value},
            valid_range=f"{film_a.valid_range}; {film_b.valid_range}",
            source=f"P2 Formula 3; {film_a.source}; {film_b.source}",
            warnings=film_a.warnings + film_b.warnings,
            radiation_included=film_a.radiation_included or film_b.radiation_included,
        )

    return law


def formula_4(housing_film: float, housing_area: float, bearing_area: float) -> FilmLaw:
    """P2 Formula 4, as published: the housing's film referred to the bearing area, a_h A_h / A_b.

    housing_film : a_h [W/(m2 K)]
    housing_area, bearing_area : [m2]

    It only says that housing and bearing pass the same heat at the same temperature difference and knows
    nothing of the bearing; `bearing_film` is the physical law. The warning says so wherever it is used.
    """
    positive("housing film", housing_film, "W/(m2 K)")
    positive("housing area", housing_area, "m2")
    positive("bearing area", bearing_area, "m2")
    value = housing_film * housing_area / bearing_area
    return _always(
        FilmCoefficient(
            value=value,
            formula="formula_4",
            inputs={"housing_film": housing_film, "housing_area": housing_area, "bearing_area": bearing_area},
            valid_range="as published, to reproduce P2 only",
            source="P2 Formula 4",
            warnings=(
                f"bearing film = {value:.4g} W/(m2 K) is the housing's film spread "
                "on the bearing area (P2 Formula 4), not a property of the bearing; use bearing_film",
            ),
        )
    )


def bearing_film(conductivity: float, film_thickness: float, nusselt: float = 2.0) -> FilmLaw:
    """Lubricant film of a journal bearing, from its mean temperature to one of its walls: Nu k / h_mean.

    conductivity : k of the oil [W/(m K)]
    film_thickness : mean thickness, the radial clearance of the warm bearing [m]
    nusselt : 2 for heat conducted across from the middle of the film (the default, and the lower bound);
        6 for heat generated evenly inside it, mean against wall; 1 from wall to wall

    Journal speed and eccentricity enter through nothing but the thickness: the flow is laminar and along the
    walls, so that across the film there is conduction only. The fluid temperature is the film's.
    """
    positive("oil conductivity", conductivity, "W/(m K)")
    positive("film thickness", film_thickness, "m")
    positive("Nusselt number of the film", nusselt, "")
    warnings = outside("film thickness", film_thickness, 1e-6, 1e-3, "check the unit of the clearance", "m")
    warnings += outside("oil conductivity", conductivity, 0.08, 0.2, "check the oil data", "W/(m K)")
    warnings += outside(
        "Nusselt number of the film", nusselt, 1.0, 6.0, "give 2 where nothing better is known"
    )
    return _always(
        FilmCoefficient(
            value=nusselt * conductivity / film_thickness,
            formula="bearing_film",
            inputs={"conductivity": conductivity, "film_thickness": film_thickness, "nusselt": nusselt},
            valid_range="laminar film, 1e-6 to 1e-3 m, conduction across",
            source="conduction across the film: mid-plane to wall 2 k/h; mean to wall 6 k/h if heated evenly",
            warnings=warnings,
        )
    )


def _always(coefficient: FilmCoefficient) -> FilmLaw:
    def law(wall: float, fluid: float) -> FilmCoefficient:
        return coefficient

    return law


# Film of a wall in moving air: a fan or a draught along a gearbox housing.
#
# ISO/TR 14179-2 has a term for forced air as well; its printed form could not be confirmed and is not built on.

LEAST_REYNOLDS, MOST_REYNOLDS = 10.0, 1e7
"""Range of the correlations of a plate in a stream."""
BLEND = 3.0
"""Exponent with which forced and free convection add up."""


def forced_air_plate(velocity: float, length: float, height: float) -> FilmLaw:
    """Wall along which air flows, in the room that surrounds it.

    Forced part: Nu = sqrt(Nu_lam^2 + Nu_turb^2), Nu_lam = 0.664 Re^(1/2) Pr^(1/3),
    Nu_turb = 0.037 Re^0.8 Pr / (1 + 2.443 Re^-0.1 (Pr^(2/3) - 1)), over ``length``: a stream with the turbulence that
    a fan and the edges of a box give it, without a transition at one Reynolds number. Free part: Churchill and Chu
    over ``height``. h^3 = h_forced^3 + h_free^3, so that still air leaves the free part. No radiation in it.

    velocity : of the air along the wall [m/s]
    length : of the wall along the stream [m]
    height : of the wall, for its free part [m]

    Source: VDI Heat Atlas, 2nd ed., G4 (Gnielinski's mean of Pohlhausen's laminar and Petukhov and Popov's turbulent
    plate; both parts as in ht); blend: Incropera et al., Fundamentals of Heat and Mass Transfer, 7th ed., eq. 9.64
    with n = 3. Raises FilmError for a length that is not positive or a negative velocity.
    """
    not_negative("air velocity", velocity, "m/s")
    positive("length along the stream", length, "m")
    free = vertical_plate_churchill(height)

    def law(wall: float, fluid: float) -> FilmCoefficient:
        from ht.conv_external import (
            Nu_horizontal_plate_laminar_Baehr,
            Nu_horizontal_plate_turbulent_Schlichting,
        )

        from thermal.films.still import air

        still = free(wall, fluid)
        gas = air(0.5 * (wall + fluid))
        reynolds = velocity * length / gas.kinematic_viscosity
        forced, warnings = 0.0, still.warnings
        if velocity > 0.0:
            laminar = float(Nu_horizontal_plate_laminar_Baehr(reynolds, gas.prandtl))
            turbulent = float(Nu_horizontal_plate_turbulent_Schlichting(reynolds, gas.prandtl))
            forced = math.hypot(laminar, turbulent) * gas.conductivity / length
            warnings += outside(
                "Reynolds number of the air stream", reynolds, LEAST_REYNOLDS, MOST_REYNOLDS,
                "check velocity and length, or use a coefficient measured in place",
            )  # fmt: skip
        return FilmCoefficient(
            value=(forced**BLEND + still.value**BLEND) ** (1.0 / BLEND),
            formula="forced_air_plate",
            inputs={
                "velocity": velocity, "length": length, "height": height, "reynolds": reynolds, "forced": forced,
                "free": still.value,
            },
            valid_range=f"{LEAST_REYNOLDS:g} < Re < {MOST_REYNOLDS:g} along a plane wall",
            source=f"VDI Heat Atlas G4, plate in a stream; Incropera et al., eq. 9.64; {still.source}",
            warnings=warnings,
        )  # fmt: skip

    return law


# Films of rotating shafts, discs and narrow gaps in air. Speeds in rad/s, fixed when the law is made.
#
# The Jungnickel/Grossmann laws (P2 Ref. 18) carry constants for air near room temperature, do not depend on the
# temperatures they are given and warn at others; the rest take air at the film temperature. At rest the
# rotating films vanish: use a free-convection law there.
#
# The laws with a Reynolds number also serve in a mist of oil drops: ``density`` [kg/m3] replaces that of dry air in
# it, as the windage laws take it. Drops that are brought to the speed of the wall are brought to its temperature too
# (Reynolds analogy); conductivity and heat capacity stay those of air, which leaves out what the drops store. No
# measurement of such films is known: the density is an estimate with a wide range.

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


# Ribs on a wall as a factor on its film: the array of fins that is not drawn.

LEAST_GAP = 5e-3
"""Clear distance [m] of two ribs below which their boundary layers meet in room air (limit assumed)."""


@dataclass(frozen=True, kw_only=True)
class RibArray:
    """Straight ribs of constant thickness, side by side on a plane wall [m].

    Raises FilmError for a measure that is not positive, and for ribs that leave no gap.
    """

    height: float
    """From the wall to the tip."""
    thickness: float
    pitch: float
    """From middle to middle."""

    def __post_init__(self) -> None:
        positive("rib height", self.height, "m")
        positive("rib thickness", self.thickness, "m")
        positive("rib pitch", self.pitch, "m")
        if self.thickness >= self.pitch:
            raise FilmError(
                f"rib thickness = {self.thickness:g} m must be below the pitch of {self.pitch:g} m; thin the ribs or "
                "set them further apart"
            )

    @property
    def _corrected(self) -> float:
        """Height with half the thickness added, which stands for the heat through the tip [m]."""
        return self.height + 0.5 * self.thickness

    def efficiency(self, film: float, conductivity: float) -> float:
        """Fin efficiency tanh(m L)/(m L), m = sqrt(2 h/(k t)) [-]; film : h [W/(m2 K)], conductivity : [W/(m K)]."""
        slender = self._corrected * math.sqrt(2.0 * film / (conductivity * self.thickness))
        return math.tanh(slender) / slender if slender > 0.0 else 1.0

    def factor(self, film: float, conductivity: float) -> float:
        """Heat of the ribbed wall over that of the bare one at the same film [-]: gaps, ribs at their efficiency."""
        ribs = 2.0 * self._corrected / self.pitch
        return 1.0 - self.thickness / self.pitch + ribs * self.efficiency(film, conductivity)


def ribbed(law: FilmLaw, ribs: RibArray, conductivity: float) -> FilmLaw:
    """``law`` on wall and ribs, referred to the area of the wall without them.

    conductivity : of the ribs [W/(m K)]

    Source: Incropera et al., Fundamentals of Heat and Mass Transfer, 7th ed., section 3.6: eq. 3.94 to 3.97 (straight
    fin with adiabatic tip at the corrected length) and 3.107 (overall surface efficiency of an array).
    """
    positive("conductivity of the ribs", conductivity, "W/(m K)")

    def law_with_ribs(wall: float, fluid: float) -> FilmCoefficient:
        bare = law(wall, fluid)
        warnings = bare.warnings + outside(
            "gap between ribs", ribs.pitch - ribs.thickness, LEAST_GAP, math.inf,
            "use a coefficient measured on such ribs: air hardly passes between them", "m",
        )  # fmt: skip
        if bare.radiation_included:
            warnings += (
                f"film {bare.formula} contains radiation, which ribs hardly add to as they see each other; use "
                "a film of convection alone with law = radiation beside it",
            )
        factor = ribs.factor(bare.value, conductivity)
        measures = {"height": ribs.height, "thickness": ribs.thickness, "pitch": ribs.pitch}
        inputs = {f"rib_{name}": value for name, value in measures.items()}
        inputs |= {"rib_conductivity": conductivity, "rib_factor": factor}
        inputs["rib_efficiency"] = ribs.efficiency(bare.value, conductivity)
        return replace(
            bare, value=factor * bare.value, formula=f"{bare.formula} with ribs", inputs=bare.inputs | inputs,
            source=f"{bare.source}; ribs: Incropera et al., section 3.6", warnings=warnings,
        )  # fmt: skip

    return law_with_ribs
