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

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
