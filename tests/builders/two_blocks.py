"""Two blocks with a gap between them and one boundary condition of every kind: a model for unit tests."""

from dataclasses import replace

from thermal.conditions.boundary import (
    Adiabatic,
    BodySource,
    BoundaryCondition,
    Exchange,
    Film,
    PrescribedTemperature,
    Radiation,
    SurfaceSource,
)
from thermal.fe.mesh import NamedMesh, box_mesh, disjoint_union
from thermal.films.law import FilmCoefficient, FilmLaw

CONDUCTIVITY = {"hot": 40.0, "cold": 15.0}


def law(base: float, power: float = 0.0, warning: str = "") -> FilmLaw:
    """h = base |Tw - Tf|^power, as free convection has it."""

    def coefficient(wall: float, fluid: float) -> FilmCoefficient:
        return FilmCoefficient(
            value=base * abs(wall - fluid) ** power,
            formula="power",
            inputs={"wall": wall, "fluid": fluid},
            valid_range="any",
            source="test",
            warnings=(warning,) if warning else (),
        )

    return coefficient


def renamed(mesh: NamedMesh, prefix: str) -> NamedMesh:
    return replace(mesh, surfaces={f"{prefix}_{name}": nodes for name, nodes in mesh.surfaces.items()})


def two_blocks() -> NamedMesh:
    """Two blocks with a gap between them; the right one touches nothing else."""
    hot = renamed(box_mesh((0.2, 0.1, 0.1), (4, 2, 2), name="hot"), "hot")
    cold = renamed(box_mesh((0.1, 0.1, 0.1), (2, 2, 2), origin=(0.201, 0.0, 0.0), name="cold"), "cold")
    return disjoint_union(hot, cold)


def conditions() -> list[BoundaryCondition]:
    """Every kind there is; the cold block loses heat only through the exchange."""
    return [
        Film(surface="hot_x_min", kind="oil", fluid_temperature=420.0, law=law(60.0, 0.3)),
        Film(surface="hot_y_min", kind="air", fluid_temperature=293.0, law=law(3.0, 0.25)),
        Radiation(surface="hot_y_min", emissivity=0.9, surroundings_temperature=290.0),
        Film(surface="hot_y_max", kind="air", fluid_temperature=293.0, law=law(8.0)),
        PrescribedTemperature(surface="hot_z_min", temperature=330.0),
        SurfaceSource(surface="hot_z_max", power=25.0, kind="friction"),
        Exchange(surface_a="hot_x_max", surface_b="cold_x_min", kind="gap", law=law(20.0, 0.2)),
        BodySource(body="cold", power=12.0, kind="loss"),
        SurfaceSource(surface="cold_x_max", power=-5.0, kind="cooling"),
        *(Adiabatic(surface=f"cold_{name}") for name in ("y_min", "y_max", "z_min", "z_max")),
    ]
