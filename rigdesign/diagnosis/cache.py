"""Libraries kept on disk by rig, sensors and plan, so that the next set of the same rig is quick.

A library is found again by the hash of the case and its effects with their bounds; of those stored, one serves whose
channels and operating points hold those asked for (`Library.serving`). The folder is RIGDESIGN_CACHE_DIR or the user's
cache folder; deleting it loses time only.
"""

import hashlib
import json
import os
import pickle
import shutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rigdesign import __version__
from rigdesign.case.model import Case
from rigdesign.diagnosis.effects import Effect
from rigdesign.diagnosis.library import Library, Response
from rigdesign.prediction.model import Channel, Setting

SCHEMA = 3
"""Of the stored libraries; raise it with any change of what they hold."""


def cache_folder() -> Path:
    """Where libraries are kept."""
    given = os.environ.get("RIGDESIGN_CACHE_DIR")
    if given:
        return Path(given)
    return Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "rigdesign"


def library_of(
    case: Case,
    settings: Sequence[Setting],
    channels: Sequence[Channel],
    effects: Sequence[Effect],
    build: Callable[[], Library],
) -> Library:
    """A stored library that serves these points and channels, or the one ``build`` makes, stored."""
    found = stored_library(case, settings, channels, effects)
    if found is not None:
        return found
    made = build()
    _store(_folder(case, effects), made)
    serving = made.serving(tuple(settings), tuple(channels))
    assert serving is not None
    return serving


def stored_library(
    case: Case, settings: Sequence[Setting], channels: Sequence[Channel], effects: Sequence[Effect]
) -> Library | None:
    """Of the stored libraries that serve these points and channels the one nearest to them; None if there is none."""
    folder = _folder(case, effects)
    nearest, least = None, float("inf")
    for file in sorted(folder.glob("*.pickle")) if folder.is_dir() else ():
        found = _read(file)
        if found is None or (distance := found.distance(settings)) >= least:
            continue
        serving = found.serving(tuple(settings), tuple(channels))
        if serving is not None:
            nearest, least = serving, distance
    return nearest


@dataclass(frozen=True)
class Parts:
    """Finished responses of a library in the making, kept beside the libraries: an interrupted run goes on there."""

    folder: Path

    @classmethod
    def of(
        cls, case: Case, settings: Sequence[Setting], channels: Sequence[Channel], effects: Sequence[Effect]
    ) -> "Parts":
        """Of one library: its rig, plan and sensors."""
        plan = hashlib.sha256(repr((tuple(settings), tuple(channels))).encode()).hexdigest()[:16]
        return cls(_folder(case, effects) / f"{plan}.parts")

    def known(self) -> dict[str, Response | None]:
        """Effect -> its response, None where the model refused it."""
        found: dict[str, Response | None] = {}
        for file in sorted(self.folder.glob("*.pickle")) if self.folder.is_dir() else ():
            part = _unpickled(file)
            if isinstance(part, dict):
                found |= part
        return found

    def keep(self, responses: Mapping[str, Response | None]) -> None:
        """Store responses by effect."""
        _store(self.folder, dict(responses))

    def remove(self) -> None:
        """Forget them: the library is whole."""
        shutil.rmtree(self.folder, ignore_errors=True)


def _folder(case: Case, effects: Sequence[Effect]) -> Path:
    return cache_folder() / "diagnosis" / _key(case, effects)


def _key(case: Case, effects: Sequence[Effect]) -> str:
    content = {
        "schema": SCHEMA,
        "version": __version__,
        "case": case.hash,
        "effects": [[effect.name, *(part.bounds for part in effect.parameters)] for effect in effects],
    }
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:32]


def _read(file: Path) -> Library | None:
    found = _unpickled(file)
    return found if isinstance(found, Library) else None


def _unpickled(file: Path) -> object:
    """A file that is cut or from another version is as good as none."""
    try:
        return pickle.loads(file.read_bytes())
    except (OSError, pickle.UnpicklingError, EOFError, AttributeError, ImportError, IndexError):
        return None


def _store(folder: Path, what: object) -> None:
    """Beside, then renamed; a folder that cannot be written to costs time, not the result."""
    content = pickle.dumps(what, protocol=5)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        beside = folder / f".{os.getpid()}.part"
        beside.write_bytes(content)
        beside.replace(folder / f"{hashlib.sha256(content).hexdigest()[:16]}.pickle")
    except OSError:
        return
