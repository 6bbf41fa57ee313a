"""Catalogue of shafts that bend: what turns with them, bearings and supports; for sets with lateral channels only.

Loads once a turn are written by their parts along cosine and sine, as angles count in the case: from +y in the sense of
rotation, where the pinion of the first mesh passes zero. What a shaft has is one unbalance in one plane, that of the
gear next to its centre of mass, one bow, one run-out of the flange: probes in one plane cannot separate more. Healthy
spreads: half of what the balance grade permits, like other tolerances, is two standard deviations; bows and flanges
as they are ground and turned in; clearances by the tolerance of their fit.
"""

from cmath import phase, rect
from collections.abc import Callable, Iterator

from dynamics.rotor.rotor_model import rotor_of
from rigdesign.case.drivetrain import BowInput, ShaftInput
from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue.effects import (
    BEARING,
    EXCITATION,
    PRACTICE,
    Changes,
    Effect,
    GearboxPart,
    Parameter,
    Scaled,
    factor,
    of_gearbox,
    of_rig,
)
from rigdesign.rig.elastic_rig import MM_PER_S, grade_of, highest_speeds
from rigdesign.rig.model import build_rig

GENERAL_GRADE = 6.3
"""Balance quality grade of general machinery, by whose permissible unbalance the bound counts [mm/s]."""

TIMES_GENERAL = 40.0
"""Largest unbalance over what that grade permits."""

HEALTHY_GRADE = 2.5
"""Balance quality grade of a healthy shaft whose unbalances are stated, and to be measured once more [mm/s]."""

HEALTHY_SHARE = 0.25
"""Standard deviation of one part of a healthy unbalance over what its grade permits."""

LARGEST_BOW = 100e-6
"""Of a shaft or a flange [m]."""

HEALTHY_BOW = 2.5e-6
"""Standard deviation of one part of the bow of a ground shaft [m]: a dial gauge reads 10 um."""

LARGEST_TILT = 1e-3
"""Of a flange [rad]."""

HEALTHY_TILT = 3e-5
"""The same of the tilt of a flange [rad]: 6 um on a diameter of 100 mm."""

LARGEST_ANGLE = 20e-3
"""Angle between the axes at a cross joint beyond that of the case [rad]."""

LEAST_ANGLE = 1e-3
"""Of it that matters [rad]: what a laser alignment leaves."""

CLEARANCE_SPREAD = 0.12
"""Spread of the logarithm of a bearing clearance: tolerances of bore and journal over their difference."""

SUPPORT_SPREAD = 0.25
"""Spread of the logarithm of a stated stiffness of a bearing or of the housing under it."""


@of_rig(lateral=True)
def turning_loads(case: Case) -> Iterator[Effect]:
    """Unbalance and bow of every shaft."""
    power = case.power_circuit
    planes = _Planes(case)
    for name, shaft in power.shafts.items():
        most = TIMES_GENERAL * planes.permitted(name, GENERAL_GRADE)
        healthy = HEALTHY_SHARE * planes.permitted(name, grade_of(case, shaft) or HEALTHY_GRADE)
        yield _once_a_turn(
            f"unbalance:{name}", f"unbalance of {name}", ("unbalance", most, "kg m"),
            "order 1 of its shaft growing with the square of the speed, lateral, at any torque",
            MoreUnbalance(name, planes.of(name), grade_of(case, shaft)), healthy,
        )  # fmt: skip
        if len(_supports(case, name)) > 1:
            yield _once_a_turn(
                f"shaft_bow:{name}", f"bow of {name}", ("bow", LARGEST_BOW, "m"),
                "order 1 of its shaft, lateral, from low speed on; none at the bearings of a shaft that bends freely",
                MoreBow(name), HEALTHY_BOW,
            )  # fmt: skip


