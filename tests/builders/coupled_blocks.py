"""Three blocks that heat each other by contact, radiation and oil: a model for unit tests."""

from tests.builders.two_blocks import law, renamed
from thermal.conditions.boundary import (
    Adiabatic,
    BodySource,
    Film,
    PrescribedTemperature,
    Radiation,
    SurfaceSource,
)
from thermal.conditions.contact import Contact
from thermal.conditions.enclosure import Enclosure
from thermal.conditions.streams import Stream, StreamNetwork, Supply, Volume, VolumeFilm, VolumeLink
from thermal.conduction.setup import Condition
from thermal.fe.mesh import NamedMesh, box_mesh, disjoint_union

CONDUCTIVITY = {"base": 40.0, "lid": 15.0, "wall": 30.0}
CAPACITY = {"base": 3.6e6, "lid": 2.4e6, "wall": 3.6e6}


def coupled_blocks() -> NamedMesh:
    """A lid on a base with another mesh, and a wall next to it that touches nothing."""
    base = renamed(box_mesh((0.2, 0.1, 0.1), (4, 2, 2), name="base"), "base")
    lid = renamed(box_mesh((0.1, 0.1, 0.05), (3, 3, 1), origin=(0.04, 0.0, 0.1), name="lid"), "lid")
    wall = renamed(box_mesh((0.02, 0.1, 0.1), (1, 2, 2), origin=(0.3, 0.0, 0.0), name="wall"), "wall")
    return disjoint_union(base, lid, wall)


def contact() -> Contact:
    """Joint of base and lid; its conductance rises with the temperature of one side."""
    return Contact(surface_a="base_z_max", surface_b="lid_z_min", kind="joint", law=law(120.0, 0.2))


def enclosure() -> Enclosure:
    """The gap between base and wall, open to a room of 295 K."""
    return Enclosure(
        name="gap",
        surfaces=("base_x_max", "wall_x_min"),
        emissivities=(0.8, 0.6),
        view_factors=((0.0, 0.35), (0.35, 0.0)),
        opening_temperature=295.0,
    )


def network() -> StreamNetwork:
    """Oil into a stirred chamber, on along the wall in plug flow, and a bypass that joins it before it leaves."""
    return StreamNetwork(
        specific_heat=2000.0,
        volumes=(
            Volume(name="chamber", power=30.0, heat_capacity=400.0),
            Volume(name="wall oil", plug_flow=True, heat_capacity=50.0),
            Volume(name="collector"),
        ),
        supplies=(Supply(name="cooler", temperature=380.0), Supply(name="room", temperature=293.0)),
        films=(
            VolumeFilm(surface="base_y_min", volume="chamber", kind="splash", law=law(150.0, 0.1)),
            VolumeFilm(surface="lid_z_max", volume="chamber", kind="splash", law=law(80.0)),
            VolumeFilm(surface="wall_x_max", volume="wall oil", kind="oil film", law=law(400.0, 0.1)),
            VolumeFilm(surface="wall_z_min", volume="wall oil", kind="oil film", law=law(200.0)),
        ),
        streams=(
            Stream(source="cooler", target="chamber", mass_flow=0.010),
            Stream(source="chamber", target="wall oil", mass_flow=0.004),
            Stream(source="chamber", target="collector", mass_flow=0.006, kind="bypass"),
            Stream(source="wall oil", target="collector", mass_flow=0.004),
            Stream(source="collector", target=None, mass_flow=0.010),
        ),
        links=(
            VolumeLink(a="chamber", b="room", conductance=0.8),
            VolumeLink(a="collector", b="wall oil", conductance=1.5),
        ),
    )


def conditions() -> list[Condition]:
    """The lid gives its heat away through the joint and the oil, the wall through radiation and the oil."""
    adiabatic = [
        *(f"lid_{name}" for name in ("x_min", "x_max", "y_min", "y_max")),
        *(f"wall_{name}" for name in ("y_min", "y_max", "z_max")),
        "base_z_min",
    ]
    return [
        contact(),
        enclosure(),
        network(),
        Film(surface="base_x_min", kind="air", fluid_temperature=293.0, law=law(6.0, 0.25)),
        Radiation(surface="base_z_max", emissivity=0.5, surroundings_temperature=293.0),
        PrescribedTemperature(surface="base_y_max", temperature=340.0),
        SurfaceSource(surface="lid_y_max", power=8.0, kind="friction"),
        BodySource(body="wall", power=15.0, kind="loss"),
        *(Adiabatic(surface=name) for name in adiabatic if name != "lid_y_max"),
    ]
