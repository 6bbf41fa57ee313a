"""Oil on the teeth of a jet-lubricated gear: a film is laid on the flanks, flung off, and laid again.

Fling-off (the model of Blok and DeWinter). Every wetting floods the flank with cold oil. The centrifugal field
thins the film from the root outwards; after a short while its thickness no longer depends on how much was laid,

    h(x, t) = sqrt(nu x / (w^2 r t)),    u = (w^2 r / nu) (h y - y^2/2)

with x the height above the lower edge of the wetted part. Heat soaks into the film to a depth sqrt(a t), a the
thermal diffusivity; film and depth meet at

    t* = (1/w) sqrt(nu x / (a r)).

A flank of one temperature gives off k/sqrt(a) sqrt(t*) q per area, kelvin and wetting. For constant viscosity q
depends on t/t* alone and follows from the similar form of the energy equation,

    tau (1 - e/2 + e^2/4) dT/dtau + e (1 - e)(2 - e)/4 dT/de = tau^2 d2T/de2,    e = y/h, tau = t/t*;

it starts as 2 sqrt(tau/pi), the half space, and ends at 1.227 when the film has warmed through (`FLUNG_OFF`). With one
wetting a turn the mean coefficient is sqrt(w)/(2 pi) sqrt(k rho c) (nu x/(a r))^(1/4) q, the form in which DeWinter
and Blok, J. Eng. Ind. 96 (1974) 60, are quoted; their paper was not at hand, and q is computed, not read off their
chart. Later work agrees on the mechanism (von Plehwe et al., J. Heat Transfer 141 (2019) 082103, abstract): the
heat is conducted into the film, ends when its capacity is used up, and gets less with a thin first film.

The oil laid down bounds the heat: a film h_0 thick takes at most rho c h_0. Both limits are joined by
(1/q^4 + 1/H_0^4)^(-1/4), H_0 = h_0/sqrt(a t*), within 6 % of the energy equation solved with a film min(h_0, h(x, t)).

Left out: inertia and Coriolis force in the film, mist between the wettings (more cooling), the flank being hotter
than the body just after contact (more cooling), oil that never reaches the flank (less; ``wetted_share``).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from thermal.films.law import FilmCoefficient, FilmError, FilmLaw, not_negative, outside, positive

GRAVITY = 9.81
LIQUID = (233.15, 673.15)
"""Film temperatures [K] for which properties are evaluated; the value at the end counts beyond, with a warning."""
FLUNG_OFF = np.array(
    [
        (0.0, 0.0), (0.25, 0.5716), (0.49, 0.8103), (0.64, 0.9306), (0.81, 1.0406), (1.0, 1.1266), (1.21, 1.1822),
        (1.44, 1.2109), (1.69, 1.2224), (2.0, 1.2260), (3.0, 1.2267),
    ]
)  # fmt: skip
"""(tau, q): heat a film has taken at the time tau t*, in units of sqrt(k rho c t*) per area and kelvin; straight
between the points over sqrt(tau)."""
SOURCE = (
    "DeWinter and Blok, J. Eng. Ind. 96 (1974) 60, as quoted since; number computed from the energy equation"
)
_PLACES = tuple(
    (0.5 * (float(knot) + 1.0), 0.5 * float(weight))
    for knot, weight in zip(*np.polynomial.legendre.leggauss(8))
)
"""(share of the height, weight) of a mean over the wetted part."""


@dataclass(frozen=True, kw_only=True)
class FilmOil:
    """Oil on the flank; each property a function of the temperature [K].

    conductivity [W/(m K)], density [kg/m3], heat_capacity [J/(kg K)], kinematic_viscosity [m2/s]
    highest_temperature : mean film temperature [K] above which the oil's data are not trusted
    """

    conductivity: Callable[[float], float]
    density: Callable[[float], float]
    heat_capacity: Callable[[float], float]
    kinematic_viscosity: Callable[[float], float]
    highest_temperature: float = math.inf

    def at(self, film: float) -> tuple[float, float, float]:
        """Conductivity [W/(m K)], rho c [J/(m3 K)] and viscosity [m2/s] at a film temperature [K], kept in `LIQUID`."""
        liquid = min(max(film, LIQUID[0]), LIQUID[1])
        capacity = self.density(liquid) * self.heat_capacity(liquid)
        return self.conductivity(liquid), capacity, self.kinematic_viscosity(liquid)

    def warnings(self, film: float) -> tuple[str, ...]:
        """Sentence for a film temperature [K] that the data of the oil do not reach."""
        low, high = LIQUID
        return outside(
            "temperature of the flank film", film, low, min(self.highest_temperature, high),
            "cool the gear or take an oil made for it", "K",
        )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class ToothRing:
    """Teeth of a gear as the film sees them.

    root_radius, tip_radius : [m]
    flank_area : both flanks of all teeth [m2]
    tooth_thickness : at half height [m]
    conductivity : of the teeth [W/(m K)]
    """

    root_radius: float
    tip_radius: float
    flank_area: float
    tooth_thickness: float
    conductivity: float

    def __post_init__(self) -> None:
        for name, unit in (
            ("root_radius", "m"),
            ("flank_area", "m2"),
            ("tooth_thickness", "m"),
            ("conductivity", "W/(m K)"),
        ):
            positive(f"tooth ring: {name}", getattr(self, name), unit)
        if not self.tip_radius > self.root_radius:
            raise FilmError(
                f"tooth ring: tip_radius = {self.tip_radius:.6g} m must be above root_radius = "
                f"{self.root_radius:.6g} m; exchange or correct them"
            )

    @property
    def height(self) -> float:
        """Tooth height [m]."""
        return self.tip_radius - self.root_radius


@dataclass(frozen=True, kw_only=True)
class Wetting:
    """How often and how much oil is laid on the flanks.

    speed : of the gear [rad/s]
    per_turn : wettings of every flank in a turn, one per jet
    flow : oil that reaches the flanks [m3/s]
    wetted_share : outer share of the tooth height that is wetted
    """

    speed: float
    per_turn: int
    flow: float
    wetted_share: float = 1.0

    def __post_init__(self) -> None:
        not_negative("wetting: speed", self.speed, "rad/s")
        positive("wetting: flow", self.flow, "m3/s")
        if self.per_turn < 1:
            raise FilmError(
                f"wetting: per_turn = {self.per_turn} must be at least 1; a dry flank has no film"
            )
        if not 0.0 < self.wetted_share <= 1.0:
            raise FilmError(
                f"wetting: wetted_share = {self.wetted_share} must be above 0 and at most 1; it is a share"
            )

    @property
    def frequency(self) -> float:
        """Wettings a second [1/s]."""
        return self.per_turn * self.speed / (2.0 * math.pi)


def heat_flung_off(time: float) -> float:
    """q(tau): heat a thick film has taken after ``time`` = t/t*, in units of sqrt(k rho c t*) per area and kelvin."""
    return float(np.interp(math.sqrt(time), np.sqrt(FLUNG_OFF[:, 0]), FLUNG_OFF[:, 1]))


def fling_off(ring: ToothRing, wetting: Wetting, oil: FilmOil, factor: float = 1.0) -> FilmLaw:
    """Mean coefficient over all flanks of a film flung off after each wetting (module text).

    factor : multiplies the result; what is left of uncertainty after ``wetted_share``

    The fluid temperature is that of the oil as it is laid; properties are taken half-way to the wall. A part of
    the flank that stays dry counts with zero.
    """
    positive("factor of the flank film", factor, "")
    height, radius = wetting.wetted_share * ring.height, 0.5 * (ring.root_radius + ring.tip_radius)
    frequency = wetting.frequency
    area = wetting.wetted_share * ring.flank_area
    laid = wetting.flow / (frequency * area) if frequency > 0.0 else math.inf
    gravities = wetting.speed**2 * radius / GRAVITY

    def law(wall: float, fluid: float) -> FilmCoefficient:
        film = 0.5 * (wall + fluid)
        conductivity, capacity, viscosity = oil.at(film)
        diffusivity = conductivity / capacity
        value = depth = 0.0
        if frequency > 0.0:
            slowest = math.sqrt(viscosity * height / (diffusivity * radius)) / wetting.speed
            depth = math.sqrt(diffusivity * slowest)
            heat = 0.0
            for place, weight in _PLACES:
                time = slowest * math.sqrt(place)
                flung = heat_flung_off(1.0 / (frequency * time))
                supply = laid / math.sqrt(diffusivity * time)
                heat += weight * math.sqrt(time) * (flung**-4 + supply**-4) ** -0.25
            value = factor * wetting.wetted_share * frequency * math.sqrt(conductivity * capacity) * heat
        return FilmCoefficient(
            value=value,
            formula="fling_off",
            inputs={
                "speed": wetting.speed, "wettings_per_turn": float(wetting.per_turn), "oil_flow": wetting.flow,
                "wetted_share": wetting.wetted_share, "factor": factor, "film_temperature": film,
                "viscosity": viscosity, "thickness_laid": laid if frequency > 0.0 else 0.0,
                "thickness_warmed": depth,
            },
            valid_range="laminar film, centrifugal acceleration above 100 g",
            source=SOURCE,
            warnings=oil.warnings(film)
            + outside(
                "centrifugal acceleration of the flank film", gravities, 100.0, math.inf,
                "the oil drips instead of being flung off; give a measured coefficient", "g",
            ),
        )  # fmt: skip

    return law


def jet_renewal(ring: ToothRing, wetting: Wetting, oil: FilmOil, factor: float = 1.0) -> FilmLaw:
    """Mean coefficient over all flanks of a film that stays until the next jet renews it: 2 sqrt(k rho c f/pi).

    Penetration theory (Higbie, Trans. AIChE 31 (1935) 365) with f wettings a second, bounded by the capacity
    rho c h_0 f of the oil laid, joined as in `fling_off`. Nothing is flung off: an upper bound.
    """
    positive("factor of the flank film", factor, "")
    frequency, area = wetting.frequency, wetting.wetted_share * ring.flank_area

    def law(wall: float, fluid: float) -> FilmCoefficient:
        film = 0.5 * (wall + fluid)
        conductivity, capacity, _ = oil.at(film)
        value = 0.0
        if frequency > 0.0:
            soaked = 2.0 * math.sqrt(conductivity * capacity * frequency / math.pi)
            value = (
                factor * wetting.wetted_share * (soaked**-4 + (capacity * wetting.flow / area) ** -4) ** -0.25
            )
        slow = () if frequency > 0.0 else ("speed = 0 rad/s renews no film; give a measured coefficient",)
        return FilmCoefficient(
            value=value,
            formula="jet_renewal",
            inputs={
                "speed": wetting.speed, "wettings_per_turn": float(wetting.per_turn), "oil_flow": wetting.flow,
                "wetted_share": wetting.wetted_share, "factor": factor, "film_temperature": film,
            },
            valid_range="upper bound: no oil flung off between two wettings",
            source="penetration theory, Higbie, Trans. AIChE 31 (1935) 365",
            warnings=oil.warnings(film) + slow,
        )  # fmt: skip

    return law


def fin_efficiency(ring: ToothRing, film: float) -> float:
    """Tooth as a straight fin with a dry tip: tanh(m L)/(m L), m^2 = 2 h/(k s).

    film : mean coefficient on the flanks [W/(m2 K)]
    """
    argument = ring.height * math.sqrt(2.0 * film / (ring.conductivity * ring.tooth_thickness))
    return math.tanh(argument) / argument if argument > 1e-6 else 1.0


def on_rim(law: FilmLaw, ring: ToothRing, rim_area: float) -> FilmLaw:
    """The film of the flanks as a film on the smooth rim that stands for the teeth: h eta A_flank/A_rim.

    Heat P that enters the flanks evenly reaches the rim as eta P and leaves the tooth as (1 - eta) P before it:
    the fin with a heated and cooled surface, k s/2 T'' = h (T - T_oil) - P/A, gives both shares the same eta
    (`fin_efficiency`), and the tooth as a whole the mean temperature of `tooth_excess`.

    rim_area : [m2]
    """
    positive("area of the rim", rim_area, "m2")

    def rim(wall: float, fluid: float) -> FilmCoefficient:
        flank = law(wall, fluid)
        efficiency = fin_efficiency(ring, flank.value)
        return FilmCoefficient(
            value=flank.value * efficiency * ring.flank_area / rim_area,
            formula=f"tooth_ring({flank.formula})",
            inputs=flank.inputs
            | {
                "flank_film": flank.value, "fin_efficiency": efficiency, "flank_area": ring.flank_area,
                "rim_area": rim_area,
            },
            valid_range=flank.valid_range,
            source=f"{flank.source}; tooth as a fin",
            warnings=flank.warnings,
        )  # fmt: skip

    return rim


def tooth_excess(ring: ToothRing, film: float, heat: float, rim_excess: float) -> float:
    """Mean temperature of the teeth above the oil [K]: T_h + eta (T_rim - T_h), T_h = P/(h A).

    film : on the flanks [W/(m2 K)], above 0; heat : P into the flanks of the gear [W]
    rim_excess : rim above the oil [K]
    """
    heated = heat / (positive("film on the flanks", film, "W/(m2 K)") * ring.flank_area)
    return heated + fin_efficiency(ring, film) * (rim_excess - heated)