@of_rig(lateral=True)
def couplings_out_of_true(case: Case) -> Iterator[Effect]:
    """Flanges that turn out of true, and the angle of cross joints."""
    power = case.power_circuit
    for name, coupling in power.couplings.items():
        path = f"drivetrain.couplings.{name}"
        if coupling.radial_stiffness:
            yield _once_a_turn(
                f"flange_run_out:{name}", f"run-out of a flange at the coupling {name}",
                ("run-out", LARGEST_BOW, "m"),
                "order 1 of both its shafts, lateral, the same at any speed below their resonances",
                Turned(f"{path}.flange_run_out", rect(coupling.flange_run_out, coupling.flange_run_out_angle)),
                HEALTHY_BOW,
            )  # fmt: skip
        if coupling.angular_stiffness:
            yield _once_a_turn(
                f"flange_tilt:{name}", f"tilt of the flange at the coupling {name}", ("tilt", LARGEST_TILT, "rad"),
                "order 1 of both its shafts, lateral, the same at any speed below their resonances",
                Turned(f"{path}.flange_tilt", rect(coupling.flange_tilt, coupling.flange_tilt_angle)), HEALTHY_TILT,
            )  # fmt: skip
        if coupling.alternates:
            parts = [
                Parameter(
                    name=f"angle {word}", unit="rad", low=-LARGEST_ANGLE, high=LARGEST_ANGLE, source=PRACTICE
                )
                for word in ("across", "upwards")
            ]
            yield Effect(
                name=f"cross_joint_angle:{name}",
                title=f"angle between the axes at the cross joint {name}",
                family=EXCITATION,
                signature="order 2 of its shafts, lateral in proportion to the torque",
                parameters=tuple(parts),
                change=MoreAngle(path, (coupling.cold_angle_lateral, coupling.cold_angle_vertical)),
                matters=LEAST_ANGLE,
                bends=True,
            )


@of_gearbox(lateral=True)
def bearing_stiffness(part: GearboxPart) -> Iterator[Effect]:
    """What every bearing yields by: the clearance of its film or its stated stiffness, and the housing under it."""
    power = part.case.power_circuit
    stated = power.bearing_coefficients == "stated"
    for name, bearing in part.box.bearings.items():
        path, label = f"{part.path}.bearings.{name}", f"{part.name}.{name}"
        shows = "mesh orders of its shaft, order 1 where an unbalance is stated, most at its own sensors"
        if stated and bearing.radial_stiffness is not None:
            yield _yields(
                f"bearing_stiffness:{label}", f"stiffness of the bearing {label}", shows,
                (f"{path}.radial_stiffness", bearing.radial_stiffness), (0.2, 5.0), SUPPORT_SPREAD,
            )  # fmt: skip
        elif bearing.type == "journal":
            yield _yields(
                f"bearing_clearance:{label}", f"clearance of the bearing {label}",
                f"{shows}, its friction and temperature a little",
                (f"{path}.diametral_clearance", bearing.diametral_clearance), (0.4, 2.5), CLEARANCE_SPREAD,
            )  # fmt: skip
        if bearing.support_stiffness is not None:
            yield _yields(
                f"support_stiffness:{label}", f"stiffness of the housing under the bearing {label}",
                f"{shows}, accelerations more than shaft displacements",
                (f"{path}.support_stiffness", bearing.support_stiffness), (0.2, 5.0), SUPPORT_SPREAD,
            )  # fmt: skip


def _once_a_turn(
    name: str,
    title: str,
    size: tuple[str, float, str],
    signature: str,
    change: Callable[[Case, tuple[float, ...]], Changes],
    healthy: float,
) -> Effect:
    """Entry of a load that turns with its shaft, of free phase; size : name, bound and unit of its amplitude."""
    label, most, unit = size
    first, second = (
        Parameter(name=f"{label} along {along}", unit=unit, low=-most, high=most, source=PRACTICE)
        for along in ("cosine", "sine")
    )
    return Effect(
        name=name,
        title=title,
        family=EXCITATION,
        signature=signature,
        parameters=(first, second),
        change=change,
        healthy=healthy,
        linear=True,
        bends=True,
    )


def _yields(
    name: str,
    title: str,
    signature: str,
    value: tuple[str, float],
    bounds: tuple[float, float],
    healthy: float,
) -> Effect:
    """Entry that multiplies a value (path, as it is) of one bearing."""
    return Effect(
        name=name,
        title=title,
        family=BEARING,
        signature=signature,
        parameters=(factor("factor", *bounds),),
        change=Scaled((value,)),
        healthy=healthy,
        bends=True,
    )


