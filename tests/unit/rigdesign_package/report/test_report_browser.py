"""The report as a browser draws and prints it."""

from dataclasses import replace
from pathlib import Path

import pytest

from rigdesign.report.pages.report import report_html
from rigdesign.results.result import Flip
from tests.builders.browser import Browser, browser
from tests.builders.report import make_check, make_result
from tests.builders.report_inputs import rig_inputs
from tests.builders.report_ranges import ranges

__all__ = ["browser"]

WIDTHS = (1280, 800, 390)
CUT = """
const view = document.documentElement.clientWidth, cut = [];
for (const used of document.querySelectorAll('.used')) {
  const bar = used.querySelector('.meter'), fill = bar.querySelector('i'), label = used.querySelector('span');
  for (const part of [bar, fill, label]) {
    const box = part.getBoundingClientRect();
    let left = 0, right = view;
    for (let up = part.parentElement; up; up = up.parentElement)
      if (getComputedStyle(up).overflowX !== 'visible') {
        const frame = up.getBoundingClientRect();
        left = Math.max(left, frame.left); right = Math.min(right, frame.right);
      }
    if (box.left < left - 1 || box.right > right + 1 || box.height < 1) cut.push(used.textContent);
  }
  const beyond = fill.getBoundingClientRect().right - bar.getBoundingClientRect().right;
  if (label.scrollWidth > label.clientWidth + 1 || beyond > 1) cut.push(used.textContent);
}
return cut;
"""
"""Labels of the bars of the checks that the page or a box with an edge cuts off."""


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    result = make_result(inputs=rig_inputs())
    path: Path = tmp_path_factory.mktemp("page") / "report.html"
    path.write_text(report_html(result), encoding="utf-8")
    return path


def test_page_is_drawn_without_a_request_or_an_error(browser: Browser, page: Path) -> None:
    browser.open(page)
    assert browser.find("main figure svg")
    assert browser.requests() == []
    assert browser.console() == []


def test_a_request_and_an_error_would_be_seen(browser: Browser, tmp_path: Path) -> None:
    bad = tmp_path / "bad.html"
    bad.write_text('<img src="http://127.0.0.1:9/x.png"><script>console.error("heard")</script>')
    browser.open(bad)
    browser.driver.execute_async_script("setTimeout(arguments[0], 200)")
    assert browser.requests() == ["http://127.0.0.1:9/x.png"]
    assert any("heard" in line for line in browser.console())


@pytest.mark.parametrize("width", WIDTHS)
def test_bars_are_whole_and_the_page_does_not_scroll_sideways(
    browser: Browser, page: Path, width: int
) -> None:
    browser.open(page, width=width)
    assert len(browser.find(".meter")) > 5
    assert browser.run(CUT) == []
    assert browser.overflow() <= 0


LEAST_TYPE = 7.5
"""Height of the smallest type of the schematic on a phone [CSS pixels]."""
SCROLLED = """
return [...document.querySelectorAll('.sheet *')].filter(e => e.scrollWidth > e.clientWidth + 1 && e.clientWidth
  && getComputedStyle(e).overflowX !== 'visible').map(e => e.outerHTML.slice(0, 80))
"""
"""Boxes of the first page that scroll sideways."""


def test_the_first_page_fits_a_phone_with_readable_type_in_the_schematic(
    browser: Browser, tmp_path: Path
) -> None:
    flip = Flip(
        path="schedule.test_torque", title="test torque", holds=False, stated="180 Nm", needed="99.31 Nm",
        check="specimen.root_stress", turns=True, effect="root stress of specimen test pinion holds",
    )  # fmt: skip
    page = tmp_path / "report.html"
    page.write_text(report_html(make_result(inputs=rig_inputs(), flips=[flip])), encoding="utf-8")
    browser.open(page, width=390)
    assert browser.run(SCROLLED) == []
    shown = [figure for figure in browser.find(".sheet figure") if figure.is_displayed()]
    assert len(shown) == 1 and "test gearbox" in shown[0].text.replace("\n", " ")
    scale = browser.run(
        "const svg = arguments[0].querySelector('svg'); return svg.clientWidth / svg.viewBox.baseVal.width",
        shown[0],
    )
    sizes = browser.run(
        "return [...arguments[0].querySelectorAll('text')].map(t => parseFloat(getComputedStyle(t).fontSize))",
        shown[0],
    )
    assert len(sizes) > 8 and scale * min(sizes) > LEAST_TYPE
    browser.resize(1280)
    shown = [figure for figure in browser.find(".sheet figure") if figure.is_displayed()]
    assert len(shown) == 1 and "test gearbox (specimen)" in shown[0].text


def test_a_cut_bar_would_be_seen(browser: Browser, page: Path) -> None:
    browser.open(page, width=390)
    browser.run("for (const e of document.querySelectorAll('table.checks')) e.style.minWidth = '900px'")
    assert browser.run(CUT)


def test_contents_lead_to_their_sections_at_the_width_of_a_phone(browser: Browser, page: Path) -> None:
    browser.open(page, width=390)
    browser.run("document.documentElement.style.scrollBehavior = 'auto'")
    links = browser.find("nav a")
    browser.run("arguments[0].click()", links[3])
    target = links[3].get_attribute("href").rpartition("#")[2]
    top = browser.run("return document.getElementById(arguments[0]).getBoundingClientRect().top", target)
    assert browser.run("return window.scrollY") > 0
    assert abs(top) < 2


def test_first_printed_page_is_the_decision_sheet_and_the_body_has_eight(
    browser: Browser, page: Path
) -> None:
    browser.open(page)
    pages = [" ".join(text.split()) for text in browser.print_pages()]
    first = pages[0]
    for text in (
        "FAIL",
        "Why",
        "Inputs that would turn a failing check",
        "The rig",
        "prepared",
        "checked",
        "approved",
    ):
        assert text in first, text
    assert "Checks and margins" not in first
    assert "Checks and margins" in pages[1]
    assert "approved" not in pages[1]
    appendix = next(
        number for number, text in enumerate(pages) if number > 1 and "Basis of the checks" in text
    )
    assert appendix <= 8
    assert f"page 2 of {len(pages)}" in pages[1]
    assert pages[1].startswith("uhcf_prototype – fail")


def test_checks_that_do_not_apply_are_folded_on_the_screen_and_printed(browser: Browser, page: Path) -> None:
    browser.open(page)
    assert not browser.run("return document.querySelector('details.lists').open")
    printed = " ".join(" ".join(browser.print_pages()).split())
    assert "no coupling is fitted" in printed


def test_a_long_report_keeps_its_first_page(browser: Browser, tmp_path: Path) -> None:
    """Eight failing checks with long titles: the first page names five and the signatures stay on it."""
    many = [
        make_check(
            f"strength.x{n}", 9.0, 1.0 + n, title=f"safety of a part with a rather long name, place {n}"
        )
        for n in range(8)
    ]
    path = tmp_path / "long.html"
    result = replace(make_result(inputs=rig_inputs()), checks=many, ranges=ranges())
    path.write_text(report_html(result), encoding="utf-8")
    browser.open(path)
    pages = browser.print_pages()
    assert "holds from about 160 N m" in pages[0]
    assert "approved" in pages[0]
    assert "Checks and margins" in pages[1]
