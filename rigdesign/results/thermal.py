"""Losses, oil, temperatures and thermal expansion of a run, as they stand in results.json."""

from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from thermal.fe.mesh import NamedMesh


@dataclass(frozen=True, kw_only=True)
class LossRow:
    """Power loss of one place at one stage [W]; into_oil + into_body + not_heat = power + pump."""

    place: str
    kind: str
    stage: str
    power_W: float  # noqa: N815
    into_oil_W: float  # noqa: N815
    into_body_W: float  # noqa: N815
    pump_W: float = 0.0  # noqa: N815
    """Given by the oil pump, not by the shaft: kinetic energy of the jets. A negative ``power_W`` with it is what a
    jet faster than the pitch line gives to the shaft."""
    basis: Literal["computed", "input"]
    not_heat_W: float = 0.0  # noqa: N815
    """Work of a mesh damper: power of the motor that is heat of no part."""
    details: dict[str, float | str] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class OilRow:
    """One oil consumer at one stage."""

    consumer: str
    stage: str
    inlet_degC: float  # noqa: N815
    outlet_degC: float  # noqa: N815
    flow_l_min: float
    heat_W: float  # noqa: N815
    """Loss into the oil plus heat taken from bodies."""


@dataclass(frozen=True, kw_only=True)
class HeatRow:
    """Heat of one surface [W], positive into the solid."""

    surface: str
    kind: str
    power_W: float  # noqa: N815
    area_m2: float
    mean_temperature_degC: float  # noqa: N815
    coefficient: dict[str, Any] | None = None
    """Film coefficient with formula, inputs, range, source."""


@dataclass(frozen=True, kw_only=True)
class HeatSplitRow:
    """Where the friction heat of one gear goes; friction = at once into the oil + into the rim."""

    gear: str
    rule: Literal["assumed", "flank_film"]
    friction_W: float  # noqa: N815
    """Of all its meshes, into its flanks."""
    at_once_W: float  # noqa: N815
    """Leaves with the oil before it reaches the rim."""
    film_W: float  # noqa: N815
    """From the rim into the gear oil; other heat of the gear leaves this way too."""
    share_into_oil: float
    """(at once + film) / friction; above 1 where other heat of the gear leaves through its teeth."""
    share_into_bodies: float
    bulk_degC: float  # noqa: N815
    """Mean of the gear body."""
    tooth_degC: float | None  # noqa: N815
    """Mean of the teeth; None without a flank film."""
    flank_film_W_m2K: float | None  # noqa: N815
    """Mean over all flanks."""
    fin_efficiency: float | None
    weak_film: dict[str, float | None] | None = None
    """share_into_oil, bulk_degC, tooth_degC, flank_film_W_m2K at the low ends of the ranges of the film."""
    strong_film: dict[str, float | None] | None = None
    """The same at the high ends."""


@dataclass(frozen=True, kw_only=True)
class FluidRow:
    """A volume or stream of a housing; heat + power + links = 0 for a volume."""

    name: str
    kind: Literal["volume", "stream"]
    inlet_degC: float | None  # noqa: N815
    """Of a stream."""
    temperature_degC: float  # noqa: N815
    """Of a volume, at the outlet of a stream."""
    heat_W: float  # noqa: N815
    """From its surfaces into it."""
    power_W: float = 0.0  # noqa: N815
    """Set free in it."""
    links_W: dict[str, float] = field(default_factory=dict)  # noqa: N815
    """Link -> heat that it brings into the volume."""


@dataclass(frozen=True, kw_only=True)
class ThermalResult:
    """Steady temperatures of one gearbox at one held stage."""

    gearbox: str
    stage: str
    max_temperature_degC: float  # noqa: N815
    max_temperature_body: str
    heat: list[HeatRow]
    closure_relative: float
    nodes: int
    elements: int
    bodies: dict[str, dict[str, float]]
    """body -> {mean_degC, max_degC, min_degC}."""
    room_heat_W: float  # noqa: N815
    alternatives: dict[str, float]
    """Highest temperature under either reading of radiation, heat to the room under the one not taken."""
    heat_split: list[HeatSplitRow] = field(default_factory=list)
    """Of the friction heat of every gear."""
    fluids: list[FluidRow] = field(default_factory=list)
    """Volumes and streams of the housing."""


@dataclass(frozen=True, kw_only=True)
class ExpansionResult:
    """Expansion of one gearbox at one held stage; every entry as drawn (``cold``) and warm (``hot``), with its
    unit."""

    gearbox: str
    stage: str
    seal_gaps: list[dict[str, Any]]
    """{seal, shaft, cold_mm, hot_min_mm, hot_mean_mm, angle_of_min_deg, hot_mm: [...], angle_deg: [...]}"""
    shafts: list[dict[str, Any]]
    """{shaft, growth_mm, axial_play_cold_mm, axial_play_hot_mm, free_expansion_mm}"""
    gears: list[dict[str, Any]]
    """{gear pair, centre_distance_cold_mm, centre_distance_hot_mm, backlash_cold_mm, backlash_hot_mm,
    tip_clearance_cold_mm, tip_clearance_hot_mm, bulk_pinion_degC, bulk_wheel_degC}"""
    bearings: list[dict[str, Any]]
    """{bearing, diametral_clearance_cold_um, diametral_clearance_hot_um}"""
    bores: list[dict[str, Any]] = field(default_factory=list)
    """{bearing, tilt_mrad, tilt_lateral_mrad, tilt_vertical_mrad, tilt_over_width_um, out_of_round_um,
    second_harmonic_um, long_axis_deg, out_of_round_share}: shaft axis in the bore, bore round; as drawn all are
    zero."""
    axes: list[dict[str, Any]] = field(default_factory=list)
    """{gear_pair, centre_distance_change_um, face_width_mm, inclination_um, recommended_inclination_um, skew_um,
    recommended_skew_um}: axes of a mesh over its face width; as drawn they are parallel."""
    couplings: list[dict[str, Any]] = field(default_factory=list)
    """{coupling, first, second, offset_cold_mm, offset_hot_mm, lateral_hot_mm, vertical_hot_mm, angle_cold_mrad,
    angle_hot_mrad, ends_nearer_mm, recommended_cold_lateral_mm, recommended_cold_vertical_mm}: first shaft against
    second; a shaft without a housing stays where it was set."""


@dataclass(frozen=True)
class TemperatureField:
    """Temperature, displacement and heat flux of one gearbox at one stage, for pictures and .vtu."""

    gearbox: str
    stage: str
    mesh: NamedMesh
    temperature: NDArray[np.float64]
    """(n_nodes,) [K]"""
    displacement: NDArray[np.float64]
    """(n_nodes, 3) [m]"""
    heat_flux: NDArray[np.float64] | None = None
    """(n_nodes, 3) [W/m2]"""
