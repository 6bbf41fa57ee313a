"""How the numbers of one rig, its sensors and points answer to everything that may be off: computed once, then kept.

A library holds runs of the real model (`rigdesign.prediction.predict.Predictor`) and derivatives of it, no formula
of its own. It belongs to a case, a set of channels and a plan of operating points; a later set of the same rig whose
points lie near the plan is served by the derivatives by its settings.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.prediction.model import Channel, Feature, OperatingCondition, apart, features_of, nearest_of


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

    @property
    def nonlinear(self) -> bool:
        """Several runs of one parameter: the answer is a curve over it."""
        return self._count == 1 and not self.linear

    def sensitivity(self) -> Array:
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

    channels, settings : of the plan; features : their numbers; base : (n,) prediction there
    inputs : (kind, place, setting) -> (n,) derivative by one setting value [SI]
    responses : effect -> its runs
    links, sources, dry_sources : name -> (n,): by the logarithm of a local conductance; per watt at a place, paid by
        the motor; the same unpaid
    powers : setting -> losses [W]
    modes : natural frequencies near which orders of torque are steep [rad/s]; none without a drivetrain
    error : stated error of the temperatures [K]
    """

    channels: tuple[Channel, ...]
    settings: tuple[OperatingCondition, ...]
    features: tuple[Feature, ...]
    base: Array
    inputs: Mapping[tuple[str, str, str], Array]
    responses: Mapping[str, Response]
    links: Mapping[str, Array]
    sources: Mapping[str, Array]
    dry_sources: Mapping[str, Array]
    powers: Mapping[str, float]
    modes: Array
    error: float

    def serving(
        self, settings: tuple[OperatingCondition, ...], channels: tuple[Channel, ...]
    ) -> "Library | None":
        """The library for points near some of its plan and channels among its own; None where it cannot serve.

        Names of points and channels may differ: a channel is known by what and where it reads.
        """
        points = _matches(settings, self.settings, apart)
        sensors = _matches(channels, self.channels, _reads_as)
        if points is None or sensors is None:
            return None
        names = {channel.name: self.channels[place].name for channel, place in zip(channels, sensors)}
        planned = {run.name: self.settings[place].name for run, place in zip(settings, points)} | {"": ""}
        row = {feature: number for number, feature in enumerate(self.features)}
        wanted = features_of(settings, channels)
        rows = np.array(
            [
                row[replace(feature, channel=names[feature.channel], setting=planned[feature.setting])]
                for feature in wanted
            ],
            dtype=np.intp,
        )
        run_of = {planned[run.name]: run for run in settings}
        inputs = {
            (kind, place, run_of[point].name): values[rows]
            for (kind, place, point), values in self.inputs.items()
            if point in run_of
        }
        base = self.base[rows].copy()
        for place in points:
            setting = self.settings[place]
            for (kind, where, point), values in inputs.items():
                if point == run_of[setting.name].name and states(setting, kind, where):
                    base += (
                        value_of(run_of[setting.name], kind, where) - value_of(setting, kind, where)
                    ) * values
        cut = self._cut(rows)
        return replace(
            cut,
            channels=channels,
            settings=settings,
            features=wanted,
            base=base,
            inputs=inputs,
            sources=_of_sensors(cut.sources, names),
            dry_sources=_of_sensors(cut.dry_sources, names),
            powers={run_of[point].name: power for point, power in self.powers.items() if point in run_of},
        )

    def joined(self, other: "Library") -> "Library":
        """With the points of another library of the same rig, effects and channels.

        Standing quantities and modes stay those of this one.
        """
        settings = (*self.settings, *other.settings)
        features = features_of(settings, self.channels)
        place = {feature: number for number, feature in enumerate(other.features)}
        place = {feature: number + len(self.features) for feature, number in place.items()}
        place |= {feature: number for number, feature in enumerate(self.features)}
        both = _Both(
            counts=(len(self.features), len(other.features)),
            rows=np.array([place[feature] for feature in features], dtype=np.intp),
        )
        return replace(
            self,
            settings=settings,
            features=features,
            base=both.values(self.base, other.base),
            inputs=both.columns(self.inputs, other.inputs),
            responses={
                name: both.response(response, other.responses[name])
                for name, response in self.responses.items()
                if name in other.responses
            },
            links=both.columns(self.links, other.links),
            sources=both.columns(self.sources, other.sources),
            dry_sources=both.columns(self.dry_sources, other.dry_sources),
            powers={**self.powers, **other.powers},
            error=max(self.error, other.error),
        )

    def distance(self, settings: Sequence[OperatingCondition]) -> float:
        """How far points lie from those of the plan that serve them: one at the limit, infinite where none does."""
        points = _matches(settings, self.settings, apart)
        if points is None:
            return float("inf")
        return max((apart(self.settings[place], run) for run, place in zip(settings, points)), default=0.0)

    def rows(self, features: tuple[Feature, ...]) -> "Library":
        """The library cut to some of its features."""
        place = {feature: row for row, feature in enumerate(self.features)}
        rows = np.array([place[feature] for feature in features], dtype=np.intp)
        return replace(self._cut(rows), features=features)

    def _cut(self, rows: NDArray[np.intp]) -> "Library":
        return replace(
            self,
            base=self.base[rows],
            inputs=_of_rows(self.inputs, rows),
            responses={
                name: Response(coordinates=response.coordinates, answers=response.answers[:, rows])
                for name, response in self.responses.items()
            },
            links=_of_rows(self.links, rows),
            sources=_of_rows(self.sources, rows),
            dry_sources=_of_rows(self.dry_sources, rows),
        )


