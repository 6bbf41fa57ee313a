"""How the numbers of one rig, its sensors and points answer to everything that may be off: computed once, then kept.

A library holds runs of the real model (`rigdesign.prediction.Predictor`) and derivatives of it, no formula of its
own. It belongs to a case, a set of channels and a plan of operating points; a later set of the same rig whose points
lie near the plan is served by the derivatives by its settings.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from rigdesign.diagnosis.columns import Array
from rigdesign.prediction.model import Feature, Setting


@dataclass(frozen=True, kw_only=True)
class Response:
    """Answer of all features to one effect.

    coordinates : (m, k) of the runs, the first one zero; answers : (m, n) change of the features
    """

    coordinates: Array
    answers: Array

    @property
    def linear(self) -> bool:
        """One run a parameter: the answer is taken as proportional."""
        return bool(len(self.coordinates) == self.coordinates.shape[1] + 1)

    def slope(self) -> Array:
        """(n, k) derivative at zero, from the smallest runs."""
        if self.linear:
            return np.stack(
                [self.answers[1 + i] / self.coordinates[1 + i, i] for i in range(self._count)], axis=1
            )
        places = self.coordinates[:, 0]
        low = int(np.argmax(np.where(places < 0.0, places, -np.inf)))
        high = int(np.argmin(np.where(places > 0.0, places, np.inf)))
        if places[low] < 0.0 < places[high]:
            span = places[high] - places[low]
            return np.asarray((self.answers[high] - self.answers[low]) / span)[:, None]
        used = high if places[high] > 0.0 else low
        return np.asarray(self.answers[used] / places[used])[:, None]

    @property
    def _count(self) -> int:
        return int(self.coordinates.shape[1])


@dataclass(frozen=True, kw_only=True)
class Library:
    """Everything a diagnosis takes from the model.

    features, settings : of the plan; base : (n,) prediction there
    inputs : (kind, place, setting) -> (n,) derivative by one setting value [SI]
    responses : effect -> its runs
    exponents, links, sources, dry_sources : name -> (n,): by the exponent of a loss over speed or torque; by the
        logarithm of a local conductance; per watt at a place, paid by the motor; the same unpaid
    powers : setting -> losses [W]
    error : stated error of the temperatures [K]
    """

    features: tuple[Feature, ...]
    settings: tuple[Setting, ...]
    base: Array
    inputs: Mapping[tuple[str, str, str], Array]
    responses: Mapping[str, Response]
    exponents: Mapping[str, Array]
    links: Mapping[str, Array]
    sources: Mapping[str, Array]
    dry_sources: Mapping[str, Array]
    powers: Mapping[str, float]
    error: float

    def moved(self, settings: tuple[Setting, ...]) -> "Library":
        """The library at settings near the plan (`near`): points keep their order, not their names."""
        names = {planned.name: run.name for planned, run in zip(self.settings, settings, strict=True)}
        values = self.base.copy()
        for planned, run in zip(self.settings, settings, strict=True):
            for (kind, place, point), derivative in self.inputs.items():
                if point == planned.name:
                    values += (value_of(run, kind, place) - value_of(planned, kind, place)) * derivative
        return replace(
            self,
            features=tuple(
                replace(feature, setting=names.get(feature.setting, "")) for feature in self.features
            ),
            settings=settings,
            base=values,
            inputs={(kind, place, names[point]): row for (kind, place, point), row in self.inputs.items()},
            powers={names[point]: power for point, power in self.powers.items()},
        )

    def rows(self, features: tuple[Feature, ...]) -> "Library":
        """The library cut to some of its features."""
        place = {feature: row for row, feature in enumerate(self.features)}
        rows = np.array([place[feature] for feature in features], dtype=np.intp)
        return replace(
            self,
            features=features,
            base=self.base[rows],
            inputs=_cut(self.inputs, rows),
            responses={
                name: Response(coordinates=one.coordinates, answers=one.answers[:, rows])
                for name, one in self.responses.items()
            },
            exponents=_cut(self.exponents, rows),
            links=_cut(self.links, rows),
            sources=_cut(self.sources, rows),
            dry_sources=_cut(self.dry_sources, rows),
        )


K = TypeVar("K")


def _cut(columns: Mapping[K, Array], rows: NDArray[np.intp]) -> dict[K, Array]:
    return {key: values[rows] for key, values in columns.items()}


def value_of(setting: Setting, kind: str, place: str) -> float:
    """One value of a setting [SI].

    Raises ValueError where the setting leaves it to the case: a plan states all it varies.
    """
    if kind in ("speed", "torque"):
        return float(getattr(setting, kind))
    value = setting.ambient_temperature if place == "" else getattr(setting, kind).get(place)
    if value is None:
        raise ValueError(
            f"operating point {setting.name} says nothing of {kind} {place}".rstrip()
            + "; state it in every point or in none"
        )
    return float(value)


def near(planned: tuple[Setting, ...], run: tuple[Setting, ...]) -> bool:
    """Whether every point of a run lies so near the plan that derivatives carry it over."""
    return len(planned) == len(run) and all(_close(a, b) for a, b in zip(planned, run, strict=True))


def _close(planned: Setting, run: Setting) -> bool:
    if dict(planned.tooth_offset) != dict(run.tooth_offset):
        return False
    if set(planned.inlet_temperature) != set(run.inlet_temperature) or set(planned.flow) != set(run.flow):
        return False
    if (planned.ambient_temperature is None) != (run.ambient_temperature is None):
        return False
    relative = [(planned.speed, run.speed), (planned.torque, run.torque)]
    relative += [(value, run.flow[place]) for place, value in planned.flow.items()]
    kelvins = [(value, run.inlet_temperature[place]) for place, value in planned.inlet_temperature.items()]
    if planned.ambient_temperature is not None and run.ambient_temperature is not None:
        kelvins.append((planned.ambient_temperature, run.ambient_temperature))
    return all(abs(b - a) <= 0.05 * abs(a) for a, b in relative) and all(
        abs(b - a) <= 5.0 for a, b in kelvins
    )
