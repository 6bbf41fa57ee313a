"""What the drawing of a gear has beyond its involute, its rack and its bore."""

from dataclasses import dataclass
from math import radians

from dynamics.gear.cylindrical_gear import CylindricalGear
from dynamics.gear.tooth_form import SHARP, TipEdge, ToothForm


@dataclass(frozen=True, kw_only=True)
class FlankEnds:
    """Radii where the involute of a gear begins at its fillet and ends at its tip edge, d_Ff/2 and d_Fa/2 [m]."""

    form_radius: float
    tip_radius: float


@dataclass(frozen=True, kw_only=True)
class GearDetails:
    """Tip edge, protuberance of the tool and body of one gear, cold; lengths [m].

    protuberance, protuberance_angle : see `ToothForm`; the angle in [rad]
    rim_thickness : from the root circle inwards; None: solid down to the bore
    web_thickness : axial, in the middle of the face, inside of the rim; None: as wide as the face
    """

    tip_edge: TipEdge = SHARP
    protuberance: float = 0.0
    protuberance_angle: float = radians(10.0)
    rim_thickness: float | None = None
    web_thickness: float | None = None

    def form_of(self, gear: CylindricalGear, scale: float = 1.0) -> ToothForm:
        """Tooth outline of the gear; scale : of lengths, present over cold.

        Raises GearGeometryError, see `ToothForm`.
        """
        return ToothForm(
            gear=gear,
            tip_edge=TipEdge(rounding=scale * self.tip_edge.rounding, chamfer=scale * self.tip_edge.chamfer),
            protuberance=scale * self.protuberance,
            protuberance_angle=self.protuberance_angle,
        )

    def flank_of(self, gear: CylindricalGear, scale: float = 1.0) -> FlankEnds:
        """Ends of the involute of the gear; arguments and errors as in `form_of`."""
        if self.tip_edge == SHARP and not self.protuberance:
            return FlankEnds(form_radius=gear.form_radius, tip_radius=gear.tip_radius)
        form = self.form_of(gear, scale)
        return FlankEnds(form_radius=form.form_radius, tip_radius=form.flank_tip_radius)


PLAIN = GearDetails()
