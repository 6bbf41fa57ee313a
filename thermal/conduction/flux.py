"""Heat flux at the nodes, for pictures and files: what a cell conducts on average, spread to its nodes."""

import numpy as np

from thermal.conduction.setup import ConductionSetup
from thermal.fe.mesh import FloatArray


def heat_flux(setup: ConductionSetup, temperature: FloatArray) -> FloatArray:
    """Heat flux -k grad T (n_nodes, 3) [W/m2] of a nodal ``temperature`` (n_nodes,) [K].

    The mean of the cells round a node, weighted by their volumes. Where two bodies meet it is the mean over
    both: what flows along a joint may jump there.
    """
    mesh, level = setup.mesh, setup.elements.fine
    flux, weight = np.zeros((len(mesh.points), 3)), np.zeros(len(mesh.points))
    for body, members in mesh.bodies.items():
        cells = np.unique(members).astype(np.int32)
        law = setup.conductivity[body]
        at_points = level.at_points(temperature, cells)
        value = np.broadcast_to(law(at_points) if callable(law) else float(law), at_points.shape)
        volumes = level.volumes[cells]
        conducted = -np.einsum("eq,eqi->ei", value * volumes, level.gradient(temperature, cells))
        nodes, shares = mesh.cells[cells].ravel(), mesh.cells.shape[1]
        for axis in range(3):
            flux[:, axis] += np.bincount(nodes, np.repeat(conducted[:, axis], shares), minlength=len(flux))
        weight += np.bincount(nodes, np.repeat(volumes.sum(axis=1), shares), minlength=len(flux))
    return flux / weight[:, None]
