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
    own_data = weasyprint.urls.URLFetcher(allowed_protocols=("data",))
    weasyprint.HTML(string=page, url_fetcher=own_data).write_pdf(str(path))


def _weasyprint() -> ModuleType:
    """The library; an OSError at its import is a system library that it does not find."""
    import importlib

    try:
        return importlib.import_module("weasyprint")
    except (ImportError, OSError) as error:
        raise MissingLibraryError(f"{REMEDY} ({error})") from error
