"""Makes the library of a rig: runs of the model for every effect, derivatives for everything else."""

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.errors import RigdesignError
from rigdesign.base.parallel import BackgroundTasks, cores
from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.library.cache import Parts
from rigdesign.diagnosis.library.library import Library, Response
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.prediction.model import (
    MODAL_QUANTITIES,
    ORDER_QUANTITIES,
    STANDING_QUANTITIES,
    Channel,
    OperatingCondition,
    PredictionModel,
    measured_against,
)
from rigdesign.prediction.predict import Predictor

Progress = Callable[[str], None]

BATCH = 4
"""Works a core between two notes of what is done."""

LINEAR_SHARE = 0.1
"""Run of an effect that the numbers answer to in proportion."""

OSCILLATION_SHARE = 0.01
"""The same of an excitation: what grows with its square stays small."""

POWER = Channel(name="losses of the rig", quantity="motor_power", place="motor")
"""Read in addition to the channels of the measurement: all losses together; without a drivetrain they are given."""


def build_library(
    case: Case,
    settings: Sequence[OperatingCondition],
    channels: Sequence[Channel],
    effects: Sequence[Effect],
    say: Progress = lambda message: None,
    circuit: PredictionModel | None = None,
) -> Library:
    """Run the model at the plan for everything that may be off; on all cores.

    circuit : shafts and teeth of the power circuit; left out, what data of these channels are held against

    Finished responses are kept until the library is whole, so that an interrupted run goes on there.

    Raises what the model raises at the base state; an effect that the model refuses at some size is kept up to the
    sizes it can compute.
    """
    say(f"model of {len(settings)} operating points and {len(channels)} sensors")
    metered = (POWER,) if case.drivetrain is not None else ()
    model = circuit or measured_against(channels)
    predictor = Predictor(case, tuple(settings), (*channels, *metered), circuit=model)
    predictor.prepare()
    base = predictor.base
    parts = Parts.of(case, settings, channels, effects, model)
    moving = [effect for effect in effects if _reaches(effect, channels)]
    responses = _responses(predictor, case, moving, parts, say)
    say("local conductances, sources, settings")
    of_sensors = np.array([feature.channel != POWER.name for feature in predictor.features])
    given = math.fsum(loss.power for loss in case.losses.given.values())
    powers = {setting.name: given for setting in settings}
    powers |= {
        feature.setting: float(value)
        for feature, value in zip(predictor.features, base, strict=True)
        if feature.channel == POWER.name
    }
    unpaid, watt = predictor.sources(), predictor.motor_watt()
    library = Library(
        channels=tuple(channels),
        features=tuple(feature for feature, keep in zip(predictor.features, of_sensors, strict=True) if keep),
        settings=tuple(settings),
        base=base[of_sensors],
        inputs=_by_point(predictor, of_sensors),
        responses={
            name: Response(coordinates=response.coordinates, answers=response.answers[:, of_sensors])
            for name, response in responses.items()
        },
        links={name: values[of_sensors] for name, values in predictor.links().items()},
        sources={name: (values + watt)[of_sensors] for name, values in unpaid.items()},
        dry_sources={name: values[of_sensors] for name, values in unpaid.items()},
        powers=powers,
        modes=predictor.natural_frequencies(),
        error=predictor.error,
    )
    parts.remove()
    return library


def _reaches(effect: Effect, channels: Sequence[Channel]) -> bool:
    """Whether an effect can show at all.

    Teeth and alternating torques only where orders, modes or root gauges are read, the load over the face at root
    gauges; what moves the heat not where they are all that is read at the points.
    """
    quantities = {channel.quantity for channel in channels}
    if effect.family.strain:
        return "root_strain" in quantities
    if effect.family.heat:
        return not quantities <= {"root_strain", *STANDING_QUANTITIES}
    dynamic = not quantities.isdisjoint({*ORDER_QUANTITIES, *MODAL_QUANTITIES, "root_strain"})
    return dynamic or not effect.family.dynamic


