"""Rules of a case that give the faces of a STEP file their names."""

import math

from pydantic import model_validator

from rigdesign.case.fields import Length, Offset, Part, fault
from thermal.housing.face_rules import Box, Cylinder, FaceRule, Plane

Place = tuple[Offset, Offset, Offset]
"""x, y and z in the frame of the STEP file."""
Direction = tuple[float, float, float]
"""x, y and z of a direction; its length does not count."""


class FacePlane(Part):
    """Faces in a plane."""

    point: Place
    """Any point of the plane."""
    normal: Direction
    """Direction across it, in either sense."""

    @model_validator(mode="after")
    def _has_direction(self) -> "FacePlane":
        _require_direction("normal", self.normal)
        return self


class FaceCylinder(Part):
    """Faces on a cylinder, bore or boss."""

    point: Place
    """Any point of the axis."""
    direction: Direction = (1.0, 0.0, 0.0)
    """Direction of the axis; along the shafts when left out."""
    radius: Length
    """Of the cylinder."""

    @model_validator(mode="after")
    def _has_direction(self) -> "FaceCylinder":
        _require_direction("direction", self.direction)
        return self


class FaceBox(Part):
    """Faces that lie wholly inside a box along x, y and z."""

    low: Place
    """Corner of least x, y and z."""
    high: Place
    """Corner of greatest x, y and z."""

    @model_validator(mode="after")
    def _starts_before_it_ends(self) -> "FaceBox":
        if any(low > high for low, high in zip(self.low, self.high)):
            raise fault("the box ends before it starts", "write the lesser of each coordinate in low")
        return self


class FaceSelection(Part):
    """Faces that meet everything this entry says; several entries of a surface add up."""

    plane: FacePlane | None = None
    """In this plane."""
    cylinder: FaceCylinder | None = None
    """On this cylinder."""
    box: FaceBox | None = None
    """Inside this box."""

    @model_validator(mode="after")
    def _says_something(self) -> "FaceSelection":
        if self.plane is None and self.cylinder is None and self.box is None:
            raise fault("says nothing of its faces", "add plane, cylinder or box")
        return self

    @property
    def rule(self) -> FaceRule:
        """The same as the solver reads it."""
        shapes: list[Plane | Cylinder | Box] = []
        if self.plane is not None:
            shapes.append(Plane(self.plane.point, self.plane.normal))
        if self.cylinder is not None:
            shapes.append(Cylinder(self.cylinder.point, self.cylinder.direction, self.cylinder.radius))
        if self.box is not None:
            shapes.append(Box(self.box.low, self.box.high))
        return FaceRule(tuple(shapes))


def _require_direction(key: str, direction: Direction) -> None:
    length = math.hypot(*direction)
    if not (math.isfinite(length) and length > 0.0):
        raise fault(f"{key} = {list(direction)} has no length", f"write a direction, e.g. {key} = [1, 0, 0]")
