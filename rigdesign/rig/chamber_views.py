"""View factors between the surfaces of the chambers, of each set of surfaces once."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from rigdesign.base.errors import CaseError
from thermal.conditions.ray_view_factors import RayExchange, ray_view_factors
from thermal.conditions.view_factor_closure import EnclosureError, close_view_factors
from thermal.conduction.setup import ConductionSetup

ViewFactors = tuple[tuple[float, ...], ...]
NOTICED = 0.005
"""Share of a surface's radiation that goes elsewhere, from which on an error names where it goes [-]."""

CURVED = 0.2
"""What curved facets may have more or less area than the triangles between their corners [-]."""


@dataclass(frozen=True)
class ChamberViews:
    """View factors by rays on the meshed housings.

    They depend on the meshes alone: rigs that share those share them.
    """

    conduction: Mapping[str, ConductionSetup]
    _found: dict[tuple[str, tuple[str, ...], bool], ViewFactors] = field(default_factory=dict)

    def between(self, gearbox: str, surfaces: tuple[str, ...], *, opening: bool, at: str) -> ViewFactors:
        """View factors of ``surfaces`` of a gearbox as rows, closed.

        opening : whether they leave a share to surroundings; at : path of the view factors in the case, for errors

        Raises CaseError for surfaces that do not close a chamber.
        """
        key = gearbox, surfaces, opening
        if key not in self._found:
            elements = self.conduction[gearbox].elements
            exchange = ray_view_factors(elements.mesh, surfaces)
            flat = np.array(exchange.areas)
            try:
                closed = close_view_factors(np.array(exchange.factors), flat, surfaces, opening)
            except EnclosureError as error:
                raise CaseError(f"{at} = computed: {error}{_elsewhere(exchange)}") from error
            areas = np.array([*self.areas(gearbox, surfaces).values()])
            closed = close_view_factors(closed, areas, surfaces, opening, CURVED)
            self._found[key] = tuple(tuple(row) for row in closed.tolist())
        return self._found[key]

    def areas(self, gearbox: str, surfaces: tuple[str, ...]) -> dict[str, float]:
        """Area of surfaces of a gearbox [m2]."""
        elements = self.conduction[gearbox].elements
        return {name: elements.surfaces[name].area for name in surfaces}

    def require_closed(
        self, gearbox: str, surfaces: tuple[str, ...], rows: ViewFactors, *, opening: bool, at: str
    ) -> None:
        """CaseError at the path ``at`` for given view factors that do not close on the mesh."""
        areas = np.array([*self.areas(gearbox, surfaces).values()])
        try:
            close_view_factors(np.array(rows), areas, surfaces, opening)
        except EnclosureError as error:
            raise CaseError(f"{at}: {error}") from error


def _elsewhere(exchange: RayExchange) -> str:
    """Surfaces that are no members and are seen from them."""
    seen = {name: share for name, share in exchange.elsewhere.items() if share > NOTICED}
    if not seen:
        return ""
    most = sorted(seen, key=lambda name: -seen[name])[:5]
    return ". Seen and not named: " + ", ".join(f"{name} (up to {seen[name]:.0%})" for name in most)
