"""Parametric gearbox: geometry -> mesh of ten-node tetrahedra with named bodies, surfaces and stations.

    geometry = HousingGeometry(...)
    surface_names(geometry)                  every surface that wants a boundary condition; no gmsh needed
    model = build_gearbox(geometry, "quick")

Surfaces, with ``<s>`` the name of a shaft and ``<side>`` front or rear (low or high x):

    outer_warm                    side walls and top outside, between the mid-planes of the partitions
    outer_cold_<side>             the rest of side walls and top, and the end face
    chamber_wall, chamber_floor, chamber_top, partition_warm_<side>           warm chamber inside
    cold_floor_<side>, partition_cold_<side>, cold_wall_<side>                cold section inside; its wall is
                                  sides, top, end wall, bearing bosses, shoulders and covers
                                  without partitions there is one chamber: in place of the surfaces above
    outer_warm                    all of side walls and top outside; the end faces are outer_end_<side>
    chamber_wall, chamber_floor, chamber_top, end_wall_<side>                 inside; an end wall with its bearing
                                  bosses, shoulders and covers

    bearing_bore_<s>_<side>       the bore of a bearing
    seal_bore_<s>_<side>          in the partition; seal_bore_<s>_<side>_end in the end wall, where the shaft leaves
    field_top, field_sides, field_bottom                  or housing_foot for a housing without a field
    shaft_<s>_journal_<side>, shaft_<s>_seal_<side>, shaft_<s>_seal_<side>_end, shaft_<s>_warm,
    shaft_<s>_cold_<side>, shaft_<s>_outside_<side>, shaft_<s>_end_<side>, shaft_<s>_bore
    gear_<s>_rim, gear_<s>_side_<side>
                                  without partitions a shaft has no seal_<side> and no cold_<side>; shaft_<s>_warm
                                  reaches from bearing to bearing

Surfaces of parts that are not there (no overhang, no bore, no gear) do not exist. Bodies: ``housing``,
``field``
(shares nodes with the foot; with a foot joint ``housing_foot`` touches its ``field_seat``), ``shaft_<s>``,
``gear_<s>`` (shares nodes with its seat). Housing and shafts share no nodes: lubricant films and seal gaps are
not meshed, nor is the air in the chambers.
"""

import math
from collections.abc import Iterator, Mapping
from functools import partial
from types import MappingProxyType
from typing import Literal

from thermal.fe.gmsh_session import gmsh_session
from thermal.fe.kept_results import kept
from thermal.fe.mesh import MeshError, NamedMesh, disjoint_union
from thermal.housing.geometry import ClampingField, HousingGeometry
from thermal.housing.housing_surfaces import (
    FOOT,
    body_names,
    exact_areas,
    exact_volumes,
    field_faces,
    housing_faces,
    surface_names,
)
from thermal.housing.shaft_geometry import EndBearing, GearDisc, GeometryError, ShaftGeometry
from thermal.housing.shaft_surfaces import shaft_faces
from thermal.housing.solids import (
    Component,
    MeshSizes,
    bend_axes,
    draw_field,
    draw_housing,
    draw_shaft,
    housing_size,
    mesh_component,
    shaft_size,
)
from thermal.housing.stations import (
    GearboxModel,
    bearing_stations,
    foot_joint,
    gear_stations,
    seal_stations,
    shaft_stations,
)

__all__ = [
    "ClampingField",
    "EndBearing",
    "Fidelity",
    "GearDisc",
    "GeometryError",
    "HousingGeometry",
    "MeshError",
    "MeshSizes",
    "ShaftGeometry",
    "body_names",
    "build_field",
    "build_gearbox",
    "build_shaft",
    "exact_areas",
    "exact_volumes",
    "mesh_sizes",
    "surface_names",
]

Fidelity = Literal["quick", "standard", "reference"]

_SCALES: dict[Fidelity, tuple[float, float, float, int]] = {
    "quick": (0.1, 0.3, 0.08, 7),
    "standard": (0.04, 0.1, 0.05, 10),
    "reference": (0.0108, 0.045, 0.024, 20),
}
"""Elements of walls, field and shafts relative to the root of the housing's outer area, the root of the
field's area and the longest shaft, and elements a turn: the node count hardly depends on its size."""


