"""Friction torque of a rolling bearing by one of two laws, in the four sources of the SKF model.

``iso_tr_14179_2`` (Palmgren) and ``skf`` (four sources) are written in the units of their documents under
`dynamics.standards`; here a bearing and its operation become their arguments.
"""

from dataclasses import dataclass
from typing import Literal, get_args

from dynamics.bearing.rolling_catalogue import RPM, CatalogueBearing
from dynamics.bearing.rolling_life import static_equivalent_load
from dynamics.standards import iso_tr_14179_2_2001_bearings as palmgren
from dynamics.standards import skf_friction_2006 as skf

FrictionLaw = Literal["iso_tr_14179_2", "skf"]
LAWS: tuple[FrictionLaw, ...] = get_args(FrictionLaw)
Lubrication = Literal["oil_bath", "oil_jet", "oil_spot", "grease"]
LUBRICATIONS: tuple[Lubrication, ...] = get_args(Lubrication)
OilKind = Literal["mineral", "synthetic", "transmission"]
OIL_KINDS: tuple[OilKind, ...] = get_args(OilKind)

SOURCES: dict[FrictionLaw, str] = {
    "iso_tr_14179_2": "ISO/TR 14179-2 (Palmgren), f_0 and f_1 of DIN 732-2",
    "skf": "SKF General Catalogue 6000, four-source model",
}
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

    rolling: float
    sliding: float
    seals: float
    drag: float

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


def friction_torque(
    law: FrictionLaw, bearing: CatalogueBearing, conditions: FrictionConditions
) -> FrictionTorque:
    """Friction torque of the open bearing by ``law``."""
    return _skf(bearing, conditions) if law == "skf" else _palmgren(bearing, conditions)


def _palmgren(bearing: CatalogueBearing, conditions: FrictionConditions) -> FrictionTorque:
    row = palmgren.COEFFICIENTS[bearing.kind][bearing.series]
    d_m, n, nu = bearing.mean_diameter * 1e3, conditions.speed / RPM, conditions.viscosity * 1e6
    radial, axial = conditions.radial, conditions.axial
    static = static_equivalent_load(bearing, radial, axial)
    f_1 = palmgren.f_1(row, static, bearing.static_rating)
    load = palmgren.P_1(bearing.kind, radial, axial, bearing.axial_factor)
    flange = 0.0
    if bearing.kind == "cylindrical_roller":
        f_2 = palmgren.F_2["grease" if conditions.lubrication == "grease" else "oil"]
        flange = palmgren.T_VL2(f_2, axial, d_m)
    f_0 = row.f_0 * palmgren.LUBRICATION_FACTOR[conditions.lubrication]
    return FrictionTorque(
        rolling=1e-3 * palmgren.T_VL1(f_1, load, d_m),
        sliding=1e-3 * flange,
        seals=0.0,
        drag=1e-3 * palmgren.T_VL0(f_0, nu, n, d_m),
    )


def _skf(bearing: CatalogueBearing, conditions: FrictionConditions) -> FrictionTorque:
    size = skf.Size(bearing.bore * 1e3, bearing.outside_diameter * 1e3, bearing.width * 1e3)
    n, nu = conditions.speed / RPM, conditions.viscosity * 1e6
    moments = skf_moments(bearing, conditions.radial, conditions.axial, n)
    mu_full_film = skf.MU_EHL_KIND.get(bearing.kind, skf.MU_EHL[conditions.oil_kind])
    sliding = moments.G_sl * skf.mu_sl(n, nu, size.d_m, mu_full_film)
    if n == 0.0:
        return FrictionTorque(rolling=0.0, sliding=1e-3 * sliding, seals=0.0, drag=0.0)
    starvation = 1.0
    if not flooded(bearing, conditions):
        starvation = skf.phi_rs(skf.K_RS[conditions.lubrication], skf.K_Z[bearing.kind], n, nu, size)
    rolling = skf.phi_ish(n, nu, size.d_m) * starvation * skf.M_rr(moments.G_rr, n, nu)
    return FrictionTorque(
        rolling=1e-3 * rolling, sliding=1e-3 * sliding, seals=0.0, drag=1e-3 * _skf_drag(bearing, conditions)
    )


def skf_moments(bearing: CatalogueBearing, radial: float, axial: float, n: float) -> skf.Moments:
    """G_rr and G_sl of the SKF model at loads [N] and a speed [1/min], in its units."""
    d_m = bearing.mean_diameter * 1e3
    if bearing.kind == "deep_groove_ball":
        return skf.deep_groove(skf.DEEP_GROOVE[bearing.series], d_m, radial, axial, bearing.static_rating)
    if bearing.kind == "angular_contact_ball":
        return skf.angular_contact(skf.ANGULAR_CONTACT, d_m, radial, axial, n)
    if bearing.kind == "cylindrical_roller":
        return skf.cylindrical(skf.CYLINDRICAL[bearing.series], d_m, radial, axial)
    return skf.tapered(skf.TAPERED[bearing.series], d_m, radial, axial, bearing.axial_factor)


def flooded(bearing: CatalogueBearing, conditions: FrictionConditions) -> bool:
    """Oil bath that reaches the centre of the lowest rolling element: its contacts do not starve."""
    return conditions.lubrication == "oil_bath" and conditions.oil_level >= 0.5 * bearing.elements.diameter


def _skf_drag(bearing: CatalogueBearing, conditions: FrictionConditions) -> float:
    """[N mm]; none with grease and oil in drops."""
    if conditions.lubrication not in ("oil_bath", "oil_jet"):
        return 0.0
    jet = conditions.lubrication == "oil_jet"
    size = skf.Size(bearing.bore * 1e3, bearing.outside_diameter * 1e3, bearing.width * 1e3)
    level = 0.5 * bearing.elements.diameter if jet else conditions.oil_level
    drag = skf.M_drag(bearing.kind, size, level * 1e3, conditions.speed / RPM)
    return JET_DRAG_FACTOR * drag if jet else drag
