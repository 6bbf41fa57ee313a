"""Films inside a dip-lubricated box: splashed and drained walls; faces, teeth and shafts that pass the bath.

What is published is little: constants for walls (Niemann/Winter; ISO/TR 14179-2 takes 200 W/(m2 K)) and the bulk
temperature of the teeth (Michaelis). The laws here are closed solutions of what happens to the oil (a disc in a
viscous fluid, a film flung off), each with its limits, and the constants stand beside them.
"""

import math
from dataclasses import replace

from thermal.films.convection import constant
from thermal.films.flank import FilmOil, ToothRing, Wetting, fling_off
from thermal.films.law import FilmCoefficient, FilmError, FilmLaw, not_negative, outside, positive

WALL_RANGE = (100.0, 300.0)
"""Splashed inner walls [W/(m2 K)], Niemann/Winter II, from memory."""
TANK_OF_LIQUID = (1e3, 1e5)
"""Re = omega d^2/(2 nu) of the cylinders that Eisenberg, Tobias and Wilke turned in a liquid."""
LAMINAR_DISC = 3e5
"""Re = omega R^2/nu at which the boundary layer of a disc turns turbulent."""


def wetted_wall_film(value: float = 200.0) -> FilmLaw:
    """Inner wall wetted by splashed oil or standing in the sump: a constant, 200 W/(m2 K) by default.

    ISO/TR 14179-2 (after Funck 1985) takes 200; Niemann/Winter II 100 to 300, both from memory. P2's 300 W/(m2 K) is
    the upper end; `thermal.films.convection.oil_wetted` holds it. Raises FilmError for a value that is not positive.
    """
    positive("film coefficient of the splashed wall", value, "W/(m2 K)")
    return constant(
        value,
        source="ISO/TR 14179-2:2001 (200 W/(m2 K)); range after Niemann/Winter II",
        formula="wetted_wall",
        usual=WALL_RANGE,
    )


def dipped_face_film(speed: float, radius: float, wetted_share: float, oil: FilmOil) -> FilmLaw:
    """Side face of a gear that dips into the bath, mean over the whole face [W/(m2 K)].

    h = s 0.6205 k sqrt(omega/nu) Pr^(1/3)/(1 + 0.298 Pr^(-1/3) + 0.145 Pr^(-2/3))

    Laminar boundary layer of a disc in a fluid of high Prandtl number, the same at every radius; s the part of the face
    below the oil surface. What happens above it (a film thrown outwards) is left out: more cooling.

    speed : omega [rad/s]; radius : R [m]; wetted_share : s, 0 to 1 [-]; oil : its properties. Raises FilmError outside.

    Source: V. G. Levich, Physicochemical Hydrodynamics (1962); series of J. Newman, J. Phys. Chem. 70 (1966) 1327, in
    the analogy of heat and mass transfer. Within 1 % of the energy equation from Pr = 10 upwards.
    """
    not_negative("speed", speed, "rad/s")
    positive("disc radius", radius, "m")
    _share("wetted share of the face", wetted_share)

    def law(wall: float, fluid: float) -> FilmCoefficient:
        mean = 0.5 * (wall + fluid)
        conductivity, capacity, viscosity = oil.at(mean)
        prandtl = viscosity * capacity / conductivity
        reynolds = speed * radius**2 / viscosity
        small: float = prandtl ** (-1.0 / 3.0)
        number = 0.6205 / small / (1.0 + 0.298 * small + 0.145 * small**2)
        return FilmCoefficient(
            value=wetted_share * number * conductivity * math.sqrt(speed / viscosity),
            formula="dipped_face",
            inputs={
                "speed": speed, "radius": radius, "wetted_share": wetted_share, "reynolds": reynolds,
                "prandtl": prandtl, "film_temperature": mean,
            },
            valid_range="laminar, Re = omega R^2/nu up to 3e5, Pr above 10",
            source="Levich 1962; Newman 1966",
            warnings=oil.warnings(mean)
            + outside("Reynolds number of the face", reynolds, 0.0, LAMINAR_DISC, "the film is higher there")
            + outside("Prandtl number of the oil", prandtl, 10.0, math.inf, "take a law for gases"),
        )  # fmt: skip

    return law


