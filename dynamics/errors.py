"""Errors of the dynamics: one root, below it what is wrong with an input and what did not converge.

    DynamicsError
    ├── DynamicsInputError      an input that cannot be computed; also a ValueError
    │   ├── GearGeometryError, ToothPathError, FrictionError, DrivetrainError, BearingError
    │   └── ScheduleError, LossError
    └── DynamicsNotConverged            a solver ended without a solution; also a RuntimeError
        ├── MarchDiverged, DefectiveModes
        └── FilmNotConvergedError, BearingNotConvergedError

A message states name, value, limit and remedy. Anything else that leaves the package is a defect of it.
"""


class DynamicsError(Exception):
    """Root of what the package raises on purpose."""


class DynamicsInputError(DynamicsError, ValueError):
    """An input that cannot be computed."""


class DynamicsNotConverged(DynamicsError, RuntimeError):  # noqa: N818
    """A solver ended without a solution; the message names residual, limit and remedy."""
