"""Shafts that only twist and analytic teeth: seconds for tests of what these do not decide."""

from dataclasses import replace

from rigdesign.base.fidelity import Fidelity
from rigdesign.case import Case
from rigdesign.rig.model import Rig, build_rig

OWN_EVERY = 3
"""Of many runs of changed cases, one of so many has the shafts and teeth of the case, the others these."""


def twisting_case(case: Case) -> Case:
    """A case with these in place of its own."""
    return case.with_values(
        {"drivetrain.shaft_model": "torsional", "drivetrain.mesh_stiffness": "iso_6336_scaled"}
    )


def twisting_rig(case: Case, fidelity: Fidelity = "quick") -> Rig:
    """The rig of a case with these in place of its own."""
    return replace(build_rig(case, fidelity), shaft_model="torsional", mesh_stiffness="iso_6336_scaled")