def _by_point(predictor: Predictor, of_sensors: NDArray[np.bool_]) -> dict[tuple[str, str, str], Array]:
    """Derivatives by the settings, each point's by itself."""
    points = np.array([feature.setting for feature in predictor.features])
    return {
        (kind, place, setting.name): np.where(points == setting.name, values, 0.0)[of_sensors]
        for (kind, place), values in predictor.inputs().items()
        for setting in predictor.settings
    }


def _responses(
    predictor: Predictor, case: Case, effects: Sequence[Effect], parts: Parts, say: Progress
) -> dict[str, Response]:
    """Effect -> its runs, without those that the model refuses; finished ones are kept as ``parts``."""
    responses = parts.known(say)
    left = [effect for effect in effects if effect.name not in responses]
    works = [_Runs(predictor, case, tuple(group)) for group in _together(left)]
    size = BATCH * cores()
    for start in range(0, len(works), size):
        say(f"response {len(effects) - len(left) + 1} of {len(effects)}")
        with BackgroundTasks(works[start : start + size]) as tasks:
            new = {name: response for made in tasks.results() for name, response in made.items()}
        parts.keep(new)
        responses |= new
        left = [effect for effect in left if effect.name not in new]
    whole = ((effect.name, responses[effect.name]) for effect in effects)
    return {name: response for name, response in whole if response is not None}


def _together(effects: Sequence[Effect]) -> list[list[Effect]]:
    """Effects that share what one process remembers: the same of both gears of a mesh may be one to its contacts."""
    groups: dict[object, list[Effect]] = {}
    for effect in sorted(effects, key=_run_order):
        flanks = effect.family.tooth_contact and not effect.any_tooth
        gearbox = effect.place.partition(".")[0]
        groups.setdefault((effect.kind, gearbox) if flanks else effect.name, []).append(effect)
    return list(groups.values())


class _Runs:
    """The runs of some effects; a class, so that another core can be handed it."""

    def __init__(self, predictor: Predictor, case: Case, effects: tuple[Effect, ...]) -> None:
        self._predictor, self._case, self._effects = predictor, case, effects

    def __call__(self) -> dict[str, Response | None]:
        return {effect.name: self._response(effect) for effect in self._effects}

    def _response(self, effect: Effect) -> Response | None:
        """From the smallest run on: where the model refuses one, the larger ones are left out."""
        base = self._predictor.base
        coordinates, answers = [np.zeros(len(effect.parameters))], [np.zeros_like(base)]
        refused: list[Array] = []
        for place in sorted(run_places(effect), key=lambda sizes: float(np.abs(sizes).max())):
            if any(np.all(np.sign(place) == np.sign(smaller)) for smaller in refused):
                continue
            changes = effect.changes(self._case, tuple(float(value) for value in place))
            try:
                run = self._predictor.oscillating if effect.oscillates else self._predictor.response
                answers.append(run(changes) - base)
                coordinates.append(place)
            except RigdesignError:
                refused.append(place)
        if len(coordinates) < 1 + len(effect.parameters):
            return None
        return Response(coordinates=np.array(coordinates), answers=np.array(answers))


def run_places(effect: Effect) -> list[Array]:
    """Coordinates at which an effect is run."""
    bounds = [parameter.bounds for parameter in effect.parameters]
    if effect.linear or len(bounds) > 1:
        share = OSCILLATION_SHARE if effect.oscillates else LINEAR_SHARE
        steps = [share * max(abs(low), abs(high)) for low, high in bounds]
        return list(np.diag(steps))
    low, high = bounds[0]
    shares = effect.family.sizes if low < 0.0 else effect.family.one_sided_sizes
    places = (share * (high if share > 0.0 else -low) for share in shares)
    return [np.array([place]) for place in places if place != 0.0]


def _run_order(effect: Effect) -> tuple[int, int]:
    """Order in which the works are dealt to the cores: what runs longest first, so that none ends alone."""
    return effect.family.run_rank, -len(run_places(effect))
