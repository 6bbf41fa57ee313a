"""junit.xml: one testcase per check, so that any CI server shows the verdicts."""

import re
from itertools import groupby
from pathlib import Path

from rigdesign.report.numbers import limit_text, margin_text, quantity_text
from rigdesign.results.check import Check
from rigdesign.results.result import RunResult

NOT_XML = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""Characters that XML 1.0 cannot hold."""


def write_junit(result: RunResult, path: Path) -> None:
    """Write junit.xml: a suite per group of checks.

    fail -> failure with value, limit and margin; warn -> passed, the reason in system-out; not applicable ->
    skipped with the reason. No times: two runs give the same file.
    """
    from junitparser import JUnitXml, TestSuite

    document = JUnitXml(f"rigdesign {_clean(result.case['name'])}")
    for group, checks in groupby(sorted(result.checks, key=lambda item: item.group), lambda item: item.group):
        suite = TestSuite(_clean(group) or "checks")
        for check in checks:
            suite.add_testcase(_testcase(check, result.case["name"]))
        document.add_testsuite(suite)
    document.update_statistics()  # type: ignore[no-untyped-call]
    document.write(str(path), pretty=True)


def _testcase(check: Check, case: str):  # type: ignore[no-untyped-def]  # junitparser has no types
    from junitparser import Failure, Skipped, TestCase

    testcase = TestCase(_clean(check.id), classname=_clean(f"{case}.{check.group or 'checks'}"))
    summary = _clean(check_summary(check))
    if check.verdict == "fail":
        failure = Failure(summary, type_="limit exceeded")
        failure.text = _clean(f"{check.reason}\nsource: {check.source}\nrole: {check.role}".strip())
        testcase.result = [failure]
    elif check.verdict == "not applicable":
        testcase.result = [Skipped(_clean(check.reason) or "not applicable")]
    else:
        lines = [summary]
        if check.verdict == "warn":
            lines.insert(0, f"warning: {check.reason}")
        testcase.system_out = _clean("\n".join(lines))
    return testcase


def check_summary(check: Check) -> str:
    """One line: title, value, limit, margin, utilisation."""
    value = quantity_text(check.value, check.unit)
    parts = [f"{check.title}: {value}, limit {limit_text(check)}"]
    if check.margin is not None:
        parts.append(f"margin {margin_text(check)}")
    if check.utilisation is not None:
        parts.append(f"utilisation {100 * check.utilisation:.0f} %")
    return ", ".join(parts)


def _clean(text: str) -> str:
    return NOT_XML.sub("\N{REPLACEMENT CHARACTER}", text)
