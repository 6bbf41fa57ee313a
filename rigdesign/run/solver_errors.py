"""The boundary between the solvers and the user: which of their errors are the case's, and which no convergence.

Only what the solvers raise on purpose is turned into such an error: everything below `thermal.errors.ThermalError` and
`dynamics.errors.DynamicsError`, and what an oil or material refuses. Anything else is a defect of the tool and is
left as it is.
"""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

import dynamics.errors
import thermal.errors
from rigdesign.base.errors import (
    CaseError,
    MissingLibraryError,
    NotConvergedError,
    RigdesignError,
    UsageError,
)
from rigdesign.base.system import gmsh_remedy, missing_gmsh_libraries
from rigdesign.case.model import Case
from rigdesign.properties.materials import MaterialError
from rigdesign.properties.oil import OilError

INPUT = thermal.errors.ThermalInputError, dynamics.errors.DynamicsInputError, OilError, MaterialError
NO_CONVERGENCE = thermal.errors.ThermalNotConverged, dynamics.errors.DynamicsNotConverged


@contextmanager
def solver_errors(case: Case) -> Iterator[None]:
    """Turn what the solvers raise on purpose into the tool's errors.

    Raises
    ------
    CaseError
        An input that no solver can compute.
    NotConvergedError
        A solver without a solution; ``history`` holds its residuals where it has some.
    MissingLibraryError, UsageError
        What the machine lacks or refuses.
    """
    try:
        yield
    except INPUT as error:
        raise CaseError(str(error), str(case.path)) from error
    except NO_CONVERGENCE as error:
        residuals = getattr(error, "residuals", ())
        raise NotConvergedError(str(error), {"residuals": list(residuals)} if residuals else {}) from error
    except np.linalg.LinAlgError as error:
        raise NotConvergedError(
            f"a linear system of the run has no solution ({error}): a stiffness of the case is far out of proportion "
            "to the others, or a step left the flanks open; correct it or change speed and torque"
        ) from error
    except RigdesignError:
        raise
    except (OSError, ImportError) as error:
        raise _machine_error(error) from error


def _machine_error(error: OSError | ImportError) -> RigdesignError:
    """What the machine lacks: gmsh's libraries, another library, or room and rights for files."""
    missing = missing_gmsh_libraries()
    if missing or "gmsh" in str(error):
        return MissingLibraryError(f"{gmsh_remedy(missing)} ({error})")
    if isinstance(error, ImportError):
        return MissingLibraryError(
            f"{error.name or 'a library'} cannot be loaded: {error}; run: rigdesign doctor"
        )
    return UsageError(
        f"the machine refuses a file: {error}; look at free space and rights of the temporary folder and of "
        "NUMBA_CACHE_DIR"
    )
