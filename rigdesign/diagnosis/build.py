"""Makes the library of a rig: runs of the model for every effect, derivatives for everything else."""

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from rigdesign.beside import Beside
from rigdesign.case.model import Case
from rigdesign.diagnosis.columns import Array
from rigdesign.diagnosis.effects import Effect
from rigdesign.diagnosis.library import Library, Response
from rigdesign.errors import RigdesignError
from rigdesign.prediction import Predictor
from rigdesign.prediction.model import ORDER_QUANTITIES, Channel, Setting

Progress = Callable[[str], None]

SHARES = (-1.0, -0.4, -0.12, 0.12, 0.4, 1.0)
"""Runs of a nonlinear effect, as shares of its bounds."""

DYNAMIC = frozenset({"excitation", "tooth", "stiffness", "inertia", "damping"})
"""Families that leave temperatures and losses nearly as they are."""

LINEAR_SHARE = 0.1
"""Run of an effect that the numbers answer to in proportion."""

SWING_SHARE = 0.01
"""The same of an excitation: what grows with its square stays small beside."""

POWER = Channel(name="losses of the rig", quantity="motor_power", place="motor")
"""Read beside the channels of the measurement: all losses together."""


def build_library(
    case: Case,
    settings: Sequence[Setting],
    channels: Sequence[Channel],
    effects: Sequence[Effect],
    say: Progress = lambda message: None,
) -> Library:
    """Run the model at the plan for everything that may be off; on all cores.

    Raises what the model raises at the base state; an effect that the model refuses at some size is kept up to the
    sizes it can compute.
    """
    say(f"model of {len(settings)} operating points and {len(channels)} sensors")
    predictor = Predictor(case, tuple(settings), (*channels, POWER))
    predictor.prepare()
    base = predictor.base
    moving = sorted((effect for effect in effects if _reaches(effect, channels)), key=_haste)
    work = [_Response(predictor, case, effect, base) for effect in moving]
    say(f"responses to {len(moving)} effects")
    with Beside(work) as beside:
        found = beside.results()
    responses = {effect.name: one for effect, one in zip(moving, found, strict=True) if one is not None}
    say("local conductances, sources, settings")
    own = np.array([feature.channel != POWER.name for feature in predictor.features])
    powers = {
        feature.setting: float(value)
        for feature, value in zip(predictor.features, base, strict=True)
        if feature.channel == POWER.name
    }
    paid, unpaid = predictor.sources(paid=True), predictor.sources()
    return Library(
        channels=tuple(channels),
        features=tuple(feature for feature, keep in zip(predictor.features, own, strict=True) if keep),
        settings=tuple(settings),
        base=base[own],
        inputs=_by_point(predictor, own),
        responses={
            name: Response(coordinates=one.coordinates, answers=one.answers[:, own])
            for name, one in responses.items()
        },
        exponents={name: values[own] for name, values in _exponents(predictor, case, responses)},
        links={name: values[own] for name, values in predictor.links().items()},
        sources={name: values[own] for name, values in paid.items()},
        dry_sources={name: values[own] for name, values in unpaid.items()},
        powers=powers,
        error=predictor.error,
    )


def _reaches(effect: Effect, channels: Sequence[Channel]) -> bool:
    """Whether an effect can show at all: teeth and swinging torques only where orders or modes are read."""
    dynamic = any(channel.quantity in (*ORDER_QUANTITIES, "natural_frequency") for channel in channels)
    return dynamic or effect.family not in DYNAMIC


def _by_point(predictor: Predictor, own: NDArray[np.bool_]) -> dict[tuple[str, str, str], Array]:
    """Derivatives by the settings, each point's by itself."""
    points = np.array([feature.setting for feature in predictor.features])
    return {
        (kind, place, setting.name): np.where(points == setting.name, values, 0.0)[own]
        for (kind, place), values in predictor.inputs().items()
        for setting in predictor.settings
    }


class _Response:
    """The runs of one effect; a class, so that another core can be handed it."""

    def __init__(self, predictor: Predictor, case: Case, effect: Effect, base: Array) -> None:
        self._predictor, self._case, self._effect, self._base = predictor, case, effect, base

    def __call__(self) -> Response | None:
        coordinates = [np.zeros(len(self._effect.parameters))]
        answers = [np.zeros_like(self._base)]
        for place in run_places(self._effect):
            changes = self._effect.changes(self._case, tuple(float(value) for value in place))
            try:
                found = (
                    self._predictor.swinging(changes)
                    if swings(self._effect)
                    else self._predictor.response(changes)
                )
                answer = found - self._base
            except RigdesignError:
                continue
            coordinates.append(place)
            answers.append(answer)
        if len(coordinates) < 1 + len(self._effect.parameters):
            return None
        return Response(coordinates=np.array(coordinates), answers=np.array(answers))


def swings(effect: Effect) -> bool:
    """Whether an effect only swings, with no mean over a turn: waves over the teeth, harmonic torques."""
    return effect.family == "excitation" and effect.linear and not effect.any_tooth


def run_places(effect: Effect) -> list[Array]:
    """Coordinates at which an effect is run."""
    bounds = [parameter.bounds for parameter in effect.parameters]
    if effect.linear or len(bounds) > 1:
        share = SWING_SHARE if swings(effect) else LINEAR_SHARE
        steps = [share * max(abs(low), abs(high)) for low, high in bounds]
        return list(np.diag(steps))
    low, high = bounds[0]
    shares = (share * (high if share > 0.0 else -low) for share in SHARES)
    return [np.array([share]) for share in shares if share != 0.0]


def _haste(effect: Effect) -> tuple[int, int]:
    """Order in which the works are dealt to the cores: what runs longest first, so that none ends alone."""
    dear = ("tooth", "stiffness", "inertia", "damping", "excitation", "state", "oil")
    place = dear.index(effect.family) if effect.family in dear else len(dear)
    return place, -len(run_places(effect))


_EXPONENT_LAWS = {"mesh": ("speed", "torque"), "bearing": ("speed",), "windage": ("speed",)}


def _exponents(
    predictor: Predictor, case: Case, responses: Mapping[str, Response]
) -> Iterator[tuple[str, Array]]:
    """Derivatives by the exponents of the loss laws, about the mean point.

    An exponent scales the loss of each point by itself, and a number follows its own point only: the derivative is
    that by the logarithm of the loss times the logarithm of the point's ratio.
    """
    for name in case.gearboxes:
        for kind, laws in _EXPONENT_LAWS.items():
            response = responses.get(f"{kind}_loss:{name}")
            if response is None:
                continue
            slope = response.slope()[:, 0]
            for law in laws:
                turned = dict(
                    zip((s.name for s in predictor.settings), np.log(_ratios(predictor.settings, law)))
                )
                share = np.array([turned.get(feature.setting, 0.0) for feature in predictor.features])
                yield f"{kind} loss of {name} over {law}", slope * share


def _ratios(settings: Sequence[Setting], law: str) -> Array:
    values = np.array([max(abs(getattr(setting, law)), 1e-3) for setting in settings])
    return np.asarray(values / np.exp(np.log(values).mean()))
