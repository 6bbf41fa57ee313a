"""Errors of the thermal solvers: one root, below it what is wrong with an input and what did not converge.

    ThermalError
    ├── ThermalInputError       an input that cannot be computed; also a ValueError
    │   ├── MeshError, GeometryError, ConditionError, EnclosureError, FilmError, AirRangeError
    │   └── ElasticError
    └── ThermalNotConverged            an iteration that did not reach its tolerance; also a RuntimeError

A message states name, value, limit and remedy. Anything else that leaves the package is a defect of it.
"""


class ThermalError(Exception):
    """Root of what the package raises on purpose."""


class ThermalInputError(ThermalError, ValueError):
    """An input that cannot be computed."""


class ThermalNotConverged(ThermalError, RuntimeError):  # noqa: N818
    """An iteration that did not reach its tolerance; ``residuals`` holds its history."""

    def __init__(self, message: str, residuals: tuple[float, ...] = ()) -> None:
        super().__init__(message)
        self.residuals = residuals
