"""What the analytic tooth model and ISO 6336-3 say of the same section: quick fidelity of ``dynamics.tooth``."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from scipy.optimize import brentq

from dynamics.rating.iso_rating import mesh_stiffness
from dynamics.rating.root_stress import root_influence
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_laws import ContactDiscretisation, mesh_law, pair_stiffness
from tests.reference.tooth_contact.contact_cases import PAIRS, ContactCase


@cache
def law(case: ContactCase) -> MeshLaw:
    """Mesh law of the section as a case builds it, scaled to c_gamma_alpha of ISO 6336-1; one slice."""
    pair = replace(case.pair, face_widths=(case.width, case.width))
    stiffness = pair_stiffness(pair, case.force / case.width).scaled_to(mesh_stiffness(pair, case.torque))
    return mesh_law(pair, stiffness, case.micro, discretisation=ContactDiscretisation(n_slices=1, n_path=961))


def loaded(case: ContactCase, path: float) -> dict[str, Any]:
    """Approach [m], share and root stress [Pa] of pinion and wheel of every pair, as in the records of CalculiX.

    path : of pair 0 before the load [m]; the pinion turns on by the approach, and the pairs with it
    """
    table = law(case)
    grid = table.path_start + table.path_step * np.arange(table.stiffness.shape[1])
    places = path - np.array(PAIRS) * table.base_pitch

    def forces(approach: float) -> np.ndarray:
        at = places + approach
        on = (at >= grid[0]) & (at <= grid[-1])
        depth = np.maximum(approach - np.interp(at, grid, table.gap[0]), 0.0)
        return np.where(on, np.interp(at, grid, table.stiffness[0]) * depth, 0.0)

    approach = float(brentq(lambda x: float(forces(x).sum()) - case.force, 0.0, 3e-4, xtol=1e-12))
    found, pair = forces(approach), replace(case.pair, face_widths=(case.width, case.width))
    roots = [root_influence(pair, index).at(places + approach) * found / case.width for index in (0, 1)]
    return {
        "approach": approach,
        "shares": (found / case.force).tolist(),
        "root_stress": np.array(roots).T.tolist(),
    }


def iso_root_stress(case: ContactCase, index: int) -> float:
    """Nominal stress of ISO 6336-3 method B, load at the outer point of single contact [Pa]."""
    pair = replace(case.pair, face_widths=(case.width, case.width))
    limits = pair.path
    outer = limits.start + pair.base_pitch if index == 0 else limits.end - pair.base_pitch
    return float(root_influence(pair, index, n_path=2001).at(outer)) * case.force / case.width
