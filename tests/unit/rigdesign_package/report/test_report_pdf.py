"""report.pdf: the same pages by WeasyPrint, and what happens where it is missing."""

import importlib
from datetime import date
from pathlib import Path

import pytest
from pypdf import PdfReader

from rigdesign.base.errors import MissingLibraryError
from rigdesign.report.input_sheets import Issue
from rigdesign.report.pdf import require_pdf, write_pdf
from rigdesign.report.writing import write_results
from tests.builders.report import make_result
from tests.builders.report_inputs import rig_inputs


def test_report_as_pdf_has_its_first_page_running_title_and_page_numbers(tmp_path: Path) -> None:
    write_results(make_result(inputs=rig_inputs()), tmp_path / "out", Issue(date=date(2026, 1, 2)), pdf=True)
    pages = [
        " ".join(page.extract_text().split()) for page in PdfReader(tmp_path / "out" / "report.pdf").pages
    ]
    assert "approved" in pages[0]
    assert "Checks and margins" not in pages[0]
    appendix = next(
        number for number, text in enumerate(pages) if number > 1 and "Basis of the checks" in text
    )
    assert appendix <= 8
    for number, text in enumerate(pages, start=1):
        assert f"page {number} of {len(pages)}" in text
        assert "uhcf_prototype – fail" in text
        assert "9c9c9c9c9c9c" in text
        assert "2026-01-02" in text


def test_a_page_fetches_nothing(tmp_path: Path) -> None:
    write_pdf(
        '<p>text</p><img src="file:///etc/hostname"><img src="http://127.0.0.1:9/x.png">', tmp_path / "x.pdf"
    )
    assert PdfReader(tmp_path / "x.pdf").pages[0].extract_text().strip() == "text"


@pytest.mark.parametrize("error", [ImportError("no module"), OSError("cannot load library 'libpango-1.0-0'")])
def test_a_missing_library_is_named_with_both_commands(
    monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    def missing(name: str) -> object:
        raise error

    monkeypatch.setattr(importlib, "import_module", missing)
    with pytest.raises(
        MissingLibraryError, match=r"pip install 'rigdesign\[pdf\]'.*apt-get install.*libpango"
    ):
        require_pdf()


def test_every_word_of_the_printed_report_can_be_read(tmp_path: Path) -> None:
    """Body and figures at 6.5 pt or more as printed; indices and exponents of one or two signs are smaller."""
    write_results(make_result(inputs=rig_inputs()), tmp_path, Issue(date=date(2026, 1, 2)), pdf=True)
    small: list[tuple[float, str]] = []

    def visit(text: str, cm: list[float], tm: list[float], font: object, size: float) -> None:
        scale = abs((cm[0] * cm[3] - cm[1] * cm[2]) * (tm[0] * tm[3] - tm[1] * tm[2])) ** 0.5
        if len(text.strip()) > 2 and size * scale < 6.45:
            small.append((round(size * scale, 2), text.strip()))

    reader = PdfReader(tmp_path / "report.pdf")
    for page in reader.pages:
        page.extract_text(visitor_text=visit)
    assert not small, small[:20]
    assert len(reader.pages) < 30
