"""How each power loss of a gearbox divides between its bodies and its oil."""

from typing import Annotated, Literal

from pydantic import model_validator

from rigdesign.case.fields import Part, Share, Usual, fault

MeshRule = Literal["assumed", "flank_film"]


class HeatSplit(Part):
    """Share of each loss that enters solid bodies; the rest goes into the oil at once."""

    mesh: MeshRule | None = None
    """assumed: ``mesh_into_gears`` of the friction heat enters the gears; flank_film: all of it enters the flanks,
    and the films on the rims (law ``flank_film``) decide how much heat goes into the oil. When left out:
    flank_film, or assumed where the case gives a share."""
    mesh_into_gears: Annotated[Share, Usual(0.1, 1.0)] | None = None
    """Share of the friction heat of the meshes that enters the gears, for ``mesh = assumed``."""
    mesh_pinion_share: Annotated[Share, Usual(0.1, 0.9)] | None = None
    """Of the friction heat, the part that enters the pinion; by the thermal contact of the flanks when left out."""
    windage_into_gears: Annotated[Share, Usual(0.02, 0.9)]
    """Share of the windage loss that heats the gear bodies."""
    seal_into_shaft: Annotated[Share, Usual(0.03, 1.0)]
    """Share of the seal losses that enters the shaft at the seal."""
    seal_into_housing: Annotated[Share, Usual(0.03, 1.0)]
    """Share of the seal losses that enters the bore of the seal."""

    @property
    def rule(self) -> MeshRule:
        """How the friction heat of the meshes divides: as stated, by a given share, else by the films on the flanks."""
        if self.mesh is not None:
            return self.mesh
        return "flank_film" if self.mesh_into_gears is None else "assumed"

    @model_validator(mode="after")
    def _share_given(self) -> "HeatSplit":
        if self.mesh == "assumed" and self.mesh_into_gears is None:
            raise fault(
                "mesh_into_gears is missing: the split of the mesh heat is assumed",
                'write a share, or remove mesh and write law = "flank_film" at the rims of the gears',
            )
        if self.mesh == "flank_film" and self.mesh_into_gears is not None:
            raise fault(
                f"mesh_into_gears = {self.mesh_into_gears:g} is not used: the film on the flanks decides",
                'remove it, or write mesh = "assumed"',
            )
        return self

    @model_validator(mode="after")
    def _seal_heat_fits(self) -> "HeatSplit":
        total = self.seal_into_shaft + self.seal_into_housing
        if total > 1.0:
            raise fault(
                f"seal_into_shaft and seal_into_housing add up to {total:g}, more than the whole",
                "write shares whose sum is at most 1; the rest goes into the oil",
            )
        return self