class _Planes:
    """Where the unbalance of every shaft is written, and what a balance grade permits of it."""

    def __init__(self, case: Case) -> None:
        drivetrain = build_rig(case, "quick").drivetrain
        self._drivetrain, self._speeds = drivetrain, highest_speeds(case, drivetrain)

    def of(self, shaft: str) -> float:
        """Position [m] of the gear, or else the bearing, next to the centre of mass: a node of the shaft."""
        centre = rotor_of(self._drivetrain, shaft).centre
        gears = [gear.position for gear in self._drivetrain.gears if gear.shaft == shaft]
        bearings = [bearing.position for bearing in self._drivetrain.bearings if bearing.shaft == shaft]
        return min(gears or bearings or [centre], key=lambda position: abs(position - centre))

    def permitted(self, shaft: str, grade: float) -> float:
        """Permissible unbalance [kg m] of a grade [mm/s] at the highest speed of the shaft (ISO 21940-11)."""
        mass = rotor_of(self._drivetrain, shaft).mass
        return mass * MM_PER_S * grade / self._speeds[shaft]


def _supports(case: Case, shaft: str) -> set[float | None]:
    """Positions of the bearings of a shaft."""
    boxes = case.gearboxes.values()
    return {bearing.position for box in boxes for bearing in box.bearings.values() if bearing.shaft == shaft}


# What effects of shafts that bend change in a case; loads once a turn by their parts along cosine and sine.


def _shaft(case: Case, name: str) -> ShaftInput:
    return case.power_circuit.shafts[name]


class MoreUnbalance:
    """One more unbalance on a shaft; the grade that its others leave is kept beside it."""

    NAME = "found"

    def __init__(self, shaft: str, position: float, grade: float) -> None:
        self._shaft, self._position, self._grade = shaft, position, grade

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        """The change at the parts along cosine and sine."""
        path = f"drivetrain.shafts.{self._shaft}"
        stated = _shaft(case, self._shaft).unbalances
        unbalances = {
            name: _written(unbalance.position, rect(unbalance.unbalance, unbalance.angle))
            for name, unbalance in stated.items()
        }
        more = complex(values[0], values[1])
        if self.NAME in stated:
            unbalance = stated[self.NAME]
            more += rect(unbalance.unbalance, unbalance.angle)
        unbalances[self.NAME] = _written(self._position, more)
        return {f"{path}.unbalances": unbalances, f"{path}.balance_grade": self._grade}


def _written(position: float, unbalance: complex) -> dict[str, str]:
    return {
        "position": f"{position!r} m",
        "unbalance": f"{abs(unbalance)!r} kg m",
        "angle": f"{phase(unbalance)!r} rad",
    }


class MoreBow:
    """Adds to the residual bow of a shaft."""

    def __init__(self, shaft: str) -> None:
        self._shaft = shaft

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        """The change at the parts along cosine and sine."""
        present = _shaft(case, self._shaft).bow or BowInput()
        bow = rect(present.amplitude, present.angle) + complex(values[0], values[1])
        stated: dict[str, object] = {"amplitude": f"{abs(bow)!r} m", "angle": f"{phase(bow)!r} rad"}
        if present.position is not None:
            stated["position"] = f"{present.position!r} m"
        if present.temperature_difference is not None:
            stated |= {
                "temperature_difference": f"{present.temperature_difference!r} K",
                "hot_side": f"{present.hot_side!r} rad",
            }
        return {f"drivetrain.shafts.{self._shaft}.bow": stated}


class Turned:
    """Adds to an amplitude whose angle stands at the same path with ``_angle``."""

    def __init__(self, path: str, stated: complex) -> None:
        self._path, self._stated = path, stated

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        """The change at the parts along cosine and sine."""
        whole = self._stated + complex(values[0], values[1])
        return {self._path: abs(whole), f"{self._path}_angle": phase(whole)}


class MoreAngle:
    """Adds to the angle between two axes, across and upwards."""

    def __init__(self, path: str, stated: tuple[float, float]) -> None:
        self._path, self._stated = path, stated

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        """The change at what is added to both."""
        return {
            f"{self._path}.cold_angle_lateral": self._stated[0] + values[0],
            f"{self._path}.cold_angle_vertical": self._stated[1] + values[1],
        }
