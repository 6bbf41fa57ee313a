"""The power circuit with shafts that only twist, at every speed: friction of splines follows the mesh frequency."""

from dataclasses import dataclass, field

from dynamics.drivetrain.graph import Drivetrain, assemble
from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.loss_factor import at_speed


@dataclass(frozen=True, eq=False)
class TwistingLoop:
    """Matrices by stated speed; drive_ratio : speed of the motor per stated speed."""

    drivetrain: Drivetrain
    drive_ratio: float
    _systems: dict[float, LinearSystem] = field(default_factory=dict, repr=False)

    @property
    def follows_speed(self) -> bool:
        """Whether a spline has a loss factor; all others are the same at every speed."""
        return any(gear.loss_factor for gear in self.drivetrain.gears)

    def parts(self, speed: float) -> Drivetrain:
        """Parts with the dampers of splines at a stated speed [rad/s]."""
        return at_speed(self.drivetrain, self.drive_ratio * speed)

    def at(self, speed: float) -> LinearSystem:
        """Matrices without the meshes at a stated speed [rad/s]."""
        key = speed if self.follows_speed else 0.0
        if key not in self._systems:
            self._systems[key] = assemble(self.parts(key))
        return self._systems[key]
