"""A run that records which of the numbers stated by its case it reads."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import pytest

import rigdesign.run.main
from rigdesign.base.fidelity import Fidelity
from rigdesign.case.fields import Part
from rigdesign.case.model import Case
from rigdesign.case.usual import stated_numbers
from rigdesign.results.result import RunResult

AUDITS = ("unusual_inputs", "without_effect")
"""Of the inputs themselves: they read every number."""


def recorded_run(case: Case, fidelity: Fidelity) -> tuple[RunResult, tuple[str, ...]]:
    """Result, and paths of the stated numbers that nothing read from the build of the rig to the result."""
    read, recording = set[tuple[int, str]](), True
    plain = Part.__getattribute__

    def recorded(part: Part, key: str) -> Any:
        if recording and key in type(part).__pydantic_fields__:
            read.add((id(part), key))
        return plain(part, key)

    def unrecorded(audit: Callable[..., Any]) -> Callable[..., Any]:
        def audited(*arguments: Any) -> Any:
            nonlocal recording
            recording = False
            try:
                return audit(*arguments)
            finally:
                recording = True

        return audited

    parts = dict(_parts(case, ""))
    with pytest.MonkeyPatch.context() as patch:
        for name in AUDITS:
            patch.setattr(rigdesign.run.main, name, unrecorded(getattr(rigdesign.run.main, name)))
        patch.setattr(Part, "__getattribute__", recorded)
        result = rigdesign.run.main.run_case(case, fidelity)
    assert len(read) > 300
    keys = {path: path.rpartition(".") for path in stated_numbers(case)}
    return result, tuple(
        path
        for path, (owner, _, key) in keys.items()
        if owner in parts and (id(parts[owner]), key) not in read
    )


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
