"""Rows of the heat balance: one condition at one place, integrated from its own law."""

from dataclasses import dataclass

from thermal.conditions.boundary import Exchange, Film, Radiation
from thermal.fe.elements import FiniteElements, SurfaceElements
from thermal.fe.mesh import FloatArray
from thermal.films.law import STEFAN_BOLTZMANN, FilmCoefficient


@dataclass(frozen=True, kw_only=True)
class HeatFlow:
    """Heat of one condition at one place."""

    surface: str
    """Surface, body for a source in a body, or volume."""
    kind: str
    power: float
    """[W], positive into the solid or volume."""
    area: float
    """[m2]; 0 for a source in a body and for a volume."""
    mean_temperature: float
    """Area mean of the surface, volume mean of the body, outlet temperature of the volume [K]."""
    piece: int
    """Number of the connected piece of the mesh that takes the heat; volumes count on from the last piece."""
    coefficient: FilmCoefficient | None = None


def surface_row(
    surface: SurfaceElements,
    name: str,
    kind: str,
    power: float,
    temperature: FloatArray,
    coefficient: FilmCoefficient | None = None,
) -> HeatFlow:
    """A row of a surface with its area and mean temperature; power [W] into the solid."""
    return HeatFlow(
        surface=name,
        kind=kind,
        power=power,
        area=surface.area,
        mean_temperature=surface.mean(temperature),
        piece=surface.piece,
        coefficient=coefficient,
    )


def film_row(surface: SurfaceElements, film: Film, temperature: FloatArray) -> HeatFlow:
    """Heat of a film, its coefficient at the mean wall temperature."""
    coefficient = film.law(surface.mean(temperature), film.fluid_temperature)
    power = coefficient.value * surface.integral(film.fluid_temperature - surface.at_points(temperature))
    return surface_row(surface, film.surface, film.kind, power, temperature, coefficient)


def radiation_row(surface: SurfaceElements, radiation: Radiation, temperature: FloatArray) -> HeatFlow:
    """Heat from large surroundings, integrated over T^4."""
    wall, room = surface.at_points(temperature), radiation.surroundings_temperature
    power = radiation.emissivity * STEFAN_BOLTZMANN * surface.integral(room**4 - wall**4)
    mean = surface.mean(temperature)
    coefficient = FilmCoefficient(
        value=radiation.emissivity * STEFAN_BOLTZMANN * (mean**2 + room**2) * (mean + room),
        formula="grey_radiation_to_surroundings",
        inputs={
            "emissivity": radiation.emissivity,
            "mean_temperature": mean,
            "surroundings_temperature": room,
        },
        valid_range="grey, diffuse surface that sees only its surroundings",
        source="Stefan-Boltzmann law, written as a coefficient at the mean temperature",
    )
    return surface_row(surface, radiation.surface, radiation.kind, power, temperature, coefficient)


def exchange_rows(elements: FiniteElements, exchange: Exchange, temperature: FloatArray) -> list[HeatFlow]:
    """Both sides of an exchange between area means."""
    a, b = elements.surfaces[exchange.surface_a], elements.surfaces[exchange.surface_b]
    mean_a, mean_b = a.mean(temperature), b.mean(temperature)
    coefficient = exchange.law(mean_a, mean_b)
    power = coefficient.value * a.area * (mean_b - mean_a)
    return [
        surface_row(a, exchange.surface_a, exchange.kind, power, temperature, coefficient),
        surface_row(b, exchange.surface_b, exchange.kind, -power, temperature, coefficient),
    ]
