"""Stations of a user's mesh: circles fitted to the bores and shafts that carry the names of a gearbox.

The surfaces and bodies that count are those that `thermal.housing.gearbox` names. Where one is missing, is no
cylinder about an axis along x, or a journal does not stand in its bore, heat can be computed but no clearance be read,
and the model says why.
"""

from dataclasses import dataclass, replace

import numpy as np

from thermal.fe.mesh import FloatArray, NamedMesh
from thermal.housing.geometry import HousingGeometry
from thermal.housing.housing_surfaces import FOOT, joined_surfaces
from thermal.housing.stations import (
    GearboxModel,
    Point,
    bearing_stations,
    foot_joint,
    gear_stations,
    seal_stations,
    shaft_stations,
)

ROUND = 0.02
"""Largest distance of a corner from the fitted circle, relative to its radius, of what is taken for a cylinder."""


@dataclass(frozen=True)
class FittedCylinder:
    """A cylinder about an axis along x."""

    centre: Point
    """In the middle of its length [m]."""
    radius: float
    length: float
    roundness: float
    """Largest distance of a node from the circle, relative to the radius."""


def fit_cylinder(points: FloatArray) -> FittedCylinder:
    """Least-squares circle in y and z through points (n, 3) [m], n at least 3.

    Source: Kasa, IEEE Trans. Instrum. Meas. 25 (1976) 8: linear in centre and r^2 - |centre|^2.
    """
    start, end = float(points[:, 0].min()), float(points[:, 0].max())
    middle = points[:, 1:].mean(axis=0)
    y, z = (points[:, 1:] - middle).T
    fit = np.linalg.lstsq(np.column_stack([2.0 * y, 2.0 * z, np.ones_like(y)]), y**2 + z**2)[0]
    radius = float(np.sqrt(max(fit[2] + fit[0] ** 2 + fit[1] ** 2, 0.0)))
    off = np.abs(np.hypot(y - fit[0], z - fit[1]) - radius).max()
    centre = (0.5 * (start + end), float(middle[0] + fit[0]), float(middle[1] + fit[1]))
    return FittedCylinder(centre, radius, end - start, float(off / radius) if radius > 0.0 else np.inf)


def fitted_model(mesh: NamedMesh, geometry: HousingGeometry) -> GearboxModel:
    """The model of a user's mesh; what ``geometry`` names is looked for, its measures are taken from the mesh.

    Clearances and which bearing locates a shaft are those of ``geometry``. ``no_expansion`` of the model says
    what is missing for clearances; it then has no stations.
    """
    missing = _missing(mesh, geometry)
    if missing:
        return GearboxModel(
            mesh=mesh, shafts=(), bearings=(), seals=(), gears=(), fixed_body="", foot_surface="",
            no_expansion=f"clearances need {missing}",
        )  # fmt: skip
    at = {name: fit_cylinder(mesh.points[np.unique(nodes[:, : mesh.shape.side.n_corners])])
          for name, nodes in mesh.surfaces.items()}  # fmt: skip
    field = "field" in mesh.bodies
    return GearboxModel(
        mesh=mesh,
        shafts=tuple(
            replace(s, axis=(0.0, *at[_journal(geometry, s.name)].centre[1:]),
                    start=at[s.start_surface].centre[0], end=at[s.end_surface].centre[0])
            for s in shaft_stations(geometry)
        ),
        bearings=tuple(
            replace(b, centre=at[b.bore_surface].centre, diameter=2.0 * at[b.journal_surface].radius,
                    width=at[b.bore_surface].length)
            for b in bearing_stations(geometry)
        ),
        seals=tuple(
            replace(s, centre=at[s.bore_surface].centre, shaft_diameter=2.0 * at[s.shaft_surface].radius)
            for s in seal_stations(geometry)
            if {s.bore_surface, s.shaft_surface} <= set(mesh.surfaces)
        ),
        gears=tuple(
            replace(g, centre=at[g.rim_surface].centre, face_width=at[g.rim_surface].length)
            for g in gear_stations(geometry)
        ),
        fixed_body="field" if field else "housing",
        foot_surface="field_bottom" if field else FOOT,
        joint=foot_joint(geometry),
    )  # fmt: skip


def _journal(geometry: HousingGeometry, shaft: str) -> str:
    return next(b.journal_surface for b in bearing_stations(geometry) if b.shaft == shaft)


def _missing(mesh: NamedMesh, geometry: HousingGeometry) -> str:
    """What the mesh lacks for clearances, in words; empty if nothing."""
    if mesh.shape.n_corners != 4:
        return "a mesh of ten-node tetrahedra, on which gaps round a seal are read"
    bearings, gears = bearing_stations(geometry), gear_stations(geometry)
    shafts, seals = shaft_stations(geometry), seal_stations(geometry)
    bodies = ["housing", *(s.body for s in shafts), *(g.body for g in gears)]
    cylinders = [name for b in bearings for name in (b.bore_surface, b.journal_surface)]
    cylinders += [g.rim_surface for g in gears]
    ends = [name for s in shafts for name in (s.start_surface, s.end_surface)]
    ends.append("field_bottom" if "field" in mesh.bodies else FOOT)
    ends += joined_surfaces(geometry)
    lost = [f"body {name}" for name in bodies if name not in mesh.bodies]
    lost += [f"surface {name}" for name in cylinders + ends if name not in mesh.surfaces]
    if lost:
        return ", ".join(lost)
    cylinders += [name for s in seals for name in (s.bore_surface, s.shaft_surface) if name in mesh.surfaces]
    fits = {name: fit_cylinder(mesh.points[np.unique(mesh.surfaces[name][:, :3])]) for name in cylinders}
    flat = [name for name, fit in fits.items() if fit.roundness > ROUND]
    if flat:
        return f"cylinders about an axis along x: {', '.join(flat)}"
    apart = [
        f"{b.bore_surface} about {_millimetres(bore)}, {b.journal_surface} about {_millimetres(journal)}"
        for b in bearings
        if not _together(bore := fits[b.bore_surface], journal := fits[b.journal_surface])
    ]
    return f"bores round their journals: {'; '.join(apart)}" if apart else ""


def _together(bore: FittedCylinder, journal: FittedCylinder) -> bool:
    """Whether a journal turns in its bore: on its axis, and in it over half of the shorter one at least."""
    off = np.hypot(bore.centre[1] - journal.centre[1], bore.centre[2] - journal.centre[2])
    overlap = 0.5 * (bore.length + journal.length) - abs(bore.centre[0] - journal.centre[0])
    return bool(off <= ROUND * journal.radius and overlap >= 0.5 * min(bore.length, journal.length))


def _millimetres(fit: FittedCylinder) -> str:
    return f"({', '.join(f'{1e3 * value:.4g}' for value in fit.centre)}) mm"
