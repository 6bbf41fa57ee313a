"""Pages as Debian's Chromium shows them: ``from tests.builders.browser import browser`` in a test module.

    apt-get install -y --no-install-recommends chromium chromium-driver

A machine without them fails the tests that need them: a page nobody has drawn is not tested.
"""

import base64
import io
import json
import unicodedata
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from pypdf import PdfReader
from selenium.common.exceptions import WebDriverException
from selenium.webdriver import Chrome, ChromeOptions
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.remote.webelement import WebElement
from selenium.webdriver.support.wait import WebDriverWait

CHROMIUM, DRIVER = Path("/usr/bin/chromium"), Path("/usr/bin/chromedriver")
MISSING = "no {path}; run: apt-get install -y --no-install-recommends chromium chromium-driver"
ARGUMENTS = (
    "--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars", "--force-device-scale-factor=1",
    "--enable-unsafe-swiftshader", "--disable-background-networking", "--disable-component-update", "--no-first-run",
)  # fmt: skip
OWN = ("file:", "data:", "blob:", "about:")
"""Addresses that need no network."""
A4 = {"paperWidth": 8.27, "paperHeight": 11.69, "printBackground": True, "preferCSSPageSize": True}

LOAD_TIME = 60.0
"""Seconds a page may take to load; on a busy machine ``get`` has returned before a long page was parsed."""


@dataclass
class Browser:
    """One Chromium window; a test opens its page in it."""

    driver: Chrome

    def open(self, page: Path, *, width: int = 1280, height: int = 900) -> None:
        """Load a file at a viewport of ``width`` x ``height`` CSS pixels; what earlier pages logged is forgotten."""
        self.driver.get_log("performance")
        self.driver.get_log("browser")
        self.resize(width, height)
        self.driver.get(page.resolve().as_uri())
        WebDriverWait(self.driver, LOAD_TIME).until(
            lambda driver: self.run("return document.readyState") == "complete"
        )

    def resize(self, width: int, height: int = 900) -> None:
        """The viewport itself, also below the least width of a window."""
        self.driver.execute_cdp_cmd(
            "Emulation.setDeviceMetricsOverride",
            {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600},
        )

    def run(self, script: str, *arguments: Any) -> Any:
        """What a script returns."""
        return self.driver.execute_script(script, *arguments)

    def find(self, selector: str) -> Sequence[WebElement]:
        """All elements of a CSS selector."""
        return self.driver.find_elements(By.CSS_SELECTOR, selector)

    def console(self) -> list[str]:
        """Errors and warnings of the console since the page was opened."""
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def requests(self) -> list[str]:
        """Addresses beyond the page itself that it asked for since it was opened."""
        messages = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        asked = [
            m["params"]["request"]["url"] for m in messages if m["method"] == "Network.requestWillBeSent"
        ]
        return [address for address in asked if not address.startswith(OWN)]

    def print_pages(self) -> list[str]:
        """Text of every page as printed on A4; ligatures of the font as letters."""
        pages = PdfReader(io.BytesIO(self.print_pdf())).pages
        return [unicodedata.normalize("NFKC", page.extract_text()) for page in pages]

    def print_pdf(self) -> bytes:
        """The page as printed on A4, a PDF document."""
        return base64.b64decode(self.driver.execute_cdp_cmd("Page.printToPDF", A4)["data"])

    def overflow(self) -> int:
        """By how many pixels the page can be scrolled sideways."""
        return int(
            self.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
        )

    def screenshot(self, path: Path, *, height: int | None = None) -> None:
        """What is in the window, or the first ``height`` pixels of the page."""
        if height is not None:
            self.resize(int(self.run("return window.innerWidth")), height)
        path.write_bytes(self.driver.get_screenshot_as_png())


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """One Chromium for all tests of a process."""
    for path in (CHROMIUM, DRIVER):
        if not path.exists():
            pytest.fail(MISSING.format(path=path))
    window = Browser(started())
    yield window
    window.driver.quit()


def started() -> Chrome:
    """A headless Chromium that keeps a log of its requests and its console."""
    options = ChromeOptions()
    options.binary_location = str(CHROMIUM)
    for argument in ARGUMENTS:
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"performance": "ALL", "browser": "ALL"})
    try:
        return Chrome(options=options, service=Service(str(DRIVER)))
    except WebDriverException as error:
        pytest.fail(f"Chromium does not start: {error.msg}")
