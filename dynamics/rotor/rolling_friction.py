"""Friction torque of a rolling bearing in the four sources of the SKF model, and what it depends on.

Two laws, ``iso_tr_14179_2`` (Palmgren) and ``skf`` (four sources), are written in the units of their documents under
`dynamics.standards`; the kinds of `dynamics.rotor.rolling_kinds` hold their constants and take a load and a speed to
their arguments.
"""

import math
from dataclasses import dataclass
from typing import Literal, get_args

from dynamics.standards import skf_friction_2006 as skf

FrictionLaw = Literal["iso_tr_14179_2", "skf"]
LAWS: tuple[FrictionLaw, ...] = get_args(FrictionLaw)
Lubrication = Literal["oil_bath", "oil_jet", "oil_spot", "grease"]
LUBRICATIONS: tuple[Lubrication, ...] = get_args(Lubrication)
OilKind = Literal["mineral", "synthetic", "transmission"]
OIL_KINDS: tuple[OilKind, ...] = get_args(OilKind)

RPM = math.pi / 30.0
JET_DRAG_FACTOR = 2.0
"""Jet oil: twice the drag of a bath up to the middle of the lowest rolling element (SKF General Catalogue p. 100)."""


@dataclass(frozen=True, kw_only=True)
class FrictionTorque:
    """Friction torque in its sources [N m].

    rolling : M_rr with shear heating and starvation; by the Palmgren law the load-dependent torque T_VL1
    sliding : M_sl; by the Palmgren law the flange torque T_VL2
    seals : of the bearing's own contact seals
    drag : of the oil it runs in; by the Palmgren law the load-independent torque T_VL0
    """

    rolling: float = 0.0
    sliding: float = 0.0
    seals: float = 0.0
    drag: float = 0.0

    @property
    def total(self) -> float:
        """Sum of the four [N m]."""
        return self.rolling + self.sliding + self.seals + self.drag

    def scaled(self, factor: float) -> "FrictionTorque":
        """Every source times ``factor``."""
        return FrictionTorque(
            rolling=factor * self.rolling,
            sliding=factor * self.sliding,
            seals=factor * self.seals,
            drag=factor * self.drag,
        )


@dataclass(frozen=True, kw_only=True)
class FrictionConditions:
    """What the friction of a bearing depends on besides the bearing.

    radial, axial : load, not negative [N]
    speed : magnitude [rad/s]
    viscosity : kinematic, of the oil or the base oil of the grease at the bearing temperature [m2/s]
    lubrication : how the oil comes
    oil_level : above the lowest point of the outer raceway at rest [m]; read for an oil bath
    oil_kind : decides the sliding friction in full film
    """

    radial: float
    axial: float
    speed: float
    viscosity: float
    lubrication: Lubrication
    oil_level: float
    oil_kind: OilKind

    def flooded(self, element: float) -> bool:
        """Oil bath that reaches the centre of the lowest rolling element, of this diameter [m]: it does not starve."""
        return self.lubrication == "oil_bath" and self.oil_level >= 0.5 * element


def four_sources(
    constants: skf.KindConstants,
    moments: skf.Moments,
    size: skf.Size,
    element: float,
    given: FrictionConditions,
) -> FrictionTorque:
    """Friction of the open bearing by the SKF model.

    constants, moments, size : of the kind, at the load and of the bearing, in the units of the document
    element : diameter of the rolling elements [m]
    """
    n, nu = given.speed / RPM, given.viscosity * 1e6
    full_film = skf.MU_EHL[given.oil_kind] if constants.mu_EHL is None else constants.mu_EHL
    sliding = moments.G_sl * skf.mu_sl(n, nu, size.d_m, full_film)
    if n == 0.0:
        return FrictionTorque(sliding=1e-3 * sliding)
    starvation = 1.0
    if not given.flooded(element):
        starvation = skf.phi_rs(skf.K_RS[given.lubrication], constants.K_Z, n, nu, size)
    rolling = skf.phi_ish(n, nu, size.d_m) * starvation * skf.M_rr(moments.G_rr, n, nu)
    drag = _drag(constants, size, element, given)
    return FrictionTorque(rolling=1e-3 * rolling, sliding=1e-3 * sliding, drag=1e-3 * drag)


def _drag(constants: skf.KindConstants, size: skf.Size, element: float, given: FrictionConditions) -> float:
    """[N mm]; none with grease and oil in drops."""
    if given.lubrication not in ("oil_bath", "oil_jet"):
        return 0.0
    jet = given.lubrication == "oil_jet"
    level = 0.5 * element if jet else given.oil_level
    drag = skf.M_drag(constants, size, level * 1e3, given.speed / RPM)
    return JET_DRAG_FACTOR * drag if jet else drag
