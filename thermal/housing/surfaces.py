"""The named bodies and surfaces of a parametric gearbox: one catalogue for names, recognition and areas.

Every surface is a union of patches (`thermal.housing.patches`); the closed-form area next to them is what the mesh is
checked against.
"""

from thermal.housing.geometry import HousingGeometry
from thermal.housing.housing_surfaces import FOOT, SEAT, field_faces, housing_faces, housing_volume
from thermal.housing.patches import ring_area
from thermal.housing.shaft_surfaces import shaft_faces, shaft_zones


def surface_names(geometry: HousingGeometry) -> tuple[str, ...]:
    """Names of all surfaces `build_gearbox` makes of ``geometry``, without meshing (gmsh is not imported).

    The two sides of a foot joint are left out: they have each other.
    """
    joined = joined_surfaces(geometry)
    return tuple(name for name in exact_areas(geometry) if name not in joined)


def joined_surfaces(geometry: HousingGeometry) -> tuple[str, ...]:
    """The two sides of a foot joint, which take no boundary condition; none where foot and field share their nodes."""
    return (FOOT, SEAT) if geometry.foot_joint else ()


def body_names(geometry: HousingGeometry) -> tuple[str, ...]:
    """Names of all bodies `build_gearbox` makes of ``geometry``: housing, field, shafts and gears."""
    return tuple(exact_volumes(geometry))


def exact_areas(geometry: HousingGeometry) -> dict[str, float]:
    """Closed-form area of every named surface [m2]."""
    faces = housing_faces(geometry)
    if geometry.foot_joint:
        faces += field_faces(geometry)
    for shaft in geometry.shafts:
        faces += shaft_faces(geometry, shaft)
    return {face.name: face.area for face in faces}


def exact_volumes(geometry: HousingGeometry) -> dict[str, float]:
    """Closed-form volume of every body [m3]."""
    volumes = {"housing": housing_volume(geometry)}
    if geometry.field is not None:
        volumes["field"] = geometry.field.length * geometry.field.width * geometry.field.thickness
    for shaft in geometry.shafts:
        bore = shaft.bore_diameter / 2.0
        zones = shaft_zones(geometry, shaft)
        volumes[f"shaft_{shaft.name}"] = sum(ring_area(bore, z.radius) * (z.end - z.start) for z in zones)
        if shaft.gear is not None:
            ring = ring_area(shaft.seat_diameter / 2.0, shaft.gear.outer_diameter / 2.0)
            volumes[f"gear_{shaft.name}"] = ring * shaft.gear.width
    return volumes
