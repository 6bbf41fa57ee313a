"""Friction in splines as a loss factor: what a cycle dissipates does not depend on its rate.

A spline with stiffness k and loss factor eta dissipates pi eta k phi^2 in a cycle of twist of amplitude phi, at any
frequency (structural damping, C. W. Bert, J. Sound Vib. 29, 1973, 129). Models in time need a damper: c = eta k /
omega gives the same at one frequency, here the mesh frequency of the gear on the spline, at which its teeth drive it.
At a frequency f times that the damper dissipates f times as much: a mode above the mesh frequency decays faster than
eta says (logarithmic decrement pi eta f where the spline holds all of its strain energy), one below slower, and the
second mesh order loses twice its share. At a small share of the highest speed the damper stiffens the spline for
everything that oscillates well above the mesh frequency. At rest there is none: nothing meshes.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

from dynamics.drivetrain.graph import Drivetrain
from dynamics.drivetrain.power_loop import speed_ratios
from dynamics.drivetrain.twist_rows import TwistRows


@dataclass(frozen=True, kw_only=True)
class SplineLoss:
    """Spline with a loss factor under a gear.

    loss : loss factor times stiffness [N m/rad]; cycles : meshing teeth per radian of the motor's shaft
    """

    gear: str
    loss: float
    cycles: float

    def damping(self, speed: float) -> float:
        """Damper at a speed of the motor's shaft [rad/s], eta k / omega [N m s/rad]; 0 at rest."""
        frequency = self.cycles * abs(speed)
        return self.loss / frequency if frequency > 0.0 else 0.0


def spline_losses(drivetrain: Drivetrain) -> Iterator[SplineLoss]:
    """Of every gear in a mesh whose spline has a loss factor."""
    if not any(gear.loss_factor for gear in drivetrain.gears):
        return
    ratios = speed_ratios(drivetrain)
    teeth = {mesh.pinion: mesh.teeth[0] for mesh in drivetrain.meshes}
    teeth |= {mesh.wheel: mesh.teeth[1] for mesh in drivetrain.meshes}
    for gear in drivetrain.gears:
        if gear.loss_factor and gear.name in teeth:
            yield SplineLoss(
                gear=gear.name,
                loss=gear.loss_factor * gear.stiffness,
                cycles=teeth[gear.name] * abs(ratios[gear.shaft]),
            )


def at_speed(drivetrain: Drivetrain, speed: float) -> Drivetrain:
    """The same with dampers in place of loss factors, as they are at a speed of the motor's shaft [rad/s]."""
    damping = {loss.gear: loss.damping(speed) for loss in spline_losses(drivetrain)}
    if not damping:
        return drivetrain
    return replace(
        drivetrain,
        gears=tuple(
            replace(gear, damping=damping[gear.name], loss_factor=0.0) if gear.name in damping else gear
            for gear in drivetrain.gears
        ),
    )


def with_spline_dampers(rows: TwistRows, drivetrain: Drivetrain, speed: float) -> TwistRows:
    """Rows of torques with the dampers of splines at a speed of the motor's shaft [rad/s], which carry torque too."""
    added = {loss.gear: loss.damping(speed) for loss in spline_losses(drivetrain)}
    own = [added.get(one.part, 0.0) if one.kind == "spline" else 0.0 for one in rows.sections]
    return replace(rows, damping=rows.damping + own) if added else rows
