"""Loss of a gear mesh: tooth sliding, P = mu F_N v_g, by the integrated tooth-loss factor, and oil squeezed out."""

from dynamics.losses.loss import Loss, LossError
from dynamics.tooth.friction import FrictionCoefficient, PairStiffness, ToothPath, tooth_loss_factor


def mesh_loss(
    place: str,
    path: ToothPath,
    torque_1: float,
    omega_1: float,
    friction: FrictionCoefficient,
    stiffness: PairStiffness | None = None,
) -> Loss:
    """Sliding loss of a mesh at steady load P = mu H_V T_1 omega_1 [W].

    torque_1 [N m] and omega_1 [rad/s] of the pinion; their signs do not matter.
    """
    factor = tooth_loss_factor(path, stiffness)
    transmitted = abs(torque_1 * omega_1)
    sharing = "even over the contact lines" if stiffness is None else "by tooth-pair stiffness"
    return Loss(
        place=place,
        kind="mesh",
        power=transmitted * friction.value * factor,
        details={
            "transmitted_power": transmitted,
            "friction_coefficient": friction.value,
            "friction_law": friction.law,
            "tooth_loss_factor": factor,
            "load_sharing": sharing,
            "source": f"H_V integrated over the path of contact (Wimmer 2006); {friction.source}",
        },
        warnings=friction.warnings,
    )


def squeeze_loss(place: str, mesh: Loss, share: float) -> Loss:
    """Oil squeezed out of the tooth spaces, taken as a share of the mesh loss [W].

    share : 0 to 0.1 [-]; 0 if oil is injected behind the mesh. No formula at this size is trusted: an input.
    """
    if not 0.0 <= share <= 0.1:
        raise LossError(f"{place}: squeeze share = {share}: must lie within 0 to 0.1; correct it")
    return Loss(
        place=place,
        kind="squeeze",
        power=share * mesh.power,
        details={"share_of_mesh_loss": share, "source": "input of the case"},
    )
