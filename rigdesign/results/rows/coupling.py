"""Convergence of the coupling loop as rows of the result."""

from rigdesign.coupling.loop import PointResult
from rigdesign.results.result import CouplingHistory
from rigdesign.results.units import UM


def coupling_row(result: PointResult) -> CouplingHistory:
    """Residuals of every iteration of the loop at one held stage."""
    return CouplingHistory(
        stage=result.point.stage,
        iterations=len(result.residuals),
        residuals=[
            {
                "temperature_K": residual.temperature,
                "growth_um": UM * residual.length,
                "torque_relative": residual.torque,
            }
            for residual in result.residuals
        ],
    )
