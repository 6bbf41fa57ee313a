"""Chambers of a housing whose surfaces radiate at each other."""

from collections.abc import Iterable, Mapping
from typing import Annotated, Literal

from pydantic import Field, model_validator

from rigdesign.case.fields import Name, Part, Share, Temperature, Text, Usual, fault
from rigdesign.case.matching import matched

Chamber = Literal["warm", "cold_front", "cold_rear"]
"""A chamber of the box."""
IN_CHAMBER: Mapping[Chamber, tuple[str, ...]] = {
    "warm": (
        "chamber_*", "partition_warm_*", "end_wall_*", "shaft_*_warm", "gear_*_rim", "gear_*_side_*",
    ),
    "cold_front": ("cold_wall_front", "cold_floor_front", "partition_cold_front", "shaft_*_cold_front"),
    "cold_rear": ("cold_wall_rear", "cold_floor_rear", "partition_cold_rear", "shaft_*_cold_rear"),
}  # fmt: skip
"""Surfaces of each chamber."""
OILED = 0.82
"""Emissivity of a thick film of oil on polished steel (P2, heat transfers within the test gear unit)."""


class RadiatingPart(Part):
    """Surfaces of an enclosure with an emissivity of their own."""

    surfaces: tuple[Text, ...] = Field(min_length=1)
    """Surface names; ``*`` stands for any run of characters."""
    emissivity: Annotated[Share, Usual(0.1, 1.0)]
    """Emissivity of the grey surface; 0 for one that gives back all that arrives (re-radiating, no net heat)."""


class EnclosureInput(Part):
    """Surfaces that radiate at each other, grey and diffuse, each with one radiosity.

    Films and gap exchange of the surfaces stay; the gas between them neither absorbs nor emits.
    """

    chamber: Chamber | None = None
    """Chamber of the box whose walls, shafts and gears take part; left out, only ``parts`` do."""
    emissivity: Annotated[Share, Usual(0.1, 1.0)] | None = None
    """Emissivity of the surfaces of the chamber that no part names; 0.82, oil on polished steel, when left out, which
    the report lists as an assumption."""
    parts: Mapping[Name, RadiatingPart] = {}
    """Surfaces with an emissivity of their own, by any name; in addition to the chamber or as its exception."""
    view_factors: Literal["computed"] | Mapping[Name, Mapping[Name, Share]] = "computed"
    """computed: by rays between the surfaces as they are meshed, hidden by all that stands between them; or a table
    surface -> surface -> share of its radiation that arrives there; a pair named in one direction holds in the other by
    reciprocity. Both are closed by reciprocity and summation."""
    opening_temperature: Temperature | None = None
    """Surroundings behind an opening, which take what the view factors of the surfaces leave to one; a closed
    chamber when left out."""

    @model_validator(mode="after")
    def _has_surfaces(self) -> "EnclosureInput":
        if self.chamber is None and not self.parts:
            raise fault("has no surfaces", 'add chamber = "warm", or parts with their surfaces')
        if self.chamber is None and self.emissivity is not None:
            raise fault(
                "emissivity is that of a chamber, and none is named",
                "add chamber, or write the emissivity into the parts",
            )
        return self

    def emissivities(self, names: Iterable[str]) -> dict[str, float]:
        """Surface -> emissivity of everything that takes part, among surfaces with ``names``."""
        known = tuple(names)
        usual = OILED if self.emissivity is None else self.emissivity
        patterns = () if self.chamber is None else IN_CHAMBER[self.chamber]
        found = {surface: usual for surface in known if surface in matched(patterns, known)}
        for part in self.parts.values():
            found |= dict.fromkeys(matched(part.surfaces, known), part.emissivity)
        return found

    def rows(self, areas: Mapping[str, float]) -> tuple[tuple[float, ...], ...] | None:
        """The given view factors as a matrix between surfaces with ``areas`` [m2]; None where they are computed.

        What the table says in one direction only holds in the other by reciprocity, A_i F_ij = A_j F_ji.
        """
        if self.view_factors == "computed":
            return None
        given = self.view_factors

        def factor(name: str, other: str) -> float:
            if other in given.get(name, {}):
                return given[name][other]
            return given.get(other, {}).get(name, 0.0) * areas[other] / areas[name]

        return tuple(tuple(factor(name, other) for other in areas) for name in areas)
