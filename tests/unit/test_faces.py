"""Each package has a face with the names an engineer types, and an example that runs."""

import doctest
import importlib

import pytest

FACES = (
    "dynamics.gear",
    "dynamics.tooth",
    "dynamics.rotor",
    "dynamics.vibration",
    "dynamics.losses",
    "thermal",
)
"""In the order in which their examples build on each other."""


def test_the_examples_run_one_after_the_other() -> None:
    names: dict[str, object] = {}
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
    for face in FACES:
        module = importlib.import_module(face)
        test = doctest.DocTestParser().get_doctest(module.__doc__ or "", names, face, module.__file__, 0)
        assert test.examples
        runner.run(test, clear_globs=False)
        names.update(test.globs)
    assert runner.summarize().failed == 0


@pytest.mark.parametrize("face", FACES)
def test_every_name_of_a_face_is_there(face: str) -> None:
    module = importlib.import_module(face)
    assert 5 <= len(module.__all__) <= 20
    for name in module.__all__:
        assert callable(getattr(module, name)) or isinstance(getattr(module, name), type), name
    with pytest.raises(AttributeError, match="nothing"):
        _ = module.nothing
