"""Where the tool keeps what only saves time: RIGDESIGN_CACHE_DIR, or the user's cache folder."""

import os
from pathlib import Path


def cache_folder() -> Path:
    """The folder; deleting it loses time only."""
    given = os.environ.get("RIGDESIGN_CACHE_DIR")
    if given:
        return Path(given)
    return Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "rigdesign"
