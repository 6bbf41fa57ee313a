"""When the orders of the meshes overrule a name that the orders of the shafts gave."""

from types import SimpleNamespace

import numpy as np
import pytest

from rigdesign.diagnosis.decision.decision import posterior
from rigdesign.diagnosis.decision.defaults import Thresholds
from rigdesign.diagnosis.decision.workflow import _overruled
from rigdesign.diagnosis.statistics.evidence import Evidence, Hypothesis

CIRCUIT = frozenset({"mesh", "coupling"})


def look(**log_bayes):
    """A look at the orders of the meshes; a name holds its parts apart by an underscore."""
    evidence = [
        Evidence(
            hypothesis=Hypothesis(name=name, family="physical", parts=tuple(name.split("_"))),
            log_bayes=value, coordinates=(1.0,), deviations=(0.1,), gain=2.0 * value,
            columns=np.zeros((4, 1)), answer=np.zeros(4),
        )
        for name, value in log_bayes.items()
    ]  # fmt: skip
    first = SimpleNamespace(evidence=evidence, weights=posterior(evidence, {"physical": 50}))
    return SimpleNamespace(first=first, criteria=SimpleNamespace(circuit=CIRCUIT, thresholds=Thresholds()))


@pytest.mark.parametrize(
    ("masses", "overruled"),
    [
        ({"mesh": 40.0, "pitch": 10.0}, True),
        ({"mesh": 40.0, "coupling": 40.0, "pitch": 10.0}, True),
        ({"mesh": 40.0, "pitch": 40.0}, False),
        ({"mesh_pitch": 40.0, "mesh": 10.0}, False),
        ({"leak": 40.0, "pitch": 10.0}, False),
    ],
)
def test_a_changed_circuit_overrules_a_name_that_the_meshes_do_not_show(masses, overruled):
    assert _overruled(look(**masses), ("pitch",)) is overruled


def test_a_change_of_the_circuit_is_not_overruled_by_itself():
    assert not _overruled(look(mesh=40.0, pitch=10.0), ("mesh",))
