"""The 1:1 loop at quick fidelity, solved once a worker: dynamic run, loads and records for the tests of records."""

from functools import cache

from rigdesign import load_case
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.run.main import solve_case
from tests.builders.paths import CASES

SLOW = "120 rpm"
"""Speed at which its root stress is asked for: the mesh frequency is a quarter of the first mode of the loop."""


@cache
def solved() -> SolvedRig:
    case = load_case(CASES / "loop_1to1").with_value("numerics.root_stress_speeds", [SLOW])
    return solve_case(case, "quick")


@cache
def solved_twisting() -> SolvedRig:
    """The same loop with shafts that only twist and analytic teeth."""
    models = {"drivetrain.shaft_model": "torsional", "drivetrain.mesh_stiffness": "iso_6336_scaled"}
    return solve_case(load_case(CASES / "loop_1to1").with_values(models), "quick")
