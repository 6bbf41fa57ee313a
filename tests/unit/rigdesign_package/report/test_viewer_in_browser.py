"""The turnable picture as Chromium draws it: it turns, is cut, answers keys, and asks for nothing."""

import io
import time
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image
from selenium.webdriver import ActionChains, Keys
from selenium.webdriver.support.select import Select

from rigdesign.report.pages.report import report_html
from tests.builders.browser import browser
from tests.builders.report import gearbox_field, make_result

__all__ = ["browser"]

LONGEST = 90.0
"""Seconds for a picture without a graphics card."""
CHANGED = 0.005
"""Share of the pixels from which a picture counts as another one; two of the same state do not differ at all."""
UNTOUCHED = "GL Driver Message"
"""What Chromium says of its own software renderer when a picture is read back."""


class ViewerPage:
    """The report with its turnable picture in sight."""

    def __init__(self, window, page):
        self.window = window
        window.open(page, width=1280, height=1000)
        window.run("document.getElementById('viewer').scrollIntoView()")
        self.frames(1)

    def frames(self, least):
        """Wait until so many pictures were drawn."""
        until = time.monotonic() + LONGEST
        while (found := self._frame()) < least:
            assert time.monotonic() < until, (found, least, self.window.console())
            time.sleep(0.05)
        return found

    def _frame(self):
        return int(self.window.run("return document.getElementById('viewer').dataset.frame || 0"))

    def part(self, name):
        return self.window.find(f'#viewer [data-part="{name}"]')[0]

    def picture(self):
        """(height, width, 3) numbers 0 to 255 of the plot area, once two in a row are the same."""
        before = self._shot()
        for _ in range(40):
            time.sleep(0.15)
            after = self._shot()
            if np.array_equal(before, after):
                return after
            before = after
        raise AssertionError("the picture does not come to rest")

    def _shot(self):
        return np.asarray(
            Image.open(io.BytesIO(self.part("plot").screenshot_as_png)).convert("RGB"), dtype=int
        )

    def after(self, change):
        """The picture after a change that draws anew."""
        frame = self._frame()
        change()
        self.frames(frame + 1)
        return self.picture()

    def other_than(self, picture):
        """The picture once it has changed: a drag turns it without a call of the page's own."""
        until = time.monotonic() + LONGEST
        while moved(picture, found := self.picture()) <= CHANGED:
            assert time.monotonic() < until, self.window.console()
        return found


@pytest.fixture(scope="module")
def page(browser, tmp_path_factory):
    path = tmp_path_factory.mktemp("viewer") / "report.html"
    field = gearbox_field()
    cooler = replace(field, stage="run_up", temperature=0.5 * (field.temperature + 300.0))
    path.write_text(report_html(make_result(fields=[field, cooler])), encoding="utf-8")
    return ViewerPage(browser, path)


def moved(first, second):
    """Share of the pixels that differ plainly."""
    return float((np.abs(first - second).max(axis=2) > 24).mean())


