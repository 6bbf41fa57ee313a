"""The report walks its list of sections: numbers, contents and cross references follow."""

import re
from dataclasses import replace

import pytest

from rigdesign.report.pages import report
from rigdesign.report.pages.report import environment, report_html
from rigdesign.report.sections import SECTIONS
from rigdesign.report.sections.section import ReportSection
from tests.builders.report import make_check, make_result


def test_every_section_has_its_template_and_a_place():
    ids = [section.id for section in SECTIONS]
    assert len(set(ids)) == len(ids)
    for section in SECTIONS:
        environment().get_template(section.template)
        assert bool(section.title) != bool(section.within)
        assert not section.within or section.within in ids[: ids.index(section.id)]


def test_a_new_section_is_numbered_listed_and_drawn(monkeypatch: pytest.MonkeyPatch):
    own = ReportSection(
        id="extra", title="An extra section", template="limits.html.j2",
        values=lambda result, draw: {}, applies=lambda result: bool(result.not_modelled),
    )  # fmt: skip
    late = replace(own, id="late", place="appendix")
    monkeypatch.setattr(report, "SECTIONS", (SECTIONS[0], own, *SECTIONS[1:], late))
    page = report_html(make_result())
    assert '<a href="#extra">1&ensp;An extra section</a>' in page
    assert '<h2 id="extra">1&ensp;An extra section</h2>' in page
    assert '<h2 id="verdict">2&ensp;' in page
    assert re.search(r'<h2 id="late">[A-Z]&ensp;An extra section</h2>', page)
    assert "An extra section" not in report_html(replace(make_result(), not_modelled=[]))


def test_a_check_of_a_new_group_is_in_the_report():
    check = make_check("lubrication.foam", 0.2, 0.1, title="foam on the oil", group="lubrication")
    result = make_result()
    page = report_html(replace(result, checks=[*result.checks, check]))
    assert "foam on the oil" in page
