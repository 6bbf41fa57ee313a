"""Time of the report, all figures included; printed, never a reason to fail."""

import time

import pytest

from rigdesign.report.pages.report import report_html
from tests.builders.report import make_result


@pytest.mark.performance
def test_report_time():
    result = make_result()
    times = []
    for _ in range(3):
        start = time.process_time()
        report_html(result)
        times.append(time.process_time() - start)
    print(f"report: {times[0]:.2f} s with matplotlib's import, {min(times):.2f} s after (CPU); goal 4 s")
