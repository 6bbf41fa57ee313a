"""Mutants of the shipped case at the loader.

Whatever is changed, loading ends in a case or in a CaseError that names a path; most mutants stay computable.
"""

from itertools import islice

import pytest

from rigdesign.base.errors import CaseError
from rigdesign.case import Case, load_case
from tests.builders.mutant import mutations
from tests.builders.paths import CASES

PROTOTYPE = CASES / "uhcf_prototype"
MUTANTS = 75


@pytest.mark.parametrize("seed", [1, 2])
def test_mutants_load_or_say_what_is_wrong(seed: int) -> None:
    case: Case = load_case(PROTOTYPE)
    loaded = 0
    for path, value in islice(mutations(case, seed), MUTANTS):
        try:
            mutant = case.with_value(path, value)
        except CaseError as error:
            assert error.faults, path
            assert all(fault.problem and fault.remedy for fault in error.faults), path
        else:
            assert len(mutant.hash) == 64
            loaded += 1
    assert loaded >= MUTANTS / 2
