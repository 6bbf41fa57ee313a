"""Stress from a displacement field, cell by cell at the cell's own nodes."""

import numpy as np

from thermal.expansion.elastic import ElasticSetup
from thermal.fe.shapes import FloatArray, IndexArray


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
    mesh, shape = setup.elements.mesh, setup.elements.shape
    chosen = np.arange(len(mesh.cells)) if cells is None else cells
    nodes = mesh.cells[chosen]
    slopes = shape.gradients(shape.nodes)
    jacobian = np.einsum("abj,ebi->eaij", slopes, mesh.points[nodes], optimize=True)
    reference_gradient = np.einsum("abj,ebi->eaij", slopes, displacement[nodes], optimize=True)
    gradient = reference_gradient @ np.linalg.inv(jacobian)
    material = {name: np.array(values) for name, values in setup.elastic.items()}
    young, poisson, alpha = (
        setup.elements.per_cell({name: float(values[k]) for name, values in material.items()})[chosen]
        for k in range(3)
    )
    lam = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
    mu = 0.5 * young / (1.0 + poisson)
    free = alpha[:, None] * (temperature[nodes] - reference)
    strain = 0.5 * (gradient + np.swapaxes(gradient, 2, 3)) - free[:, :, None, None] * np.eye(3)
    trace = np.einsum("eaii->ea", strain)
    return np.asarray(
        (lam[:, None] * trace)[:, :, None, None] * np.eye(3) + 2.0 * mu[:, None, None, None] * strain
    )
