"""Time of a diagnosis: the library of a rig, and the next sets it serves; printed, never a reason to fail."""

import time

import pytest

from rigdesign.case import load_case
from rigdesign.diagnosis.run import diagnose_measurement
from rigdesign.prediction.predict import predict
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
