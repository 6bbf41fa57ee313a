"""Films of surfaces in air that hardly moves: a lower bound under laws that vanish at standstill."""

from thermal.films.law import FilmCoefficient, FilmLaw

SOURCE = "transient.still_film"


def still(value: float) -> FilmLaw:
    """The same coefficient [W/(m2 K)] whatever the temperatures."""
    coefficient = FilmCoefficient(
        value=value,
        formula="still_film",
        inputs={"value": value},
        valid_range="as given; free convection in a chamber is usually 3 to 10 W/(m2 K)",
        source=SOURCE,
    )
    return lambda wall, fluid: coefficient


def at_least(law: FilmLaw, floor: float) -> FilmLaw:
    """A law, or the coefficient of still air [W/(m2 K)] where that is more; its range then does not matter."""
    least = still(floor)

    def bounded(wall: float, fluid: float) -> FilmCoefficient:
        found = law(wall, fluid)
        return found if found.value >= floor else least(wall, fluid)

    return bounded
