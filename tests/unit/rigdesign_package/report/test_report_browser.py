"""The report as a browser draws and prints it."""

from pathlib import Path

import pytest

from rigdesign.report.pages.report import report_html
from tests.builders.browser import Browser, browser
from tests.builders.report import make_result

__all__ = ["browser"]


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path: Path = tmp_path_factory.mktemp("page") / "report.html"
    path.write_text(report_html(make_result()), encoding="utf-8")
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
