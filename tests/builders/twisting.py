"""A rig with shafts that only twist and analytic teeth: seconds for tests of what these do not decide."""

from dataclasses import replace

from rigdesign.base.fidelity import Fidelity
from rigdesign.case import Case
from rigdesign.rig.model import Rig, build_rig


def twisting_rig(case: Case, fidelity: Fidelity = "quick") -> Rig:
    """The rig of a case with these in place of its own."""
    return replace(build_rig(case, fidelity), shaft_model="torsional", mesh_stiffness="iso_6336_scaled")
