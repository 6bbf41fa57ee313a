"""Libraries kept on disk by rig, sensors and plan, so that the next set of the same rig is quick.

A library is found again by the hash of the case and its effects with their bounds; of those stored, one serves whose
channels and operating points hold those asked for (`Library.serving`). A file is named after the SHA-256 of its
content and is read only where both agree; a damaged one is set aside, and what it held is computed again. It is an
archive of arrays with their names as JSON: nothing in it is run. The folder is RIGDESIGN_CACHE_DIR or the user's cache
folder; deleting it loses time only.
"""

import hashlib
import io
import json
import shutil
import zipfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from rigdesign.base.output_folder import replace_whole
from rigdesign.base.version import __version__
from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.library.library import Library, Response
from rigdesign.prediction.model import (
    Channel,
    Feature,
    OperatingCondition,
    PredictionModel,
    measured_against,
)
from thermal.fe.kernel_cache import cache_folder

SCHEMA = 6
"""Of the stored libraries; raise it with any change of what they hold."""
ENDING = ".npz"
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
    stored = stored_library(case, settings, channels, effects, say)
    if stored is not None:
        return stored
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
    for stored in _stored(_folder(case, effects, measured_against(channels)), say):
        if not isinstance(stored, Library):
            continue
        if (distance := stored.distance(settings)) >= least:
            continue
        serving = stored.serving(tuple(settings), tuple(channels))
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
        responses: dict[str, Response | None] = {}
        for part in _stored(self.folder, say):
            responses |= {} if isinstance(part, Library) else part
        return responses

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


Stored = Library | Mapping[str, Response | None]


def _stored(folder: Path, say: Progress) -> Iterator[Stored]:
    """What the whole files of a folder hold; damaged ones are set aside and reported, as are those of others."""
    for file in sorted(filter(Path.is_file, folder.glob(f"*{ENDING}"))):
        try:
            content = file.read_bytes()
        except OSError as error:
            say(f"{file} cannot be read ({error.strerror}): what it holds is computed again")
            continue
        stored = _unpacked(content) if _name(content) == file.name else None
        if stored is not None:
            yield stored
            continue
        with suppress(OSError):  # what cannot be renamed costs the next run the same words again
            file.replace(file.with_name(file.name + DAMAGED))
        say(f"{file} is damaged: it was set aside as {file.name}{DAMAGED} and is computed again")


def _name(content: bytes) -> str:
    return f"{hashlib.sha256(content).hexdigest()[:16]}{ENDING}"


def _store(folder: Path, stored: Stored) -> None:
    """A folder that cannot be written to costs time, not the result."""
    content = _packed(stored)
    with suppress(OSError):
        replace_whole(folder / _name(content), content)


COLUMNS = ("inputs", "links", "sources", "dry_sources")
"""Of a library: name -> (n,)."""


class _Index(BaseModel):
    """What of a file is not numbers: the names of its arrays, in their order."""

    whole: bool = False
    channels: tuple[Channel, ...] = ()
    settings: tuple[OperatingCondition, ...] = ()
    features: tuple[Feature, ...] = ()
    powers: dict[str, float] = {}
    error: float = 0.0
    columns: dict[str, list[tuple[str, ...]]] = {}
    responses: list[str] = []
    refused: list[str] = []


def _packed(stored: Stored) -> bytes:
    responses = stored.responses if isinstance(stored, Library) else stored
    known = {name: response for name, response in responses.items() if response is not None}
    arrays: dict[str, NDArray[Any]] = {}
    for number, response in enumerate(known.values()):
        arrays |= {f"coordinates {number}": response.coordinates, f"answers {number}": response.answers}
    index = _Index(responses=list(known), refused=[name for name in responses if name not in known])
    if isinstance(stored, Library):
        columns = {kind: getattr(stored, kind) for kind in COLUMNS}
        arrays |= {"base": stored.base, "modes": stored.modes}
        arrays |= {kind: np.array(list(column.values())) for kind, column in columns.items()}
        names = {
            kind: [(name,) if isinstance(name, str) else name for name in column]
            for kind, column in columns.items()
        }
        stated = {
            key: getattr(stored, key) for key in ("channels", "settings", "features", "powers", "error")
        }
        index = index.model_copy(update={**stated, "whole": True, "columns": names})
    stream = io.BytesIO()
    text = np.frombuffer(index.model_dump_json().encode(), np.uint8)
    np.savez(stream, allow_pickle=False, index=text, **arrays)
    return stream.getvalue()


def _unpacked(content: bytes) -> Stored | None:
    """What an archive holds; None for one that is no library of this version."""
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
        index = _Index.model_validate_json(arrays["index"].tobytes())
        responses = {
            name: Response(coordinates=arrays[f"coordinates {number}"], answers=arrays[f"answers {number}"])
            for number, name in enumerate(index.responses)
        }
        if not index.whole:
            return {**responses, **dict.fromkeys(index.refused)}
        columns: dict[str, Any] = {
            kind: {
                names if kind == "inputs" else names[0]: values
                for names, values in zip(index.columns[kind], arrays[kind], strict=True)
            }
            for kind in COLUMNS
        }
        return Library(
            channels=index.channels,
            settings=index.settings,
            features=index.features,
            base=arrays["base"],
            responses=responses,
            powers=index.powers,
            modes=arrays["modes"],
            error=index.error,
            **columns,
        )
    except (ValueError, KeyError, OSError, zipfile.BadZipFile):
        return None
