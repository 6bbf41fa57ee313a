"""Steady heat conduction and thermal expansion of gearbox housings. SI units in and out.

A box of cast iron with two shafts, wetted by oil of 70 degC inside, in a room of 20 degC:

>>> from thermal import Adiabatic, ConductionSetup, EndBearing, Film, GearDisc, HousingGeometry, ShaftGeometry
>>> from thermal import SurfaceSource, build_gearbox, niemann_winter, oil_wetted, solve_steady
>>> bearing = EndBearing(journal_diameter=0.04, width=0.03, clearance=20e-6)
>>> shafts = tuple(
...     ShaftGeometry(
...         name=name,
...         y=y,
...         front=bearing,
...         rear=bearing,
...         seat_diameter=0.044,
...         overhang_diameter=0.038,
...         seal_gap=0.5e-3,
...         locating="rear",
...         gear=GearDisc(outer_diameter=0.099, width=0.015),
...     )
...     for name, y in (("pinion", -0.05), ("wheel", 0.05))
... )
>>> box = build_gearbox(
...     HousingGeometry(
...         chamber_length=0.08,
...         height=0.28,
...         width=0.32,
...         wall_thickness=0.015,
...         floor_thickness=0.02,
...         top_thickness=0.015,
...         end_wall_thickness=0.036,
...         shaft_height=0.14,
...         shafts=shafts,
...     )
... )
>>> def condition(surface):
...     if surface == "housing_foot":
...         return Adiabatic(surface=surface)
...     if "outer" in surface or "_end_" in surface:
...         return Film(surface=surface, kind="air", fluid_temperature=293.15, law=niemann_winter(height=0.28))
...     return Film(surface=surface, kind="oil", fluid_temperature=343.15, law=oil_wetted())
>>> setup = ConductionSetup(box.mesh, {body: 50.0 for body in box.mesh.bodies})
>>> heat = SurfaceSource(surface="gear_pinion_rim", kind="mesh", power=150.0)
>>> solution = solve_steady(setup, [heat, *(condition(surface) for surface in box.mesh.surfaces)])
>>> print(f"{solution.temperature.max() - 273.15:.0f} degC, balance closed: {solution.balance.closure < 1e-8}")
96 degC, balance closed: True
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from thermal.conditions.boundary import Adiabatic, Film, PrescribedTemperature, Radiation, SurfaceSource
    from thermal.conduction.setup import ConductionSetup
    from thermal.conduction.steady import TemperatureSolution, solve_steady
    from thermal.expansion.expansion import expand
    from thermal.expansion.setup import ExpansionSetup
    from thermal.films.convection import oil_wetted, rotating_disc
    from thermal.films.still import niemann_winter, recknagel_plate
    from thermal.housing.gearbox import HousingGeometry, build_gearbox
    from thermal.housing.shaft_geometry import EndBearing, GearDisc, ShaftGeometry
    from thermal.transient.history import solve_transient

__all__ = [
    "Adiabatic",
    "ConductionSetup",
    "EndBearing",
    "ExpansionSetup",
    "Film",
    "GearDisc",
    "HousingGeometry",
    "PrescribedTemperature",
    "Radiation",
    "ShaftGeometry",
    "SurfaceSource",
    "TemperatureSolution",
    "build_gearbox",
    "expand",
    "niemann_winter",
    "oil_wetted",
    "recknagel_plate",
    "rotating_disc",
    "solve_steady",
    "solve_transient",
]

_HOMES = {
    "Adiabatic": "conditions.boundary",
    "ConductionSetup": "conduction.setup",
    "EndBearing": "housing.shaft_geometry",
    "ExpansionSetup": "expansion.setup",
    "Film": "conditions.boundary",
    "GearDisc": "housing.shaft_geometry",
    "HousingGeometry": "housing.gearbox",
    "PrescribedTemperature": "conditions.boundary",
    "Radiation": "conditions.boundary",
    "ShaftGeometry": "housing.shaft_geometry",
    "SurfaceSource": "conditions.boundary",
    "TemperatureSolution": "conduction.steady",
    "build_gearbox": "housing.gearbox",
    "expand": "expansion.expansion",
    "niemann_winter": "films.still",
    "oil_wetted": "films.convection",
    "recknagel_plate": "films.still",
    "rotating_disc": "films.convection",
    "solve_steady": "conduction.steady",
    "solve_transient": "transient.history",
}


def __getattr__(name: str) -> object:
    """Import a name on first use."""
    if name in _HOMES:
        return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
