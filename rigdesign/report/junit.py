"""junit.xml: one testcase per check, so that any CI server shows the verdicts.

The time of a testcase is its part of the run: the seconds of every part of the run (``timings_s``) are shared out
evenly among the checks that use it, so that the testcases together last as long as the run. Checks that do not apply
take none. Times differ from run to run as ``timings_s`` does; all else is the same.
"""

import re
from collections.abc import Mapping, Sequence
from itertools import groupby
from pathlib import Path

from rigdesign.report.numbers import limit_text, margin_text, value_text
from rigdesign.results.check import Check
from rigdesign.results.result import RunResult

NOT_XML = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""Characters that XML 1.0 cannot hold."""
OF_LOADS = frozenset({"dynamics", "specimen", "bought parts"})
OF_HOUSINGS = frozenset({"temperatures", "clearances", "bearings", "oil", "alignment"})
GROUPS_OF_PARTS: Mapping[str, frozenset[str]] = {
    "dynamics": OF_LOADS,
    "load_errors": OF_LOADS,
    "discretisation": OF_HOUSINGS,
    "alternatives": OF_HOUSINGS,
    "transient": frozenset({"transient"}),
}
"""Part of the run -> groups of the checks that use it; every other part serves all checks."""


def write_junit(result: RunResult, path: Path) -> None:
    """Write junit.xml: a suite per group of checks.

    fail -> failure with value, limit and margin; open -> error with the reason; an advisory limit that is missed and
    not applicable -> skipped with the reason; pass -> passed, its flags in system-out.
    """
    from junitparser import JUnitXml, TestSuite

    seconds = check_seconds(result.checks, result.timings_s)
    document = JUnitXml(f"rigdesign {_clean(result.case['name'])}")
    for group, checks in groupby(sorted(result.checks, key=lambda item: item.group), lambda item: item.group):
        suite = TestSuite(_clean(group) or "checks")
        for check in checks:
            suite.add_testcase(_testcase(check, result.case["name"], seconds[check.id]))
        document.add_testsuite(suite)
    document.update_statistics()  # type: ignore[no-untyped-call]
    document.write(str(path), pretty=True)


def check_seconds(checks: Sequence[Check], timings: Mapping[str, float]) -> dict[str, float]:
    """Seconds of the run by id of the check, together those of all parts; 0 for checks that do not apply."""
    seconds = {check.id: 0.0 for check in checks}
    applied = [check for check in checks if check.verdict != "not applicable"] or list(checks)
    for part, whole in timings.items():
        groups = GROUPS_OF_PARTS.get(part)
        sharing = [check for check in applied if groups is None or check.group in groups] or applied
        for check in sharing:
            seconds[check.id] += whole / len(sharing)
    return seconds


def _testcase(check: Check, case: str, seconds: float):  # type: ignore[no-untyped-def]  # junitparser has no types
    from junitparser import Error, Failure, Skipped, TestCase

    classname = _clean(f"{case}.{check.group or 'checks'}")
    testcase = TestCase(_clean(check.id), classname=classname, time=round(seconds, 3))
    summary = _clean(check_summary(check))
    if check.status in ("fail", "open"):
        kind, what = (Failure, "limit exceeded") if check.status == "fail" else (Error, "not judged")
        failure = kind(summary, type_=what)
        failure.text = _clean(f"{check.reason}\nsource: {check.source}\nrole: {check.role}".strip())
        testcase.result = [failure]
    elif check.status == "advisory":
        testcase.result = [Skipped(f"advisory limit missed: {summary}")]
    elif check.status == "not applicable":
        testcase.result = [Skipped(_clean(check.reason) or "not applicable")]
    else:
        flags = [f"{flag}: {check.reason}" for flag in check.flags]
        testcase.system_out = _clean("\n".join([*flags, summary]))
    return testcase


def check_summary(check: Check) -> str:
    """One line: title, value, limit, margin, distance."""
    value = value_text(check)
    parts = [f"{check.title}: {value}, limit {limit_text(check)}"]
    if check.margin is not None:
        parts.append(f"margin {margin_text(check)}")
    if check.distance is not None:
        parts.append(f"distance {100 * check.distance:.0f} %")
    return ", ".join(parts)


def _clean(text: str) -> str:
    return NOT_XML.sub("\N{REPLACEMENT CHARACTER}", text)
