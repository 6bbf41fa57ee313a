"""How finely and how long to compute."""

from typing import Annotated, Literal

from pydantic import Field

from rigdesign.case.fields import (
    Count,
    Frequency,
    Length,
    Part,
    Positive,
    Speed,
    TemperatureDifference,
    Usual,
)


class Numerics(Part):
    """Tolerances of the coupling loop and sizes of the models; the fidelity scales the sizes."""

    temperature_tolerance: Annotated[TemperatureDifference, Usual("0.004 K", "0.3 K")]
    """Most change of any temperature in the last iteration of the coupling loop."""
    growth_tolerance: Annotated[Length, Usual("0.04 um", "4 um")]
    """Most change of any thermal expansion in the last iteration of the coupling loop."""
    torque_tolerance: Annotated[Positive, Usual(5e-5, 5e-3)]
    """Most relative change of any torque in the last iteration of the coupling loop."""
    coupling_passes: Count = 30
    """Most iterations of the coupling loop."""
    sample_rate: Frequency
    """Rate at which the time run is stored; it integrates ``internal_steps`` times as fast."""
    internal_steps: Annotated[int, Field(ge=4, le=256)] = 4
    """Integration steps per sample."""
    slices_spur: Annotated[int, Field(ge=1, le=101)] | None = None
    """Slices over the face of spur gears; by what their faces need when left out: 1 if flat, else 8."""
    slices_helical: Annotated[int, Field(ge=3, le=101)] | None = None
    """Slices over the face of helical gears; when left out 8 a base pitch of overlap, at least 8."""
    shaft_element_length: Length | None = None
    """Longest element of the shafts; when left out a sixteenth of the torsional wave of the fourth mesh harmonic at
    the highest speed, at most of 20 kHz."""
    curve_speed_start: Annotated[Speed, Usual(0.02, 1.0, "test speed")]
    """First speed of the dynamic factor curve."""
    curve_speed_end: Annotated[Speed, Usual(0.3, 3.0, "test speed")]
    """Last speed of the dynamic factor curve."""
    curve_speeds: Annotated[int, Field(ge=2, le=5000), Usual(8, 900)] = 200
    """Speeds between both, evenly spaced; resonances get more."""
    root_stress_speeds: tuple[Speed, ...] = ()
    """Speeds at which root stress and strain rate are shown over the rolling angle, in addition to the held stages."""
    response_period: Literal["mesh", "revolution", "hunting_cycle"] = "mesh"
    """What the periodic response repeats after. When left out: a mesh; in a loop whose meshes pass teeth at different
    rates a revolution of the pinion of ``torque_at``, or the hunting cycle where that ends on part of a tooth."""
