"""D. W. Dudley, When splines need stress control, Product Engineering 28, 23 December 1957: stresses of splines.

Symbols as printed; SI units here, the document counts in inches and pounds. Confidence: S_s and S_c agree with two
public transcriptions of the article (zakgear.com, tke.ir) as read in 2026. The bursting stresses S_1 to S_3 are from
memory of Machinery's Handbook, which reprints them; each follows from first principles as its docstring says, S_2 from
the rotating disc with the printed factors 1.656e-6 and 0.212 for steel. The article gives t_c = D/(2 N); AGMA's answer
of 2018 to a question on AGMA 6123-C16 (RFI 18-02) takes that for a misprint of the circular thickness pi D/(2 N), used
here. Application factor K_a and life factors L_f, L_w belong to loads and allowable stresses, not to these stresses.
"""

import math
from dataclasses import dataclass

from dynamics.errors import DynamicsInputError


@dataclass(frozen=True, kw_only=True)
class Spline:
    """Toothing of a spline, lengths [m].

    N : teeth; D : pitch diameter; phi : pressure angle [rad]; F_e : length that carries; h : radial height of contact
    K_m : load distribution factor [-], 1 for aligned shafts; K_m 1 to 3 with misalignment and length (Table IV)

    Raises DynamicsInputError for a length that is not positive, or K_m below 1.
    """

    N: int
    D: float
    phi: float
    F_e: float
    h: float
    K_m: float = 1.0

    def __post_init__(self) -> None:
        for name in ("N", "D", "F_e", "h"):
            value = getattr(self, name)
            if not value > 0.0:
                raise DynamicsInputError(f"spline: {name} = {value:g}: must be above 0; correct its geometry")
        if not 0.0 < self.phi < 0.5 * math.pi:
            raise DynamicsInputError(
                f"spline: phi = {self.phi:g} rad: must lie between 0 and 90 deg; correct it"
            )
        if not self.K_m >= 1.0:
            raise DynamicsInputError(
                f"spline: K_m = {self.K_m:g}: must be at least 1; write 1 for aligned shafts"
            )

    @property
    def t_c(self) -> float:
        """Thickness of a tooth on the pitch circle, pi D/(2 N) [m]."""
        return math.pi * self.D / (2 * self.N)


def S_s_teeth(spline: Spline, T: float) -> float:
    """Shear stress of the teeth on the pitch circle, 4 T K_m/(D N F_e t_c) [Pa]: half of the teeth carry.

    T : torque [N m]
    """
    return 4.0 * T * spline.K_m / (spline.D * spline.N * spline.F_e * spline.t_c)


def S_c(spline: Spline, T: float) -> float:
    """Pressure on the flanks of the teeth, 2 T K_m/(D N F_e h) [Pa]: all teeth carry. T : torque [N m]"""
    return 2.0 * T * spline.K_m / (spline.D * spline.N * spline.F_e * spline.h)


def S_s_shaft(T: float, D_re: float, D_h: float = 0.0) -> float:
    """Shear stress of the shaft under the teeth, 16 T D_re/(pi (D_re^4 - D_h^4)) [Pa].

    T : torque [N m]; D_re : root diameter of the teeth of the shaft, D_h : its bore [m]

    Raises DynamicsInputError for a bore that is not inside the root circle.
    """
    if not 0.0 <= D_h < D_re:
        raise DynamicsInputError(
            f"spline: shaft bore D_h = {1e3 * D_h:g} mm, root diameter D_re = {1e3 * D_re:g} mm: the bore must be "
            "inside; correct one of them"
        )
    return 16.0 * T * D_re / (math.pi * (D_re**4 - D_h**4))


def S_1(spline: Spline, T: float, t_w: float) -> float:
    """Hoop stress of the hub by the radial part of the tooth forces, T tan(phi)/(pi D t_w F_e) [Pa].

    Their sum 2 T tan(phi)/D as a pressure on the pitch cylinder of a thin ring. T : torque [N m]; t_w : wall of the hub
    outside of its teeth [m]

    Raises DynamicsInputError for a hub without a wall.
    """
    if not t_w > 0.0:
        raise DynamicsInputError(
            f"spline: wall of the hub t_w = {1e3 * t_w:g} mm: must be above 0; correct hub and root diameter"
        )
    return T * math.tan(spline.phi) / (math.pi * spline.D * t_w * spline.F_e)


def S_2(omega: float, rho: float, nu: float, D_oi: float, D_ri: float) -> float:
    """Hoop stress at the root of the teeth of the hub by its rotation [Pa]: bored disc of constant thickness,
    (3 + nu)/16 rho omega^2 (D_oi^2 + (1 - nu)/(3 + nu) D_ri^2).

    omega : [rad/s]; rho : density [kg/m3]; nu : Poisson's ratio; D_oi : outside of the hub [m]; D_ri : root of its
    teeth [m]
    """
    return (3.0 + nu) / 16.0 * rho * omega**2 * (D_oi**2 + (1.0 - nu) / (3.0 + nu) * D_ri**2)


def S_3(spline: Spline, T: float, Y: float = 1.5) -> float:
    """Hoop stress of the hub by bending of its teeth, 4 T/(D^2 F_e Y) [Pa].

    Lewis: force of a tooth over F_e Y D/N, half of the teeth carry. T : torque [N m]; Y : form factor, 1.5 for internal
    teeth of 30 deg [-]
    """
    return 4.0 * T / (spline.D**2 * spline.F_e * Y)


def S_t(tension: float, centrifugal: float, K_m: float) -> float:
    """Tension of the hub, K_m (S_1 + S_3) + S_2 [Pa]; tension : S_1 + S_3, centrifugal : S_2."""
    return K_m * tension + centrifugal
