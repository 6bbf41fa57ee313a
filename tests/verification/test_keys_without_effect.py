"""Every number that a case states is read by the run, or the run says that it has no effect."""

from collections.abc import Iterator, Mapping
from fnmatch import fnmatchcase
from typing import Any

import pytest

import rigdesign.run.main
from rigdesign.case.fields import Part
from rigdesign.case.loader import load_case
from rigdesign.case.usual import stated_numbers
from tests.builders.paths import CASES

NOT_AT_QUICK = (
    "schema_version",  # read by the loader
    "numerics.curve_speeds",  # set by the fidelity
    "gearboxes.*.seals.*.radial_gap",  # orbits in their gap need shafts that bend
    "gearboxes.*.bearings.*.radial_*",  # lateral coefficients as well
)


@pytest.mark.parametrize("name", ["fzg", "loop_1to1", "uhcf_prototype"])
def test_a_number_is_read_or_said_to_have_no_effect(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Reads are recorded from the build of the rig to the result, without those of the audits of the inputs."""
    case, read = load_case(CASES / name), set[tuple[int, str]]()
    numbers, parts = stated_numbers(case), dict(_parts(case, ""))
    plain = Part.__getattribute__

    def recorded(part: Part, key: str) -> Any:
        if key in type(part).__pydantic_fields__:
            read.add((id(part), key))
        return plain(part, key)

    for audit in ("unusual_inputs", "without_effect"):
        monkeypatch.setattr(rigdesign.run.main, audit, lambda *_: {})
    with monkeypatch.context() as patch:
        patch.setattr(Part, "__getattribute__", recorded)
        result = rigdesign.run.main.run_case(case, "quick")
    monkeypatch.undo()
    findings = rigdesign.run.main.without_effect(case, result.checks)
    said = [path for finding in findings for path in finding.text.partition("depends on ")[2].split(", ")]
    keys = {path: path.rpartition(".") for path in numbers}
    idle = [
        path
        for path, (owner, _, key) in keys.items()
        if owner in parts and (id(parts[owner]), key) not in read
    ]
    unsaid = [
        path
        for path in idle
        if not any(fnmatchcase(path, pattern) for pattern in NOT_AT_QUICK)
        and not any(fnmatchcase(path, pattern) for pattern in said)
    ]
    assert len(read) > 300
    assert unsaid == []


def _parts(node: Any, path: str) -> Iterator[tuple[str, Part]]:
    below = f"{path}." if path else ""
    if isinstance(node, Part):
        yield path, node
        for key in type(node).model_fields:
            yield from _parts(getattr(node, key), below + key)
    elif isinstance(node, Mapping):
        for key, item in node.items():
            yield from _parts(item, below + key)
    elif isinstance(node, tuple):
        for number, item in enumerate(node):
            yield from _parts(item, f"{below}{getattr(item, 'name', number)}")