K = TypeVar("K")


@dataclass(frozen=True)
class _Both:
    """Numbers of two libraries behind each other, then in the order of their features together.

    counts : features of each; rows : (n,) places in those behind each other
    """

    counts: tuple[int, int]
    rows: NDArray[np.intp]

    def values(self, first: Array, second: Array) -> Array:
        """(..., n) of all features."""
        return np.asarray(np.concatenate([first, second], axis=-1)[..., self.rows])

    def columns(self, first: Mapping[K, Array], second: Mapping[K, Array]) -> dict[K, Array]:
        """Zero where one of both has no such column."""
        none, nothing = (np.zeros(count) for count in self.counts)
        return {
            name: self.values(first.get(name, none), second.get(name, nothing))
            for name in dict.fromkeys((*first, *second))
        }

    def response(self, first: Response, second: Response) -> Response:
        """At the coordinates that the model could compute for both."""
        place = {tuple(sizes): number for number, sizes in enumerate(second.coordinates)}
        shared = [number for number, sizes in enumerate(first.coordinates) if tuple(sizes) in place]
        same = [place[tuple(first.coordinates[number])] for number in shared]
        return Response(
            coordinates=first.coordinates[shared],
            answers=self.values(first.answers[shared], second.answers[same]),
        )


def _of_rows(columns: Mapping[K, Array], rows: NDArray[np.intp]) -> dict[K, Array]:
    return {key: values[rows] for key, values in columns.items()}


NEAR_SENSOR = "near:"
"""How the name of a source begins that lies at a thermocouple."""


def _of_sensors(sources: Mapping[str, Array], names: Mapping[str, str]) -> dict[str, Array]:
    """Sources at the sensors of a set by the names they have there; ``names``: of the set -> of the library."""
    renamed = {f"{NEAR_SENSOR}{kept}": f"{NEAR_SENSOR}{here}" for here, kept in names.items()}
    return {
        renamed.get(name, name): values
        for name, values in sources.items()
        if name in renamed or not name.startswith(NEAR_SENSOR)
    }


def states(setting: OperatingCondition, kind: str, place: str) -> bool:
    """Whether a setting says this value or leaves it to the case."""
    if kind in ("speed", "torque"):
        return True
    if place == "":
        return setting.ambient_temperature is not None
    return place in getattr(setting, kind)


def value_of(setting: OperatingCondition, kind: str, place: str) -> float:
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


T = TypeVar("T")


def _matches(
    wanted: Sequence[T], offered: Sequence[T], distance: Callable[[T, T], float]
) -> list[int] | None:
    """For each wanted one the place of the nearest offered one, none used twice; None if one is a distance of 1 off."""
    matches = nearest_of(wanted, offered, distance, 1.0)
    return list(matches.values()) if len(matches) == len(wanted) else None


def _reads_as(kept: Channel, wanted: Channel) -> float:
    """Zero where a channel of the library reads what is wanted."""
    same = kept.reads == wanted.reads
    return 0.0 if same and set(wanted.orders) <= set(kept.orders) else 2.0
