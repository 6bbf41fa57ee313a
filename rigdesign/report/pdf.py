"""report.pdf: the page of the report on A4, by WeasyPrint (extra ``pdf``), which runs no script and fetches nothing."""

from pathlib import Path
from types import ModuleType

from rigdesign.base.errors import MissingLibraryError

REMEDY = (
    "--pdf needs WeasyPrint and the system library Pango; run: pip install 'rigdesign[pdf]' and "
    "apt-get install -y --no-install-recommends libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0"
)


def require_pdf() -> None:
    """Check that a PDF can be made, before anything is computed.

    Raises
    ------
    MissingLibraryError
        WeasyPrint or Pango is not installed; names the commands that install them.
    """
    _weasyprint()


def write_pdf(page: str, path: Path) -> None:
    """Write a report page as PDF.

    page : text of report.html; nothing it names is fetched

    Raises
    ------
    MissingLibraryError
        WeasyPrint or Pango is not installed.
    """
    weasyprint = _weasyprint()
    document = weasyprint.HTML(string=page, url_fetcher=_nothing)
    document.write_pdf(str(path), presentational_hints=False)


def _weasyprint() -> ModuleType:
    """The library; an OSError at its import is a system library that it does not find."""
    import importlib

    try:
        return importlib.import_module("weasyprint")
    except (ImportError, OSError) as error:
        raise MissingLibraryError(f"{REMEDY} ({error})") from error


def _nothing(address: str, *_: object, **__: object) -> dict[str, object]:
    """Data addresses are part of the page; everything else stays where it is."""
    from weasyprint import default_url_fetcher

    if address.startswith("data:"):
        found: dict[str, object] = default_url_fetcher(address)
        return found
    raise ValueError(f"the report fetches nothing: {address[:80]}")
