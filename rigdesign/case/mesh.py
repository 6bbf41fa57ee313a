"""Element sizes of a housing where the usual ones do not do."""

from pydantic import model_validator

from rigdesign.case.fields import Length, Part, fault

SMALLEST = 1e-3
"""Least element size [m]; below it a gearbox has millions of nodes."""


class HousingMesh(Part):
    """Element size by zone at standard fidelity; quick and reference keep their usual ratio to it.

    A zone that is left out takes its size from that of the whole box. Bores and shafts are never divided into
    fewer elements a turn than the fidelity asks for.
    """

    walls: Length | None = None
    """Largest elements in the walls of the housing."""
    field: Length | None = None
    """Largest elements at the outer edges of the clamping field; under the foot the size of the walls holds."""
    seals: Length | None = None
    """Largest elements on bores and shafts of the seals."""
    bearings: Length | None = None
    """Largest elements on bearing bores, bosses and journals."""
    gears: Length | None = None
    """Largest elements on gears and their seats."""

    @model_validator(mode="after")
    def _feasible(self) -> "HousingMesh":
        if small := [zone for zone, size in self.sizes().items() if size < SMALLEST]:
            raise fault(
                f"element size of {', '.join(small)} is below {1e3 * SMALLEST:g} mm",
                "write a larger one; second-order elements need one layer in a wall",
            )
        return self

    def sizes(self) -> dict[str, float]:
        """Given sizes [m] by the zone's name in thermal.housing.solids.MeshSizes."""
        zones = {"wall": self.walls, "field": self.field, "seal": self.seals, "bearing": self.bearings}
        zones["gear"] = self.gears
        return {zone: size for zone, size in zones.items() if size is not None}
