"""Seats of gears on their shafts: splines with their stiffness and damping, and the toothing that limits their load."""

from math import radians
from typing import Annotated

from pydantic import Field, model_validator

from rigdesign.base.units import show
from rigdesign.case.fields import (
    Count,
    Length,
    LinearStiffness,
    Part,
    Quantity,
    Share,
    Stress,
    TorsionalDamping,
    TorsionalStiffness,
    Usual,
    fault,
)

SplineAngle = Annotated[float, Quantity("angle", at_least="15 deg", at_most="50 deg")]


WORKING_DEPTH = 0.9
"""Of a spline to DIN 5480, in modules: half of tip diameter of the shaft less tip diameter of the hub."""


class SplineToothing(Part):
    """Toothing of a spline and its strength; each stress is checked where its allowable value is stated."""

    teeth: Count = Field(ge=4, le=500)
    """Number of teeth."""
    module: Annotated[Length, Usual(0.005, 0.2, "shaft diameter")] | None = None
    """Module; or ``pitch_diameter``."""
    pitch_diameter: Annotated[Length, Usual(0.4, 2.5, "shaft diameter")] | None = None
    """Pitch diameter, teeth times module."""
    pressure_angle: SplineAngle = radians(30.0)
    """Pressure angle of the flanks; 30 deg by DIN 5480."""
    length: Annotated[Length, Usual(0.1, 4.0, "shaft diameter")]
    """Axial length of contact."""
    working_depth: Length | None = None
    """Radial height over which the flanks touch; 0.9 modules when left out, as of a spline to DIN 5480."""
    load_distribution_factor: float = Field(default=1.0, ge=1.0, le=5.0)
    """K_m of Dudley: load distribution over length and teeth with tilted axes, 1 to 3."""
    shaft_root_diameter: Length | None = None
    """Root circle of the teeth of the shaft; without it the shear of the shaft under them is not checked."""
    hub_root_diameter: Length | None = None
    """Root circle of the teeth of the hub, its largest bore; without it the tension of the hub is not checked."""
    hub_diameter: Length | None = None
    """Outside diameter of the hub; the root circle of the gear when left out."""
    allowable_pressure: Annotated[Stress, Usual("5 MPa", "600 MPa")] | None = None
    """Allowable flank pressure under the dynamic torque, life factor included. Dudley: 35 MPa for straight teeth of
    case-hardened steel that slide, nine times as much where they are fixed."""
    allowable_shear: Annotated[Stress, Usual("40 MPa", "700 MPa")] | None = None
    """Allowable shear stress of teeth and shaft. Dudley: 345 MPa for case-hardened steel, times its life
    factor, 0.5 to 0.2 for 1e5 to 1e7 cycles of the torque."""
    allowable_tension: Annotated[Stress, Usual("40 MPa", "1000 MPa")] | None = None
    """Allowable tensile stress of the hub at speed."""

    @model_validator(mode="after")
    def _geometry(self) -> "SplineToothing":
        if (self.module is None) == (self.pitch_diameter is None):
            given = "neither" if self.module is None else "both"
            raise fault(
                f"{given} of module and pitch_diameter is given",
                'write one of the two, e.g. module = "2 mm"',
            )
        inner, outer = self.hub_root_diameter, self.hub_diameter
        if outer is not None and (inner is None or inner >= outer):
            raise fault(
                f"hub_diameter = {show(outer, 'length')} needs a hub_root_diameter inside of it",
                "write the root circle of the teeth of the hub, or leave hub_diameter out",
            )
        return self

    @property
    def reference_diameter(self) -> float:
        """Pitch diameter [m]."""
        return self.teeth * (self.module or 0.0) if self.pitch_diameter is None else self.pitch_diameter

    @property
    def contact_height(self) -> float:
        """Radial height over which the flanks touch [m]."""
        if self.working_depth is not None:
            return self.working_depth
        return WORKING_DEPTH * self.reference_diameter / self.teeth


class Spline(Part):
    """Spline-hub connection of a gear with its shaft."""

    torsional_stiffness: Annotated[TorsionalStiffness, Usual(1.6, 70.0, "stiffness of the shaft")]
    """Torque per angle of twist between gear and shaft."""
    torsional_damping: TorsionalDamping = 0.0
    """Torque per speed of twist between gear and shaft."""
    loss_factor: Share = 0.0
    """Friction between the teeth, instead of ``torsional_damping``: a cycle of twist dissipates pi times this factor
    times ``torsional_stiffness`` times the square of its amplitude, at any frequency. The loop has a viscous damper
    with the same loss at the mesh frequency of the gear at every speed."""
    radial_stiffness: LinearStiffness | None = None
    """Force per radial offset between gear and shaft, of shafts that bend; with ``axial_stiffness`` and
    ``angular_stiffness``, or none of the three for a gear that only twists against its shaft."""
    axial_stiffness: LinearStiffness | None = None
    """Force per axial travel between gear and shaft."""
    angular_stiffness: TorsionalStiffness | None = None
    """Moment per tilt between gear and shaft, about a diameter."""
    lateral_damping_time: float = Field(default=0.0, ge=0.0, le=1e-3)
    """Damping over stiffness of these three [s]."""
    toothing: SplineToothing | None = None
    """Toothing of the spline, for the checks of its strength."""

    @model_validator(mode="after")
    def _one_damper(self) -> "Spline":
        if self.torsional_damping and self.loss_factor:
            raise fault(
                f"torsional_damping = {show(self.torsional_damping, 'torsional_damping')} and loss_factor = "
                f"{self.loss_factor:g} exclude each other",
                "write one of the two",
            )
        return self

    @model_validator(mode="after")
    def _whole_seat(self) -> "Spline":
        stated = {
            "radial_stiffness": self.radial_stiffness,
            "axial_stiffness": self.axial_stiffness,
            "angular_stiffness": self.angular_stiffness,
        }
        missing = [key for key, value in stated.items() if value is None]
        if missing and len(missing) < len(stated):
            raise fault(
                f"{' and '.join(missing)} of the seat missing: an elastic seat needs all three",
                "write all three, or none for a seat that is elastic in torsion only",
            )
        if self.lateral_damping_time and missing:
            raise fault(
                f"lateral_damping_time = {self.lateral_damping_time:g} is given without stiffness",
                "write radial_stiffness, axial_stiffness and angular_stiffness, or leave it out",
            )
        return self
