"""validation.html: what missed comes first, deviations over what is allowed, drawn whole in Chromium."""

import math

import pytest

from rigdesign.report.figures.validation import published_number, share_of_tolerance
from rigdesign.report.pages.validation import source_name, write_validation
from tests.builders.browser import browser  # noqa: F401 - a fixture
from tests.published.rows import Gate, Goal, PublishedQuantity, Window, compare, not_modelled


def row(
    computed, criterion=None, *, basis="predicted", value=2.0, identity="x", source="P2, Table 2", **given
):
    published = PublishedQuantity(
        id=identity, text=f"quantity <{identity}>", source=source, unit="mm", value=value
    )
    return compare(published, computed, basis, criterion, **given)


@pytest.mark.parametrize(
    ("found", "share"),
    [
        (row(2.1, Gate(0.1)), 0.5),
        (row(1.6, Goal(0.1)), -2.0),
        (row(2.0, Gate(0.0)), 0.0),
        (row(2.2), None),
        (row(5.0, Window(4.0, 8.0)), -0.5),
        (row(8.0, Window(4.0, 8.0)), 1.0),
        (row(10.0, Window(4.0, 8.0)), 2.0),
        (row(0.6, Window(0.3, math.inf)), -0.5),
        (row(0.15, Window(0.3, math.inf)), -2.0),
        (row(0.15, Window(-math.inf, 0.3)), 0.5),
        (row(0.6, Window(-math.inf, 0.3)), 2.0),
    ],
)
def test_share_of_what_is_allowed(found, share):
    assert share_of_tolerance(found) == (None if share is None else pytest.approx(share))


@pytest.mark.parametrize(
    ("computed", "criterion"),
    [(-0.1, Window(0.0, math.inf)), (-2.0, Window(1.0, math.inf)), (2.0, Window(-math.inf, -1.0)),
     (2.1, Gate(0.0)), (0.5, Window(-math.inf, 0.0))],
)  # fmt: skip
def test_what_misses_its_limit_stands_beyond_it(computed, criterion):
    found = row(computed, criterion)
    assert found.verdict == "gate missed" and abs(share_of_tolerance(found)) > 1.0


def test_a_published_range_is_drawn_at_its_nearer_end():
    assert published_number(row(5.0, value=(2.0, 3.0))) == 3.0
    assert published_number(row(2.5, value=(2.0, 3.0))) == 2.5


@pytest.mark.parametrize(
    ("source", "name"),
    [("P2, Table 2", "P2"), ("ISO 6336-3:2006, clause 5", "ISO 6336-3"), ("", "no source")],
)
def test_the_document_of_a_source(source, name):
    assert source_name(row(1.0, source=source)) == name


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    out = tmp_path_factory.mktemp("validation")
    waiting = PublishedQuantity(
        id="P1-later", text="words only", source="P1, Figure 7", unit="1", printed="rises"
    )
    rows = [
        row(
            2.0 + 0.01 * n,
            Gate(0.1),
            identity=f"V-{n}",
            basis="verification",
            source="NAFEMS, T2",
            value=2.0 + 0.015 * n,
        )
        for n in range(30)
    ]
    rows += [
        row(2.1, Goal(0.1), identity="P2-met"),
        row(40.0, Goal(0.1), identity="P2-missed", assumptions="mesh damping 300 N s/m", free_parameters=2),
        row(3.0, Gate(0.1), identity="P2-broken", basis="fitted"),
        row(0.6, Window(0.3, math.inf), identity="P2-open", basis="arithmetic"),
        row(2.3, identity="P2-shown", basis="input"),
        not_modelled(waiting, "predicted", reason="no case of that rig"),
    ]  # fmt: skip
    write_validation(rows, out)
    return out / "validation.html"


@pytest.mark.parametrize("width", [1280, 390])
def test_the_page_is_drawn_whole(browser, page, width):  # noqa: F811
    browser.open(page, width=width)
    assert browser.requests() == [] and browser.console() == []
    assert browser.overflow() == 0
    sizes = browser.run(
        "return [...document.querySelectorAll('figure svg')].map(s => [s.clientWidth, s.clientHeight])"
    )
    assert len(sizes) == 3 and all(min(size) > 100 for size in sizes)
    cut = browser.run(
        """return [...document.querySelectorAll('figure svg')].flatMap(svg => {
             const frame = svg.getBoundingClientRect();
             return [...svg.querySelectorAll('text')].filter(t => t.getBoundingClientRect().right > frame.right + 1
               || t.getBoundingClientRect().left < frame.left - 1).map(t => t.textContent);
           })"""
    )
    assert cut == []


def test_what_missed_comes_first_with_its_assumptions(browser, page):  # noqa: F811
    browser.open(page)
    missed, table = browser.find("table")
    rows = [line.text for line in missed.find_elements("css selector", "tbody tr")]
    assert [line.split()[2] for line in rows] == ["P2-broken", "P2-missed"]
    assert "+1900 %" in rows[1] and "± 10 %" in rows[1] and "mesh damping" in rows[1]
    verdicts = [cell.text for cell in table.find_elements("css selector", "tbody td:first-child")]
    assert verdicts[:2] == ["gate missed", "goal missed"] and verdicts[-1] == "not modelled"
    assert len(verdicts) == 36
    counts = browser.find(".counts")[0].text.split("\n")
    assert counts[:4] == ["1 of 2", "predicted rows within their goal", "31 of 32", "gates held"]
    first = browser.find("figure")[0].text
    for text in ("predicted", "verification", "P2-broken", "P2-missed"):
        assert text in first


def test_open_windows_and_markup_are_written_as_text(page):
    text = page.read_text(encoding="utf-8")
    assert "≥ 0.3" in text and "inf<" not in text
    assert "quantity &lt;P2-met&gt;" in text


def test_rows_without_any_number_make_a_page(tmp_path):
    waiting = PublishedQuantity(id="later", text="words", source="", unit="1", printed="rises")
    write_validation([not_modelled(waiting, "predicted", reason="none")], tmp_path)
    text = (tmp_path / "validation.html").read_text(encoding="utf-8")
    assert "<svg" not in text and "Every gate holds" in text
