"""Film laws for `thermal.conditions.boundary`: everything a surface of a gearbox may be cooled or heated by.

A law is called with the area-mean wall temperature and the fluid temperature [K] (for an exchange: the means
of the two surfaces) and returns a coefficient with its formula, inputs, range, source and warnings.
This module holds the laws that are a number or a sum of others; correlations live in `thermal.films.still`,
`thermal.films.forced`, `thermal.films.ribs` and `thermal.films.rotating` and are re-exported here.
"""

from dataclasses import replace

from thermal.films.forced import forced_air_plate
from thermal.films.inputs import FilmError, not_negative, outside, positive
from thermal.films.law import FilmCoefficient, FilmLaw
from thermal.films.ribs import ribbed
from thermal.films.rotating import (
    narrow_gap_jungnickel,
    narrow_gap_taylor,
    rotating_cylinder_becker,
    rotating_cylinder_dropkin_carmi,
    rotating_cylinder_etemad,
    rotating_cylinder_jungnickel,
    rotating_cylinder_kays_bjorklund,
    rotating_disc,
    rotating_disc_jungnickel,
)
from thermal.films.still import (
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
        one, two = first(wall, fluid), second(wall, fluid)
        total = one.value + two.value
        inputs = {f"first.{name}": number for name, number in one.inputs.items()}
        inputs |= {f"second.{name}": number for name, number in two.inputs.items()}
        return FilmCoefficient(
            value=one.value * two.value / total if total > 0.0 else 0.0,
            formula=f"series({one.formula}, {two.formula})",
            inputs=inputs | {"first": one.value, "second": two.value},
            valid_range=f"{one.valid_range}; {two.valid_range}",
            source=f"P2 Formula 3; {one.source}; {two.source}",
            warnings=one.warnings + two.warnings,
            radiation_included=one.radiation_included or two.radiation_included,
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
