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

from typing import TYPE_CHECKING

import lazy_loader

if TYPE_CHECKING:
    from thermal.conditions.boundary import Adiabatic as Adiabatic
    from thermal.conditions.boundary import Film as Film
    from thermal.conditions.boundary import PrescribedTemperature as PrescribedTemperature
    from thermal.conditions.boundary import Radiation as Radiation
    from thermal.conditions.boundary import SurfaceSource as SurfaceSource
    from thermal.conduction.setup import ConductionSetup as ConductionSetup
    from thermal.conduction.steady import TemperatureSolution as TemperatureSolution
    from thermal.conduction.steady import solve_steady as solve_steady
    from thermal.expansion.expansion import expand as expand
    from thermal.expansion.setup import ExpansionSetup as ExpansionSetup
    from thermal.films.convection import oil_wetted as oil_wetted
    from thermal.films.convection import rotating_disc as rotating_disc
    from thermal.films.still import niemann_winter as niemann_winter
    from thermal.films.still import recknagel_plate as recknagel_plate
    from thermal.housing.gearbox import HousingGeometry as HousingGeometry
    from thermal.housing.gearbox import build_gearbox as build_gearbox
    from thermal.housing.shaft_geometry import EndBearing as EndBearing
    from thermal.housing.shaft_geometry import GearDisc as GearDisc
    from thermal.housing.shaft_geometry import ShaftGeometry as ShaftGeometry
    from thermal.transient.history import solve_transient as solve_transient

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "conditions.boundary": ["Adiabatic", "Film", "PrescribedTemperature", "Radiation", "SurfaceSource"],
        "conduction.setup": ["ConductionSetup"],
        "conduction.steady": ["TemperatureSolution", "solve_steady"],
        "expansion.expansion": ["expand"],
        "expansion.setup": ["ExpansionSetup"],
        "films.convection": ["oil_wetted", "rotating_disc"],
        "films.still": ["niemann_winter", "recknagel_plate"],
        "housing.gearbox": ["HousingGeometry", "build_gearbox"],
        "housing.shaft_geometry": ["EndBearing", "GearDisc", "ShaftGeometry"],
        "transient.history": ["solve_transient"],
    },
)
