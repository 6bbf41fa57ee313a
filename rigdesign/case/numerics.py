"""How finely and how long to compute."""

from typing import Annotated, Literal

from pydantic import Field

from rigdesign.case.fields import Count, Frequency, Length, Part, Positive, Speed, TemperatureDifference


class Numerics(Part):
    """Tolerances of the coupling loop and sizes of the models; the fidelity scales the sizes."""

    temperature_tolerance: TemperatureDifference
    growth_tolerance: Length
    torque_tolerance: Positive
    """Relative."""
    coupling_passes: Count = 30
    """Most passes of the coupling loop."""
    sample_rate: Frequency
    internal_steps: Annotated[int, Field(ge=8, le=256)] = 8
    """Integration steps per sample."""
    slices_spur: Annotated[int, Field(ge=1, le=101)] = 5
    slices_helical: Annotated[int, Field(ge=3, le=101)] = 12
    shaft_element_length: Length
    curve_speed_start: Speed
    """First speed of the dynamic factor curve."""
    curve_speed_end: Speed
    curve_speeds: Annotated[int, Field(ge=2, le=5000)] = 200
    response_period: Literal["mesh", "revolution", "hunting_cycle"] = "mesh"
    """What the periodic response repeats after."""
