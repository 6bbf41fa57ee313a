"""Stress from a displacement field, cell by cell at the cell's own nodes."""

import numpy as np
from skfem.helpers import eye, sym_grad

from thermal.expansion.elastic import ElasticSetup
from thermal.fe.arrays import FloatArray, IndexArray
from thermal.fe.elements import VECTOR
from thermal.fe.reference_elements import QuadratureRule
from thermal.forms import lame, stress


def stress_at_nodes(
    setup: ElasticSetup,
    displacement: FloatArray,
    temperature: FloatArray,
    reference: float,
    cells: IndexArray | None = None,
) -> FloatArray:
    """Stress (k, n_local, 3, 3) [Pa] of k ``cells`` (all if None) at their nodes, not averaged between cells.

    displacement : (n_nodes, 3) [m]; temperature : (n_nodes,) and reference [K]

    sigma = lambda tr(e) 1 + 2 mu e with e the strain less the free one, alpha (T - T0). At nodes the stress of
    a second-order cell is one order less accurate than inside, but what surfaces and corners are judged by.
    """
    elements = setup.elements
    chosen = np.arange(len(elements.mesh.cells), dtype=np.int32) if cells is None else cells
    nodes = elements.shape.nodes
    basis = elements.bases.cells(chosen, VECTOR, QuadratureRule(nodes, np.ones(len(nodes))))
    material = {name: lame(m.young, m.poisson) for name, m in setup.elastic.items()}
    lam, mu = (
        elements.per_cell({name: v[k] for name, v in material.items()})[chosen, None] for k in range(2)
    )
    alpha = elements.per_cell({name: m.expansion for name, m in setup.elastic.items()})[chosen, None]
    free = alpha * (temperature[elements.mesh.cells[chosen]] - reference)
    strain = sym_grad(basis.interpolate(displacement.ravel())) - eye(free, 3)
    return np.asarray(np.moveaxis(stress(strain, lam, mu), (0, 1), (2, 3)))
