"""Faults that follow from others: of values that the tool itself filled in, or could not."""

from collections.abc import Sequence
from dataclasses import replace

from rigdesign.base.errors import Fault
from rigdesign.case.defaults.fill import rules
from rigdesign.case.defaults.rule import BY_THE_TOOL
from rigdesign.case.paths import path_pattern
from rigdesign.case.provenance import Mark

NOT_WORKED_OUT = "left out, and the rest of the case does not say what its default is"


def causes_first(faults: Sequence[Fault], marks: Sequence[Mark], missing: str) -> list[Fault]:
    """Faults of what the case states, then keys without a default; defaults that are themselves wrong come last.

    Parameters
    ----------
    faults : of a case with its defaults
    marks : of all its values, those filled in by the tool among them
    missing : problem of a key that is missing

    Returns
    -------
    faults : a wrong default is left out where there are other faults: it follows from them
    """
    filled = {mark.path for mark in marks if (mark.assumed or mark.source or "").startswith(BY_THE_TOOL)}
    patterns = [path_pattern(rule.path) for rule in rules()]
    stated: list[Fault] = []
    unknown: list[Fault] = []
    wrong_defaults: list[Fault] = []
    for fault in faults:
        path = fault.path.partition(" ")[0]
        if path in filled:
            wrong_defaults.append(fault)
        elif fault.problem == missing and any(pattern.fullmatch(path) for pattern in patterns):
            unknown.append(fault)
        else:
            stated.append(fault)
    if stated and unknown:
        named = ", ".join(fault.path for fault in unknown)
        unknown = [
            Fault("", "", f"{NOT_WORKED_OUT}: {named}", "correct the faults above first, or add these keys")
        ]
    else:
        unknown = [replace(fault, problem=NOT_WORKED_OUT) for fault in unknown]
    return [*stated, *unknown] or wrong_defaults
