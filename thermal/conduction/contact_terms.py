"""Residual and Jacobian of the contacts of a model."""

from collections.abc import Sequence

import numpy as np
from scipy import sparse

from thermal.conditions.contact import Contact, SurfaceJoint
from thermal.conduction.law_values import checked_value
from thermal.fe.low_rank import DIFFERENCE, Column
from thermal.fe.mesh import FloatArray


class ContactTerms:
    """All contacts with their joints."""

    def __init__(self, contacts: Sequence[Contact], joints: Sequence[SurfaceJoint]) -> None:
        self.contacts, self.joints = contacts, joints
        self._jumps = [joint.jump for joint in joints]
        self._units = [
            sparse.csr_array(jump.T @ (sparse.diags_array(joint.weights) @ jump))
            for jump, joint in zip(self._jumps, joints, strict=True)
        ]
        """(n_nodes, n_nodes) matrix of each contact at 1 W/(m2 K) [m2]."""
        self._means = [(joint.mean(joint.side_a), joint.mean(joint.side_b)) for joint in joints]

    def values(self, temperature: FloatArray) -> list[float]:
        """Conductance of every contact [W/(m2 K)]."""
        return [
            _value(contact, float(a @ temperature), float(b @ temperature))
            for contact, (a, b) in zip(self.contacts, self._means, strict=True)
        ]

    def heat_out(self, temperature: FloatArray) -> tuple[FloatArray, float]:
        """Heat (n_nodes,) that leaves every node; sum of the flows' sizes [W]."""
        out = np.zeros(len(temperature))
        turned = 0.0
        values = self.values(temperature)
        for value, jump, joint in zip(values, self._jumps, self.joints, strict=True):
            flow = value * joint.weights * (jump @ temperature)
            out += jump.T @ flow
            turned += 2.0 * abs(float(flow.sum()))
        return out, turned

    def matrix(self, temperature: FloatArray) -> sparse.csr_array | None:
        """Symmetric part of the Jacobian [W/K]; None without contacts."""
        total: sparse.csr_array | None = None
        for value, unit in zip(self.values(temperature), self._units, strict=True):
            total = value * unit if total is None else total + value * unit
        return total

    def columns(self, temperature: FloatArray) -> list[tuple[Column, Column]]:
        """What conductances that follow the mean temperatures add to the Jacobian."""
        columns = []
        for contact, (a, b), unit in zip(self.contacts, self._means, self._units, strict=True):
            t_a, t_b = float(a @ temperature), float(b @ temperature)
            by_a = _value(contact, t_a + DIFFERENCE, t_b) - _value(contact, t_a - DIFFERENCE, t_b)
            by_b = _value(contact, t_a, t_b + DIFFERENCE) - _value(contact, t_a, t_b - DIFFERENCE)
            if by_a != 0.0 or by_b != 0.0:
                slope = (by_a * a + by_b * b) / (2.0 * DIFFERENCE)
                columns.append((_column(unit @ temperature), _column(slope)))
        return columns

    def links(self, temperature: FloatArray) -> list[tuple[str, str]]:
        """Pairs of surfaces that pass heat."""
        values = zip(self.contacts, self.values(temperature), strict=True)
        return [(c.surface_a, c.surface_b) for c, value in values if value > 0.0]


def _value(contact: Contact, mean_a: float, mean_b: float) -> float:
    return checked_value(contact.law(mean_a, mean_b).value, contact.surface_a, contact.kind)


def _column(values: FloatArray) -> Column:
    nodes = np.flatnonzero(values).astype(np.int32)
    return nodes, values[nodes]
