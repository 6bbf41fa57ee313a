"""Tooth force of every mesh per tooth force of the mesh whose torque the case states, without losses."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from dynamics.gear.pair import GearPair
from rigdesign.base.errors import CaseError, Fault
from rigdesign.case.model import Case

Array = NDArray[np.float64]


def loop_forces(case: Case, pairs: Mapping[str, GearPair], lines: Mapping[str, int]) -> dict[str, float]:
    """Signed force of each mesh ``gearbox.mesh`` of the closed loop for the force 1 in the first one.

    Positive where the pinion drives its wheel. Every shaft line is in balance: what one mesh gives it, the others
    take. Round one loop all forces are equal; an idler is driven by one neighbour and drives the other. Several
    loops side by side share the load as equal meshes would (least sum of squares).

    lines : shaft -> line of the drivetrain

    Raises
    ------
    CaseError
        The first mesh is in no loop: nothing can be locked into it.
    """
    forces = _forces(_balance(case, pairs, lines))
    if forces is None:
        joined = (
            "; ".join(f"{name}: {', '.join(one.shafts)}" for name, one in case.drivetrain.couplings.items())
            if case.drivetrain
            else "none"
        )
        fault = Fault(
            "drivetrain.couplings", joined,
            f"leaves mesh {next(iter(pairs))}, where drivetrain.torque_at counts, in no closed loop: nothing holds a "
            "torque in it",
            "close the loop through a second gearbox or let torque_at name a gear of the loop",
        )  # fmt: skip
        raise CaseError([fault], f"case {case.name}")
    return dict(zip(pairs, map(float, forces)))


def gearbox_forces(case: Case, pairs: Mapping[str, GearPair]) -> dict[str, float]:
    """The same for gearboxes without a drivetrain: force 1 in the first mesh of each, its idlers in balance."""
    found: dict[str, float] = {}
    for box in case.gearboxes:
        own = {name: pair for name, pair in pairs.items() if name.split(".")[0] == box}
        shafts = {gear.shaft: i for i, gear in enumerate(case.gearboxes[box].gears.values())}
        rows = _balance(case, own, shafts)
        forces = _forces(rows[np.count_nonzero(rows, axis=1) > 1])
        found |= dict(zip(own, [1.0] * len(own) if forces is None else map(float, forces)))
    return {name: found[name] for name in pairs}


def _balance(case: Case, pairs: Mapping[str, GearPair], lines: Mapping[str, int]) -> Array:
    """(n_lines, n_meshes) torque on each line per force in each mesh [m]."""
    rows = np.zeros((max(lines.values()) + 1, len(pairs)))
    for index, (name, pair) in enumerate(pairs.items()):
        box_name, own = name.split(".")
        box = case.gearboxes[box_name]
        mesh = box.meshes[own]
        rows[lines[box.gears[mesh.pinion].shaft], index] += pair.base_radii[0]
        rows[lines[box.gears[mesh.wheel].shaft], index] -= pair.base_radii[1]
    return rows


def _forces(rows: Array) -> Array | None:
    """Forces of least squares with ``rows @ forces = 0`` and 1 in the first mesh; None if that one must be 0."""
    free = np.eye(rows.shape[1]) - np.linalg.pinv(rows) @ rows
    return None if free[0, 0] < 1e-9 else np.asarray(free[:, 0] / free[0, 0])
