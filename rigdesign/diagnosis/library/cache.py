"""Libraries kept on disk by rig, sensors and plan, so that the next set of the same rig is quick.

A library is found again by the hash of the case and its effects with their bounds; of those stored, one serves whose
channels and operating points hold those asked for (`Library.serving`). A file is named after the SHA-256 of its
content and is read only where both agree; a damaged one is set aside, and what it held is computed again. The folder
is RIGDESIGN_CACHE_DIR or the user's cache folder; deleting it loses time only.
"""

import hashlib
import json
import os
import pickle
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from rigdesign.base.version import __version__
from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.library.library import Library, Response
from rigdesign.prediction.model import Channel, OperatingCondition, PredictionModel, measured_against
from thermal.fe.kernel_cache import cache_folder

SCHEMA = 5
"""Of the stored libraries; raise it with any change of what they hold."""
DAMAGED = ".damaged"
"""How the name of a file ends that was set aside."""

Progress = Callable[[str], None]


def _silent(message: str) -> None:
    """Say nothing."""


def library_of(
    case: Case,
    settings: Sequence[OperatingCondition],
    channels: Sequence[Channel],
    effects: Sequence[Effect],
    build: Callable[[], Library],
    say: Progress = _silent,
) -> Library:
    """A stored library that serves these points and channels, or the one ``build`` makes, stored.

    say : called with a sentence for every damaged file that is set aside
    """
    found = stored_library(case, settings, channels, effects, say)
    if found is not None:
        return found
    made = build()
    _store(_folder(case, effects, measured_against(channels)), made)
    serving = made.serving(tuple(settings), tuple(channels))
    assert serving is not None
    return serving


def stored_library(
    case: Case,
    settings: Sequence[OperatingCondition],
    channels: Sequence[Channel],
    effects: Sequence[Effect],
    say: Progress = _silent,
) -> Library | None:
    """Of the stored libraries that serve these points and channels the one nearest to them; None if there is none."""
    nearest, least = None, float("inf")
    for found in _stored(_folder(case, effects, measured_against(channels)), Library, say):
        if (distance := found.distance(settings)) >= least:
            continue
        serving = found.serving(tuple(settings), tuple(channels))
        if serving is not None:
            nearest, least = serving, distance
    return nearest


@dataclass(frozen=True)
class Parts:
    """Finished responses of a library in the making, kept with the libraries: an interrupted run goes on there."""

    folder: Path

    @classmethod
    def of(
        cls,
        case: Case,
        settings: Sequence[OperatingCondition],
        channels: Sequence[Channel],
        effects: Sequence[Effect],
        circuit: PredictionModel,
    ) -> "Parts":
        """Of one library: its rig, plan, sensors and model."""
        plan = hashlib.sha256(repr((tuple(settings), tuple(channels), circuit)).encode()).hexdigest()[:16]
        return cls(_folder(case, effects, circuit) / f"{plan}.parts")

    def known(self, say: Progress = _silent) -> dict[str, Response | None]:
        """Effect -> its response, None where the model refused it; ``say`` is called for damaged files."""
        found: dict[str, Response | None] = {}
        for part in _stored(self.folder, dict, say):
            found |= part
        return found

    def keep(self, responses: Mapping[str, Response | None]) -> None:
        """Store responses by effect."""
        _store(self.folder, dict(responses))

    def remove(self) -> None:
        """Forget them: the library is whole."""
        shutil.rmtree(self.folder, ignore_errors=True)


def _folder(case: Case, effects: Sequence[Effect], circuit: PredictionModel) -> Path:
    return cache_folder() / "diagnosis" / _key(case, effects, circuit)


def _key(case: Case, effects: Sequence[Effect], circuit: PredictionModel) -> str:
    content = {
        "schema": SCHEMA,
        "version": __version__,
        "case": case.hash,
        "circuit": repr(circuit),
        "effects": [
            [effect.name, effect.linear, *(part.bounds for part in effect.parameters)] for effect in effects
        ],
    }
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:32]


T = TypeVar("T")


def _stored(folder: Path, kind: type[T], say: Progress) -> Iterator[T]:
    """What the whole files of a folder hold; damaged ones are set aside and reported."""
    for file in sorted(folder.glob("*.pickle")) if folder.is_dir() else ():
        found = _unpickled(file)
        if isinstance(found, kind):
            yield found
        else:
            _set_aside(file)
            say(
                f"{file} is damaged or cannot be read: it was set aside as {file.name}{DAMAGED} and is computed again"
            )


def _unpickled(file: Path) -> object:
    """The object a file holds; None where the content is not the one that the file is named after, or no object."""
    if not file.is_file():
        return None
    try:
        content = file.read_bytes()
        return pickle.loads(content) if _name(content) == file.name else None
    except Exception:  # pickle raises whatever the classes of another version do
        return None


def _set_aside(file: Path) -> None:
    """Out of the way of the next run; what cannot be renamed costs that run the same words again."""
    with suppress(OSError):
        file.replace(file.with_name(file.name + DAMAGED))


def _name(content: bytes) -> str:
    return f"{hashlib.sha256(content).hexdigest()[:16]}.pickle"


def _store(folder: Path, what: object) -> None:
    """BackgroundTasks, then renamed; a folder that cannot be written to costs time, not the result."""
    content = pickle.dumps(what, protocol=5)
    part = folder / f".{os.getpid()}.part"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        part.write_bytes(content)
        part.replace(folder / _name(content))
    except OSError:
        with suppress(OSError):
            part.unlink(missing_ok=True)
