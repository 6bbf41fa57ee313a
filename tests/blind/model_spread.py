"""How far the answers of three other models of one rig lie from those of its own model, by kind of effect.

    python -m tests.blind.model_spread loop_1to1 loop_hunting

Shafts twist or bend, teeth are analytic or of finite elements. Of every series of numbers (one channel, one order,
orders of the meshes left out) the factor is taken by which another model answers more or less than the one that data
are held against. Printed is the root mean square of its distance from one over series, models and effects of a kind;
series count by how well their noise lets them be seen.
"""

import sys
import tempfile
from collections.abc import Mapping, Sequence
from itertools import product
from pathlib import Path

import numpy as np

from rigdesign.base.errors import RigdesignError
from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.library.build import OSCILLATION_SHARE, run_places
from rigdesign.diagnosis.run import mesh_orders
from rigdesign.diagnosis.statistics.columns import Array, series_numbers
from rigdesign.measurement import Data, features, load_measurement
from rigdesign.prediction.model import MEASURED_AGAINST, PredictionModel
from rigdesign.prediction.predict import Predictor
from tests.blind.score import case_of, effects_for, set_of
from tests.virtual_rig.generate import make_set

SHARE = 0.12
"""Of the bounds: size at which effects are run."""

MODELS = tuple(
    PredictionModel(shafts=shafts, teeth=teeth)
    for shafts, teeth in product(("elastic", "torsional"), ("analytic", "influence_numbers"))
)


def main(rigs: Sequence[str]) -> None:
    """Print kind, error, and of how many effects."""
    found: dict[str, list[float]] = {}
    for rig in rigs:
        for effect, error in spread_of(rig).items():
            found.setdefault(effect.partition(":")[0], []).append(error)
    for kind, errors in sorted(found.items()):
        print(f"{kind:24s} {np.sqrt(np.mean(np.square(errors))):8.3f}   {len(errors)} effects")


def spread_of(rig: str) -> dict[str, float]:
    """Effect -> relative error of the answer of the model that data are held against, over the other models.

    The nearest of the four models is the one that data are held against, and no other one.
    """
    with tempfile.TemporaryDirectory() as scratch:
        make_set(rig, {"kind": "none", "sensors": "rich", "plan": 9}, 1, Path(scratch) / "set")
        data = features(load_measurement(set_of(Path(scratch) / "set"), case_of(rig)))
    own, *models = (answers(rig, data, model) for model in (MEASURED_AGAINST, *MODELS))
    shown = np.array([not one.order or one.order not in mesh_orders(case_of(rig)) for one in data.features])
    noise = np.where(shown, data.noise, np.inf)
    series = series_numbers(data.features)
    found = {}
    for name, answer in own.items():
        errors = sorted(apart(answer, model[name], noise, series) for model in models if name in model)
        squares = np.square(errors[1:])
        found[name] = float(np.sqrt(np.mean(squares))) if len(squares) else 0.0
    return found


def answers(rig: str, data: Data, model: PredictionModel) -> Mapping[str, Array]:
    """Effect of the dynamics -> (n,) change of the numbers at a small size, by one model."""
    channels = tuple(entry.channel for entry in data.channels.values())
    predictor = Predictor(case_of(rig), data.settings, channels, circuit=model)
    predictor.prepare()
    row = {feature: number for number, feature in enumerate(predictor.features)}
    rows = np.array([row[feature] for feature in data.features])
    found = {}
    for effect in effects_for(rig):
        if effect.family.dynamic:
            try:
                found[effect.name] = _answer(rig, predictor, effect)[rows]
            except RigdesignError as error:
                print(f"{rig} {effect.name} {model}: {error}", file=sys.stderr)
    return found


def _answer(rig: str, predictor: Predictor, effect: Effect) -> Array:
    if effect.oscillates:
        place = OSCILLATION_SHARE * max(run_places(effect), key=lambda one: float(np.abs(one).max()))
    else:
        place = np.array([SHARE * max(one.bounds, key=abs) for one in effect.parameters[:1]])
        place = np.concatenate([place, np.zeros(len(effect.parameters) - 1)])
    changes = effect.changes(case_of(rig), tuple(float(value) for value in place))
    run = predictor.oscillating if effect.oscillates else predictor.response
    return np.asarray(run(changes) - predictor.base)


def apart(own: Array, other: Array, noise: Array, series: Array) -> float:
    """Root mean square of (factor - 1) over series, weighted by the square of what is seen of each."""
    count = int(series.max()) + 1
    weight = np.bincount(series, (own / noise) ** 2, count)
    shared = np.bincount(series, own * other / noise**2, count)
    factor = np.divide(shared, weight, out=np.ones(count), where=weight > 0.0)
    return float(np.sqrt(np.average((factor - 1.0) ** 2, weights=weight))) if weight.any() else 0.0


if __name__ == "__main__":
    main(sys.argv[1:])
