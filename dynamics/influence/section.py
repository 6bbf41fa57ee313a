"""Transverse section of a gear body with a few teeth in second-order quadrilaterals, as gmsh divides its drawing."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.gear.tooth_form import ToothForm
from dynamics.influence.gear_body import STANDARD, TEETH, GearBody, SectionDivision
from dynamics.influence.quadrilaterals import anticlockwise, least_jacobian, on_circles
from dynamics.influence.section_drawing import Ring, SectionDrawing
from thermal.fe.gmsh_session import gmsh_session

Array = NDArray[np.float64]
IndexArray = NDArray[np.int32]
GMSH_QUAD_8 = 16
"""gmsh's number of the element."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Section:
    """Quadrilaterals of the section and the nodes that loads and results need.

    The axis of tooth 0 is y. Tooth k stands k pitches on, clockwise as the right flank faces.
    """

    points: Array
    """(n, 2) [m]"""
    cells: IndexArray
    """(n_cells, 8) corners anticlockwise, then the middles of the sides."""
    flanks: Mapping[int, IndexArray]
    """Tooth -> (2 profile + 1,) nodes of its right flank from fillet to tip, corners and middles of elements."""
    axes: Mapping[int, IndexArray]
    """Tooth -> nodes on its axis from the ring below it to the tip, corners and middles."""
    fillets: Mapping[tuple[int, int], IndexArray]
    """(tooth, +1 right or -1 left) -> nodes from the middle of the tooth space to the flank, corners and middles."""
    rims: Mapping[int, IndexArray]
    """+1 right or -1 left -> nodes on the root circle from the last tooth drawn to the other side of the gear."""
    bore: IndexArray
    """Nodes on the bore."""
    web: IndexArray
    """Cells inside of the rim; none in a solid body."""


def gear_section(form: ToothForm, body: GearBody, division: SectionDivision = STANDARD) -> Section:
    """Divide the section of a gear.

    Raises DynamicsInputError for a bore or rim that leaves no body under the teeth and for a tip edge or protuberance
    that elements cannot follow; OSError or ImportError where gmsh is missing.
    """
    ring = Ring.of(form, body)
    with gmsh_session() as gmsh:
        drawing = SectionDrawing(gmsh.model.geo, form, ring, division)
        drawing.draw()
        gmsh.model.geo.synchronize()
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(2)
        section = _section(gmsh, drawing)
    if not least_jacobian(section.points, section.cells) > 0.0:
        raise DynamicsInputError(
            f"section of the gear with {form.gear.teeth} teeth and module {1e3 * form.gear.normal_module:g} mm: "
            f"elements fold; a tip edge (rounding {1e3 * form.tip_edge.rounding:.3f} mm, chamfer "
            f"{1e3 * form.tip_edge.chamfer:.3f} mm) or protuberance ({1e3 * form.protuberance:.3f} mm) of a tenth of "
            "the module is usual, reduce them"
        )
    return section


def _section(gmsh: ModuleType, drawing: SectionDrawing) -> Section:
    """The mesh of everything drawn."""
    blocks = [_quadrilaterals(gmsh, patch) for patch in drawing.patches]
    numbered = np.concatenate(blocks)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    used = np.unique(numbered)
    place = np.full(int(tags.max()) + 1, -1, dtype=np.int32)
    place[used] = np.arange(len(used), dtype=np.int32)
    row = np.full(int(tags.max()) + 1, -1, dtype=np.int64)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    points = coordinates.reshape(-1, 3)[row[used], :2]
    cells = anticlockwise(points, place[numbered])
    of_teeth = sum(len(block) for block in blocks[: drawing.of_teeth])
    of_web = sum(len(block) for block in blocks[len(blocks) - drawing.of_web :])
    ordered = {name: place[_along(gmsh, curves)] for name, curves in drawing.curves.items()}
    return Section(
        points=on_circles(points, cells[of_teeth:]),
        cells=cells,
        flanks={tooth: ordered[f"flank {tooth} 1"] for tooth in TEETH},
        axes={tooth: ordered[f"axis {tooth}"] for tooth in TEETH},
        fillets={(tooth, side): ordered[f"fillet {tooth} {side}"] for tooth in TEETH for side in (-1, 1)},
        rims={side: ordered[f"rim {side}"] for side in (1, -1)},
        bore=np.unique(ordered["bore"]),
        web=np.arange(len(cells) - of_web, len(cells), dtype=np.int32),
    )


def _quadrilaterals(gmsh: ModuleType, surface: int) -> NDArray[np.int64]:
    """(n, 8) node tags of a surface."""
    kinds, _, nodes = gmsh.model.mesh.getElements(2, surface)
    assert list(kinds) == [GMSH_QUAD_8], f"gmsh left elements of kinds {kinds}"
    return np.asarray(nodes[0].reshape(-1, 8).astype(np.int64))


def _along(gmsh: ModuleType, curves: list[int]) -> NDArray[np.int64]:
    """Node tags of curves that follow each other, in order, corners and middles."""
    found: list[int] = []
    for curve in curves:
        nodes = gmsh.model.mesh.getElements(1, curve)[2][0].reshape(-1, 3).astype(np.int64)
        steps = nodes[:, [0, 2]].ravel().tolist()
        found += steps if not found else steps[1:]
        found.append(int(nodes[-1, 1]))
    return np.array(found)
