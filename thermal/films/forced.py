"""Film of a wall in moving air: a fan or a draught along a gearbox housing.

ISO/TR 14179-2 has a term for forced air as well; its printed form could not be confirmed and is not built on.
"""

import math

from thermal.films.inputs import not_negative, outside, positive
from thermal.films.law import FilmCoefficient, FilmLaw
from thermal.films.still import vertical_plate_churchill

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

        from thermal.films.air import air

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
