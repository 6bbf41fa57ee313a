"""Time of a diagnosis: the library of a rig, and the next sets it serves; printed, never a reason to fail.

Run with ``pytest -m performance -s tests/performance/test_diagnosis_speed.py``.
"""

import time

import pytest

from rigdesign.case import load_case
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.diagnosis.library.build import run_places
from rigdesign.diagnosis.run import diagnose_measurement
from rigdesign.prediction import OWN_MODEL, TORSIONAL, Channel, OperatingCondition
from rigdesign.prediction.predict import Predictor, predict
from tests.builders.paths import CASES

RIGS = {"uhcf_prototype": ("set_2", "set_3"), "loop_1to1": ("set_1",)}


@pytest.mark.performance
@pytest.mark.parametrize("rig", RIGS)
def test_a_library_and_the_sets_it_serves(rig, tmp_path, monkeypatch):
    monkeypatch.setenv("RIGDESIGN_CACHE_DIR", str(tmp_path))
    case = load_case(CASES / rig)
    folders = [CASES / rig / "measured" / name for name in RIGS[rig]]
    start = time.perf_counter()
    first = diagnose_measurement(case, folders[0])
    whole = time.perf_counter() - start
    library = first.problem.residuals.library
    start = time.perf_counter()
    predict(case, library.settings[:1], library.channels)
    point = time.perf_counter() - start
    runs = sum(len(one.coordinates) - 1 for one in library.responses.values()) * len(library.settings)
    print(
        f"\n{rig}, {len(library.settings)} points, {len(library.features)} numbers: first set {whole:.0f} s "
        f"(goal 120 with 15 points), {runs} runs of a point in it; one full point {point:.1f} s, "
        f"{runs * point / whole:.0f} times as long for all"
    )
    for folder in folders:
        start = time.perf_counter()
        diagnose_measurement(case, folder)
        print(f"  next set of the rig ({folder.name}): {time.perf_counter() - start:.1f} s (goal 15)")


FAMILIES = ("stiffness", "inertia", "damping", "oil", "loss", "excitation")
POINTS = (
    OperatingCondition(name="slow", speed=105.0, torque=350.0),
    OperatingCondition(name="fast", speed=377.0, torque=200.0),
)
CHANNELS = (
    Channel(name="torque", quantity="torque", place="wheel_side", orders=(0.0, 1.0, 28.0, 29.0)),
    Channel(name="first", quantity="natural_frequency", place="1"),
    Channel(name="oil", quantity="oil_outlet_temperature", place="test.gear_oil"),
)


@pytest.mark.performance
@pytest.mark.parametrize("circuit", [TORSIONAL, OWN_MODEL], ids=["torsional", "elastic"])
def test_runs_of_effects_by_family(circuit):
    """Processor time of a run and point over that of a converged base point, first effect of a family."""
    case = load_case(CASES / "loop_1to1")
    start = time.process_time()
    predictor = Predictor(case, POINTS, CHANNELS, circuit=circuit)
    base = (time.process_time() - start) / len(POINTS)
    start = time.process_time()
    predictor.prepare()
    prepared = (time.process_time() - start) / len(POINTS)
    print(f"\nbase {base:.2f} s a point, its derivatives {prepared / base:.1f} times that")
    for family in FAMILIES:
        effect = next(one for one in effects_of(case) if one.family.name == family)
        run = predictor.oscillating if effect.oscillates else predictor.response
        places = run_places(effect)
        start = time.process_time()
        for place in places:
            run(effect.changes(case, tuple(map(float, place))))
        each = (time.process_time() - start) / len(places) / len(POINTS)
        print(f"  {family:12s} {effect.name:32s} {len(places)} runs, {each / base:.3f} of a base point each")
