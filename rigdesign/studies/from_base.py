"""Points from the solved base case, where their inputs touch a part of the model only; all others in full.

Every point starts from the base case and from no other point, so that its numbers depend on neither order nor
workers. Solved once, for the base case: meshes and their errors, the time run over the schedule.
"""

from functools import cached_property

from threadpoolctl import threadpool_limits

from rigdesign.base.errors import CaseError, NotConvergedError
from rigdesign.base.fidelity import Fidelity
from rigdesign.case.model import Case
from rigdesign.checks import estimated_checks
from rigdesign.results.check import overall
from rigdesign.rig.model import build_rig
from rigdesign.rig.reuse import same_housings
from rigdesign.run.main import run_case
from rigdesign.run.solver_errors import solver_errors
from rigdesign.studies.modified_rig import Reanalysis, reanalysis
from rigdesign.studies.reference_rig import Reference, reanalysed, restored, solve_reference
from rigdesign.studies.result import CheckedPoint, checked_point
from thermal.fe.kernels import one_thread


class FromBase:
    """Computes the points of a study; the base case is solved when the first point can start from it.

    Parameters
    ----------
    case : the base case; fidelity : of base case and points
    """

    def __init__(self, case: Case, fidelity: Fidelity) -> None:
        self._case = case
        self._fidelity = fidelity
        self._stated = {row.path: row.value for row in case.inputs}

    def __call__(self, case: Case, *, fidelity: Fidelity) -> CheckedPoint:
        """One point, at the fidelity of the base case.

        A point with other housings, and one whose loop does not converge from the base case, is solved in full.

        Raises
        ------
        RigdesignError
            The point has no result.
        """
        with one_thread(), threadpool_limits(limits=1):
            return self._point(case)

    def _point(self, case: Case) -> CheckedPoint:
        again = reanalysis(case, self._changed(case))
        found = None if again is None else self._modified(again)
        return found or checked_point(run_case(case, fidelity=self._fidelity))

    @cached_property
    def _reference(self) -> Reference | None:
        """The base case solved; None where it has no result."""
        try:
            return solve_reference(self._case, self._fidelity)[0]
        except (CaseError, NotConvergedError):
            return None

    def _changed(self, case: Case) -> list[str]:
        """Paths of the values that the base case states otherwise, or not at all."""
        values = {row.path: row.value for row in case.inputs}
        paths = [path for path in {**self._stated, **values} if self._stated.get(path) != values.get(path)]
        return [path for path in paths if path not in values or not self._same(path, values[path])]

    def _same(self, path: str, value: str) -> bool:
        """Whether the base case has this value in another spelling."""
        try:
            return self._case.with_value(path, value).hash == self._case.hash
        except CaseError:
            return False

    def _modified(self, again: Reanalysis) -> CheckedPoint | None:
        """The point from the base case; None where that tells nothing of it."""
        reference = self._reference
        if reference is None:
            return None
        try:
            with solver_errors(again.case):
                if not same_housings(build_rig(again.case, self._fidelity), restored(reference).rig):
                    return None
            found = reanalysed(reference, again, estimated_checks)
        except NotConvergedError:
            return None
        return CheckedPoint(
            verdict=overall(found.checks),
            max_temperature_degC=found.max_temperature_degC,
            checks=found.checks,
        )