def mesh_sizes(
    geometry: HousingGeometry, fidelity: Fidelity, zones: Mapping[str, float] = MappingProxyType({})
) -> MeshSizes:
    """Element sizes of one fidelity, scaled with the parts of ``geometry``.

    zones : size [m] by zone (wall, field, seal, bearing, gear) at standard fidelity, in place of the usual
        one; the other fidelities keep their ratio to it

    Raises GeometryError for a fidelity that is not quick, standard or reference.
    """
    if fidelity not in _SCALES:
        raise GeometryError(f"fidelity = {fidelity!r} is unknown; use one of {', '.join(_SCALES)}")
    wall, field, shaft, circle = _SCALES[fidelity]
    g = geometry
    outer = math.sqrt(2.0 * (g.length * g.width + g.length * g.height + g.width * g.height))
    plate = math.sqrt(g.field.length * g.field.width) if g.field is not None else outer
    reach = max(g.length + s.overhang_front + s.overhang_rear for s in g.shafts)
    ratio = wall / _SCALES["standard"][0]
    given = {zone: ratio * size for zone, size in zones.items()}
    return MeshSizes(
        wall=given.get("wall", wall * outer), field=given.get("field", field * plate), shaft=shaft * reach,
        circle=circle, seal=given.get("seal", math.inf), bearing=given.get("bearing", math.inf),
        gear=given.get("gear", math.inf),
    )  # fmt: skip


def build_gearbox(geometry: HousingGeometry, fidelity: Fidelity | MeshSizes = "quick") -> GearboxModel:
    """Mesh a gearbox and locate its bearings, seals, shafts and gears.

    fidelity : quick (10 to 20 k nodes for a usual gearbox), standard (30 to 50 k), reference (350 k and
        more), or sizes

    The same input gives the same arrays in every process; a model built before is returned again from memory,
    so do not write into it. Raises GeometryError (ValueError), MeshError (ValueError) and, where gmsh or a
    system library it needs is missing, the loader's ImportError or OSError.
    """
    return _build(geometry, fidelity if isinstance(fidelity, MeshSizes) else mesh_sizes(geometry, fidelity))


def _components(geometry: HousingGeometry, sizes: MeshSizes) -> Iterator[Component]:
    """Housing, field where it is a body of its own, shafts with their gears."""
    yield Component(
        name="housing",
        draw=partial(draw_housing, geometry),
        faces=housing_faces(geometry),
        size=housing_size(geometry, sizes),
        axes=bend_axes(geometry),
    )
    if geometry.foot_joint:
        yield _field_component(geometry, sizes)
    for shaft in geometry.shafts:
        yield _shaft_component(geometry, shaft, sizes)


def _field_component(geometry: HousingGeometry, sizes: MeshSizes) -> Component:
    """The field as a body of its own."""
    return Component(
        name="field",
        draw=partial(draw_field, geometry),
        faces=field_faces(geometry),
        size=housing_size(geometry, sizes),
    )


def _shaft_component(geometry: HousingGeometry, shaft: ShaftGeometry, sizes: MeshSizes) -> Component:
    """A shaft with its gear."""
    return Component(
        name=f"shaft {shaft.name}",
        draw=partial(draw_shaft, geometry, shaft),
        faces=shaft_faces(geometry, shaft),
        size=shaft_size(geometry, shaft, sizes),
        axes=[(shaft.y, geometry.shaft_height, math.inf)],
    )


@kept
def build_shaft(geometry: HousingGeometry, shaft: ShaftGeometry, sizes: MeshSizes) -> NamedMesh:
    """Mesh one shaft of a gearbox with its gear, for a housing that is not the box.

    Errors and memory as of `build_gearbox`.
    """
    with gmsh_session() as gmsh:
        return mesh_component(gmsh, _shaft_component(geometry, shaft, sizes), sizes.circle)


@kept
def build_field(geometry: HousingGeometry, sizes: MeshSizes) -> NamedMesh:
    """Mesh the field of a gearbox with the seat of its foot, for a housing that is not the box.

    Errors and memory as of `build_gearbox`.
    """
    with gmsh_session() as gmsh:
        return mesh_component(gmsh, _field_component(geometry, sizes), sizes.circle)


@kept
def _build(geometry: HousingGeometry, sizes: MeshSizes) -> GearboxModel:
    with gmsh_session() as gmsh:
        components = [
            mesh_component(gmsh, component, sizes.circle) for component in _components(geometry, sizes)
        ]
    return GearboxModel(
        mesh=disjoint_union(*components),
        shafts=shaft_stations(geometry),
        bearings=bearing_stations(geometry),
        seals=seal_stations(geometry),
        gears=gear_stations(geometry),
        fixed_body="housing" if geometry.field is None else "field",
        foot_surface=FOOT if geometry.field is None else "field_bottom",
        joint=foot_joint(geometry),
    )
