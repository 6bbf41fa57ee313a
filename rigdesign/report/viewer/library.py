"""Files of the turnable picture that go into the page: script, style, and the drawing library as it was published."""

from base64 import b64encode
from functools import cache
from pathlib import Path

FOLDER = Path(__file__).parent
LIBRARY = FOLDER / "bundle" / "plotly-gl3d.min.js.gz"


@cache
def drawing_library() -> str:
    """plotly.js gl3d as gzip in base64, 0.74 MB: unpacked by the page itself."""
    return b64encode(LIBRARY.read_bytes()).decode("ascii")


@cache
def viewer_text(name: str) -> str:
    """A script or style of this folder."""
    return (FOLDER / name).read_text(encoding="utf-8")
