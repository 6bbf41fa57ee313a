"""What loads the closed power loop: a torque that one mesh shall carry, or the twist of the bracing that is held."""

from dataclasses import dataclass

from dynamics.errors import DynamicsInputError


@dataclass(frozen=True, kw_only=True)
class LoopLoad:
    """Load of the loop; exactly one of torque and twist is given.

    torque : mean torque at the pinion of ``control_mesh``, negative on the back flank [N m]; the bracing twist that
        makes it is solved along
    twist : bracing twist that is held [rad]; the torque follows
    control_mesh : index of the mesh whose torque is meant

    Raises DynamicsInputError if both or neither are given.
    """

    torque: float | None = None
    twist: float | None = None
    control_mesh: int = 0

    def __post_init__(self) -> None:
        if (self.torque is None) == (self.twist is None):
            raise DynamicsInputError(
                "give either the torque or the twist of the loop, not both and not neither"
            )
