"""Writes results.json, junit.xml, fields, curves and the self-contained report to a folder."""

import json
from pathlib import Path
from typing import Any

from rigdesign.base.json_text import to_text
from rigdesign.base.output_folder import file_stem, remove_published, staged
from rigdesign.report.input_sheets import Issue
from rigdesign.report.results_json import FAILURE, results_document
from rigdesign.results.result import RunResult


def write_results(result: RunResult, out: Path, issue: Issue | None = None, *, pdf: bool = False) -> None:
    """Write results.json, report.html, junit.xml, fields/*.vtu and curves/*.csv to the folder ``out``.

    issue : date and author of the report; today's without; pdf : the report as report.pdf as well

    Every file appears whole or not at all, results.json last. Files of an earlier run in the same folder that
    this run does not write are removed; other files are left alone.

    Raises
    ------
    OutputError
        If the folder cannot be written.
    NonFiniteResultError
        If a result is NaN or infinite; nothing is written then.
    MissingLibraryError
        With ``pdf``: WeasyPrint or Pango is not installed.
    """
    from rigdesign.report.junit import write_junit

    document = results_document(result, beside_files=True)
    earlier = _published_before(out)
    with staged(out) as scratch:
        document["fields"] = _write_fields(result, scratch)
        _write_curves(result, scratch)
        _write_pages(result, scratch, issue, pdf=pdf)
        write_junit(result, scratch / "junit.xml")
        files = [path.relative_to(scratch).as_posix() for path in scratch.rglob("*") if path.is_file()]
        document["files"] = sorted([*files, "results.json"])
        (scratch / "results.json").write_text(to_text(document), encoding="utf-8", newline="\n")
    remove_published(out, sorted({*earlier, FAILURE} - set(document["files"])))


def _write_fields(result: RunResult, folder: Path) -> list[dict[str, Any]]:
    from rigdesign.report.fields import write_field

    (folder / "fields").mkdir()
    entries = []
    for field in result.fields:
        name = f"fields/{file_stem(field.gearbox, field.stage)}.vtu"
        entries.append({"file": name, **write_field(field, folder / name)})
    return entries


def _write_curves(result: RunResult, folder: Path) -> None:
    from rigdesign.report.tables import curve_tables

    (folder / "curves").mkdir()
    for name, text in curve_tables(result).items():
        (folder / "curves" / name).write_text(text, encoding="utf-8", newline="\n")


def write_report(result: RunResult, out: Path, issue: Issue, *, html: bool, pdf: bool) -> list[Path]:
    """Write the report alone, into a folder that may hold the result; the files written.

    A results.json there lists them from then on, so that the next run in this folder replaces them.

    Raises
    ------
    OutputError, MissingLibraryError
        As `write_results`.
    """
    listed = _published_before(out)
    with staged(out) as scratch:
        _write_pages(result, scratch, issue, html=html, pdf=pdf)
        names = sorted(path.name for path in scratch.iterdir())
        if set(names) - set(listed) and listed:
            document = json.loads((out / "results.json").read_text(encoding="utf-8"))
            document["files"] = sorted({*listed, *names})
            (scratch / "results.json").write_text(to_text(document), encoding="utf-8", newline="\n")
    return [out / name for name in names]


def _write_pages(
    result: RunResult, folder: Path, issue: Issue | None, *, html: bool = True, pdf: bool = False
) -> None:
    from rigdesign.report.pages.report import report_html

    page = report_html(result, issue)
    if html:
        (folder / "report.html").write_text(page, encoding="utf-8", newline="\n")
    if pdf:
        from rigdesign.report.pdf import write_pdf

        write_pdf(page, folder / "report.pdf")


def _published_before(out: Path) -> list[str]:
    """Files that an earlier results.json in this folder lists; an unreadable one lists none."""
    try:
        listed = json.loads((out / "results.json").read_text(encoding="utf-8")).get("files", [])
    except (OSError, ValueError, AttributeError):
        return []
    return [name for name in listed if isinstance(name, str)]
