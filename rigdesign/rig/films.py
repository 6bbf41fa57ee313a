"""Film laws of the case by name, each with the numbers of its place: height, diameter, speed, mist."""

from rigdesign.case import housing as laws
from thermal.films import convection
from thermal.films.law import FilmLaw


def plate_film(condition: laws.PlateFilm, height: float) -> FilmLaw:
    """Law of a still wall or plate in room air; ``height`` of the housing [m] where the case gives none."""
    return convection.scaled(_plate_film(condition, height), condition.film_factor)


def _plate_film(condition: laws.PlateFilm, height: float) -> FilmLaw:
    match condition:
        case laws.NiemannWinter():
            return convection.niemann_winter(condition.height or height, condition.draught_factor)
        case laws.RecknagelPlate():
            turbulent = condition.correlation == "turbulent"
            return convection.recknagel_plate("turbulent" if turbulent else "dimensional")
        case laws.IsoTr14179():
            return convection.iso_tr_14179_2_free(condition.height or height)
        case laws.VerticalPlate():
            return convection.vertical_plate_churchill(condition.height or height)
        case laws.HorizontalPlate():
            match condition.correlation:
                case "vdi":
                    return convection.horizontal_plate_vdi(condition.length, condition.facing)
                case "rohsenow":
                    return convection.horizontal_plate_rohsenow(condition.length, condition.facing)
            return convection.horizontal_plate_mcadams(condition.length, condition.facing)


def shaft_film(condition: laws.ShaftFilm, speed: float, diameter: float, density: float | None) -> FilmLaw:
    """Law of a shaft or gear surface.

    speed : [rad/s]; diameter : [m]; density : of the mist it turns in [kg/m3], None in dry air
    """
    return convection.scaled(_shaft_film(condition, speed, diameter, density), condition.film_factor)


def _shaft_film(condition: laws.ShaftFilm, speed: float, diameter: float, density: float | None) -> FilmLaw:
    match condition:
        case laws.HorizontalCylinder():
            return convection.horizontal_cylinder_churchill_chu(diameter, speed)
        case laws.RotatingDisc():
            if condition.correlation == "jungnickel":
                return convection.rotating_disc_jungnickel(speed, 0.5 * diameter)
            return convection.rotating_disc(speed, 0.5 * diameter, density)
        case laws.RotatingCylinder():
            match condition.correlation:
                case "jungnickel":
                    return convection.rotating_cylinder_jungnickel(speed, diameter)
                case "kays_bjorklund":
                    return convection.rotating_cylinder_kays_bjorklund(speed, diameter, density)
                case "etemad":
                    return convection.rotating_cylinder_etemad(speed, diameter, density)
                case "dropkin_carmi":
                    return convection.rotating_cylinder_dropkin_carmi(speed, diameter, density)
            return convection.rotating_cylinder_becker(speed, diameter, density)


def printed_law(taken: laws.TakenFrom) -> FilmLaw | None:
    """Film law a printed coefficient was read from; None if the case does not say."""
    match taken.law:
        case "niemann_winter":
            return convection.niemann_winter(taken.height or 0.0)
        case "recknagel_plate":
            return convection.recknagel_plate("dimensional")
        case "iso_tr_14179_2":
            return convection.iso_tr_14179_2_free(taken.height or 0.0)
    return None
