"""Second-order tetrahedral meshes whose bodies and surfaces have names."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int32]


@dataclass(frozen=True)
class NamedMesh:
    """A mesh of 10-node tetrahedra (VTK node order) with named bodies and surfaces.

    points : (n_nodes, 3) coordinates [m]
    cells : (n_cells, 10) node indices, corners first, mid-side nodes 01 12 20 03 13 23
    bodies : name -> (k,) cell indices; every cell belongs to exactly one body
    surfaces : name -> (k, 6) node indices of 6-node triangles, corners first, mid-sides 01 12 20, normal
        pointing out of the body they bound; every facet on the boundary of the mesh belongs to exactly one
        surface. An interface between two bodies that share nodes may be named too (it then has one side).
    """

    points: FloatArray
    cells: IndexArray
    bodies: dict[str, IndexArray]
    surfaces: dict[str, IndexArray]
