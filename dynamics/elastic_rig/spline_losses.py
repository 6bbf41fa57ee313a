"""Dampers of splines with a loss factor in the elastic rig: they follow the speed of the running state."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.loss_factor import SplineLoss, spline_losses
from dynamics.elastic_rig.assembly import ElasticModel

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SplineDamper:
    """Damper on the twist row . q of a spline, row (n,); what it does is `SplineLoss`."""

    row: Array
    loss: SplineLoss


def spline_dampers(model: ElasticModel) -> tuple[SplineDamper, ...]:
    """Of every spline with a loss factor, rows on all freedoms of the model."""
    return tuple(
        SplineDamper(model.joint(loss.gear, "spline").row("turn"), loss)
        for loss in spline_losses(model.rig.drivetrain)
    )
