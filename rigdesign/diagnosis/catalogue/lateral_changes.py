"""What effects of shafts that bend change in a case; loads once a turn by their parts along cosine and sine."""

from cmath import phase, rect

from rigdesign.case.drivetrain import BowInput, ShaftInput
from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue.effects import Changes


def _shaft(case: Case, name: str) -> ShaftInput:
    assert case.drivetrain is not None
    return case.drivetrain.shafts[name]


class MoreUnbalance:
    """One more unbalance on a shaft; the grade that its others leave is kept beside it."""

    NAME = "found"

    def __init__(self, shaft: str, position: float, grade: float) -> None:
        self._shaft, self._position, self._grade = shaft, position, grade

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        """The change at the parts along cosine and sine."""
        at = f"drivetrain.shafts.{self._shaft}"
        stated = _shaft(case, self._shaft).unbalances
        found = {name: _written(own.position, rect(own.unbalance, own.angle)) for name, own in stated.items()}
        more = complex(values[0], values[1])
        if self.NAME in stated:
            own = stated[self.NAME]
            more += rect(own.unbalance, own.angle)
        found[self.NAME] = _written(self._position, more)
        return {f"{at}.unbalances": found, f"{at}.balance_grade": self._grade}


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
        own = _shaft(case, self._shaft).bow or BowInput()
        bow = rect(own.amplitude, own.angle) + complex(values[0], values[1])
        stated: dict[str, object] = {"amplitude": f"{abs(bow)!r} m", "angle": f"{phase(bow)!r} rad"}
        if own.position is not None:
            stated["position"] = f"{own.position!r} m"
        if own.temperature_difference is not None:
            stated |= {
                "temperature_difference": f"{own.temperature_difference!r} K",
                "hot_side": f"{own.hot_side!r} rad",
            }
        return {f"drivetrain.shafts.{self._shaft}.bow": stated}


class Turned:
    """Adds to an amplitude whose angle stands at the same path with ``_angle``."""

    def __init__(self, path: str, now: complex) -> None:
        self._path, self._now = path, now

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        """The change at the parts along cosine and sine."""
        whole = self._now + complex(values[0], values[1])
        return {self._path: abs(whole), f"{self._path}_angle": phase(whole)}


class MoreAngle:
    """Adds to the angle between two axes, across and upwards."""

    def __init__(self, at: str, now: tuple[float, float]) -> None:
        self._at, self._now = at, now

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        """The change at what is added to both."""
        return {
            f"{self._at}.cold_angle_lateral": self._now[0] + values[0],
            f"{self._at}.cold_angle_vertical": self._now[1] + values[1],
        }
