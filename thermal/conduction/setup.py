"""What conduction on one mesh needs whatever its conditions: matrices, joints of touching surfaces."""

from collections.abc import Mapping, Sequence

import numpy as np

from thermal.conditions.boundary import Adiabatic
from thermal.conditions.contact import Contact, SurfaceJoint, covered, join
from thermal.conduction.capacity import Conductivity, HeatCapacity, VariableConduction
from thermal.conduction.condition_checks import Condition, check_conductivity, surfaces_of
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray, NamedMesh

USUAL = 293.15
"""Temperature [K] at which a conductivity law gives the size of its matrix entries."""


class ConductionSetup:
    """Conduction matrices of a mesh, assembled once and used for every stage and iteration of the coupling.

    conductivity : body -> k [W/(m K)], a number or a law of the temperature
    elements : share the spaces of an earlier setup on the same mesh
    Raises MeshError for a bad mesh and ConditionError for missing, unknown or impossible conductivities.
    """

    def __init__(
        self,
        mesh: NamedMesh,
        conductivity: Mapping[str, Conductivity],
        elements: FiniteElements | None = None,
    ) -> None:
        check_conductivity(mesh.bodies, conductivity)
        self.mesh = mesh
        self.conductivity = dict(conductivity)
        self.elements = FiniteElements(mesh) if elements is None else elements
        laws = {name: k for name, k in self.conductivity.items() if callable(k)}
        constant = {name: 0.0 if callable(k) else float(k) for name, k in self.conductivity.items()}
        per_cell = self.elements.per_cell(constant)
        self.fine = self.elements.fine.conduction(per_cell)
        """(nnz,) values of the second-order matrix [W/K], bodies with a law left out."""
        self.coarse = self.elements.coarse.conduction(per_cell)
        """Values of the linear matrix [W/K], bodies with a law left out."""
        self.variable = VariableConduction(self.elements, laws) if laws else None
        """The bodies with a law."""
        size = self.fine
        if self.variable is not None:
            usual = np.full(len(mesh.points), USUAL)
            size = size + self.variable.fine_values(usual)
        self.size = self.elements.fine.row_sizes(size)
        """(n_nodes,) sum of the sizes of each row's entries [W/K], for the rounding error of the residual."""
        self._capacities: dict[tuple[tuple[str, float], ...], HeatCapacity] = {}
        self._joints: dict[tuple[str, str, float | None, float], SurfaceJoint] = {}

    def notes(self, conditions: Sequence[Condition]) -> tuple[str, ...]:
        """What is to be said of the joints among ``conditions``: surfaces that touch and give heat to others."""
        others = {
            name for c in conditions if not isinstance(c, Contact | Adiabatic) for name in surfaces_of(c)
        }
        contacts = (c for c in conditions if isinstance(c, Contact))
        return tuple(text for c in contacts for text in covered(c, self.joint(c), others))

    def heat_capacity(self, capacity: Mapping[str, float]) -> HeatCapacity:
        """Capacity matrices for body -> density times specific heat [J/(m3 K)], assembled once."""
        key = tuple(sorted(capacity.items()))
        if key not in self._capacities:
            self._capacities[key] = HeatCapacity(self.elements, capacity)
        return self._capacities[key]

    def joint(self, contact: Contact) -> SurfaceJoint:
        """Common part of the surfaces of a contact, found once."""
        key = (contact.surface_a, contact.surface_b, contact.reach, contact.least_coverage)
        if key not in self._joints:
            self._joints[key] = join(self.elements, contact)
        return self._joints[key]


# Heat flux at the nodes, for pictures and files: what a cell conducts on average, spread to its nodes.


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
