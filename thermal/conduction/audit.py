"""Audits of a housing's heat: what cannot be, what was assumed otherwise, what was counted twice.

Pure functions on numbers; each returns a sentence for the report, or None when there is nothing to say. They
judge solved fields and published numbers alike (thermal sheet, seed thermal case, section 2).
"""

from collections.abc import Iterable

from thermal.conditions.boundary import Film, Radiation
from thermal.conduction.condition_checks import Condition
from thermal.films.inputs import not_negative, positive
from thermal.films.law import STEFAN_BOLTZMANN, FilmCoefficient, FilmLaw

ROUNDING = 1e-3
"""Relative shortfall of radiation that is taken for rounding of printed numbers."""


def least_radiation(emissivity: float, ambient: float, film: float, convection: float) -> float:
    """Least heat [W] that a surface radiates while it gives off ``convection`` [W] through its film.

    emissivity : eps [-]
    ambient : T0 of air and surroundings [K]
    film : h [W/(m2 K)], the same all over the surface

    T^4 is convex, so that T^4 - T0^4 >= 4 T0^3 (T - T0) at every point whatever the field; integrated over
    one surface in one ambient, Q_rad >= (4 eps sigma T0^3 / h) Q_conv.
    """
    not_negative("emissivity", emissivity, "")
    positive("ambient temperature", ambient, "K")
    positive("film coefficient", film, "W/(m2 K)")
    return 4.0 * emissivity * STEFAN_BOLTZMANN * ambient**3 / film * convection


def radiation_too_small(
    surface: str,
    *,
    convection: float,
    radiation: float,
    emissivity: float,
    film: float,
    ambient: float,
) -> str | None:
    """Whether a surface radiates less than any temperature field allows; heats [W] positive to the room."""
    if convection <= 0.0:
        return None
    least = least_radiation(emissivity, ambient, film, convection)
    if radiation >= least * (1.0 - ROUNDING):
        return None
    area = f" ({least / radiation:.3g} times the radiating one would explain it)" if radiation > 0.0 else ""
    return (
        f"{surface}: radiation = {radiation:.4g} W is below {least:.4g} W, the least that any temperature "
        f"field gives with {convection:.4g} W of convection at h = {film:.4g} W/(m2 K), "
        f"eps = {emissivity:.3g} and {ambient:.4g} K; check the convective area{area}, emissivity and the "
        "temperature of the surroundings"
    )


def assumed_difference(
    surface: str,
    *,
    assumed: float,
    solved: float,
    law: FilmLaw | None = None,
    fluid_temperature: float | None = None,
    tolerance: float = 0.1,
) -> str | None:
    """Whether a film was taken at another temperature difference [K] than the one that came out.

    law, fluid_temperature : the film law and its fluid [K]; given both, the sentence says what the
        coefficient would have been at the solved difference
    tolerance : relative deviation from the assumed difference that is let pass
    """
    positive("assumed temperature difference", assumed, "K")
    if abs(solved - assumed) <= tolerance * assumed:
        return None
    effect = ""
    if law is not None and fluid_temperature is not None:
        taken = law(fluid_temperature + assumed, fluid_temperature).value
        right = law(fluid_temperature + solved, fluid_temperature).value
        change = f" ({100.0 * (right / taken - 1.0):+.0f} %)" if taken > 0.0 else ""
        effect = f", where the coefficient is {right:.4g} instead of {taken:.4g} W/(m2 K){change}"
    return (
        f"{surface}: assumed temperature difference = {assumed:.4g} K, solved {solved:.4g} K{effect}; the "
        f"limit is {100.0 * tolerance:.0f} % of the assumed one; let the film follow the wall temperature"
    )


def radiation_counted_twice(surface: str, film: FilmCoefficient, radiating: bool) -> str | None:
    """Whether a surface radiates explicitly although its film contains radiation already."""
    if not radiating or not film.radiation_included:
        return None
    return (
        f"{surface}: film {film.formula} is of the size of convection and radiation together, and the surface "
        "radiates as well; verdicts should depend on one of them (radiation_included = true drops the explicit "
        "radiation)"
    )


def audit_conditions(conditions: Iterable[Condition], wall_excess: float = 50.0) -> tuple[str, ...]:
    """Double counting in a list of boundary conditions, one sentence a surface, in order of the films.

    wall_excess : wall above fluid [K] at which the film laws are evaluated
    """
    listed = list(conditions)
    radiating = {c.surface for c in listed if isinstance(c, Radiation) and c.emissivity > 0.0}
    found = []
    for film in listed:
        if isinstance(film, Film):
            text = radiation_counted_twice(
                film.surface, film.coefficient_at(wall_excess), film.surface in radiating
            )
            if text is not None:
                found.append(text)
    return tuple(found)
