"""Strain gauges in the root of a tooth: place, grid, bridge; `rigdesign.rig.strain_gauges` puts them on the gear."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from rigdesign.case.fields import (
    Angle,
    Length,
    Offset,
    Part,
    Positive,
    Quantity,
    Resistance,
    Size,
    Usual,
    Voltage,
    fault,
)

ArmStrain = Annotated[float, Field(ge=-1.0, le=1.0)]
ResponseTime = Annotated[float, Quantity("time", at_least="0 s", at_most="0.1 s", example="0.02 ms")]


class StrainBridge(Part):
    """Wheatstone bridge of one strain gauge."""

    kind: Literal["quarter", "half_passive", "half", "full"]
    """quarter: one gauge, completed in the amplifier; half_passive: one gauge with a passive resistor next to it,
    completed in the amplifier; half: two gauges; full: four."""
    supply_voltage: Annotated[Voltage, Usual("0.3 V", "15 V")]
    """Voltage that feeds the bridge, at the amplifier."""
    arms: tuple[ArmStrain, ...] | None = None
    """Strain of each active arm over that of the gauge, e.g. 1 and -0.3 for a second gauge across; 1 and -1, or twice
    that, when left out: a bent bar."""
    completion_resistance: Resistance | None = None
    """Of the passive resistor; that of the gauge when left out."""
    wires: int | None = None
    """Wires to the amplifier, each a channel of a slip ring; 3, and 4 for a full bridge, when left out."""
    lead_resistance: Resistance = 0.0
    """Of one wire with its slip-ring contact."""


class StrainGaugeInput(Part):
    """One strain gauge in the root of a tooth; its grid lies along the fillet, across the tooth trace.

    Its place along the fillet is one of ``fillet_position``, ``tangent_angle`` and ``root_diameter``; the 30 deg
    tangent of ISO 6336-3 when all are left out.
    """

    tooth: int = Field(default=0, ge=0, le=1999)
    """Number of its tooth, counted from 0 as those of ``flank``."""
    fillet: Literal["front", "back"] = "front"
    """Fillet under the front flank, or under the back flank; that of the front flank is pulled where the mesh runs on
    its front flanks."""
    face_position: Annotated[Offset, Usual(0.0, 0.5, "face width")]
    """Middle of the grid over the face width: from mid-face, positive to the rear end, the one that comes into mesh
    last."""
    fillet_position: Offset | None = None
    """Distance of the middle of the grid along the fillet from its 30 deg tangent, positive to the tip."""
    tangent_angle: Angle | None = None
    """Angle between the fillet and the tooth axis at the middle of the grid, in the normal section."""
    root_diameter: Size | None = None
    """Diameter at the middle of the grid."""
    misalignment: Angle = 0.0
    """Direction of the grid against that of the fillet."""
    grid_length: Annotated[Length, Usual("0.2 mm", "5 mm")]
    """Length of the measuring grid, along its wires."""
    grid_width: Annotated[Length, Usual("0.2 mm", "5 mm")]
    """Width of the measuring grid."""
    gauge_factor: Annotated[Positive, Usual(1.5, 4.0)] = 2.0
    """k: relative change of resistance over strain."""
    resistance: Annotated[Resistance, Usual("50 ohm", "1100 ohm")] = 120.0
    """Resistance of the gauge."""
    transverse_sensitivity: float = Field(default=0.0, ge=-0.2, le=0.2)
    """Sensitivity across over that along the grid."""
    stress_state: Literal["uniaxial", "plane_strain"] = "uniaxial"
    """How strain becomes stress: uniaxial: E eps, as at the ends of the face; plane_strain: E eps / (1 - nu^2), a wide
    tooth at mid-face."""
    response_time: ResponseTime = 0.0
    """Time constant of slip ring, amplifier and logger taken as a first-order low-pass: 1 / (2 pi cut-off frequency);
    0.02 ms pass 8 kHz. What a recording is compared with has it."""
    bridge: StrainBridge
    """Circuit that measures its resistance."""

    @model_validator(mode="after")
    def _one_place(self) -> "StrainGaugeInput":
        stated = [key for key in PLACES if getattr(self, key) is not None]
        if len(stated) > 1:
            raise fault(
                f"{' and '.join(stated)} are given", "keep one of them: each is the place along the fillet"
            )
        return self


PLACES = ("fillet_position", "tangent_angle", "root_diameter")
"""Keys of the place along the fillet."""
