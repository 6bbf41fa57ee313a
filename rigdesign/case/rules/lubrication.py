"""Rules of the lubrication: what a sump needs, and bearings that cannot live on what they get."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rigdesign.base.errors import Fault
from rigdesign.base.units import show
from rigdesign.case.geometry import pitch_diameters

if TYPE_CHECKING:
    from rigdesign.case.gearbox import Gearbox
    from rigdesign.case.lubrication import DipOil
    from rigdesign.case.model import Case


def lubrication_faults(case: "Case") -> Iterator[Fault]:
    """Everything wrong with how gears and bearings get their oil."""
    for name, box in case.gearboxes.items():
        at = f"gearboxes.{name}"
        yield from _bearings(at, box)
        if box.sump is not None:
            yield from _sump(at, box, box.sump)
    yield from _drift(case)


def _bearings(at: str, box: "Gearbox") -> Iterator[Fault]:
    """Plain bearings need oil that is fed."""
    for name, bearing in box.bearings.items():
        if box.fed_bearings is None and bearing.needs_fed_oil:
            yield Fault(
                f"{at}.bearing_oil.lubrication", f'"{box.bearing_oil.lubrication}"',
                f"bearing {name} is a plain bearing, which needs oil that is fed",
                f"add [{at}.bearing_oil] with oil, inlet_temperature and flow",
            )  # fmt: skip
            return


def _sump(at: str, box: "Gearbox", sump: "DipOil") -> Iterator[Fault]:
    if box.housing is None and sump.sump_temperature is None:
        yield Fault(
            f"{at}.oil.sump_temperature", "",
            "without a housing nothing says what cools the sump",
            'add it, e.g. sump_temperature = "90 degC", or a [housing] table',
        )  # fmt: skip
    least = 0.5 * min(map(box.seat_diameter, box.gears))
    if sump.level >= least:
        yield Fault(
            f"{at}.oil.level", show(sump.level, "length"),
            f"reaches the top of a shaft, {show(least, 'length')} above its axis",
            "write a level below that, measured from the shaft axes and negative below them",
        )  # fmt: skip
    modules = {gear: mesh.normal_module for mesh in box.meshes.values() for gear in (mesh.pinion, mesh.wheel)}
    reach = max(0.5 * diameter + modules[gear] for gear, diameter in pitch_diameters(box).items())
    if sump.level <= -reach:
        yield Fault(
            f"{at}.oil.level", show(sump.level, "length"),
            f"no gear reaches the oil: the largest ends {show(reach, 'length')} below the axes",
            "raise the level, measured from the shaft axes and negative below them",
        )  # fmt: skip
    paths = box.oil_paths
    for key in ("leak_warm_cold", "bypass", "short_circuit"):
        if getattr(paths, key):
            yield Fault(
                f"{at}.oil_paths.{key}", f"{getattr(paths, key):g}", "the gears dip: no oil flows past them",
                'remove it, or write lubrication = "jet"',
            )  # fmt: skip
    films = {} if box.housing is None else box.housing.boundary
    for name, film in films.items():
        if getattr(film, "correlation", "") == "jet_renewal":
            yield Fault(
                f"{at}.housing.boundary.{name}.correlation", '"jet_renewal"', "the gears dip: no jet wets them",
                'write correlation = "fling_off"',
            )  # fmt: skip


def _drift(case: "Case") -> Iterator[Fault]:
    """A bracing that drifts with the gear oil needs to know its temperature before the run."""
    power = case.drivetrain
    if power is None or power.bracing.temperature_drift == 0.0:
        return
    box = case.gearboxes.get(power.torque_at.split(".")[0])
    if box is not None and box.gear_oil_temperature is None:
        yield Fault(
            "drivetrain.bracing.temperature_drift", f"{power.bracing.temperature_drift:g}",
            "counts from the temperature of the gear oil, which this case leaves to the heat balance of the sump",
            "state gearboxes.….oil.sump_temperature, or write 0",
        )  # fmt: skip