def dipped_shaft_film(speed: float, diameter: float, wetted_share: float, oil: FilmOil) -> FilmLaw:
    """Shaft that turns in the bath, mean over its whole surface [W/(m2 K)].

    h = s 0.0791 k/d Re^0.7 Pr^0.356,  Re = omega d^2/(2 nu)

    speed : omega [rad/s]; diameter : d [m]; wetted_share : s, of its circumference [-]; oil : its properties.

    Source: M. Eisenberg, C. W. Tobias and C. R. Wilke, J. Electrochem. Soc. 101 (1954) 306, mass transfer at Schmidt
    numbers of 835 to 11,490, in the analogy; Becker 1963 (water, Pr 2.2 to 6.4) is within 15 % of it in oil too.
    """
    not_negative("speed", speed, "rad/s")
    positive("shaft diameter", diameter, "m")
    _share("wetted share of the shaft", wetted_share)

    def law(wall: float, fluid: float) -> FilmCoefficient:
        mean = 0.5 * (wall + fluid)
        conductivity, capacity, viscosity = oil.at(mean)
        prandtl = viscosity * capacity / conductivity
        reynolds = speed * diameter**2 / (2.0 * viscosity)
        number = 0.0791 * reynolds**0.7 * prandtl**0.356
        return FilmCoefficient(
            value=wetted_share * number * conductivity / diameter,
            formula="dipped_shaft",
            inputs={
                "speed": speed, "diameter": diameter, "wetted_share": wetted_share, "reynolds": reynolds,
                "prandtl": prandtl, "film_temperature": mean, "viscosity": viscosity,
            },
            valid_range="1e3 < Re < 1e5, Pr 2 to 11,490",
            source="Eisenberg, Tobias and Wilke 1954",
            warnings=oil.warnings(mean)
            + outside("Reynolds number of the shaft", reynolds, *TANK_OF_LIQUID, "compare with a measured film"),
        )  # fmt: skip

    return law


def above_bath(wet: FilmLaw, dry: FilmLaw, wetted_share: float) -> FilmLaw:
    """Mean film of a part with ``wetted_share`` of it in the bath (counted in ``wet``) and the rest in air."""
    if wetted_share <= 0.0:
        return dry

    def law(wall: float, fluid: float) -> FilmCoefficient:
        oil, air = wet(wall, fluid), dry(wall, fluid)
        in_air = (1.0 - wetted_share) * air.value
        return replace(oil, value=oil.value + in_air, inputs=oil.inputs | {"part_in_air": in_air})

    return law


def dipped_rim_film(
    ring: ToothRing, speed: float, immersion: float, lifted_flow: float, oil: FilmOil
) -> FilmLaw:
    """Flanks of a gear that dips into the bath: flooded once a turn, then flung off (`flank.fling_off`).

    immersion : depth of the tooth tips [m], the dipped part of the tooth height counts; lifted_flow : oil that the
    tooth spaces lift at most [m3/s]; speed [rad/s]. Zero without immersion or at rest. On the rim that stands for the
    teeth use `flank.on_rim`.

    No test on dipped gears is known: the bulk temperature of Michaelis is the check (36.6 against 35.3 K above the sump
    for FZG-C gears at load stage 10). Heat
    given off while the teeth stand in the oil is left out: more cooling.
    """
    not_negative("immersion of the tooth tips", immersion, "m")
    not_negative("speed", speed, "rad/s")
    if immersion == 0.0 or speed == 0.0:
        return constant(0.0, source="gear at rest or above the oil", formula="dipped_rim")
    share = min(1.0, immersion / ring.height)
    return fling_off(ring, Wetting(speed=speed, per_turn=1, flow=lifted_flow, wetted_share=share), oil)


def _share(quantity: str, value: float) -> None:
    if not 0.0 <= value <= 1.0:
        raise FilmError(f"{quantity} = {value}: must lie within 0 to 1; it is a share")
