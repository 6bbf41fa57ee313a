"""The joint between a gearbox and the field it stands on."""

from typing import Annotated

from pydantic import Field, model_validator

from rigdesign.case.fields import Conductivity, HeatTransferCoefficient, Part, Small, Stress, fault


class PressedJoint(Part):
    """Two rough metal faces under pressure (Cooper, Mikic, Yovanovich 1969)."""

    pressure: Stress
    """Mean contact pressure of the joint."""
    roughness: Small
    """Root of the sum of both squared rms roughnesses."""
    slope: Annotated[float, Field(gt=0.0, le=1.0)]
    """Root of the sum of both squared mean slopes of the asperities; 0.05 to 0.3 for machined faces."""
    hardness: Stress
    """Micro-hardness of the softer side."""
    filling_conductivity: Conductivity | None = None
    """Thermal conductivity of oil or grease between the faces; dry air when left out."""

    @model_validator(mode="after")
    def _rough(self) -> "PressedJoint":
        if self.roughness == 0.0:
            raise fault("roughness is zero", "write the rms roughness of both faces, e.g. 3 um")
        return self


class FootContact(Part):
    """Foot and field as bodies that touch: a measured or assumed conductance, or the joint it follows from."""

    conductance: HeatTransferCoefficient | None = None
    """Heat flux per kelvin between foot and field."""
    joint: PressedJoint | None = None
    """Joint of two rough faces from which the conductance follows."""

    @model_validator(mode="after")
    def _one(self) -> "FootContact":
        if (self.conductance is None) == (self.joint is None):
            given = "neither" if self.conductance is None else "both"
            raise fault(f"{given} of conductance and joint is given", "write one of the two")
        return self