def test_it_is_drawn_turned_cut_and_deformed(page):
    start = page.picture()
    colours = {tuple(pixel) for pixel in (start[::4, ::4] // 16).reshape(-1, 3).tolist()}
    assert len(colours) > 60
    assert float((start.min(axis=2) < 200).mean()) > 0.1

    plot = page.part("plot")
    drag = ActionChains(page.window.driver).move_to_element(plot).click_and_hold().move_by_offset(160, 0)
    drag.release().perform()
    turned = page.other_than(start)

    page.after(lambda: page.window.run("document.querySelector('[data-view=start]').click()"))
    keyed = page.after(lambda: plot.send_keys(Keys.ARROW_LEFT))
    assert moved(turned, keyed) > CHANGED

    higher = page.after(
        lambda: page.window.run(
            "const s = arguments[0]; s.value = Number(s.value) - 60; s.dispatchEvent(new Event('input'))",
            page.part("position"),
        )
    )
    assert moved(keyed, higher) > CHANGED
    uncut = page.after(lambda: Select(page.part("axis")).select_by_value(""))
    assert moved(higher, uncut) > CHANGED
    assert not page.part("position").is_enabled()
    assert "no cut" in page.part("words").text

    shape = Select(page.part("factor"))
    factor = shape.options[3].get_attribute("value")
    deformed = page.after(lambda: shape.select_by_index(3))
    assert moved(uncut, deformed) > CHANGED
    assert f"displacement drawn {factor} times as large" in page.part("words").text
    coloured = page.after(lambda: Select(page.part("quantity")).select_by_value("displacement"))
    assert moved(deformed, coloured) > CHANGED

    boxes = page.part("bodies").find_elements("css selector", "label")
    assert [box.text for box in boxes] == ["housing", "clamping field", "shaft pinion", "shaft wheel"]
    shafts = page.after(boxes[0].click)
    assert moved(coloured, shafts) > CHANGED
    page.after(boxes[0].click)

    again = page.after(lambda: page.window.run("document.querySelector('[data-view=top]').click()"))
    assert moved(coloured, again) > CHANGED


def test_the_other_stage_and_the_other_side_of_the_cut_are_drawn(page):
    page.after(lambda: page.window.run("document.querySelector('[data-view=start]').click()"))
    stages = Select(page.part("field"))
    assert [option.text for option in stages.options] == [
        "gearbox test, stage dwell", "gearbox test, stage run up",
    ]  # fmt: skip
    assert stages.first_selected_option.text.endswith("dwell")
    first = page.after(lambda: Select(page.part("axis")).select_by_value("y"))
    second = page.after(lambda: stages.select_by_index(1))
    assert moved(first, second) > CHANGED
    assert page.part("words").text.startswith("Gearbox test, stage run up: shape as drawn; cut at y = ")
    assert moved(second, page.after(page.part("side").click)) > CHANGED


def test_the_cut_runs_over_what_is_shown_and_leaves_something_at_both_ends(page):
    """The clamping field, hidden at first, and bodies that are switched off do not count."""
    page.after(lambda: page.window.run("document.querySelector('[data-view=start]').click()"))
    boxes = page.part("bodies").find_elements("css selector", "label")
    assert not boxes[1].find_element("css selector", "input").is_selected()
    slide = (
        "const [s, end] = arguments; s.value = s[end]; s.dispatchEvent(new Event('input')); "
        "return [Number(s.min), Number(s.max)]"
    )
    spans = {}
    for axis in "xyz":
        page.after(lambda: Select(page.part("axis")).select_by_value(axis))  # noqa: B023
        for end in ("min", "max"):
            shot = page.after(
                lambda: spans.update({axis: page.window.run(slide, page.part("position"), end)})  # noqa: B023
            )
            assert float((np.ptp(shot, axis=2) > 40).mean()) > 0.002, (axis, end, spans[axis])
    page.after(boxes[0].click)
    shafts = page.window.run(slide, page.part("position"), "max")
    assert spans["z"][0] < shafts[0] < shafts[1] < spans["z"][1]
    page.after(boxes[0].click)


def test_it_asks_for_nothing_and_complains_of_nothing(page):
    assert page.window.requests() == []
    assert [line for line in page.window.console() if UNTOUCHED not in line] == []


def test_the_pointer_names_surface_and_temperature(page):
    page.after(lambda: page.window.run("document.querySelector('[data-view=start]').click()"))
    plot = page.part("plot")
    told = ""
    for right, down in ((0, 0), (-30, 40), (40, 30), (-60, 20), (60, -10), (0, 60)):
        ActionChains(page.window.driver).move_to_element_with_offset(plot, right, down).perform()
        time.sleep(0.3)
        told = page.window.run("return document.querySelector('#viewer .hoverlayer')?.textContent || ''")
        told += page.window.run(
            "return [...document.querySelectorAll('#viewer .hovertext')].map((t) => t.textContent).join()"
        )
        if told:
            break
    assert "°C" in told
    assert "µm" in told


def test_every_control_has_a_name_and_is_reached_by_keyboard(page):
    controls = page.window.find("#viewer select, #viewer input, #viewer button, #viewer [tabindex]")
    assert len(controls) > 15
    for control in controls:
        assert control.accessible_name.strip(), control.get_attribute("outerHTML")
        assert int(control.get_attribute("tabIndex")) >= 0


def test_the_still_picture_stands_in_print_and_without_webgl(browser, tmp_path):
    text = report_html(make_result(dynamics=None))
    path = tmp_path / "report.html"
    blind = '<script>HTMLCanvasElement.prototype.getContext = () => null;</script><div id="viewer">'
    path.write_text(text.replace('<div id="viewer">', blind, 1), encoding="utf-8")
    browser.open(path)
    browser.run("document.getElementById('viewer').scrollIntoView()")
    until = time.monotonic() + LONGEST
    while not browser.find("#viewer [data-part=missing]")[0].is_displayed():
        assert time.monotonic() < until
        time.sleep(0.05)
    assert browser.find("#viewer .still svg")[0].is_displayed()
    assert not browser.find("#viewer .panel")[0].is_displayed()
    path.write_text(text, encoding="utf-8")
    page = ViewerPage(browser, path)
    assert not browser.find("#viewer .still svg")[0].is_displayed()
    browser.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    try:
        assert browser.find("#viewer .still svg")[0].is_displayed()
        assert not page.part("plot").is_displayed()
    finally:
        browser.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
