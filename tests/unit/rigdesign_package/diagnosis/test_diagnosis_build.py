"""How a library is made: sizes an effect is run at, sizes the model refuses, interrupted runs."""

import numpy as np
import pytest

from rigdesign.base.errors import NotConvergedError
from rigdesign.diagnosis.catalogue.effects import DAMPING, TOOTH, Effect, Parameter
from rigdesign.diagnosis.library.build import _responses, _together, run_places
from rigdesign.diagnosis.library.cache import Parts


def effect(name, family, low, high, **more):
    return Effect(
        name=name,
        title=name,
        family=family,
        signature="",
        parameters=(Parameter(name="size", unit="", low=low, high=high, source="test"),),
        change=lambda case, values: {name: values[0]},
        **more,
    )


class Model:
    """Answers with the square of the size; refuses sizes above a limit."""

    def __init__(self, limit=np.inf):
        self.base = np.zeros(3)
        self.limit = limit
        self.asked = []

    def response(self, changes):
        ((name, size),) = changes.items()
        self.asked.append((name, size))
        if abs(size) > self.limit:
            raise NotConvergedError("too much")
        return self.base + size**2


def made(model, effects, folder, said=None):
    say = (lambda message: None) if said is None else said.append
    return _responses(model, None, effects, Parts(folder), say)


def test_sizes_of_a_tooth_that_gives_way_and_of_flanks():
    weak = effect("weak_tooth:a.b", TOOTH, 0.0, 0.8, any_tooth=20)
    assert np.concatenate(run_places(weak)) == pytest.approx([0.096, 0.32, 0.56, 0.8])
    slope = effect("profile_slope:a.b", TOOTH, -20.0, 10.0)
    assert np.concatenate(run_places(slope)) == pytest.approx([-20.0, -6.0, 3.0, 10.0])
    assert len(run_places(effect("damping:a.b", DAMPING, -1.0, 1.0))) == 6


def test_a_size_that_is_refused_leaves_out_the_larger_ones_on_its_side(tmp_path, monkeypatch):
    monkeypatch.setattr("rigdesign.base.parallel.cores", lambda: 1)
    model = Model(limit=0.5)
    found = made(
        model,
        [effect("weak_tooth:a.b", TOOTH, 0.0, 0.8), effect("damping:a", DAMPING, -1.0, 0.5)],
        tmp_path / "x",
    )
    assert found["weak_tooth:a.b"].coordinates[:, 0] == pytest.approx([0.0, 0.096, 0.32])
    assert ("weak_tooth:a.b", 0.8) not in model.asked
    assert sorted(found["damping:a"].coordinates[:, 0]) == pytest.approx([-0.4, -0.12, 0.0, 0.06, 0.2, 0.5])
    assert found["damping:a"].answers[:, 0] == pytest.approx(found["damping:a"].coordinates[:, 0] ** 2)


def test_an_interrupted_run_goes_on_where_it_stopped(tmp_path, monkeypatch):
    monkeypatch.setattr("rigdesign.base.parallel.cores", lambda: 1)
    monkeypatch.setattr("rigdesign.diagnosis.library.build.cores", lambda: 1)
    effects = [effect(f"damping:{number}", DAMPING, -1.0, 1.0) for number in range(10)]

    class Interrupted(Model):
        def response(self, changes):
            if len(self.asked) == 6 * 6:
                raise KeyboardInterrupt
            return super().response(changes)

    with pytest.raises(KeyboardInterrupt):
        made(Interrupted(), effects, tmp_path / "parts")
    model, said = Model(), []
    found = made(model, effects, tmp_path / "parts", said)
    assert said == ["response 5 of 10", "response 9 of 10"]
    assert {name for name, _ in model.asked} == {f"damping:{number}" for number in range(4, 10)}
    assert list(found) == [one.name for one in effects]
    whole = made(Model(), effects, tmp_path / "other")
    for name, one in whole.items():
        assert np.array_equal(found[name].answers, one.answers)
    Parts(tmp_path / "parts").remove()
    assert Parts(tmp_path / "parts").known() == {}


def test_what_the_model_refuses_altogether_is_not_asked_again(tmp_path, monkeypatch):
    monkeypatch.setattr("rigdesign.base.parallel.cores", lambda: 1)
    one = effect("damping:a", DAMPING, -1.0, 1.0)
    assert made(Model(limit=0.0), [one], tmp_path / "parts") == {}
    model = Model()
    assert made(model, [one], tmp_path / "parts") == {}
    assert model.asked == []


def test_flanks_of_one_gearbox_are_run_in_one_process():
    """The same deviation of both gears of a mesh meets contacts that were solved before; all else runs by itself."""
    names = ("slope:test.pinion", "slope:test.wheel", "slope:other.pinion", "crowning:test.pinion")
    flanks = [effect(name, TOOTH, -1.0, 1.0) for name in names]
    others = [effect(name, DAMPING, -1.0, 1.0) for name in ("damping:test.a", "damping:test.b")]
    groups = {frozenset(one.name for one in group) for group in _together([*flanks, *others])}
    assert groups == {frozenset(names[:2]), *(frozenset([one.name]) for one in (*flanks[2:], *others))}
